#include "Phantoms/BeatingHeart.h"

#include "Phantoms/ThoraxHeart.h"
#include "Phantoms/ThoraxShapes.h"

#include <algorithm>
#include <cmath>

namespace sono {

using namespace shapes;

namespace {

constexpr double pi = 3.14159265358979323846;

const Vec2d axisMm(5.0, -0.5); // of the left ventricle, lateral and elevational

constexpr double annulusWayMm = 13.0;
constexpr double squeeze = 0.82; // E over the cavity's squared radius
constexpr double twistApexDeg = 8.0;
constexpr double twistBaseDeg = -4.0;
constexpr double fadeMm = 24.0;

// Of the way along the axis: it rises between the first two bends and falls between the last two.
constexpr double apexLowMm = 22.0, apexHighMm = 34.0;
constexpr double baseLowMm = 94.0, baseHighMm = 108.0;
constexpr double apexOfAtriaMm = 102.0; // the squeeze fades from there to the roof
constexpr double roofLowMm = 138.0, roofHighMm = 154.0;

/// Integral of smoothStep from below `low`.
double risen(double low, double high, double x)
{
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return (high - low) * (t * t * t - 0.5 * t * t * t * t) + std::max(0.0, x - high);
}

struct AlongAxis
{
  double mm;    ///< d
  double slope; ///< its derivative
};

AlongAxis wayAt(double z)
{
  constexpr double rising = 0.5 * (baseLowMm + baseHighMm - apexLowMm - apexHighMm);
  constexpr double falling = 0.5 * (roofLowMm + roofHighMm - baseLowMm - baseHighMm);
  constexpr double up = annulusWayMm / rising;
  constexpr double down = annulusWayMm / falling;
  const double apex = smoothStep(apexLowMm, apexHighMm, z);
  const double base = smoothStep(baseLowMm, baseHighMm, z);
  const double roof = smoothStep(roofLowMm, roofHighMm, z);
  const double a = risen(apexLowMm, apexHighMm, z);
  const double b = risen(baseLowMm, baseHighMm, z);
  const double c = risen(roofLowMm, roofHighMm, z);
  return { up * (a - b) - down * (b - c), up * (apex - base) - down * (base - roof) };
}

/// Squared radius of an ellipsoid about (87 mm, the ventricle's centre), fading out in the atria.
double squaredRadius(double z, double radiusMm, double halfLengthMm)
{
  const double t = (z - 87.0) / halfLengthMm;
  return radiusMm * radiusMm * std::max(0.0, 1.0 - t * t);
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

Vec3d heartRestingPlaceMm(const Vec3d& p, double phase)
{
  const double a = contractionAt(phase);
  constexpr double farMm = 30.0;
  if (a == 0.0 || glm::distance(p, heartSphereCentreMm()) > heartSphereRadiusMm(HeartShape{}) + farMm)
  {
    return p;
  }
  const double share = 1.0 - smoothStep(0.0, fadeMm, sampleHeart(p, HeartShape{}).outsideMm);
  const AlongAxis way = wayAt(p.z);
  const double m = 1.0 + a * way.slope;
  const double Z = p.z + a * way.mm;
  const double cavity = squaredRadius(Z, 20.5, 54.5);
  const double wall = squaredRadius(Z, 33.0, 63.5);
  const double inAtria = smoothStep(apexOfAtriaMm, roofLowMm, p.z);
  const double E = a * squeeze * cavity * (1.0 - inAtria);
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
  const double level = std::clamp((Z - 30.0) / (113.0 - 30.0), 0.0, 1.0);
  const double twist = a * (twistApexDeg + (twistBaseDeg - twistApexDeg) * level) * pi / 180.0 * (1.0 - inAtria) *
                       (1.0 - smoothStep(outer + 1.0, outer + 40.0, r));
  const double c = std::cos(twist);
  const double s = std::sin(twist);
  const Vec2d stood = stretch * Vec2d(c * q.x - s * q.y, s * q.x + c * q.y) + axisMm;
  return p + share * (Vec3d(stood.x, stood.y, Z) - p);
}

Vec3d heartPlaceMm(const Vec3d& resting, double phase)
{
  Vec3d p = resting;
  for (int step = 0; step < 200; ++step)
  {
    const Vec3d missing = resting - heartRestingPlaceMm(p, phase);
    p += 0.7 * missing;
    if (glm::length(missing) < 1e-9)
    {
      break;
    }
  }
  return p;
}

} // namespace sono
