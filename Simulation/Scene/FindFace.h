#pragma once

#include "Kernel/Vec.h"
#include "Scene/Lanes.h"
#include "Scene/SurfaceFace.h"

#include <cstddef>

// The faces between voxels of different tissues, on a core or by a thread of a GPU (SurfacePieces).

namespace sono::stepfit {
inline namespace SONO_LANES_NAMESPACE {

constexpr float certainlyNot = 0.25f; // facing of a coarse normal along the column: of the piece's less than 0.5

/// A volume's tissue indices.
struct TissueVolume
{
  const std::uint8_t* tissues;
  Vec3i size;

  SONO_LANES std::uint8_t at(const Vec3i& v) const
  {
    return tissues[v.x + size.x * (v.y + std::ptrdiff_t(size.y) * v.z)];
  }
};

/// From the mean place of the tissue below to that of the one above, in the 5 x 5 x 4 voxels around a face; in voxels,
/// any length.
SONO_LANES inline Vec3f coarseNormal(const TissueVolume& volume, const Vec3i& voxel, const Vec3i& next, int axis)
{
  Vec3i low = voxel - 2;
  Vec3i high = voxel + 2;
  low[axis] = voxel[axis] - 1;
  const std::uint8_t below = volume.at(voxel);
  const std::uint8_t above = volume.at(next);
  Vec3f middle(voxel);
  middle[axis] += 0.5f;
  low = glm::max(low, Vec3i(0));
  high = glm::min(high, volume.size - 1);
  Vec3f sum(0.0f);
  for (int k = low.z; k <= high.z; ++k)
  {
    for (int j = low.y; j <= high.y; ++j)
    {
      for (int i = low.x; i <= high.x; ++i)
      {
        const std::uint8_t t = volume.at(Vec3i(i, j, k));
        const float sign = t == above ? 1.0f : (t == below ? -1.0f : 0.0f);
        sum += sign * (Vec3f(i, j, k) - middle);
      }
    }
  }
  return sum;
}

/// The face above a voxel along an axis; false where there is none, or where columns of another axis certainly stand
/// for all of it.
SONO_LANES inline bool findFace(const TissueVolume& volume, const Vec3f& spacingMm, const Vec3i& voxel, int axis,
                                SurfaceFace& face)
{
  Vec3i next = voxel;
  ++next[axis];
  if (next[axis] >= volume.size[axis] || volume.at(voxel) == volume.at(next))
  {
    return false;
  }
  const Vec3f coarse = coarseNormal(volume, voxel, next, axis);
  const float length = glm::length(coarse);
  const bool isThin = !(length > 1e-3f) || coarse[axis] <= 0.0f;
  if (!isThin && coarse[axis] < certainlyNot * length)
  {
    return false;
  }
  face = { voxel, isThin ? Vec3f(0.0f) : glm::normalize(coarse / spacingMm), std::uint8_t(axis), volume.at(voxel),
           volume.at(next) };
  return true;
}

/// Voxels [first, last) whose middle lies in bricks [from, to) of an edge.
struct BrickVoxels
{
  Vec3i first;
  Vec3i last;

  SONO_LANES BrickVoxels(const Vec3i& from, const Vec3i& to, float edgeMm, const Vec3f& spacingMm, const Vec3i& size)
    : first(glm::max(Vec3i(glm::ceil(Vec3f(from) * edgeMm / spacingMm - 0.5f)), Vec3i(0)))
    , last(glm::min(Vec3i(glm::ceil(Vec3f(to) * edgeMm / spacingMm - 0.5f)), size))
  {
  }
};

} // namespace SONO_LANES_NAMESPACE
} // namespace sono::stepfit
