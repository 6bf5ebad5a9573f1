#pragma once

#include "Core/Progress.h"
#include "Labels/LabelVolume.h"

#include <string>

namespace sono {

/// Reads a DICOM Segmentation (BINARY, FRACTIONAL, whose voxels count where at least half of the largest fraction is
/// there, and LABELMAP) with its segments' names, colours and codes; the ids are the segment numbers. Slices that it
/// leaves out hold no segment. Overlapping segments are flattened as VoxelRuns.h has it. Throws Error for another DICOM
/// file, for planes that make no regular stack and for films of masks; and Aborted.
LabelVolume readDicomSeg(const std::string& path, const Progress& progress = {});

/// Whether a file is DICOM of the modality SEG.
bool isDicomSeg(const std::string& path);

/// Where it stands, without its pixels.
GridPlacement dicomSegPlacement(const std::string& path);

} // namespace sono
