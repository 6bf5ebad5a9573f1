#pragma once

#include "Trace/ReverberationWindows.h"
#include "Trace/TracedBin.h"
#include "Trace/TracedReverberation.h"

#include <vector>

namespace sono {

// What a line's batches of paths come to, for all bins at once, in vectors: the sums of TracedBin.h and
// TracedReverberation.h in the same order.

/// A line's arrays, as long as its bins.
struct BinRows
{
  float* intensity;
  float* standardError;
  float* attenuation;
};

/// finishBin of each bin. `shared` is what all paths leave, `batches` the means of what those of a batch leave besides.
void finishBins(const std::vector<BinSums<double>>& shared, const std::vector<std::vector<BinSums<double>>>& batches,
                int sums, double frequencyMHz, const BinRows& out);

/// What is kept of a line's ReverberationMeans, by bin.
struct ReverberationLine
{
  ReverberationRows around; ///< aroundOf, of one line
  std::vector<float> ownLevel, error;
};

/// reverberationMeans of each of `count` bins. A batch without any is empty.
ReverberationLine reverberationOf(const std::vector<std::vector<ReverberationSums>>& batches, int count);

} // namespace sono
