#pragma once

#include "Core/Progress.h"
#include "Core/SharedSpan.h"
#include "Labels/LabelVolume.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sono {

struct VoxelFile;

/// A scan: one number per voxel, i fastest. CT: Hounsfield units; MR: as the scanner has it.
struct IntensityVolume
{
  GridPlacement placement;
  std::vector<float> values;
  SharedSpan<std::int16_t> shorts; ///< instead of these, where the file has such (areShorts): half of the memory
  std::string modality;            ///< "CT" or "MR" as DICOM says; empty where the file does not
};

/// The same, of values that somebody else holds.
struct IntensityView
{
  GridPlacement placement;
  const float* values = nullptr;
  SharedSpan<std::int16_t> shorts; ///< where `values` are none
  std::size_t count = 0;
  std::string modality;

  IntensityView() = default;
  IntensityView(const IntensityVolume& volume) // whoever takes a view takes a volume
    : placement(volume.placement)
    , values(volume.shorts.data ? nullptr : volume.values.data())
    , shorts(volume.shorts)
    , count(volume.shorts.data ? volume.shorts.size : volume.values.size())
    , modality(volume.modality)
  {
  }
};

/// The least and the largest of some values, and whether all are finite (if not, the others mean nothing).
struct IntensityRange
{
  float low = 0.0f;
  float high = 0.0f;
  bool finite = true;
};

/// By all cores; of no values 0 to 0.
IntensityRange rangeOf(const float* values, std::size_t count);
IntensityRange rangeOf(const std::int16_t* values, std::size_t count);

/// Whether a file's values are whole numbers of at most 16 bits that nothing scales, so that they are read as such.
bool areShorts(const VoxelFile& file);

/// Reads a CT or MR volume and places it in the world (LPS mm): NIfTI, NRRD and MetaImage as readLabelMap places them
/// (NIfTI's scl_slope and scl_inter applied), or a DICOM series: its folder, or one of its files, with RescaleSlope and
/// RescaleIntercept applied and its slices in the order of their positions.
/// Whole numbers that areShorts stay as they are; all else becomes floats.
/// Throws Error for what readLabelMap refuses of a file but its numbers, for NaN and infinity, colours, layers and
/// phases, and for a series that lacks slices, or one of several in its folder; and Aborted.
IntensityVolume readIntensities(const std::string& path, const Progress& progress = {});

} // namespace sono
