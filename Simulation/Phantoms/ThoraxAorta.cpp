#include "Phantoms/ThoraxAorta.h"

#include "Phantoms/ThoraxShapes.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <array>
#include <cmath>

namespace sono {

namespace {

constexpr double ascendingRadiusMm = 12.5;
constexpr double descendingRadiusMm = 10.5;
constexpr double wallMm = 2.0;
constexpr double valveThicknessMm = 2.0;
// Of the open valve: 1.8 cm^2, half of a healthy one's, so that the leaflets stand clear of the wall. Nearer to it,
// their free edges would be taken for the ring that they hang in (findHeartLandmarks).
constexpr double orificeRadiusMm = 7.5;
constexpr double leafletHeightMm = 10.0;
constexpr double leafletThicknessMm = 1.4;

const Vec3d archEnd(22.0, 31.0, 62.0);
const Vec3d descendingEnd(18.0, 33.0, -200.0);

/// Cubic Bezier curve.
Vec3d bezier(const std::array<Vec3d, 4>& c, double t)
{
  const double s = 1.0 - t;
  return s * s * s * c[0] + 3.0 * s * s * t * c[1] + 3.0 * s * t * t * c[2] + t * t * t * c[3];
}

} // namespace

ThoraxAorta::ThoraxAorta(const Vec3d& valveMm, const Vec3d& axis, const AortaPhase& phase)
  : descending_(archEnd, descendingEnd, 0.0)
  , phase_(phase)
{
  const std::array<Vec3d, 4> control{ valveMm, valveMm + 70.0 * axis, archEnd + Vec3d(0.0, 0.0, 65.0), archEnd };
  const double reachMm = ascendingRadiusMm + wallMm + phase_.squeezedMm;
  lowMm_ = valveMm - reachMm;
  highMm_ = valveMm + reachMm;
  for (int i = 0; i < segments_; ++i)
  {
    const Vec3d end = bezier(control, double(i + 1) / segments_);
    line_.emplace_back(bezier(control, double(i) / segments_), end, 0.0);
    lowMm_ = glm::min(lowMm_, end - reachMm);
    highMm_ = glm::max(highMm_, end + reachMm);
  }
}

ThoraxLabel ThoraxAorta::tube(double radialMm, double radiusMm) const
{
  return radialMm < radiusMm ? AortaLumen : radialMm < radiusMm + wallMm + phase_.squeezedMm ? AortaWall : Background;
}

bool ThoraxAorta::isLeaflet(double radialMm, double alongMm) const
{
  const double orificeMm = phase_.valveOpening * orificeRadiusMm;
  if (radialMm < orificeMm)
  {
    return false;
  }
  const double heightMm = valveThicknessMm + phase_.valveOpening * (leafletHeightMm - valveThicknessMm);
  return alongMm < valveThicknessMm || (alongMm < heightMm && radialMm < orificeMm + leafletThicknessMm);
}

ThoraxAorta::Nearest ThoraxAorta::nearest(const Vec3d& p) const
{
  Nearest nearest{ 1e18, 0.0 };
  for (int i = 0; i < segments_; ++i)
  {
    const shapes::Capsule& segment = line_[std::size_t(i)];
    const double t = segment.along(p);
    const Vec3d away = p - segment.startMm - t * segment.alongMm;
    const double distanceMm2 = glm::dot(away, away);
    if (distanceMm2 < nearest.distanceMm2)
    {
      nearest = { distanceMm2, i + t };
    }
  }
  return nearest;
}

ThoraxLabel ThoraxAorta::sample(const Vec3d& p) const
{
  if (p.z < archEnd.z)
  {
    const double radialMm = descending_.distance(p);
    if (radialMm < descendingRadiusMm + wallMm + phase_.squeezedMm)
    {
      return tube(radialMm, descendingRadiusMm);
    }
  }
  if (glm::any(glm::lessThan(p, lowMm_)) || glm::any(glm::greaterThan(p, highMm_)))
  {
    return Background;
  }
  const auto [distanceMm2, along] = nearest(p);
  if (along <= 0.0)
  {
    return Background; // on the ventricle's side of the valve
  }
  const double nearestMm = std::sqrt(distanceMm2);
  const double radiusMm = glm::mix(ascendingRadiusMm, descendingRadiusMm, along / segments_);
  const bool leaflets = nearestMm < radiusMm && isLeaflet(nearestMm, along * glm::length(line_[0].alongMm));
  return leaflets ? AorticValve : tube(nearestMm, radiusMm);
}

double ThoraxAorta::leastOutsideMm(const Vec3d& p) const
{
  const double nearestMm = std::min(descending_.distance(p), std::sqrt(nearest(p).distanceMm2));
  return nearestMm - ascendingRadiusMm - wallMm - phase_.squeezedMm; // the widest
}

} // namespace sono
