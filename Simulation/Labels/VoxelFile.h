#pragma once

#include "Core/Progress.h"
#include "Labels/ByteStream.h"
#include "Labels/LabelVolume.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sono {

enum class NumberType
{
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Int64,
  UInt64,
  Float32,
  Float64
};

/// Bytes of a number.
std::size_t bytesOf(NumberType type);

/// A volume in a file of any format: what its header says, and its numbers, not yet read.
struct VoxelFile
{
  std::string path;
  GridPlacement placement;
  NumberType type = NumberType::UInt8;
  bool swapped = false; ///< the bytes of a number lie the other way round than in this machine
  double slope = 1.0;   ///< what a number means: slope * number + intercept
  double intercept = 0.0;
  std::size_t layers = 1;   ///< volumes of this placement; those of one voxel lie side by side, or
  bool layersFirst = false; ///< one volume after the other
  ByteStream bytes;         ///< at the first number

  std::uint64_t numbers() const { return std::uint64_t(placement.voxelCount()) * layers; }
};

/// Opens a label map or an image of intensities by the ending of its name (ReadLabelMap.h lists the formats) at a phase
/// of time. Throws Error for a missing or unreadable file, one that holds less than its header promises, a colour
/// image, a sheared grid, and more dimensions than three and (NIfTI) time.
VoxelFile openVoxels(const std::string& path, int phase = 0);

/// The ending of a name that openVoxels reads, in lower case: .nii.gz, .nii, .seg.nrrd, .nrrd, .nhdr, .mha or .mhd;
/// empty for another one.
std::string voxelFileEnding(const std::string& path);

/// Which format a name that openVoxels reads stands for; NRRD when neither.
bool isNiftiName(const std::string& path);
bool isMetaName(const std::string& path);

/// Whether a file says of itself that it is DICOM ("DICM" at byte 128), whatever its name.
bool isDicomFile(const std::string& path);

/// Throws Error when openVoxels cannot read it, whatever is in it.
void needVoxelFile(const std::string& path, int phase);

/// Reverses the bytes of each of `count` numbers.
void swapBytes(void* numbers, std::size_t bytesEach, std::size_t count);

namespace detail {

template<class T, class Sink>
void readNumbersAs(VoxelFile& file, const Progress& progress, Sink& sink)
{
  constexpr std::size_t chunk = 65536 / sizeof(T); // stays in the nearest cache
  const std::uint64_t count = file.numbers();
  file.bytes.need(count * sizeof(T));
  std::vector<T> numbers(std::size_t(std::min<std::uint64_t>(chunk, count)));
  for (std::uint64_t at = 0; at < count; at += chunk)
  {
    const std::size_t part = std::size_t(std::min<std::uint64_t>(chunk, count - at));
    file.bytes.read(numbers.data(), part * sizeof(T));
    if (file.swapped)
    {
      swapBytes(numbers.data(), sizeof(T), part);
    }
    sink(static_cast<const T*>(numbers.data()), part, std::size_t(at));
    report(progress, file.bytes.fraction());
  }
  file.bytes.finish();
}

} // namespace detail

/// Reads the numbers of a file, a part at a time: calls sink(const T* numbers, std::size_t count, std::size_t position)
/// with the type T that the file has. Throws Error when they end too early, and Aborted.
template<class Sink>
void readNumbers(VoxelFile& file, const Progress& progress, Sink sink)
{
  switch (file.type)
  {
    case NumberType::Int8:
      return detail::readNumbersAs<std::int8_t>(file, progress, sink);
    case NumberType::UInt8:
      return detail::readNumbersAs<std::uint8_t>(file, progress, sink);
    case NumberType::Int16:
      return detail::readNumbersAs<std::int16_t>(file, progress, sink);
    case NumberType::UInt16:
      return detail::readNumbersAs<std::uint16_t>(file, progress, sink);
    case NumberType::Int32:
      return detail::readNumbersAs<std::int32_t>(file, progress, sink);
    case NumberType::UInt32:
      return detail::readNumbersAs<std::uint32_t>(file, progress, sink);
    case NumberType::Int64:
      return detail::readNumbersAs<std::int64_t>(file, progress, sink);
    case NumberType::UInt64:
      return detail::readNumbersAs<std::uint64_t>(file, progress, sink);
    case NumberType::Float32:
      return detail::readNumbersAs<float>(file, progress, sink);
    case NumberType::Float64:
      return detail::readNumbersAs<double>(file, progress, sink);
  }
}

} // namespace sono
