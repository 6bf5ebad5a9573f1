#pragma once

#include "Kernel/Vec.h"

#include <algorithm>
#include <cmath>

/// Implicit shapes of the bundled anatomy: functions that are negative inside and near the surface equal the
/// distance in mm (exact for capsules and planes, first order for ellipsoids).
namespace sono::shapes {

/// Ellipsoid with semi-axes `radii` along the coordinate axes; `p` relative to its centre. First-order distance
/// k0 (k0 - 1) / k1 with k0 = |p/r|, k1 = |p/r^2| (Quilez 2008).
inline double ellipsoid(const Vec3d& p, const Vec3d& radii)
{
  const Vec3d scaled = p / radii;
  const double k0 = glm::length(scaled);
  const double k1 = glm::length(scaled / radii);
  return k1 < 1e-9 ? -std::min({ radii.x, radii.y, radii.z }) : k0 * (k0 - 1.0) / k1;
}

/// Fraction along the segment a-b of the point nearest to `p`, in [0, 1].
inline double alongSegment(const Vec3d& p, const Vec3d& a, const Vec3d& b)
{
  const Vec3d ab = b - a;
  return std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
}

/// Capsule from a to b whose radius goes linearly from ra to rb.
inline double capsule(const Vec3d& p, const Vec3d& a, const Vec3d& b, double ra, double rb)
{
  const double t = alongSegment(p, a, b);
  return glm::length(p - (a + t * (b - a))) - (ra + t * (rb - ra));
}

/// Union of two shapes, their edge filled over a width of `k` mm (quadratic polynomial blend).
inline double smoothUnion(double a, double b, double k)
{
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - 0.25 * k * h * h;
}

/// Intersection of two shapes, its edge rounded over a width of `k` mm.
inline double smoothIntersection(double a, double b, double k)
{
  return -smoothUnion(-a, -b, k);
}

/// 0 below `low`, 1 above `high`, a cubic between.
inline double smoothStep(double low, double high, double x)
{
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

} // namespace sono::shapes
