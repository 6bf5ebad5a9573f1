#pragma once

#include "Kernel/Vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sono {

/// A Gaussian of one width in mm, integrated over the voxels along each axis, cut at 2.6 sigma or more and normalised
/// to 1.
struct GaussianAxes
{
  Vec3i radius{ 0, 0, 0 };
  std::array<std::vector<float>, 3> weight; ///< 2 radius + 1 each
};
GaussianAxes makeGaussian(const Vec3d& spacingMm, double sigmaMm);

/// Smooths the indicator function of one value in a block of a volume: out(i,j,k) for the `count` voxels from `first`
/// on, i fastest, is the Gaussian-weighted share of voxels equal to `value`. Beyond its border the volume is continued
/// by its last voxels. `Voxel` is std::uint8_t or std::uint16_t. Keeps its scratch memory: one object a thread.
template<class Voxel>
class MaskSmoother
{
public:
  MaskSmoother(const Voxel* voxels, Vec3i size)
    : voxels_(voxels)
    , size_(size)
  {
  }
  void smooth(Voxel value, const Vec3i& first, const Vec3i& count, const GaussianAxes& gaussian, float* out);

private:
  const Voxel* voxels_;
  Vec3i size_;
  std::vector<float> indicator_;
  std::vector<float> alongZ_;
  std::vector<float> alongY_;
  std::vector<float> alongX_;
};

extern template class MaskSmoother<std::uint8_t>;
extern template class MaskSmoother<std::uint16_t>;

} // namespace sono
