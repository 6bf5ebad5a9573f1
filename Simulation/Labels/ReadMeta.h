#pragma once

#include "Core/Progress.h"
#include "Labels/LabelVolume.h"
#include "Labels/VoxelFile.h"

#include <string>

namespace sono {

/// Reads a MetaImage label map (.mha, or .mhd with its data file): binary, with or without zlib compression, either
/// byte order. World coordinates are LPS mm: TransformMatrix lists the world directions of i, j, k one after the other,
/// as ITK has it; AnatomicalOrientation only describes them and is not used. `labels` stays empty: the format has no
/// names. Throws Error as readLabelMap does, and Aborted.
///
/// Not by MetaIO, whose MetaImage::Read reports success for data that end early or do not inflate, with voxels of 0 or
/// of whatever lay in memory.
LabelVolume readMeta(const std::string& path, const Progress& progress = {});

/// Its numbers as they stand in the file.
VoxelFile openMeta(const std::string& path);

} // namespace sono
