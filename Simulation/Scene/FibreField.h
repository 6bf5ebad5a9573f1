#pragma once

#include "Kernel/FibreView.h"
#include "Kernel/Vec.h"
#include "Labels/LabelVolume.h"
#include "Scene/VoxelBox.h"

#include <cstdint>
#include <vector>

namespace sono {

/// The direction of the muscle's fibres at each voxel of a box, 8 bits an axis.
class FibreField
{
public:
  FibreField() = default;
  explicit FibreField(const VoxelBox& box);

  const VoxelBox& box() const { return box_; }
  /// Unit vector along the grid's axes, of either sense; 0 where there are no fibres, and outside of the box.
  Vec3f at(const Vec3i& voxel) const { return view().at(voxel); }
  /// For lookups while this lives.
  FibreView view() const { return { packed_.data(), box_.first, box_.size() }; }
  void set(const Vec3i& voxel, const Vec3d& direction);
  /// One word a voxel, i fastest: 128 + 127 times each component, x in the low byte; 0: none.
  const std::vector<std::uint32_t>& packed() const { return packed_; }

private:
  VoxelBox box_;
  std::vector<std::uint32_t> packed_;
};

/// Angle of the fibres against the way around the wall, degrees, at its inner and outer surface (Streeter et al. 1969;
/// Data/docs/physics.md section 4.7); linear between.
constexpr double fibreAngleInsideDeg = 60.0;
constexpr double fibreAngleOutsideDeg = -60.0;

/// The fibres of a heart's walls. `isMuscle` and `isBlood` tell the tissues; the depth in the wall is the share of the
/// distance to the cavity in that to both of its surfaces. A wall between the left ventricle's blood (a label whose
/// name holds "left" and "ventric") and other blood counts as the left ventricle's. "Around" is across the long axis of
/// the left ventricle's blood (of all blood where no label is named so): the principal axis of its voxels. The fibres
/// of a papillary muscle (a label whose name holds "papillar") run along it, its own principal axis.
FibreField buildFibreField(const LabelVolume& volume, const std::vector<std::uint8_t>& tissueVoxels,
                           const std::vector<bool>& isMuscle, const std::vector<bool>& isBlood);

} // namespace sono
