#pragma once

#include "Files/DicomMasks.h"

#include <iosfwd>
#include <vector>

namespace sono {

/// Writes a DICOM Segmentation up to its first pixel, by DCMTK (explicit little endian), frame by frame. `segments` are
/// the labels that occur, by id.
void writeMaskHeader(const CineInfo& cine, const std::vector<ProbePose>& poses, const std::vector<LabelInfo>& segments,
                     const std::vector<DicomMasks::Frame>& frames, std::ostream& stream);

} // namespace sono
