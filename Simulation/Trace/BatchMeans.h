#pragma once

#include "Trace/Trace.h"

#include <cmath>

namespace sono {

/// Adds the mean of a line's batches to its intensity and stores their standard error, from the spread of the batches'
/// means.
inline void addBatchMeans(const std::vector<std::vector<float>>& means, int line, TracedLines& out)
{
  const std::size_t row = std::size_t(line) * std::size_t(out.binCount);
  const double batches = double(means.size());
  for (std::size_t b = 0; b < std::size_t(out.binCount); ++b)
  {
    double mean = 0.0;
    double spread = 0.0;
    for (const auto& m : means)
    {
      mean += m[b];
    }
    mean /= batches;
    for (const auto& m : means)
    {
      spread += (m[b] - mean) * (m[b] - mean);
    }
    out.intensity[row + b] += float(mean);
    out.standardError[row + b] = means.size() > 1 ? float(std::sqrt(spread / (batches * (batches - 1.0)))) : 0.0f;
  }
}

} // namespace sono
