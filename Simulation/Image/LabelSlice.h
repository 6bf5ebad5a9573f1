#pragma once

#include "Image/ScanConvert.h"
#include "Image/ScanConvertVolume.h"
#include "Kernel/LabelRow.h"
#include "Labels/LabelVolume.h"

#include <cstdint>
#include <vector>

namespace sono {

/// Where lines show what lies on them (see TracedLines::depthOffsetMm), lines x bins. Without: range is depth.
struct DepthOffsets
{
  const std::vector<float>* mm = nullptr; ///< null or empty: none
  int binCount = 0;
  double binMm = 0.0;

  bool any() const { return mm && !mm->empty(); }
};

/// The label at each pixel of a scan-converted image, as its ground truth: the id of the voxel nearest to what is shown
/// there; 0 outside the scanned area and outside the label map. Same order as the image's pixels. `pose` must be
/// orthonormal, the offsets those of the geometry's lines, all fans and elevations. Throws as scanConvert.
std::vector<std::uint16_t> sliceLabels(const LabelVolume& labels, const ScanGeometry& geometry, const ProbePose& pose,
                                       const PlaneImage& image, const DepthOffsets& offsets = {});
std::vector<std::uint16_t> sliceLabels(const LabelVolume& labels, const ScanGeometry& geometry, const ProbePose& pose,
                                       const VolumeImage& image, const DepthOffsets& offsets = {});

/// The way from a pixel to the depth offsets, see labelShift; without bins of these to the scale of what is shown
/// alone.
PlaneScan offsetScan(const ScanGeometry& geometry, int binCount, double binMm, double pixelMm);
/// The rows of an image's plane, from its least depth on, through the label map; see labelAt.
std::vector<LabelRow> labelRows(const LabelVolume& labels, const ProbePose& pose, const PlaneImage& layout);

} // namespace sono
