#pragma once

#include "Files/DicomCine.h"

#include <dcmtk/config/osconfig.h>

#include <dcmtk/dcmdata/dctk.h>

#include <string>
#include <vector>

namespace sono {

// What the makers of DICOM headers share. Each throws Error naming the element that cannot be written.

void checkDicom(const OFCondition& status, const DcmTagKey& tag);
void putText(DcmItem& item, const DcmTagKey& tag, const std::string& text);
void putWord(DcmItem& item, const DcmTagKey& tag, int number);
/// Decimal text, as many numbers as there are.
void putNumbers(DcmItem& item, const DcmTagKey& tag, const std::vector<double>& numbers);

/// A number as DICOM's decimal text, which has 16 characters.
std::string dicomDecimal(double number);

/// A new item at the end of a sequence, which is made where it is not there.
DcmItem& addItem(DcmItem& item, const DcmTagKey& sequence);
/// The same with a code: designator, value and meaning.
DcmItem& addCode(DcmItem& item, const DcmTagKey& sequence, const char* scheme, const std::string& value,
                 const std::string& meaning);

/// Patient, study, who made it, and that it is a simulation, of this image or of what belongs to it.
void putOrigin(DcmItem& data, const CineInfo& info);

/// The bytes of a file without pixels, or of an item (explicit little endian).
std::string dicomBytes(DcmObject& object);

/// What stands before so many bytes of pixels, which come behind all else, and a zero where their number is odd.
std::string pixelDataStart(std::uint64_t bytes);

} // namespace sono
