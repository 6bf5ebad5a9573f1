#include "Phantoms/ThoraxAorta.h"

#include "Phantoms/ThoraxShapes.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

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
  : phase_(phase)
{
  const std::array<Vec3d, 4> control{ valveMm, valveMm + 70.0 * axis, archEnd + Vec3d(0.0, 0.0, 65.0), archEnd };
  for (int i = 0; i <= segments_; ++i)
  {
    points_[i] = bezier(control, double(i) / segments_);
  }
  lowMm_ = highMm_ = points_[0];
  for (const Vec3d& point : points_)
  {
    lowMm_ = glm::min(lowMm_, point - (ascendingRadiusMm + wallMm + phase_.squeezedMm));
    highMm_ = glm::max(highMm_, point + (ascendingRadiusMm + wallMm + phase_.squeezedMm));
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

ThoraxLabel ThoraxAorta::sample(const Vec3d& p) const
{
  if (p.z < archEnd.z)
  {
    const double radialMm = shapes::capsule(p, archEnd, descendingEnd, 0.0, 0.0);
    if (radialMm < descendingRadiusMm + wallMm + phase_.squeezedMm)
    {
      return tube(radialMm, descendingRadiusMm);
    }
  }
  if (glm::any(glm::lessThan(p, lowMm_)) || glm::any(glm::greaterThan(p, highMm_)))
  {
    return Background;
  }
  double nearestMm = 1e9;
  double along = 0.0;
  for (int i = 0; i < segments_; ++i)
  {
    const double t = shapes::alongSegment(p, points_[i], points_[i + 1]);
    const double distance = glm::length(p - glm::mix(points_[i], points_[i + 1], t));
    if (distance < nearestMm)
    {
      nearestMm = distance;
      along = i + t;
    }
  }
  if (along <= 0.0)
  {
    return Background; // on the ventricle's side of the valve
  }
  const double radiusMm = glm::mix(ascendingRadiusMm, descendingRadiusMm, along / segments_);
  const bool leaflets = nearestMm < radiusMm && isLeaflet(nearestMm, along * glm::length(points_[1] - points_[0]));
  return leaflets ? AorticValve : tube(nearestMm, radiusMm);
}

} // namespace sono
