#pragma once

#include "Core/Progress.h"
#include "Labels/LabelVolume.h"
#include "Labels/VoxelFile.h"

#include <string>

namespace sono {

/// Reads an NRRD label map (.nrrd, .nhdr, .seg.nrrd) with the segment names, colours and codes of its key/value pairs;
/// `labels` holds those, also of ids that no voxel carries. Overlapping layers (4-D) are flattened as VoxelRuns.h has
/// it, and segments that share a label value across layers are numbered anew, from 1 in their order. Throws Error as
/// readLabelMap does, and Aborted.
LabelVolume readNrrd(const std::string& path, const Progress& progress = {});

/// Its numbers as they stand in the file, with all layers.
VoxelFile openNrrd(const std::string& path);

} // namespace sono
