#pragma once

#include "Kernel/BoundaryRecord.h"

#include <cstdint>

namespace sono {

/// The surface that a path has left last: the tissue on its other side and the plane of the surface there. The normal,
/// into the medium that the path goes on in, lies on the octahedron, not on the sphere: lengths along it are in its
/// units.
struct LeftSurface
{
  std::uint32_t bits = 0u; ///< tissue in the low byte; octahedral normal 12 + 12, 0.03 degrees
  float heightMm = 3e38f;  ///< above the plane, of where the path goes on from; so high: no surface has been left

  SONO_HD int tissue() const { return int(bits & 255u); }
  SONO_HD Vec3f normal() const
  {
    return fromOctahedron(float((bits >> 8) & 4095u) * (2.0f / 4094.0f) - 1.0f,
                          float(bits >> 20) * (2.0f / 4094.0f) - 1.0f);
  }
  /// The path has gone on by this way.
  SONO_HD void move(const Vec3f& way) { heightMm += glm::dot(normal(), way); }
};

/// `heightMm` in lengths of the unit normal.
SONO_HD inline LeftSurface leftSurface(int tissue, const Vec3f& normal, float heightMm)
{
  const Vec2f n = ontoOctahedron(normal);
  const std::uint32_t u = std::uint32_t((n.x * 0.5f + 0.5f) * 4094.0f + 0.5f);
  const std::uint32_t v = std::uint32_t((n.y * 0.5f + 0.5f) * 4094.0f + 0.5f);
  const float scale = fabsf(normal.x) + fabsf(normal.y) + fabsf(normal.z);
  return { std::uint32_t(tissue) | (u << 8) | (v << 20), heightMm / scale };
}

} // namespace sono
