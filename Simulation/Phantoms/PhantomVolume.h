#pragma once

#include "Labels/LabelVolume.h"

#include <functional>
#include <string>
#include <vector>

namespace sono {

/// A block of voxels whose surface, where a probe stands, is the plane z = 0 and whose middle lies on x = y = 0.
/// Phantoms use the world's axes: x lateral, y elevational, z depth. `labelAt` gives the index into `tissues` at a
/// place, from any thread; its label has that index plus one as id and the tissue as its name. Labels without voxels
/// are left out. Throws Error when spacingMm is not in [0.1, 5] mm, or there would be more than 4 10^8 voxels.
LabelVolume makePhantomVolume(const Vec3d& extentMm, double spacingMm, const std::vector<std::string>& tissues,
                              const std::function<int(const Vec3d&)>& labelAt);

} // namespace sono
