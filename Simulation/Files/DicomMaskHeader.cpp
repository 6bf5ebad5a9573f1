#include "Files/DicomMaskHeader.h"

#include "Core/Version.h"
#include "Files/DicomItems.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <ostream>

namespace sono {

namespace {

/// sRGB (IEC 61966-2-1) as DICOM's CIELab (PS3.3 C.10.7.1.1: 16 bits, D50), by CIE 15: what readDicomSeg takes back.
std::array<Uint16, 3> labOf(const std::array<float, 3>& colour)
{
  double linear[3];
  for (std::size_t n = 0; n < 3; ++n)
  {
    const double v = std::clamp(double(colour[n]), 0.0, 1.0);
    linear[n] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  }
  // Linear sRGB, whose white is D65, to XYZ of D50 (Bradford), over the white's.
  const double xyz[3] = { (0.4360747 * linear[0] + 0.3850649 * linear[1] + 0.1430804 * linear[2]) / 0.9642,
                          0.2225045 * linear[0] + 0.7168786 * linear[1] + 0.0606169 * linear[2],
                          (0.0139322 * linear[0] + 0.0971045 * linear[1] + 0.7141733 * linear[2]) / 0.8249 };
  double f[3];
  for (std::size_t n = 0; n < 3; ++n)
  {
    f[n] = xyz[n] > 216.0 / 24389.0 ? std::cbrt(xyz[n]) : 841.0 / 108.0 * xyz[n] + 4.0 / 29.0;
  }
  const auto word = [](double share) { return Uint16(std::lround(65535.0 * std::clamp(share, 0.0, 1.0))); };
  return { word((116.0 * f[1] - 16.0) / 100.0), word((500.0 * (f[0] - f[1]) + 128.0) / 255.0),
           word((200.0 * (f[1] - f[2]) + 128.0) / 255.0) };
}

/// The first of a text's characters, which UTF-8 has in one or more bytes.
std::string shortened(const std::string& text, std::size_t characters)
{
  std::size_t end = 0;
  for (std::size_t count = 0; end < text.size(); ++end)
  {
    const bool begins = (static_cast<unsigned char>(text[end]) & 0xc0u) != 0x80u;
    count += begins;
    if (count > characters)
    {
      break;
    }
  }
  std::string part = text.substr(0, end);
  std::replace(part.begin(), part.end(), '\\', '/'); // separates values
  return part;
}

void putSegmentation(DcmItem& data, const CineInfo& cine)
{
  putText(data, DCM_SOPClassUID, UID_SegmentationStorage);
  putText(data, DCM_SOPInstanceUID, freshDicomUid());
  putText(data, DCM_Modality, "SEG");
  putText(data, DCM_SeriesInstanceUID, freshDicomUid());
  putText(data, DCM_SeriesNumber, "2");
  putText(data, DCM_SeriesDescription, "Labels of simulated ultrasound");
  putText(data, DCM_DeviceSerialNumber, "none");
  putText(data, DCM_ContentLabel, "LABELS");
  putText(data, DCM_ContentDescription, "What each pixel of the simulated pictures shows");
  putText(data, DCM_ContentCreatorName, "");
  putText(data, DCM_SegmentationType, "BINARY");
  putWord(data, DCM_SamplesPerPixel, 1);
  putText(data, DCM_PhotometricInterpretation, "MONOCHROME2");
  putWord(data, DCM_Rows, cine.height);
  putWord(data, DCM_Columns, cine.width);
  putWord(data, DCM_BitsAllocated, 1);
  putWord(data, DCM_BitsStored, 1);
  putWord(data, DCM_HighBit, 0);
  putWord(data, DCM_PixelRepresentation, 0);
  DcmItem& series = addItem(data, DCM_ReferencedSeriesSequence);
  putText(series, DCM_SeriesInstanceUID, cine.ids.series);
  DcmItem& instance = addItem(series, DCM_ReferencedInstanceSequence);
  putText(instance, DCM_ReferencedSOPClassUID, UID_UltrasoundMultiframeImageStorage);
  putText(instance, DCM_ReferencedSOPInstanceUID, cine.ids.instance);
}

void putSegment(DcmItem& data, const LabelInfo& label, int number)
{
  const std::string name = label.name.empty() ? "label_" + std::to_string(label.id) : label.name;
  DcmItem& segment = addItem(data, DCM_SegmentSequence);
  putWord(segment, DCM_SegmentNumber, number);
  putText(segment, DCM_SegmentLabel, shortened(name, 64));
  putText(segment, DCM_SegmentDescription, "Label " + std::to_string(label.id) + " of the label map");
  putText(segment, DCM_SegmentAlgorithmType, "AUTOMATIC");
  putText(segment, DCM_SegmentAlgorithmName, "SonoVDB");
  const std::size_t space = label.code.find(' ');
  const bool isCoded = space != std::string::npos && space > 0 && label.code.size() - space - 1 <= 16;
  addCode(segment, DCM_SegmentedPropertyCategoryCodeSequence, "SCT", isCoded ? "123037004" : "85756007",
          isCoded ? "Anatomical Structure" : "Tissue");
  if (isCoded)
  {
    addCode(segment, DCM_SegmentedPropertyTypeCodeSequence, label.code.substr(0, space).c_str(),
            label.code.substr(space + 1), shortened(name, 64));
  }
  else
  {
    addCode(segment, DCM_SegmentedPropertyTypeCodeSequence, "SCT", "85756007", "Tissue");
  }
  if (label.hasColor)
  {
    const std::array<Uint16, 3> lab = labOf(label.color);
    checkDicom(segment.putAndInsertUint16Array(DCM_RecommendedDisplayCIELabValue, lab.data(), 3),
               DCM_RecommendedDisplayCIELabValue);
  }
}

/// Frames go by time, then by segment.
void putDimensions(DcmItem& data)
{
  const std::string uid = freshDicomUid();
  putText(addItem(data, DCM_DimensionOrganizationSequence), DCM_DimensionOrganizationUID, uid);
  const auto dimension = [&](const DcmTagKey& index, const DcmTagKey& group, const char* label) {
    DcmItem& item = addItem(data, DCM_DimensionIndexSequence);
    putText(item, DCM_DimensionOrganizationUID, uid);
    checkDicom(item.putAndInsertTagKey(DCM_DimensionIndexPointer, index), DCM_DimensionIndexPointer);
    checkDicom(item.putAndInsertTagKey(DCM_FunctionalGroupPointer, group), DCM_FunctionalGroupPointer);
    putText(item, DCM_DimensionDescriptionLabel, label);
  };
  dimension(DCM_TemporalPositionIndex, DCM_FrameContentSequence, "Picture");
  dimension(DCM_ReferencedSegmentNumber, DCM_SegmentIdentificationSequence, "Segment");
}

std::vector<double> orientationOf(const ProbePose& pose)
{
  return { pose.lateral.x, pose.lateral.y, pose.lateral.z, pose.axial.x, pose.axial.y, pose.axial.z };
}

void putOrientation(DcmItem& groups, const ProbePose& pose)
{
  putNumbers(addItem(groups, DCM_PlaneOrientationSequence), DCM_ImageOrientationPatient, orientationOf(pose));
}

/// Of the first pixel, rows along the array.
void putPosition(DcmItem& groups, const CineInfo& cine, const ProbePose& pose)
{
  const Vec3d first = pose.positionMm + cine.firstMm[0] * pose.lateral + cine.firstMm[1] * pose.axial;
  putNumbers(addItem(groups, DCM_PlanePositionSequence), DCM_ImagePositionPatient, { first.x, first.y, first.z });
}

/// What lies between parallel pictures of a sweep that goes across them, mm, where it is the same between all; else 0.
double stepAcrossMm(const std::vector<ProbePose>& poses)
{
  if (poses.size() < 2)
  {
    return 0.0;
  }
  const Vec3d across = glm::cross(poses.front().lateral, poses.front().axial);
  const double stepMm = glm::dot(poses[1].positionMm - poses[0].positionMm, across);
  for (std::size_t n = 1; n < poses.size(); ++n)
  {
    const Vec3d from = poses[n].positionMm - poses[n - 1].positionMm;
    constexpr double exactMm = 1e-3;
    if (glm::distance(from, stepMm * across) > exactMm)
    {
      return 0.0;
    }
  }
  return std::abs(stepMm);
}

void putSource(DcmItem& groups, const CineInfo& cine, std::size_t picture)
{
  DcmItem& derivation = addItem(groups, DCM_DerivationImageSequence);
  addCode(derivation, DCM_DerivationCodeSequence, "DCM", "113076", "Segmentation");
  DcmItem& source = addItem(derivation, DCM_SourceImageSequence);
  putText(source, DCM_ReferencedSOPClassUID, UID_UltrasoundMultiframeImageStorage);
  putText(source, DCM_ReferencedSOPInstanceUID, cine.ids.instance);
  putText(source, DCM_ReferencedFrameNumber, std::to_string(picture + 1));
  putText(source, DCM_SpatialLocationsPreserved, "YES");
  addCode(source, DCM_PurposeOfReferenceCodeSequence, "DCM", "121322", "Source image for image processing operation");
}

void putFrame(DcmItem& groups, const CineInfo& cine, const ProbePose& pose, std::size_t picture, int segment)
{
  DcmItem& content = addItem(groups, DCM_FrameContentSequence);
  const Uint32 index[] = { Uint32(picture + 1), Uint32(segment) };
  checkDicom(content.putAndInsertUint32(DCM_TemporalPositionIndex, index[0]), DCM_TemporalPositionIndex);
  checkDicom(content.putAndInsertUint32Array(DCM_DimensionIndexValues, index, 2), DCM_DimensionIndexValues);
  putPosition(groups, cine, pose);
  putSource(groups, cine, picture);
  putWord(addItem(groups, DCM_SegmentIdentificationSequence), DCM_ReferencedSegmentNumber, segment);
}

} // namespace

void writeMaskHeader(const CineInfo& cine, const std::vector<ProbePose>& poses, const std::vector<LabelInfo>& segments,
                     const std::vector<DicomMasks::Frame>& frames, std::ostream& stream)
{
  DcmFileFormat file;
  DcmDataset& data = *file.getDataset();
  putOrigin(data, cine);
  putSegmentation(data, cine);
  std::map<int, int> numberOf;
  for (const LabelInfo& segment : segments)
  {
    const int number = int(numberOf.size()) + 1;
    numberOf[segment.id] = number;
    putSegment(data, segment, number);
  }
  putDimensions(data);
  DcmItem& shared = addItem(data, DCM_SharedFunctionalGroupsSequence);
  DcmItem& measures = addItem(shared, DCM_PixelMeasuresSequence);
  putNumbers(measures, DCM_PixelSpacing, { cine.pixelMm[1], cine.pixelMm[0] }); // between rows first
  const bool isParallel = std::all_of(poses.begin(), poses.end(), [&](const ProbePose& pose) {
    return orientationOf(pose) == orientationOf(poses.front());
  });
  const double stepMm = isParallel ? stepAcrossMm(poses) : 0.0;
  if (stepMm > 0.0)
  {
    putNumbers(measures, DCM_SliceThickness, { stepMm });
    putNumbers(measures, DCM_SpacingBetweenSlices, { stepMm });
  }
  else
  {
    putNumbers(measures, DCM_SliceThickness, { cine.pixelMm[0] }); // a plane has none; what is not 0 can be shown
  }
  if (isParallel)
  {
    putOrientation(shared, poses.front());
  }
  putText(data, DCM_NumberOfFrames, std::to_string(frames.size()));
  stream << dicomBytes(file);
  // The frames' sequence is the last before the pixels. Of a length that is not said, it need not be held as a whole:
  // tag, type, two empty bytes and that length; in the end a tag and no length (PS3.5 7.5).
  stream << std::string("\x00\x52\x30\x92SQ\0\0\xff\xff\xff\xff", 12);
  for (const DicomMasks::Frame& frame : frames)
  {
    DcmItem groups(DCM_Item);
    const ProbePose& pose = poses[frame.picture];
    putFrame(groups, cine, pose, frame.picture, numberOf[frame.label]);
    if (!isParallel)
    {
      putOrientation(groups, pose);
    }
    stream << dicomBytes(groups);
  }
  stream << std::string("\xfe\xff\xdd\xe0\0\0\0\0", 8);
  const std::uint64_t bits = std::uint64_t(frames.size()) * std::uint64_t(cine.width) * std::uint64_t(cine.height);
  stream << pixelDataStart((bits + 7) / 8);
}

} // namespace sono
