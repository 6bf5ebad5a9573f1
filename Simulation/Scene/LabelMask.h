#pragma once

#include "Scene/SurfaceField.h"

namespace sono {

/// The voxels of one label as a NanoVDB mask grid, "voxels_<id>"; `box` is the label's bounding box.
NanoGrid buildLabelMask(const LabelVolume& volume, int labelId, const VoxelBox& box);

/// The label ids of a grid as one value a voxel of a volume of `size`, i fastest.
std::vector<std::uint16_t> voxelsOf(const LabelGrid& labels, const Vec3i& size);

} // namespace sono
