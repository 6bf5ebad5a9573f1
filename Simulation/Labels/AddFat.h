#pragma once

#include "Labels/LabelVolume.h"

#include <string>

namespace sono {

/// Makes a body stouter: pushes its skin outwards by `mm`, along the distance from it, and puts fat below. The old skin
/// becomes fat, the new one is 2 mm thick; all that lies within stays where it is. The box grows where its face is of
/// one label; where the box cuts the body, nothing grows out of the cut. Fat has the label of the map's subcutaneous
/// fat, of another fat where it has no such, else the new label "subcutaneous_fat".
///
/// @param volume whose labels have their tissues (prepareBody)
/// @param mm at least 0; what is below half a voxel leaves the map as it is
/// @param outside tissue around the body
/// Throws Error where no label is skin.
void addFat(LabelVolume& volume, double mm, const std::string& outside);

} // namespace sono
