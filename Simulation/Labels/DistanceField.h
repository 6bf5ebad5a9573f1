#pragma once

#include "Kernel/Vec.h"

#include <vector>

namespace sono {

/// Euclidean distance in mm of every voxel's centre to the nearest centre of a voxel with mask[i] != 0, i fastest;
/// a very large number where there is none. Exact: Felzenszwalb and Huttenlocher 2012, "Distance transforms of sampled
/// functions", an axis at a time. O(voxels), on all cores.
std::vector<float> distanceTo(const std::vector<char>& mask, const Vec3i& size, const Vec3d& spacingMm);

} // namespace sono
