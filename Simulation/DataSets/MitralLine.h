#pragma once

#include "DataSets/ImageSight.h"

#include <cstdint>
#include <vector>

namespace sono {

/// What a straight line between the mitral annulus' hinges divides in a mask.
struct MitralSides
{
  std::uint8_t ventricle = 0; ///< the mask's values
  std::uint8_t atrium = 0;
  const std::vector<bool>* isValve = nullptr; ///< by label id
};

/// Divides ventricle and atrium as annotators do (Leclerc et al. 2019), by a straight line from hinge to hinge,
/// whatever the leaflets do: between the hinges, what belongs to either of them or to the valve is the ventricle's on
/// the side of the apex and the atrium's on the other. `mask` and `labels` are the picture's, row by row of `width`;
/// `apex` lies off the line.
void divideAtHinges(const ImagePoint& first, const ImagePoint& second, const ImagePoint& apex, const MitralSides& sides,
                    const std::uint16_t* labels, int width, std::vector<std::uint8_t>& mask);

} // namespace sono
