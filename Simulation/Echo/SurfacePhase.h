#pragma once

#include "Kernel/Rng.h"
#include "Kernel/SurfaceEcho.h"

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

/// The random phase of a point's diffuse echo: a function of the seed and of the place in the world, as scatterers'
/// amplitudes are. `kind` is the axis of a label's columns, or 3 for targets.
inline void setPhases(std::uint64_t seed, const Vec3i& cell, std::uint32_t kind, std::uint32_t number,
                      SurfacePoint& point)
{
  const RandomWords w = philox(seed, std::uint32_t(cell.x), std::uint32_t(cell.y), std::uint32_t(cell.z),
                               0x5f0ce000u | (kind << 10) | (number >> 4));
  const Vec2f& at = unitCircle()[(w.v[(number >> 2) & 3u] >> (8u * (number & 3u))) & 255u];
  point.phaseRe = at.x;
  point.phaseIm = at.y;
}

} // namespace sono
