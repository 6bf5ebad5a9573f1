#pragma once

#include "Core/Progress.h"
#include "Kernel/Vec.h"
#include "Probe/ScanGeometry.h"

#include <cstdint>
#include <vector>

namespace sono {

/// An image of the volume that a matrix scans, in the frame of its pose: voxel (i, j, k) lies at
/// (lateral, elevational, axial) = minMm + (i, j, k) voxelMm.
struct VolumeImage
{
  Vec3i size{ 0 };
  double voxelMm = 0.0;
  Vec3d minMm{ 0.0 };
  std::vector<float> value;       ///< lateral fastest, axial slowest; 0 outside the scanned volume
  std::vector<std::uint8_t> mask; ///< 1 inside

  std::size_t voxelCount() const { return std::size_t(size.x) * size.y * size.z; }
};

/// Size and place of that image, without values. Throws Error when the geometry fills no volume, and when voxelMm
/// is not positive or asks for more than 2^28 voxels.
VolumeImage volumeImageLayout(const ScanGeometry& geometry, double voxelMm);

/// The edge of a voxel, mm, of which the image has at most 2^25: the one wished for, or where that asks for more, as
/// little wider as will do. Throws Error when the geometry fills no volume and when the wish is not positive.
double voxelMmThatFits(const ScanGeometry& geometry, double wishedMm);

/// Trilinear scan conversion, in (line, elevation, depth), of elevations x lines x samples (`sampleMm` apart, the first
/// at depth 0) onto cubic voxels that cover the scanned volume's bounding box, centred laterally and elevationally. The
/// last sample holds for up to one sample more; what lies beyond the samples or the geometry's depth is outside. One
/// line is drawn one voxel wide. Throws Error when the geometry fills no volume, when voxelMm is not
/// positive or asks for more than 2^28 voxels, and when `values` is not totalLineCount x sampleCount; Aborted.
VolumeImage scanConvertVolume(const ScanGeometry& geometry, const std::vector<float>& values, int sampleCount,
                              double sampleMm, double voxelMm, const Progress& progress = {});

} // namespace sono
