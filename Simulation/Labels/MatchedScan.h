#pragma once

#include "Core/Progress.h"
#include "Core/SharedSpan.h"
#include "Labels/LabelVolume.h"
#include "Labels/ReadIntensities.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sono {

/// A CT or MR at the voxels of a label map.
struct MatchedScan
{
  static constexpr std::int16_t nothing = -32768; ///< where the scan does not reach

  SharedSpan<std::int16_t> values; ///< one a voxel of the label map, i fastest: of a CT, Hounsfield units
  bool isCt = false;
  double reachedShare = 1.0; ///< of the labelled voxels (those but 0), how many lie within the scan
  std::string notice; ///< what a scan that does not say it was taken for, and why, if not for a CT; empty: nothing
};

/// Interpolates a scan, linearly between the centres of its voxels, where a label map has its own. It is a CT where its
/// modality says so or, where that is not known, where its values are those of one: some below -200, none above 32767,
/// and of those above the lowest, which may be padding, at most a twentieth below -1500. Else it is an MR, which is
/// scaled so that its largest value becomes 32767. Throws Error where both name a frame of reference and not the same
/// one; for values that are neither Hounsfield units nor an MR's; where less than half of the labelled voxels lie
/// within the scan, with how much does and where the two lie; and Aborted.
MatchedScan matchScan(const LabelVolume& labels, const IntensityView& scan, const Progress& progress = {});

/// What a scan has in the voxels of a label.
struct ScanOfLabel
{
  std::int64_t voxels = 0; ///< that the scan reaches
  double mean = 0.0;
  double deviation = 0.0;
};

/// Parallel to the labels.
std::vector<ScanOfLabel> scanOfLabels(const LabelVolume& labels, const MatchedScan& scan,
                                      const Progress& progress = {});

/// Of the voxels of a tissue's labels; 0 where the scan reaches none of them.
double meanOfTissue(const LabelVolume& labels, const std::vector<ScanOfLabel>& means, const std::string& tissue);

/// Throws Error when a CT shows other tissues than the labels are, as that of another patient does: where a quarter of
/// the voxels whose tissues tell are of labels whose mean lies outside of what theirs have: bone above 80 HU, lung
/// below -350, air below -250, fat -250 to 40, organs and muscles -40 to 600. The sentence names the label that is
/// furthest off. An MR tells nothing. `means` are those of scanOfLabels; each label has its tissue.
void requireSamePatient(const LabelVolume& labels, const MatchedScan& scan, const std::vector<ScanOfLabel>& means);

} // namespace sono
