#include "Labels/ReadDicomSeg.h"

#include "Labels/DicomFile.h"
#include "Labels/VoxelFile.h"
#include "Labels/VoxelRuns.h"

#include <dcmtk/dcmdata/dcfcache.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace sono {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
  throw Error("cannot read '" + path + "': " + why + ".");
}

/// DICOM's CIELab (PS3.3 C.10.7.1.1: 16 bits, D50) as sRGB, by CIE 15 and IEC 61966-2-1.
std::array<float, 3> colourFromLab(const std::vector<double>& lab)
{
  const double lightness = lab[0] / 65535.0 * 100.0;
  const double a = lab[1] / 65535.0 * 255.0 - 128.0;
  const double b = lab[2] / 65535.0 * 255.0 - 128.0;
  const auto inverse = [](double t) { return t > 6.0 / 29.0 ? t * t * t : 108.0 / 841.0 * (t - 4.0 / 29.0); };
  const double middle = (lightness + 16.0) / 116.0;
  const double x = 0.9642 * inverse(middle + a / 500.0);
  const double y = inverse(middle);
  const double z = 0.8249 * inverse(middle - b / 200.0);
  // XYZ of D50 to linear sRGB, whose white is D65 (Bradford).
  const double linear[3] = { 3.1338561 * x - 1.6168667 * y - 0.4906146 * z,
                             -0.9787684 * x + 1.9161415 * y + 0.0334540 * z,
                             0.0719453 * x - 0.2289914 * y + 1.4052427 * z };
  std::array<float, 3> colour{};
  for (std::size_t n = 0; n < 3; ++n)
  {
    const double v = std::clamp(linear[n], 0.0, 1.0);
    colour[n] = float(v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055);
  }
  return colour;
}

LabelInfo segmentOf(DcmItem& item)
{
  LabelInfo label;
  label.id = int(dicomNumber(item, DCM_SegmentNumber).value_or(0.0));
  label.name = dicomText(item, DCM_SegmentLabel);
  if (DcmItem* const type = dicomItem(item, DCM_SegmentedPropertyTypeCodeSequence))
  {
    const std::string scheme = dicomText(*type, DCM_CodingSchemeDesignator);
    const std::string value = dicomText(*type, DCM_CodeValue);
    label.code = value.empty() ? "" : scheme + " " + value;
    label.name = label.name.empty() ? dicomText(*type, DCM_CodeMeaning) : label.name;
  }
  const auto lab = dicomNumbers(item, DCM_RecommendedDisplayCIELabValue, 3);
  if (!lab.empty())
  {
    label.color = colourFromLab(lab);
    label.hasColor = true;
  }
  return label;
}

std::vector<LabelInfo> segmentsOf(DcmItem& data, const std::string& path)
{
  std::vector<LabelInfo> labels;
  DcmSequenceOfItems* segments = nullptr;
  data.findAndGetSequence(DCM_SegmentSequence, segments);
  DcmObject* object = segments ? segments->nextInContainer(nullptr) : nullptr; // the items are a linked list
  for (; auto* const item = dynamic_cast<DcmItem*>(object); object = segments->nextInContainer(object))
  {
    labels.push_back(segmentOf(*item));
    if (labels.back().id < 1 || labels.back().id > 65535)
    {
      refuse(path, "its segment " + std::to_string(labels.size()) +
                     " has no number; save it again from the program that made it");
    }
  }
  std::sort(labels.begin(), labels.end(), [](const LabelInfo& x, const LabelInfo& y) { return x.id < y.id; });
  const auto twice = std::adjacent_find(labels.begin(), labels.end(),
                                        [](const LabelInfo& x, const LabelInfo& y) { return x.id == y.id; });
  if (labels.empty() || twice != labels.end())
  {
    refuse(path, labels.empty()
                   ? "it lists no segments"
                   : "two of its segments have the number " + std::to_string(twice->id) + "; number them anew");
  }
  return labels;
}

/// An item of the functional groups: a frame's own before the one that all share.
DcmItem* groupOf(DcmItem& data, DcmItem* frame, const DcmTagKey& sequence)
{
  DcmItem* const own = frame ? dicomItem(*frame, sequence) : nullptr;
  DcmItem* const shared = dicomItem(data, DCM_SharedFunctionalGroupsSequence);
  return own || !shared ? own : dicomItem(*shared, sequence);
}

enum class Kind
{
  Binary,
  Fractional,
  LabelMap
};

Kind kindOf(DcmItem& data, const std::string& path)
{
  const std::string type = dicomText(data, DCM_SegmentationType);
  const Kind kind = type == "BINARY" ? Kind::Binary : type == "FRACTIONAL" ? Kind::Fractional : Kind::LabelMap;
  const std::string modality = dicomText(data, DCM_Modality);
  if (modality != "SEG")
  {
    refuse(path, "it is DICOM of the modality '" + modality +
                   "', no segmentation (SEG); as a label map choose the file that holds the segments");
  }
  if (kind == Kind::LabelMap && type != "LABELMAP")
  {
    refuse(path, "its segmentation type '" + type + "' is none of BINARY, FRACTIONAL, LABELMAP");
  }
  return kind;
}

