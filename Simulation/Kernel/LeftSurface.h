#pragma once

#include "Kernel/BoundaryRecord.h"

#include <cstdint>

namespace sono {

/// The surface that a path has left last: the tissue on its other side, the plane of the surface there, and how far the
/// path's position lies above that.
struct LeftSurface
{
  std::uint32_t bits = 255u; ///< tissue in the low byte, 255: none; octahedral normal 12 + 12, 0.03 degrees
  float heightMm = 0.0f;     ///< of where the path goes on from

  SONO_HD bool isThere() const { return tissue() != 255; }
  SONO_HD int tissue() const { return int(bits & 255u); }
  /// Into the medium that the path goes on in.
  SONO_HD Vec3f normal() const
  {
    return glm::normalize(fromOctahedron(float((bits >> 8) & 4095u) * (2.0f / 4094.0f) - 1.0f,
                                         float(bits >> 20) * (2.0f / 4094.0f) - 1.0f));
  }
};

SONO_HD inline LeftSurface leftSurface(int tissue, const Vec3f& normal, float heightMm)
{
  const Vec2f n = ontoOctahedron(normal);
  const std::uint32_t u = std::uint32_t((n.x * 0.5f + 0.5f) * 4094.0f + 0.5f);
  const std::uint32_t v = std::uint32_t((n.y * 0.5f + 0.5f) * 4094.0f + 0.5f);
  return { std::uint32_t(tissue) | (u << 8) | (v << 20), heightMm };
}

} // namespace sono
