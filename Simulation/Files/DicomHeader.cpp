#include "Files/DicomHeader.h"

#include "Core/Error.h"
#include "Core/Version.h"

#include <dcmtk/config/osconfig.h>

#include <dcmtk/dcmdata/dcostrmb.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

namespace sono {

namespace {

void check(const OFCondition& status, const DcmTagKey& tag)
{
  if (status.bad())
  {
    throw Error(std::string("DICOM's ") + DcmTag(tag).getTagName() + " cannot be written (" + status.text() +
                "); is DCMTK's dictionary installed?");
  }
}

void put(DcmItem& item, const DcmTagKey& tag, const std::string& text)
{
  check(item.putAndInsertString(tag, text.c_str()), tag);
}

void putWord(DcmItem& item, const DcmTagKey& tag, int number)
{
  check(item.putAndInsertUint16(tag, Uint16(number)), tag);
}

/// A number as DICOM's decimal text, which has 16 characters.
std::string decimal(double number)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.9g", number);
  return text;
}

/// A UUID of random bits as a UID (PS3.5 B.2): 128 bits as one decimal number.
std::string freshUid()
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

void putPatientAndStudy(DcmItem& data, const CineInfo& info)
{
  OFString date;
  OFString time;
  DcmDate::getCurrentDate(date);
  DcmTime::getCurrentTime(time);
  put(data, DCM_SpecificCharacterSet, "ISO_IR 192");
  put(data, DCM_PatientName, info.patientName);
  put(data, DCM_PatientID, info.patientId);
  put(data, DCM_PatientBirthDate, "");
  put(data, DCM_PatientSex, "");
  put(data, DCM_StudyInstanceUID, freshUid());
  for (const DcmTagKey& tag : { DCM_StudyDate, DCM_ContentDate })
  {
    put(data, tag, date.c_str());
  }
  for (const DcmTagKey& tag : { DCM_StudyTime, DCM_ContentTime })
  {
    put(data, tag, time.c_str());
  }
  for (const DcmTagKey& tag : { DCM_ReferringPhysicianName, DCM_StudyID, DCM_AccessionNumber })
  {
    put(data, tag, "");
  }
}

void putSeries(DcmItem& data)
{
  const std::string maker = std::string("SonoVDB ") + version();
  put(data, DCM_SOPClassUID, UID_UltrasoundMultiframeImageStorage);
  put(data, DCM_SOPInstanceUID, freshUid());
  put(data, DCM_Modality, "US");
  put(data, DCM_SeriesInstanceUID, freshUid());
  put(data, DCM_SeriesNumber, "1");
  put(data, DCM_Laterality, "");
  put(data, DCM_SeriesDescription, "Simulated ultrasound");
  put(data, DCM_Manufacturer, "SonoVDB (Simulated)");
  put(data, DCM_ManufacturerModelName, "Simulated ultrasound");
  put(data, DCM_SoftwareVersions, version());
  put(data, DCM_InstanceNumber, "1");
  put(data, DCM_PatientOrientation, "");
  put(data, DCM_ImageType, "DERIVED\\PRIMARY");
  put(data, DCM_DerivationDescription, "Simulated by " + maker + " from labelled anatomy; nobody was scanned.");
  put(data, DCM_BurnedInAnnotation, "NO");
  put(data, DCM_LossyImageCompression, "00");
}

void putPixels(DcmItem& data, const CineInfo& info)
{
  putWord(data, DCM_SamplesPerPixel, 1);
  put(data, DCM_PhotometricInterpretation, "MONOCHROME2");
  putWord(data, DCM_Rows, info.height);
  putWord(data, DCM_Columns, info.width);
  putWord(data, DCM_BitsAllocated, 8);
  putWord(data, DCM_BitsStored, 8);
  putWord(data, DCM_HighBit, 7);
  putWord(data, DCM_PixelRepresentation, 0);
  putWord(data, DCM_UltrasoundColorDataPresent, 0);
}

void putTimes(DcmItem& data, const std::vector<double>& timesS)
{
  put(data, DCM_NumberOfFrames, std::to_string(timesS.size()));
  const double frames = double(std::max<std::size_t>(timesS.size() - 1, 1));
  const double meanMs = 1000.0 * (timesS.back() - timesS.front()) / frames;
  std::string steps = "0";
  bool areEqual = true;
  for (std::size_t n = 1; n < timesS.size(); ++n)
  {
    const double stepMs = 1000.0 * (timesS[n] - timesS[n - 1]);
    if (!(stepMs > 0.0) || !std::isfinite(stepMs))
    {
      throw Error("Frame " + std::to_string(n + 1) + " is not later than the one before; set times that increase.");
    }
    areEqual = areEqual && std::abs(stepMs - meanMs) < 1e-6 * meanMs;
    steps += "\\" + decimal(stepMs);
  }
  const DcmTagKey tag = areEqual ? DCM_FrameTime : DCM_FrameTimeVector;
  put(data, tag, areEqual ? decimal(meanMs) : steps);
  check(data.putAndInsertTagKey(DCM_FrameIncrementPointer, tag), DCM_FrameIncrementPointer);
  if (meanMs > 0.0)
  {
    put(data, DCM_CineRate, std::to_string(std::max(1l, std::lround(1000.0 / meanMs))));
    put(data, DCM_RecommendedDisplayFrameRate, std::to_string(std::max(1l, std::lround(1000.0 / meanMs))));
  }
}

void putTransducer(DcmItem& data, const ProbeSettings& probe)
{
  std::string parameters = std::string("scanKind=") + traitsOf(probe.geometry.kind).presetName;
  const auto add = [&](const auto& value, const Parameter& parameter) {
    parameters += std::string("\\") + parameter.name + "=" + decimal(numberOf(value));
  };
  ScanGeometry::visit(probe.geometry, [&](const auto& value, const Parameter& parameter) {
    if (parameter.choices.empty() && probe.geometry.uses(parameter))
    {
      add(value, parameter);
    }
  });
  ProbeSettings::visitPulse(probe, add);
  BeamAperture::visit(probe, add);
  put(data, DCM_TransducerType, traitsOf(probe.geometry.kind).dicomType);
  put(data, DCM_TransducerData, parameters);
  put(data, DCM_DepthOfScanField, std::to_string(std::lround(probe.geometry.depthMm)));
}

/// US Region Calibration (PS3.3 C.8.5.5). Every pixel's place follows from the reference pixel and the spacing.
void putRegion(DcmItem& data, const CineInfo& info)
{
  DcmItem* region = nullptr;
  check(data.findOrCreateSequenceItem(DCM_SequenceOfUltrasoundRegions, region), DCM_SequenceOfUltrasoundRegions);
  putWord(*region, DCM_RegionSpatialFormat, 1); // 2D
  putWord(*region, DCM_RegionDataType, 1);      // tissue
  const auto number = [&](const DcmTagKey& tag, Uint32 value) { check(region->putAndInsertUint32(tag, value), tag); };
  number(DCM_RegionFlags, 0);
  number(DCM_RegionLocationMinX0, 0);
  number(DCM_RegionLocationMinY0, 0);
  number(DCM_RegionLocationMaxX1, Uint32(info.width - 1));
  number(DCM_RegionLocationMaxY1, Uint32(info.height - 1));
  number(DCM_TransducerFrequency, Uint32(std::lround(1000.0 * info.probe.centreFrequencyMHz)));
  struct Axis
  {
    DcmTagKey unit;
    DcmTagKey pixel;
    DcmTagKey value;
    DcmTagKey delta;
  };
  const Axis axes[] = {
    { DCM_PhysicalUnitsXDirection, DCM_ReferencePixelX0, DCM_ReferencePixelPhysicalValueX, DCM_PhysicalDeltaX },
    { DCM_PhysicalUnitsYDirection, DCM_ReferencePixelY0, DCM_ReferencePixelPhysicalValueY, DCM_PhysicalDeltaY }
  };
  constexpr double cmPerMm = 0.1;
  for (std::size_t n = 0; n < 2; ++n)
  {
    const long pixel = std::lround(-info.firstMm[n] / info.pixelMm[n]);
    const double valueMm = info.firstMm[n] + double(pixel) * info.pixelMm[n];
    putWord(*region, axes[n].unit, 3); // cm
    check(region->putAndInsertSint32(axes[n].pixel, Sint32(pixel)), axes[n].pixel);
    check(region->putAndInsertFloat64(axes[n].value, cmPerMm * valueMm), axes[n].value);
    check(region->putAndInsertFloat64(axes[n].delta, cmPerMm * info.pixelMm[n]), axes[n].delta);
  }
}

std::string bytesOf(DcmFileFormat& file)
{
  const E_TransferSyntax syntax = EXS_LittleEndianExplicit;
  file.validateMetaInfo(syntax);
  std::string bytes;
  std::string room(1 << 16, '\0');
  DcmOutputBufferStream stream(room.data(), offile_off_t(room.size()));
  file.transferInit();
  OFCondition status = EC_StreamNotifyClient;
  while (status == EC_StreamNotifyClient)
  {
    status = file.write(stream, syntax, EET_ExplicitLength, nullptr);
    void* part = nullptr;
    offile_off_t length = 0;
    stream.flushBuffer(part, length);
    bytes.append(static_cast<const char*>(part), std::size_t(length));
  }
  file.transferEnd();
  if (status.bad())
  {
    throw Error(std::string("The header of a DICOM file cannot be made: ") + status.text() + ".");
  }
  return bytes;
}

void appendNumber(std::uint32_t number, std::string& bytes)
{
  for (int shift = 0; shift < 32; shift += 8)
  {
    bytes += char(number >> shift & 0xffu);
  }
}

} // namespace

std::string dicomHeader(const CineInfo& info)
{
  DcmFileFormat file;
  DcmDataset& data = *file.getDataset();
  putPatientAndStudy(data, info);
  putSeries(data);
  putPixels(data, info);
  putTimes(data, info.timesS);
  putTransducer(data, info.probe);
  putRegion(data, info);
  std::string bytes = bytesOf(file);
  // Pixel Data is the last element: tag, type, two empty bytes and length (PS3.5 7.1.2).
  bytes += std::string("\xe0\x7f\x10\x00OB\0\0", 8);
  const std::uint64_t length = std::uint64_t(info.width) * std::uint64_t(info.height) * info.timesS.size();
  appendNumber(std::uint32_t(length + length % 2), bytes);
  return bytes;
}

} // namespace sono
