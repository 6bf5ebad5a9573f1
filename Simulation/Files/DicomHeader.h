#pragma once

#include "Files/DicomCine.h"

#include <string>

namespace sono {

/// The bytes of a DICOM file up to the first picture's first byte, by DCMTK (explicit little endian). Throws Error for
/// what DICOM does not hold.
std::string dicomHeader(const CineInfo& info);

} // namespace sono
