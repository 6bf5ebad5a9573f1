#pragma once

#include "Image/ScanConvert.h"
#include "Image/ScanConvertVolume.h"
#include "Kernel/LabelRow.h"
#include "Labels/LabelVolume.h"

#include <cstdint>
#include <vector>

namespace sono {

/// The label at each pixel of a scan-converted image, as its ground truth: the id of the nearest voxel; 0 outside the
/// scanned area and outside the label map. Same order as the image's pixels. `pose` must be orthonormal.
std::vector<std::uint16_t> sliceLabels(const LabelVolume& labels, const ProbePose& pose, const PlaneImage& image);
std::vector<std::uint16_t> sliceLabels(const LabelVolume& labels, const ProbePose& pose, const VolumeImage& image);

/// The rows of an image's plane, from its least depth on, through the label map; see labelAt.
std::vector<LabelRow> labelRows(const LabelVolume& labels, const ProbePose& pose, const PlaneImage& layout);

} // namespace sono
