#pragma once

#include "Labels/LabelVolume.h"

#include <set>
#include <vector>

namespace sono {

/// Where the tissue of an anatomy came from: what is at x now stood at x - u(x) in the reference phase. The labels that
/// move are the same in every phase, the reference included, so that their speckle is the same in all of them.
class TissueMotion
{
public:
  /// u in mm along the world's LPS axes, at the centres of the grid's voxels, i fastest; labels that move by id. Kept
  /// is the part of the grid that is not 0. Throws Error where the field is not of the grid's size or not finite.
  TissueMotion(const GridPlacement& grid, const std::vector<Vec3f>& displacementMm, std::set<int> movingLabels);

  /// Trilinear; 0 outside of the field.
  Vec3d displacementMm(const Vec3d& world) const;
  bool moves(int label) const { return movingLabels_.count(label) > 0; }
  const std::set<int>& movingLabels() const { return movingLabels_; }

private:
  GridPlacement grid_; // of what is kept; no voxels where all is 0
  std::vector<Vec3f> displacementMm_;
  std::set<int> movingLabels_;
};

} // namespace sono
