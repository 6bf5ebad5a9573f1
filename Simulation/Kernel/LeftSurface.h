#pragma once

#include "Kernel/BoundaryRecord.h"
#include "Kernel/HostDevice.h"
#include "Kernel/Vec.h"

#include <cstdint>

// The surface that a path has left last. Its voxels are a staircase: near it, a path meets voxels of the tissue on its
// other side although it goes away from it. Those do not count. What does is told from them by the records, where such
// a voxel is met: it costs nothing elsewhere.

namespace sono {

/// In 29 bits: the tissue on the other side; the octahedral normal, into the medium that the path goes on in; whether
/// that is smooth, or but a voxel's face. -1: none, by a tissue that there is not.
using LeftSurface = std::int32_t;
constexpr LeftSurface noSurfaceLeft = -1;

SONO_HD inline LeftSurface leftSurface(int tissue, const Vec3f& normal, bool smooth)
{
  return LeftSurface(std::uint32_t(tissue) | (encodeOctahedral(normal) << 8) | (smooth ? 1u << 28 : 0u));
}

SONO_HD inline int tissueBehind(LeftSurface left)
{
  return left & 255;
}

/// On the octahedron: its length is between 0.57 and 1.
SONO_HD inline Vec3f normalOf(LeftSurface left)
{
  return decodeOctahedral(std::uint32_t(left) >> 8);
}

/// Whether a ray that comes from voxel `before` into voxel `after`, of the tissue behind the surface left, just passes
/// a stair of that. It does not where the surface there faces the other way (a thin wall's far side), nor where the ray
/// enters it by more than 2 to 4 degrees, which normals are exact to. The steeper record of the two tells, or, where
/// `before` is of a stair as well, that of `after`. In walls of a voxel neither does: there a ray that leaves steeply
/// passes, but not through a face that looks along the normal left. Behind the corner of a stair on a flat wall there
/// may be a voxel that touches no other tissue: it counts as the stair that it was reached from. Others of that kind
/// are no stairs.
template<class Cells>
SONO_HD inline bool isStairOf(const Cells& cells, LeftSurface left, const Vec3f& direction, const Vec3i& before,
                              const Vec3i& after, std::uint32_t wordAfter)
{
  constexpr std::uint32_t flat = 7; // confidence, sevenths
  constexpr std::uint32_t told = 2; // as in refineBoundary
  const std::uint32_t wordBefore = cells.wordAt(before.x, before.y, before.z);
  const std::uint32_t bitsBefore = cells.recordOf(before.x, before.y, before.z, wordBefore);
  const std::uint32_t bitsAfter = cells.recordOf(after.x, after.y, after.z, wordAfter);
  if (bitsAfter == 0u && ((wordAfter >> 8) != 0u || (bitsBefore >> 29) < flat))
  {
    return false;
  }
  const bool alongStairs = int(wordBefore & 255u) == tissueBehind(left);
  const bool byAfter = bitsAfter != 0u && (alongStairs || (bitsAfter >> 29) > (bitsBefore >> 29));
  const std::uint32_t bits = byAfter ? bitsAfter : bitsBefore;
  const Vec3f back = normalOf(left);
  const bool leavesSteeply = ((left >> 28) & 1) == 0 || glm::dot(direction, back) > 0.22f;
  if ((bits >> 29) < told && leavesSteeply)
  {
    return alongStairs || glm::dot(Vec3f(after - before), back) <= 0.9f;
  }
  const Vec3f out = decodeOctahedral(bits);
  const Vec3f into = byAfter || alongStairs ? -out : out;
  return glm::dot(into, back) <= 0.0f && glm::dot(direction, into) <= 0.04f;
}

} // namespace sono