/// What the header says of the pixels.
struct Frames
{
  Kind kind = Kind::Binary;
  std::size_t bits = 1; ///< of a pixel
  double half = 1.0;    ///< a fraction that counts
  DicomPlanes planes;
  std::vector<int> segments; ///< of each frame; 0: the pixels say it
};

Frames framesOf(DcmItem& data, const std::string& path)
{
  Frames frames;
  frames.kind = kindOf(data, path);
  frames.bits = std::size_t(dicomNumber(data, DCM_BitsAllocated).value_or(0.0));
  frames.half = std::max(1.0, dicomNumber(data, DCM_MaximumFractionalValue).value_or(255.0) / 2.0);
  const bool known = frames.kind == Kind::Binary       ? frames.bits == 1
                     : frames.kind == Kind::Fractional ? frames.bits == 8
                                                       : frames.bits == 8 || frames.bits == 16;
  if (!known)
  {
    refuse(path, "it has " + std::to_string(frames.bits) + " bits a pixel, which its segmentation type does not have");
  }
  DicomPlanes& planes = frames.planes;
  planes.path = path;
  planes.columns = int(dicomNumber(data, DCM_Columns).value_or(0.0));
  planes.rows = int(dicomNumber(data, DCM_Rows).value_or(0.0));
  const double count = dicomNumber(data, DCM_NumberOfFrames).value_or(1.0);
  DcmSequenceOfItems* perFrame = nullptr;
  data.findAndGetSequence(DCM_PerFrameFunctionalGroupsSequence, perFrame);
  DcmObject* object = nullptr;
  for (unsigned long n = 0; double(n) < count; ++n)
  {
    object = perFrame ? perFrame->nextInContainer(object) : nullptr; // its items are a linked list
    auto* const frame = dynamic_cast<DcmItem*>(object);
    if (!frame)
    {
      refuse(path,
             "it describes " + std::to_string(n) + " of its frames only; save it again from the program that made it");
    }
    DcmItem* const place = groupOf(data, frame, DCM_PlanePositionSequence);
    const auto at = place ? dicomNumbers(*place, DCM_ImagePositionPatient, 3) : std::vector<double>();
    DcmItem* const plane = groupOf(data, frame, DCM_PlaneOrientationSequence);
    const auto orientation = plane ? dicomNumbers(*plane, DCM_ImageOrientationPatient, 6) : std::vector<double>();
    if (at.empty() || orientation.empty() || (!planes.orientation.empty() && orientation != planes.orientation))
    {
      refuse(path,
             "its frame " + std::to_string(n + 1) +
               " does not say where it lies, or lies in another direction than the first; resample it to one stack");
    }
    planes.orientation = orientation;
    planes.positions.push_back({ at[0], at[1], at[2] });
    DcmItem* const which = groupOf(data, frame, DCM_SegmentIdentificationSequence);
    frames.segments.push_back(which ? int(dicomNumber(*which, DCM_ReferencedSegmentNumber).value_or(0.0)) : 0);
  }
  if (DcmItem* const measures =
        groupOf(data, dicomItem(data, DCM_PerFrameFunctionalGroupsSequence), DCM_PixelMeasuresSequence))
  {
    planes.spacing = dicomNumbers(*measures, DCM_PixelSpacing, 2);
    planes.sliceSpacingMm = dicomNumber(*measures, DCM_SpacingBetweenSlices);
    if (!planes.sliceSpacingMm && planes.positions.size() == 1)
    {
      planes.sliceSpacingMm = dicomNumber(*measures, DCM_SliceThickness);
    }
    if (planes.sliceSpacingMm && !(*planes.sliceSpacingMm > 0.0))
    {
      planes.sliceSpacingMm.reset();
    }
  }
  return frames;
}

/// The pixels' bytes, a part at a time: all of them may be many times the volume.
class Pixels
{
public:
  Pixels(DcmDataset& data, std::uint64_t bytes, const std::string& path)
    : path_(path)
  {
    decompressPixels(data, path);
    if (data.findAndGetElement(DCM_PixelData, element_).bad() || element_->getLength() < bytes)
    {
      refuse(path, "its pixel data end too early; copy it again");
    }
  }

  std::uint8_t* read(std::uint64_t begin, std::uint64_t end)
  {
    buffer_.resize(std::size_t(end - begin));
    if (element_->getPartialValue(buffer_.data(), Uint32(begin), Uint32(end - begin), &cache_).bad())
    {
      refuse(path_, "its pixel data end too early; copy it again");
    }
    return buffer_.data();
  }

private:
  std::string path_;
  DcmElement* element_ = nullptr;
  DcmFileCache cache_;
  std::vector<std::uint8_t> buffer_;
};

} // namespace

