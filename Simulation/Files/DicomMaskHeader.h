#pragma once

#include "Files/DicomMasks.h"

#include <string>
#include <vector>

namespace sono {

/// The bytes of a DICOM Segmentation up to its first pixel, by DCMTK (explicit little endian). `segments` are the
/// labels that occur, by id.
std::string dicomMaskHeader(const CineInfo& cine, const std::vector<ProbePose>& poses,
                            const std::vector<LabelInfo>& segments, const std::vector<DicomMasks::Frame>& frames);

} // namespace sono
