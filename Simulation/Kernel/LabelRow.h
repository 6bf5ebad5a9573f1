#pragma once

#include "Kernel/PlaneScan.h"
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
  Vec3d perAxialMm; ///< what a millimetre along the probe's axis adds to the index
};

/// How far from its pixel lies what is shown there.
struct LabelShift
{
  double pixels = 0.0; ///< along the row
  double axialMm = 0.0;
};

/// start + n step, rounded twice on every device, so that all pick the same voxel.
SONO_HD inline double alongRow(double start, double step, double n)
{
#if defined(__CUDA_ARCH__)
  return __dadd_rn(start, __dmul_rn(n, step));
#else
  return start + n * step;
#endif
}

/// The label of the nearest voxel, i fastest; 0 outside of the grid.
SONO_HD inline std::uint16_t labelAtIndex(const Vec3d& index, const std::uint16_t* voxels, const Vec3i& size)
{
  // Of what is not negative, cutting off is rounding down, and no call.
  const double x = index.x + 0.5;
  const double y = index.y + 0.5;
  const double z = index.z + 0.5;
  if (!(x >= 0.0 && x < size.x && y >= 0.0 && y < size.y && z >= 0.0 && z < size.z))
  {
    return 0;
  }
  const std::size_t plane = std::size_t(z) * std::size_t(size.y) + std::size_t(y);
  return voxels[plane * std::size_t(size.x) + std::size_t(x)];
}

SONO_HD inline std::uint16_t labelAt(const LabelRow& row, int n, const LabelShift& shift, const std::uint16_t* voxels,
                                     const Vec3i& size)
{
  Vec3d index;
  for (int a = 0; a < 3; ++a)
  {
    index[a] = alongRow(row.start[a], row.step[a], double(n) + shift.pixels);
    index[a] = alongRow(index[a], row.perAxialMm[a], shift.axialMm);
  }
  return labelAtIndex(index, voxels, size);
}

/// How far from a pixel, `x` as PlaneBeams::axialFromCentre, lies what is shown there: by the scale of what is shown,
/// and by the depth offsets of `scan`'s samples, where there are any.
SONO_HD inline LabelShift labelShift(const PlaneScan& scan, const float* offsetMm, float lateralMm, float x)
{
  float lateral;
  float axial;
  scan.beams.directionAt(lateralMm, x, lateral, axial);
  float line;
  float shownMm;
  scan.beams.beamAt(lateralMm, x, line, shownMm);
  const float mm = (offsetMm ? scan.levelAt(offsetMm, lateralMm, x) : 0.0f) + shownMm * (scan.rangePerMm - 1.0f);
  return { double(mm * lateral) / scan.pixelMm, double(mm * axial) };
}

} // namespace sono
