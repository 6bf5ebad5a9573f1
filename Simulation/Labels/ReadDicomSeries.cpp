#include "Labels/ReadDicomSeries.h"

#include "Core/LargeMemory.h"
#include "Core/ParallelFor.h"
#include "Labels/DicomFile.h"
#include "Labels/VoxelFile.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

namespace sono {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
  throw Error("cannot read '" + path + "': " + why + ".");
}

/// A file of a series, without its pixels.
struct Slice
{
  std::string path;
  std::string series; // its UID; empty: no image
  std::string modality;
  std::string frameOfReference;
  std::string description;
  int columns = 0;
  int rows = 0;
  double samples = 1.0;
  double frames = 1.0;
  std::vector<double> position;
  std::vector<double> orientation;
  std::vector<double> spacing;
  std::optional<double> thicknessMm;
};

/// Refuses a slice whose file cannot hold its pixels, before memory is taken for them.
void refuseEmptyPromise(DcmDataset& data, const Slice& slice)
{
  const DcmXfer syntax(data.getOriginalXfer());
  const bool compressed = syntax.isEncapsulated() || syntax.getStreamCompression() != ESC_none;
  const std::uint64_t pixels = std::uint64_t(slice.columns) * std::uint64_t(slice.rows);
  std::error_code error;
  if (pixels / (compressed ? ByteStream::largestInflation : 1) > fs::file_size(slice.path, error))
  {
    refuse(slice.path, "its pixels end too early; copy it again");
  }
}

Slice readSlice(const std::string& path)
{
  const std::unique_ptr<DcmFileFormat> file = openDicom(path, false);
  DcmDataset& data = *file->getDataset();
  Slice slice;
  slice.path = path;
  slice.modality = dicomText(data, DCM_Modality);
  slice.columns = int(dicomNumber(data, DCM_Columns).value_or(0.0));
  slice.rows = int(dicomNumber(data, DCM_Rows).value_or(0.0));
  if (slice.columns <= 0 || slice.rows <= 0 || slice.modality == "SEG")
  {
    return slice; // a report, a directory, a plan, a segmentation
  }
  refuseEmptyPromise(data, slice);
  slice.series = dicomText(data, DCM_SeriesInstanceUID);
  slice.frameOfReference = dicomText(data, DCM_FrameOfReferenceUID);
  slice.description = dicomText(data, DCM_SeriesDescription);
  slice.samples = dicomNumber(data, DCM_SamplesPerPixel).value_or(1.0);
  slice.frames = dicomNumber(data, DCM_NumberOfFrames).value_or(1.0);
  slice.position = dicomNumbers(data, DCM_ImagePositionPatient, 3);
  slice.orientation = dicomNumbers(data, DCM_ImageOrientationPatient, 6);
  slice.spacing = dicomNumbers(data, DCM_PixelSpacing, 2);
  slice.thicknessMm = dicomNumber(data, DCM_SliceThickness);
  return slice;
}

std::vector<Slice> readFolder(const std::string& folder, const Progress& progress)
{
  std::vector<std::string> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
  {
    if (entry.is_regular_file() && isDicomFile(entry.path().string()))
    {
      paths.push_back(entry.path().string());
    }
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Slice> slices(paths.size());
  parallelFor(int(paths.size()), progress, [&](int n) { slices[std::size_t(n)] = readSlice(paths[std::size_t(n)]); });
  return slices;
}

/// Those of one series: of `file`, or the only one in the folder.
std::vector<Slice> chooseSeries(std::vector<Slice> slices, const std::string& file, const std::string& folder)
{
  std::map<std::string, std::string> all; // series to a name for people
  std::string chosen;
  for (const Slice& slice : slices)
  {
    if (!slice.series.empty())
    {
      all.emplace(slice.series, slice.modality + " '" + slice.description + "' with '" +
                                  fs::path(slice.path).filename().string() + "'");
      chosen = slice.path == file || chosen.empty() ? slice.series : chosen;
    }
  }
  if (all.empty())
  {
    refuse(folder, "it holds no DICOM images; choose the folder that holds the slices themselves");
  }
  if (file.empty() && all.size() > 1)
  {
    refuse(folder, "it holds " + std::to_string(all.size()) + " series (" + all.begin()->second + ", " +
                     std::next(all.begin())->second + "); choose one file of the series that belongs to the labels");
  }
  slices.erase(std::remove_if(slices.begin(), slices.end(), [&](const Slice& s) { return s.series != chosen; }),
               slices.end());
  return slices;
}

bool isClose(const std::vector<double>& a, const std::vector<double>& b, double tolerance)
{
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [&](double x, double y) { return std::abs(x - y) <= tolerance; });
}

