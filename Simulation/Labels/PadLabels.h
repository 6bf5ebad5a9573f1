#pragma once

#include "Labels/LabelVolume.h"

namespace sono {

/// How a label map's box grows.
struct Padding
{
  Vec3i before{ 0 }; ///< voxels in front of the first ones along i, j, k
  GridPlacement placement;
};

/// By at least `mm` on each side of the box whose voxels are of one label, as of the air around a body; where the box
/// cuts the body it stays.
Padding padding(const LabelVolume& volume, double mm);

/// The label map in the larger box; what is new has the label of the side it lies on.
LabelVolume padded(const LabelVolume& volume, double mm);

} // namespace sono
