#include "Labels/DicomFile.h"

#include "Core/Error.h"

#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <numeric>

namespace sono {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
  throw Error("cannot read '" + path + "': " + why + ".");
}

void prepareOnce()
{
  static std::once_flag once;
  std::call_once(once, [] {
    OFLog::configure(OFLogger::OFF_LOG_LEVEL); // what matters comes as a status
    DcmRLEDecoderRegistration::registerCodecs();
    DJDecoderRegistration::registerCodecs();
    DJLSDecoderRegistration::registerCodecs();
  });
}

} // namespace

std::unique_ptr<DcmFileFormat> openDicom(const std::string& path, bool withPixels)
{
  prepareOnce();
  auto file = std::make_unique<DcmFileFormat>();
  const OFCondition status = withPixels ? file->loadFile(path.c_str())
                                        : file->loadFileUntilTag(path.c_str(), EXS_Unknown, EGL_noChange,
                                                                 DCM_MaxReadLength, ERM_autoDetect, DCM_PixelData);
  if (status.bad())
  {
    refuse(path, std::string("it is no complete DICOM file (") + status.text() + ")");
  }
  file->getDataset()->convertToUTF8(); // a name that cannot be converted stays as it is
  return file;
}

void decompressPixels(DcmDataset& data, const std::string& path)
{
  if (data.chooseRepresentation(EXS_LittleEndianExplicit, nullptr).bad() ||
      !data.canWriteXfer(EXS_LittleEndianExplicit))
  {
    const DcmXfer syntax(data.getOriginalXfer());
    refuse(path, std::string("its pixels are compressed as ") + syntax.getXferName() +
                   ", or damaged; save it uncompressed or as RLE, JPEG or JPEG-LS");
  }
}

std::string dicomText(DcmItem& item, const DcmTagKey& tag)
{
  OFString text;
  return item.findAndGetOFString(tag, text).good() ? std::string(text.c_str()) : std::string();
}

std::optional<double> dicomNumber(DcmItem& item, const DcmTagKey& tag, unsigned long index)
{
  DcmElement* element = nullptr;
  Float64 number = 0.0;
  if (item.findAndGetElement(tag, element).bad())
  {
    return {};
  }
  if (element->getFloat64(number, index).good())
  {
    return number;
  }
  Uint16 word = 0;
  if (element->getUint16(word, index).good())
  {
    return double(word);
  }
  Sint32 whole = 0; // as text
  if (element->getSint32(whole, index).good())
  {
    return double(whole);
  }
  Uint32 large = 0;
  return element->getUint32(large, index).good() ? std::optional<double>(large) : std::nullopt;
}

std::vector<double> dicomNumbers(DcmItem& item, const DcmTagKey& tag, std::size_t count)
{
  std::vector<double> numbers;
  for (std::size_t n = 0; n < count; ++n)
  {
    const auto number = dicomNumber(item, tag, n);
    if (!number || !std::isfinite(*number))
    {
      return {};
    }
    numbers.push_back(*number);
  }
  return numbers;
}

DcmItem* dicomItem(DcmItem& item, const DcmTagKey& sequence, unsigned long index)
{
  DcmItem* found = nullptr;
  DcmSequenceOfItems* items = nullptr;
  if (item.findAndGetSequence(sequence, items).good() && items && index < items->card())
  {
    found = items->getItem(index);
  }
  return found;
}

DicomStack stackPlanes(const DicomPlanes& planes, bool gaps)
{
  const std::string& path = planes.path;
  if (planes.orientation.size() != 6 || planes.spacing.size() != 2 || planes.positions.empty())
  {
    refuse(path, "it does not say where its pixels lie in the patient (position, orientation, spacing); save it "
                 "again from the program that made it");
  }
  const Vec3d along(planes.orientation[0], planes.orientation[1], planes.orientation[2]);
  const Vec3d down(planes.orientation[3], planes.orientation[4], planes.orientation[5]);
  const Vec3d normal = glm::cross(along, down);
  std::vector<std::size_t> order(planes.positions.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  const auto height = [&](std::size_t n) { return glm::dot(planes.positions[n], normal); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return height(a) < height(b); });

  // The distance of two slices: of a segmentation what it says, since slices may be left out everywhere.
  constexpr double sameMm = 1e-3;
  std::vector<double> steps;
  for (std::size_t n = 1; n < order.size(); ++n)
  {
    const double step = height(order[n]) - height(order[n - 1]);
    if (step > sameMm)
    {
      steps.push_back(step);
    }
  }
  double stepMm = planes.sliceSpacingMm.value_or(1.0);
  if (!steps.empty() && !(gaps && planes.sliceSpacingMm))
  {
    std::nth_element(steps.begin(), steps.begin() + std::ptrdiff_t(steps.size() / 2), steps.end());
    stepMm = gaps ? *std::min_element(steps.begin(), steps.end()) : steps[steps.size() / 2];
  }

  DicomStack stack;
  stack.slices.resize(order.size());
  const Vec3d first = planes.positions[order[0]];
  int last = 0;
  double lastMm = 0.0;
  for (const std::size_t n : order)
  {
    const Vec3d offset = planes.positions[n] - first;
    const double heightMm = glm::dot(offset, normal);
    const double slice = std::round(heightMm / stepMm);
    constexpr double tolerance = 0.05; // of a slice, or of a pixel
    if (!(glm::length(offset - heightMm * normal) < tolerance * std::min(planes.spacing[0], planes.spacing[1])))
    {
      refuse(path,
             "its slices are shifted against each other (a tilted gantry?); resample it to a grid at right angles");
    }
    if (!(std::abs(slice * stepMm - heightMm) < tolerance * stepMm) || (!gaps && slice - last > 1.0))
    {
      char text[160];
      std::snprintf(text, sizeof(text),
                    "slices are missing: two neighbours lie %.2f mm apart where others lie %.2f mm apart",
                    heightMm - lastMm, stepMm);
      refuse(path, std::string(text) + "; copy the whole series");
    }
    if (slice > 1000.0 + 100.0 * double(order.size())) // or two planes might ask for any amount of memory
    {
      refuse(path, "its slices lie too far apart; correct its positions");
    }
    last = int(slice);
    lastMm = heightMm;
    stack.slices[n] = last;
  }
  Mat3d columns;
  columns[0] = along * planes.spacing[1];
  columns[1] = down * planes.spacing[0];
  columns[2] = normal * stepMm;
  stack.placement = placementFromAffine({ planes.columns, planes.rows, last + 1 }, columns, first, path);
  if (double(planes.columns) * double(planes.rows) * (last + 1.0) > 4294967296.0)
  {
    refuse(path, "it has more voxels than a volume may have; crop it");
  }
  return stack;
}

} // namespace sono