DicomPlanes planesOf(const std::vector<Slice>& slices, const std::string& name)
{
  const Slice& first = slices.front();
  DicomPlanes planes{ name, first.columns, first.rows, first.orientation, first.spacing, {}, {} };
  for (const Slice& slice : slices)
  {
    if (slice.samples != 1.0)
    {
      refuse(slice.path, "it is a colour image; choose the scan itself");
    }
    if (slice.frames > 1.0)
    {
      refuse(slice.path, "it holds " + std::to_string(int(std::min(slice.frames, 1e9))) +
                           " slices in one file; convert it to NIfTI or to a file a slice");
    }
    if (slice.position.empty() || slice.orientation.empty() || slice.spacing.empty())
    {
      refuse(slice.path, "it does not say where its pixels lie in the patient (position, orientation, spacing); choose "
                         "the original scan");
    }
    const bool sameGrid = slice.columns == planes.columns && slice.rows == planes.rows &&
                          isClose(slice.spacing, planes.spacing, 1e-4 * planes.spacing[0]);
    if (!sameGrid || !isClose(slice.orientation, planes.orientation, 1e-3))
    {
      refuse(slice.path, "it has another size, pixel spacing or direction than '" + first.path +
                           "' of the same series; move one of them out of the folder");
    }
    planes.positions.push_back({ slice.position[0], slice.position[1], slice.position[2] });
  }
  planes.sliceSpacingMm = first.thicknessMm && *first.thicknessMm > 0.0 ? first.thicknessMm : std::nullopt;
  return planes;
}

template<class T>
void convertPixels(const T* pixels, std::size_t count, int bits, double slope, double intercept, float* values)
{
  // Overlays may lie in the bits above.
  const int unused = std::max(0, int(8 * sizeof(T)) - bits);
  for (std::size_t n = 0; n < count; ++n)
  {
    const auto word = std::uint16_t(std::uint16_t(pixels[n]) << unused);
    const int value = (std::is_signed_v<T> ? int(std::int16_t(word)) : int(word)) >> unused;
    values[n] = float(slope * value + intercept);
  }
}

void readPixels(const Slice& slice, float* values)
{
  const std::unique_ptr<DcmFileFormat> file = openDicom(slice.path, true);
  DcmDataset& data = *file->getDataset();
  decompressPixels(data, slice.path);
  const std::size_t count = std::size_t(slice.columns) * std::size_t(slice.rows);
  const double allocated = dicomNumber(data, DCM_BitsAllocated).value_or(0.0);
  const int bits = int(std::clamp(dicomNumber(data, DCM_BitsStored).value_or(allocated), 1.0, 16.0));
  const double slope = dicomNumber(data, DCM_RescaleSlope).value_or(1.0);
  const double intercept = dicomNumber(data, DCM_RescaleIntercept).value_or(0.0);
  const bool isSigned = dicomNumber(data, DCM_PixelRepresentation).value_or(0.0) == 1.0;
  unsigned long there = 0;
  if (allocated == 8.0)
  {
    const Uint8* bytes = nullptr;
    if (data.findAndGetUint8Array(DCM_PixelData, bytes, &there).good() && bytes && there >= count && !isSigned)
    {
      for (std::size_t n = 0; n < count; ++n)
      {
        values[n] = float(slope * bytes[n] + intercept);
      }
      return;
    }
  }
  else if (allocated == 16.0)
  {
    const Uint16* words = nullptr;
    if (data.findAndGetUint16Array(DCM_PixelData, words, &there).good() && words && there >= count)
    {
      isSigned ? convertPixels(reinterpret_cast<const Sint16*>(words), count, bits, slope, intercept, values)
               : convertPixels(words, count, bits, slope, intercept, values);
      return;
    }
  }
  refuse(slice.path, "its pixels are not there, end too early, or have neither 8 nor 16 bits; copy it again");
}

} // namespace

IntensityVolume readDicomSeries(const std::string& path, const Progress& progress)
{
  std::error_code error;
  const bool isFolder = fs::is_directory(path, error);
  const std::string parent = fs::path(path).parent_path().string();
  const std::string folder = isFolder ? path : parent.empty() ? "." : parent;
  const std::string file = isFolder ? "" : (fs::path(folder) / fs::path(path).filename()).string();
  std::vector<Slice> slices = chooseSeries(readFolder(folder, partOf(progress, 0.0, 0.3)), file, folder);
  const DicomStack stack = stackPlanes(planesOf(slices, folder), false);
  if (stack.slices.size() != std::size_t(stack.placement.size.z))
  {
    refuse(folder, "several of its slices lie at one place: phases of a motion, or copies; choose one volume of it");
  }
  IntensityVolume volume;
  volume.placement = stack.placement;
  volume.placement.frameOfReference = slices.front().frameOfReference;
  volume.modality = slices.front().modality;
  volume.values = largeVector<float>(volume.placement.voxelCount());
  const std::size_t planeVoxels = std::size_t(volume.placement.size.x) * std::size_t(volume.placement.size.y);
  parallelFor(int(slices.size()), partOf(progress, 0.3, 1.0), [&](int n) {
    readPixels(slices[std::size_t(n)], volume.values.data() + planeVoxels * std::size_t(stack.slices[std::size_t(n)]));
  });
  return volume;
}

} // namespace sono
