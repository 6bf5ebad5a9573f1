#pragma once

#include "Core/Progress.h"
#include "Kernel/Vec.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
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

  /// Appends `count` numbers to `labels`. Throws Error naming the first that is not a whole number in 0..65535.
  template<class T>
  void append(std::vector<std::uint16_t>& labels, const T* numbers, std::size_t count) const
  {
    const bool scaled = slope != 1.0 || intercept != 0.0;
    for (std::size_t n = 0; n < count; ++n)
    {
      double value = double(numbers[n]);
      if (scaled)
      {
        value = withoutRounding(slope * value + intercept);
      }
      if (!(value >= 0.0 && value <= 65535.0) || value != std::floor(value))
      {
        refuse(value, labels.size());
      }
      labels.push_back(std::uint16_t(value));
    }
  }

private:
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

} // namespace sono
