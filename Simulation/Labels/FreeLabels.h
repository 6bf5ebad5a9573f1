#pragma once

#include "Labels/LabelVolume.h"

#include <array>
#include <string>
#include <vector>

namespace sono {

/// So many ids that no label has, the smallest above all others where there are such. Throws Error when there are too
/// few.
std::vector<int> freeLabelIds(const LabelVolume& volume, int count);

/// Adds a label that no voxel need have yet.
void addLabel(LabelVolume& volume, int id, const std::string& name, const std::array<float, 3>& color);

} // namespace sono
