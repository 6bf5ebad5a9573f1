#pragma once

#include "Kernel/HostDevice.h"
#include "Kernel/Vec.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace sono {

/// A row of pixels through a grid of voxels: pixel n lies at the voxel index start + n step.
struct LabelRow
{
  Vec3d start;
  Vec3d step;
};

/// start + n step, rounded twice on every device, so that all pick the same voxel.
SONO_HD inline double alongRow(double start, double step, int n)
{
#if defined(__CUDA_ARCH__)
  return __dadd_rn(start, __dmul_rn(double(n), step));
#else
  return start + double(n) * step;
#endif
}

/// The label of the nearest voxel, i fastest; 0 outside of the grid.
SONO_HD inline std::uint16_t labelAt(const LabelRow& row, int n, const std::uint16_t* voxels, const Vec3i& size)
{
  const double x = floor(alongRow(row.start.x, row.step.x, n) + 0.5);
  const double y = floor(alongRow(row.start.y, row.step.y, n) + 0.5);
  const double z = floor(alongRow(row.start.z, row.step.z, n) + 0.5);
  if (!(x >= 0.0 && x < size.x && y >= 0.0 && y < size.y && z >= 0.0 && z < size.z))
  {
    return 0;
  }
  const std::size_t plane = std::size_t(z) * std::size_t(size.y) + std::size_t(y);
  return voxels[plane * std::size_t(size.x) + std::size_t(x)];
}

} // namespace sono
