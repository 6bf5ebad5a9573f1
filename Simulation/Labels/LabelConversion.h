#pragma once

#include "Core/LargeMemory.h"
#include "Core/Progress.h"
#include "Labels/VoxelFile.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

namespace sono {

/// How the numbers of a file become label ids, and how to name one of them in a message.
struct LabelConversion
{
  std::string path;
  Vec3i size{ 0, 0, 0 };
  std::size_t valuesPerVoxel = 1; ///< values of one voxel that lie side by side
  double slope = 1.0;             ///< label = slope * number + intercept
  double intercept = 0.0;

  explicit LabelConversion(const VoxelFile& file)
    : path(file.path)
    , size(file.placement.size)
    , valuesPerVoxel(file.layersFirst ? file.layers : 1)
    , slope(file.slope)
    , intercept(file.intercept)
  {
  }

  /// Converts `count` numbers, the first of which is the file's number `position`. Throws Error naming the first that
  /// is not a whole number in 0..65535.
  template<class T>
  void convert(const T* numbers, std::size_t count, std::size_t position, std::uint16_t* labels) const
  {
    if constexpr (std::is_integral_v<T>)
    {
      if (slope == 1.0 && intercept == 0.0)
      {
        bool outside = false;
        for (std::size_t n = 0; n < count; ++n)
        {
          labels[n] = std::uint16_t(numbers[n]);
          outside |= T(labels[n]) != numbers[n];
        }
        if (outside || (std::is_signed_v<T> && sizeof(T) <= 2 && anyNegative(numbers, count)))
        {
          convertOneByOne(numbers, count, position, labels);
        }
        return;
      }
    }
    convertOneByOne(numbers, count, position, labels);
  }

private:
  template<class T>
  static bool anyNegative(const T* numbers, std::size_t count)
  {
    T all = 0;
    for (std::size_t n = 0; n < count; ++n)
    {
      all = T(all | numbers[n]);
    }
    return all < T(0);
  }

  template<class T>
  void convertOneByOne(const T* numbers, std::size_t count, std::size_t position, std::uint16_t* labels) const
  {
    const bool scaled = slope != 1.0 || intercept != 0.0;
    for (std::size_t n = 0; n < count; ++n)
    {
      double value = double(numbers[n]);
      if (scaled)
      {
        value = withoutRounding(slope * value + intercept);
      }
      if (!(value >= 0.0 && value <= 65535.0) || value != double(std::uint16_t(value)))
      {
        refuse(value, position + n);
      }
      labels[n] = std::uint16_t(value);
    }
  }

  /// A slope of 0.1 is not 0.1 in a float, so scaled whole numbers are whole up to rounding only.
  static double withoutRounding(double value)
  {
    const double whole = std::round(value);
    return std::abs(value - whole) < 1e-3 ? whole : value;
  }

  [[noreturn]] void refuse(double value, std::size_t position) const
  {
    const std::size_t sizeX = std::size_t(size.x);
    const std::size_t sizeXy = sizeX * std::size_t(size.y);
    const std::size_t voxel = position / valuesPerVoxel % (sizeXy * std::size_t(size.z));
    std::ostringstream message;
    message << "'" << path << "' holds " << value << " at voxel (" << voxel % sizeX << "," << voxel % sizeXy / sizeX
            << "," << voxel / sizeXy << "); a label map holds whole numbers 0..65535; choose a segmentation, not an "
            << "intensity image, resampled with nearest neighbour.";
    throw Error(message.str());
  }
};

/// The label ids of a file that has no layers. Throws Error as readLabelMap does, and Aborted.
inline std::vector<std::uint16_t> readLabelNumbers(VoxelFile& file, const Progress& progress)
{
  file.bytes.need(file.numbers() * bytesOf(file.type)); // before memory is taken for them
  const LabelConversion conversion(file);
  auto labels = largeVector<std::uint16_t>(std::size_t(file.numbers()));
  readNumbers(file, progress, [&](const auto* numbers, std::size_t count, std::size_t position) {
    conversion.convert(numbers, count, position, labels.data() + position);
  });
  return labels;
}

} // namespace sono
