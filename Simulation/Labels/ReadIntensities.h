#pragma once

#include "Core/Progress.h"
#include "Labels/LabelVolume.h"

#include <string>
#include <vector>

namespace sono {

/// A scan: one number per voxel, i fastest.
struct IntensityVolume
{
  GridPlacement placement;
  std::vector<float> values; ///< CT: Hounsfield units; MR: as the scanner has it
  std::string modality;      ///< "CT" or "MR" as DICOM says; empty where the file does not
};

/// Reads a CT or MR volume and places it in the world (LPS mm): NIfTI, NRRD and MetaImage as readLabelMap places them
/// (NIfTI's scl_slope and scl_inter applied), or a DICOM series: its folder, or one of its files, with RescaleSlope and
/// RescaleIntercept applied and its slices in the order of their positions.
/// Throws Error for what readLabelMap refuses of a file but its numbers, for NaN and infinity, colours, layers and
/// phases, and for a series that lacks slices, or one of several in its folder; and Aborted.
IntensityVolume readIntensities(const std::string& path, const Progress& progress = {});

} // namespace sono
