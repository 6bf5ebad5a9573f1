#pragma once

#include "DataSets/DataSet.h"
#include "DataSets/ImageLandmarks.h"
#include "Labels/LabelVolume.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sono {

/// The mask's value of each label id, 65536 of them: n of the n-th group, 0 of none.
std::vector<std::uint8_t> groupsOf(const std::vector<LabelInfo>& labels, const std::vector<MaskGroup>& masks);

/// Whether each label id fits one of the patterns.
std::vector<bool> labelsOf(const std::vector<LabelInfo>& labels, const std::vector<std::string>& patterns);

/// Divides ventricle and atrium by the set's mitralLine where the image shows both of the annulus' hinges and the apex.
/// `isValve` tells the leaflets' label ids; `mask` and `labels` are the picture's, row by row of `width`.
void divideAtAnnulus(const DataSet& set, const std::vector<bool>& isValve, const std::vector<ImageLandmark>& landmarks,
                     const std::uint16_t* labels, int width, std::vector<std::uint8_t>& mask);

} // namespace sono
