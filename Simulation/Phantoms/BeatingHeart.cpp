#include "Phantoms/BeatingHeart.h"

#include "Phantoms/ThoraxShapes.h"

#include <algorithm>
#include <cmath>

namespace sono {

using namespace shapes;

namespace {

constexpr double pi = 3.14159265358979323846;

const Vec2d axisMm(5.0, -0.5);    // of the left ventricle, lateral and elevational
constexpr double middleMm = 87.0; // its depth

constexpr double twistApexDeg = 8.0;
constexpr double twistBaseDeg = -4.0;
constexpr double fadeMm = 24.0;
constexpr double mitralMm = 113.0;

// Of the way along the axis: it rises between the apex and these.
constexpr double baseLowMm = 94.0, baseHighMm = 108.0;
constexpr double squeezeLowMm = 80.0, squeezeHighMm = 122.0; // squeeze and twist fade between: the annulus is a ring

// Of the default heart.
constexpr double healthySqueeze = 0.87;
constexpr double healthyPercent = 60.0;
constexpr double healthyWayMm = 13.0;

/// Integral of smoothStep from below `low`.
double risen(double low, double high, double x)
{
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return (high - low) * (t * t * t - 0.5 * t * t * t * t) + std::max(0.0, x - high);
}

/// Squared radius of an ellipsoid about the ventricle's middle.
double squaredRadius(double z, const Vec2d& radiusAndHalfLengthMm)
{
  const double t = (z - middleMm) / radiusAndHalfLengthMm.y;
  return radiusAndHalfLengthMm.x * radiusAndHalfLengthMm.x * std::max(0.0, 1.0 - t * t);
}

} // namespace

double contractionAt(double phase)
{
  const double t = phase - std::floor(phase);
  const double shortening = smoothStep(0.0, 0.35, t);
  const double early = smoothStep(0.40, 0.60, t);
  const double kick = smoothStep(0.85, 1.0, t);
  return shortening - 0.8 * early - 0.2 * kick;
}

double inflowOpeningAt(double phase)
{
  const double t = phase - std::floor(phase);
  const double closed = smoothStep(0.0, 0.04, t) - smoothStep(0.39, 0.45, t);
  const double halfShut = 0.5 * (smoothStep(0.52, 0.66, t) - smoothStep(0.82, 0.92, t));
  return 1.0 - closed - halfShut;
}

double outflowOpeningAt(double phase)
{
  const double t = phase - std::floor(phase);
  return smoothStep(0.04, 0.08, t) - smoothStep(0.32, 0.37, t);
}

HeartBeat::HeartBeat(const HeartShape& shape, double ejectionPercent, double phase)
  : heart_(shape)
  , contraction_(contractionAt(phase))
  , squeeze_(healthySqueeze * ejectionPercent / healthyPercent)
  , annulusWayMm_(healthyWayMm * std::min(1.0, ejectionPercent / healthyPercent))
{
  const double halfMm = 56.0 * std::sqrt(shape.leftScale); // of the cavity, as ThoraxHeart has it
  const double thick = shape.wallMm / 10.0;
  cavityMm_ = Vec2d(20.5 * shape.leftScale, halfMm - 1.5);
  wallMm_ = Vec2d(23.0 * shape.leftScale + 9.75 * thick + 0.25, halfMm + 6.5 * thick + 1.0);
  apexMm_ = middleMm - halfMm;
  apexLowMm_ = apexMm_ - 6.5 * thick - 2.5;
  apexHighMm_ = apexMm_ + 3.0;
  const double roofMm = std::max(112.5 + 35.0 * shape.leftAtriumScale, 104.0 + 44.0 * shape.rightAtriumScale);
  roofLowMm_ = roofMm - 10.0;
  roofHighMm_ = roofMm + 6.0;
}

HeartBeat::AlongAxis HeartBeat::wayAt(double z) const
{
  const double rising = 0.5 * (baseLowMm + baseHighMm - apexLowMm_ - apexHighMm_);
  const double falling = 0.5 * (roofLowMm_ + roofHighMm_ - baseLowMm - baseHighMm);
  const double up = annulusWayMm_ / rising;
  const double down = annulusWayMm_ / falling;
  const double apex = smoothStep(apexLowMm_, apexHighMm_, z);
  const double base = smoothStep(baseLowMm, baseHighMm, z);
  const double roof = smoothStep(roofLowMm_, roofHighMm_, z);
  const double a = risen(apexLowMm_, apexHighMm_, z);
  const double b = risen(baseLowMm, baseHighMm, z);
  const double c = risen(roofLowMm_, roofHighMm_, z);
  return { up * (a - b) - down * (b - c), up * (apex - base) - down * (base - roof) };
}

bool HeartBeat::isFar(const Vec3d& p) const
{
  constexpr double farMm = 30.0;
  return glm::distance(p, heartSphereCentreMm()) > heartSphereRadiusMm(heart_.shape()) + farMm;
}

Vec3d HeartBeat::restingPlaceMm(const Vec3d& p) const
{
  return restingPlaceMm(p, { -1e9, 1e9 });
}

bool HeartBeat::isAtRest(const DistanceBounds& outsideMm) const
{
  return contraction_ == 0.0 || outsideMm.leastMm >= fadeMm;
}

bool HeartBeat::asksFor(const Vec3d& p, const DistanceBounds& outsideMm) const
{
  return !isAtRest(outsideMm) && outsideMm.mostMm > 0.0 && !isFar(p);
}

Vec3d HeartBeat::restingPlaceMm(const Vec3d& p, const DistanceBounds& outsideMm) const
{
  if (isAtRest(outsideMm) || isFar(p))
  {
    return p;
  }
  const double own = outsideMm.mostMm <= 0.0                 ? 0.0
                     : outsideMm.leastMm == outsideMm.mostMm ? outsideMm.leastMm
                                                             : heart_.sample(p).outsideMm;
  const double share = 1.0 - smoothStep(0.0, fadeMm, own);
  return share > 0.0 ? carried(p, share) : p;
}

/// By a share of the way.
Vec3d HeartBeat::carried(const Vec3d& p, double share) const
{
  const double a = contraction_;
  const AlongAxis way = wayAt(p.z);
  const double m = 1.0 + a * way.slope;
  const double Z = p.z + a * way.mm;
  const double cavity = squaredRadius(Z, cavityMm_);
  const double wall = squaredRadius(Z, wallMm_);
  const double inVentricle = smoothStep(squeezeHighMm, squeezeLowMm, p.z);
  const double E = a * squeeze_ * cavity * inVentricle;
  // Now, of endocardium and epicardium.
  const double inner = std::sqrt(std::max(0.0, m * (cavity - E)));
  const double outer = std::sqrt(std::max(0.0, m * (wall - E)));
  const Vec2d q(p.x - axisMm.x, p.y - axisMm.y);
  const double r = glm::length(q);
  const auto stoodAt = [&](double now) {
    const double t = inner > 0.0 ? std::min(1.0, now / inner) : 1.0;
    return std::sqrt(now * now / m + E * t * t * (2.0 - t * t));
  };
  const double R = r <= outer ? stoodAt(r) : r + stoodAt(outer) - outer;
  const double stretch = r > 1e-9 ? R / r : 1.0;
  const double level = std::clamp((Z - apexMm_ + 1.0) / (mitralMm - apexMm_ + 1.0), 0.0, 1.0);
  const double twist = a * (twistApexDeg + (twistBaseDeg - twistApexDeg) * level) * pi / 180.0 * inVentricle *
                       (1.0 - smoothStep(outer + 1.0, outer + 40.0, r));
  const double c = std::cos(twist);
  const double s = std::sin(twist);
  const Vec2d stood = stretch * Vec2d(c * q.x - s * q.y, s * q.x + c * q.y) + axisMm;
  return p + share * (Vec3d(stood.x, stood.y, Z) - p);
}

Vec3d HeartBeat::placeMm(const Vec3d& resting) const
{
  Vec3d p = resting;
  for (int step = 0; step < 200; ++step)
  {
    const Vec3d missing = resting - restingPlaceMm(p);
    p += 0.7 * missing;
    if (glm::length(missing) < 1e-9)
    {
      break;
    }
  }
  return p;
}

} // namespace sono
