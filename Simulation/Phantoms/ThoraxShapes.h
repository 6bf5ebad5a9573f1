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

/// The same about a centre, for many points.
struct Ellipsoid
{
  Vec3d centreMm{ 0.0 };
  Vec3d perMm{ 1.0 };   ///< 1 / radii
  double leastMm = 1.0; ///< the least of the radii

  Ellipsoid() = default;
  Ellipsoid(const Vec3d& centre, const Vec3d& radii)
    : centreMm(centre)
    , perMm(1.0 / radii)
    , leastMm(std::min({ radii.x, radii.y, radii.z }))
  {
  }

  double distance(const Vec3d& p) const
  {
    const Vec3d scaled = (p - centreMm) * perMm;
    const double k0 = glm::length(scaled);
    const double k1 = glm::length(scaled * perMm);
    return k1 < 1e-9 ? -leastMm : k0 * (k0 - 1.0) / k1;
  }

  /// Not more than any distance within `aroundMm` of a point. There k0 and k1 are off by no more than `aroundMm` over
  /// the least radius and its square, and the distance grows with k0 from 1/2 on and falls with k1.
  double leastAround(const Vec3d& p, double aroundMm) const
  {
    const Vec3d scaled = (p - centreMm) * perMm;
    const double k0 = glm::length(scaled) - aroundMm / leastMm;
    const double k1 = glm::length(scaled * perMm) + aroundMm / (leastMm * leastMm);
    return k0 > 1.0 ? k0 * (k0 - 1.0) / k1 : -1e9;
  }

  /// Not less than any; that of a point that is near the surface is large. k0 / k1 is the least radius or more.
  double mostAround(const Vec3d& p, double aroundMm) const
  {
    const double k0 = glm::length((p - centreMm) * perMm) + aroundMm / leastMm;
    return k0 < 1.0 ? (k0 - 1.0) * leastMm : 1e9;
  }
};

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

/// The same for many points, of one radius.
struct Capsule
{
  Vec3d startMm, alongMm;
  double perMm2; ///< 1 / length^2
  double radiusMm;

  Capsule(const Vec3d& a, const Vec3d& b, double radius)
    : startMm(a)
    , alongMm(b - a)
    , perMm2(1.0 / glm::dot(b - a, b - a))
    , radiusMm(radius)
  {
  }

  /// Fraction along it of the point nearest to `p`, in [0, 1].
  double along(const Vec3d& p) const { return std::clamp(glm::dot(p - startMm, alongMm) * perMm2, 0.0, 1.0); }
  double distance(const Vec3d& p) const { return glm::length(p - startMm - along(p) * alongMm) - radiusMm; }
};

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

/// Sine of a number within 1000, to 10^-13, which a loop can take by vectors.
inline double sine(double x)
{
  constexpr double pi = 3.14159265358979323846;
  constexpr double twoPiLow = 2.4492935982947064e-16; // what a number leaves of it
  constexpr double round = 6755399441055744.0;        // 1.5 * 2^52
  const double turns = (x * (0.5 / pi) + round) - round;
  const double r = (x - turns * (2.0 * pi)) - turns * twoPiLow;
  const double mirrored = (r > 0.0 ? pi : -pi) - r;
  const double t = r * r > 0.25 * pi * pi ? mirrored : r; // within a quarter turn
  const double t2 = t * t;
  // Taylor's series.
  double sum = 1.0 / 355687428096000.0;
  sum = sum * t2 - 1.0 / 1307674368000.0;
  sum = sum * t2 + 1.0 / 6227020800.0;
  sum = sum * t2 - 1.0 / 39916800.0;
  sum = sum * t2 + 1.0 / 362880.0;
  sum = sum * t2 - 1.0 / 5040.0;
  sum = sum * t2 + 1.0 / 120.0;
  sum = sum * t2 - 1.0 / 6.0;
  return t + t * t2 * sum;
}

/// 0 below `low`, 1 above `high`, a cubic between.
inline double smoothStep(double low, double high, double x)
{
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

} // namespace sono::shapes
