#pragma once

#include "Echo/SurfaceLoops.h"
#include "Kernel/SurfacePiece.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace sono {

/// 256 directions of the unit circle: as random as speckle needs.
inline const std::array<Vec2f, 256>& unitCircle()
{
  static const std::array<Vec2f, 256> circle = [] {
    std::array<Vec2f, 256> made;
    for (int n = 0; n < 256; ++n)
    {
      made[std::size_t(n)] = Vec2f(std::cos(n * 0.024543693), std::sin(n * 0.024543693));
    }
    return made;
  }();
  return circle;
}

/// Sets the random phase of a point's diffuse echo (see surfacePhase).
inline void setPhase(std::uint64_t seed, const Vec3i& cell, std::uint32_t kind, std::uint32_t number,
                     SurfacePoint& point)
{
  const Vec2f& at = unitCircle()[surfacePhase(seed, cell, kind, number)];
  point.phaseRe = at.x;
  point.phaseIm = at.y;
}

/// The same of a piece's points, the last ones of a list, from `first` on.
inline void setPhases(std::uint64_t seed, const Vec3i& cell, std::uint32_t kind, int first, PointList& points)
{
  const std::array<Vec2f, 256>& circle = unitCircle();
  RandomWords phases{};
  for (int n = first; n < points.count; ++n)
  {
    const std::uint32_t number = std::uint32_t(n - first);
    if (number % 16u == 0u)
    {
      phases = surfacePhases(seed, cell, kind, number / 16u);
    }
    const Vec2f& at = circle[phaseAmong(phases, number)];
    points.phaseRe[std::size_t(n)] = at.x;
    points.phaseIm[std::size_t(n)] = at.y;
  }
}

} // namespace sono