bool isDicomSeg(const std::string& path)
{
  try
  {
    return isDicomFile(path) && dicomText(*openDicom(path, false)->getDataset(), DCM_Modality) == "SEG";
  }
  catch (const Error&)
  {
    return false;
  }
}

GridPlacement dicomSegPlacement(const std::string& path)
{
  const std::unique_ptr<DcmFileFormat> file = openDicom(path, false);
  return stackPlanes(framesOf(*file->getDataset(), path).planes, true).placement;
}

LabelVolume readDicomSeg(const std::string& path, const Progress& progress)
{
  const std::unique_ptr<DcmFileFormat> file = openDicom(path, true);
  DcmDataset& data = *file->getDataset();
  const Frames frames = framesOf(data, path);
  LabelVolume volume;
  volume.labels = segmentsOf(data, path);
  std::vector<Structure> structures;
  std::map<int, std::size_t> structureOf;
  for (const LabelInfo& label : volume.labels)
  {
    structureOf[label.id] = structures.size();
    structures.push_back({ std::uint16_t(label.id), label.name, {} });
  }
  const auto structure = [&](int segment) -> VoxelRuns& {
    const auto found = structureOf.find(segment);
    if (found == structureOf.end())
    {
      refuse(path, "its pixels belong to a segment " + std::to_string(segment) + ", which it does not list");
    }
    return structures[found->second].voxels;
  };

  const DicomStack stack = stackPlanes(frames.planes, true);
  volume.placement = stack.placement;
  volume.placement.frameOfReference = dicomText(data, DCM_FrameOfReferenceUID);
  const std::uint64_t planePixels = std::uint64_t(frames.planes.columns) * std::uint64_t(frames.planes.rows);
  const std::size_t frameCount = stack.slices.size();
  Pixels pixels(data, (frameCount * planePixels * frames.bits + 7) / 8, path);

  // Runs are ascending: slices from the first on, whatever the order of the frames.
  std::vector<std::size_t> order(frameCount);
  for (std::size_t n = 0; n < frameCount; ++n)
  {
    order[n] = n;
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return stack.slices[a] < stack.slices[b]; });
  std::set<std::pair<int, int>> places; // of a segment
  for (std::size_t n = 0; n < frameCount; ++n)
  {
    const std::size_t frame = order[n];
    if (!places.emplace(stack.slices[frame], frames.segments[frame]).second)
    {
      refuse(path, "two of its frames show one segment at one place, as a film does; save one picture of it");
    }
    const std::uint64_t firstBit = frame * planePixels * frames.bits;
    const std::uint8_t* const bytes = pixels.read(firstBit / 8, (firstBit + planePixels * frames.bits + 7) / 8);
    const auto segmentAt = [&](std::uint64_t pixel) -> int {
      switch (frames.kind)
      {
        case Kind::Binary:
        {
          const std::uint64_t bit = firstBit % 8 + pixel;
          return (bytes[bit / 8] >> (bit % 8) & 1) != 0 ? frames.segments[frame] : 0;
        }
        case Kind::Fractional:
          return double(bytes[pixel]) >= frames.half ? frames.segments[frame] : 0;
        default:
          return frames.bits == 8 ? bytes[pixel] : bytes[2 * pixel] + 256 * bytes[2 * pixel + 1];
      }
    };
    // Of a mask most bytes hold eight equal pixels.
    const auto areEight = [&](std::uint64_t pixel, int segment) {
      const std::uint64_t bit = firstBit % 8 + pixel;
      return frames.kind == Kind::Binary && bit % 8 == 0 && pixel + 8 <= planePixels &&
             bytes[bit / 8] == (segment != 0 ? 0xff : 0);
    };
    const std::uint64_t firstVoxel = std::uint64_t(stack.slices[frame]) * planePixels;
    for (std::uint64_t pixel = 0; pixel < planePixels;)
    {
      const std::uint64_t begin = pixel;
      const int segment = segmentAt(begin);
      for (++pixel; pixel < planePixels && segmentAt(pixel) == segment;)
      {
        pixel += areEight(pixel, segment) ? 8 : 1;
      }
      if (segment != 0)
      {
        structure(segment).add(std::size_t(firstVoxel + begin), std::size_t(pixel - begin));
      }
    }
    report(progress, double(n + 1) / double(frameCount));
  }
  FlattenedStructures flat = flattenStructures(structures, volume.placement.voxelCount(), "'" + path + "'");
  volume.voxels = std::move(flat.voxels);
  volume.notice = std::move(flat.overlap);
  return volume;
}

} // namespace sono
