#pragma once

#include "Kernel/Vec.h"

#include <cstdint>

namespace sono {

/// Over a box of voxels, for each x the sums of its rows' weights, of those rows where the voxel is of a tissue and its
/// neighbour along an axis, toward its end or away from it, is not.
struct FaceColumns
{
  static constexpr int most = 16; ///< x at once
  float toward[3][most];
  float away[3][most];
};

/// The box begins at `corner`, a voxel of a volume of that size, and has a voxel's neighbours around it. A row weighs
/// weightY[j] weightZ[k]. What `to` says of x from count.x on means nothing.
void sumFaces(const std::uint8_t* corner, const Vec3i& size, std::uint8_t tissue, const Vec3i& count,
              const float* weightY, const float* weightZ, FaceColumns& to);

} // namespace sono
