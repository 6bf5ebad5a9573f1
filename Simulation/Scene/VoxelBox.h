#pragma once

#include "Kernel/Vec.h"

namespace sono {

/// Box of voxel indices, first inclusive, last exclusive.
struct VoxelBox
{
  Vec3i first{ 0, 0, 0 };
  Vec3i last{ 0, 0, 0 };
  Vec3i size() const { return last - first; }
  bool empty() const { return last.x <= first.x || last.y <= first.y || last.z <= first.z; }
  bool operator==(const VoxelBox& o) const { return first == o.first && last == o.last; }
};

} // namespace sono
