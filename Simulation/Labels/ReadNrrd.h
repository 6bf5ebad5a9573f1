#pragma once

#include "Labels/LabelVolume.h"

#include <string>

namespace sono {

/// Reads an NRRD label map (.nrrd, .nhdr, .seg.nrrd) with the segment names, colours and codes of its key/value pairs;
/// `labels` holds those, also of ids that no voxel carries. Overlapping layers (4-D) are flattened: where segments
/// overlap the later one wins, and segments that share a label value across layers are numbered anew, from 1 in their
/// order. Throws Error as readLabelMap does.
LabelVolume readNrrd(const std::string& path);

} // namespace sono
