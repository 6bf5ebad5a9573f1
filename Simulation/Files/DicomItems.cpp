#include "Files/DicomItems.h"

#include "Core/Error.h"
#include "Core/Version.h"
#include "Files/DicomIds.h"

#include <dcmtk/dcmdata/dcostrmb.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <random>

namespace sono {

namespace {

void appendNumber(std::uint32_t number, std::string& bytes)
{
  for (int shift = 0; shift < 32; shift += 8)
  {
    bytes += char(number >> shift & 0xffu);
  }
}

} // namespace

std::string freshDicomUid()
{
  std::random_device random;
  std::uint32_t words[4];
  std::generate(std::begin(words), std::end(words), std::ref(random));
  words[1] = (words[1] & 0xffff0fffu) | 0x00004000u; // version 4
  words[2] = (words[2] & 0x3fffffffu) | 0x80000000u; // variant 1
  std::string digits;
  while (std::any_of(std::begin(words), std::end(words), [](std::uint32_t word) { return word != 0; }))
  {
    std::uint64_t rest = 0;
    for (std::uint32_t& word : words)
    {
      rest = rest << 32 | word;
      word = std::uint32_t(rest / 10);
      rest %= 10;
    }
    digits.insert(digits.begin(), char('0' + rest));
  }
  return "2.25." + digits;
}

DicomIds freshDicomIds()
{
  OFString date;
  OFString time;
  DcmDate::getCurrentDate(date);
  DcmTime::getCurrentTime(time);
  return { freshDicomUid(), freshDicomUid(), freshDicomUid(), freshDicomUid(), date.c_str(), time.c_str() };
}

void checkDicom(const OFCondition& status, const DcmTagKey& tag)
{
  if (status.bad())
  {
    throw Error(std::string("DICOM's ") + DcmTag(tag).getTagName() + " cannot be written (" + status.text() +
                "); is DCMTK's dictionary installed?");
  }
}

void putText(DcmItem& item, const DcmTagKey& tag, const std::string& text)
{
  checkDicom(item.putAndInsertString(tag, text.c_str()), tag);
}

void putWord(DcmItem& item, const DcmTagKey& tag, int number)
{
  checkDicom(item.putAndInsertUint16(tag, Uint16(number)), tag);
}

void putNumbers(DcmItem& item, const DcmTagKey& tag, const std::vector<double>& numbers)
{
  std::string text;
  for (const double number : numbers)
  {
    text += (text.empty() ? "" : "\\") + dicomDecimal(number);
  }
  putText(item, tag, text);
}

std::string dicomDecimal(double number)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.9g", number);
  return text;
}

DcmItem& addItem(DcmItem& item, const DcmTagKey& sequence)
{
  DcmItem* added = nullptr;
  checkDicom(item.findOrCreateSequenceItem(sequence, added, -2), sequence); // -2: behind the last
  return *added;
}

DcmItem& addCode(DcmItem& item, const DcmTagKey& sequence, const char* scheme, const std::string& value,
                 const std::string& meaning)
{
  DcmItem& code = addItem(item, sequence);
  putText(code, DCM_CodeValue, value);
  putText(code, DCM_CodingSchemeDesignator, scheme);
  putText(code, DCM_CodeMeaning, meaning);
  return code;
}

void putOrigin(DcmItem& data, const CineInfo& info)
{
  putText(data, DCM_SpecificCharacterSet, "ISO_IR 192");
  putText(data, DCM_PatientName, info.patientName);
  putText(data, DCM_PatientID, info.patientId);
  putText(data, DCM_PatientBirthDate, "");
  putText(data, DCM_PatientSex, "");
  putText(data, DCM_StudyInstanceUID, info.ids.study);
  putText(data, DCM_FrameOfReferenceUID, info.ids.frameOfReference);
  putText(data, DCM_PositionReferenceIndicator, "");
  for (const DcmTagKey& tag : { DCM_StudyDate, DCM_ContentDate })
  {
    putText(data, tag, info.ids.date);
  }
  for (const DcmTagKey& tag : { DCM_StudyTime, DCM_ContentTime })
  {
    putText(data, tag, info.ids.time);
  }
  for (const DcmTagKey& tag : { DCM_ReferringPhysicianName, DCM_StudyID, DCM_AccessionNumber })
  {
    putText(data, tag, "");
  }
  putText(data, DCM_Manufacturer, "SonoVDB (Simulated)");
  putText(data, DCM_ManufacturerModelName, "Simulated ultrasound");
  putText(data, DCM_SoftwareVersions, version());
  putText(data, DCM_InstanceNumber, "1");
  putText(data, DCM_ImageType, "DERIVED\\PRIMARY");
  putText(data, DCM_LossyImageCompression, "00");
}

std::string dicomBytes(DcmObject& object)
{
  const E_TransferSyntax syntax = EXS_LittleEndianExplicit;
  if (auto* const file = dynamic_cast<DcmFileFormat*>(&object))
  {
    file->validateMetaInfo(syntax);
  }
  std::string bytes;
  std::string room(1 << 16, '\0');
  DcmOutputBufferStream stream(room.data(), offile_off_t(room.size()));
  object.transferInit();
  OFCondition status = EC_StreamNotifyClient;
  while (status == EC_StreamNotifyClient)
  {
    status = object.write(stream, syntax, EET_ExplicitLength, nullptr);
    void* part = nullptr;
    offile_off_t length = 0;
    stream.flushBuffer(part, length);
    bytes.append(static_cast<const char*>(part), std::size_t(length));
  }
  object.transferEnd();
  if (status.bad())
  {
    throw Error(std::string("The header of a DICOM file cannot be made: ") + status.text() + ".");
  }
  return bytes;
}

std::string pixelDataStart(std::uint64_t bytes)
{
  // Tag, type, two empty bytes and length (PS3.5 7.1.2).
  std::string start("\xe0\x7f\x10\x00OB\0\0", 8);
  appendNumber(std::uint32_t(bytes + bytes % 2), start);
  return start;
}

} // namespace sono
