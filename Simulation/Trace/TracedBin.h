#pragma once

#include "Kernel/BeamDeposit.h"
#include "Kernel/Interface.h"
#include "Trace/PathBatches.h"

#include <cmath>

// What the paths of a line leave in a radial bin, and the arrays that come of it (TracedLines): which sums there are,
// what a segment adds to each, and how they end. It stands here once, for the CPU, the GPU and the study's twin in
// double precision.

namespace sono {

/// Sums over the crossings of a bin, of I w_R times a factor each.
enum BinSum
{
  intensitySum, ///< 1
  absorbedSum,  ///< A, the attenuation that the path has met, Np of intensity
  binSumCount
};

/// How many of them, the first ones, the model's picture needs: Amadou2024's pulse keeps its frequency whatever is
/// absorbed. The GPU adds up all, since a branch costs it more.
SONO_HD inline int binSumsOf(InterfaceModel model)
{
  return model == InterfaceModel::Acoustic ? binSumCount : 1;
}

template<class Real>
struct alignas((binSumCount % 2 == 0 ? 2 : 1) * sizeof(Real)) BinSums
{
  Real of[binSumCount];
};

/// The factor at `x` times `perX` mm behind the segment's start.
SONO_HD inline float binFactor(int sum, const BeamSegment& g, float x, float perX)
{
  switch (sum)
  {
    case absorbedSum:
      return g.absorbed + g.decay * x * perX;
    default:
      return 1.0f;
  }
}

/// The values of a bin, in the order of TracedLines::visitBins: what paths leave, and what the line's axis says.
enum BinArray
{
  intensityArray,
  standardErrorArray,
  attenuationArray,
  pathArrayCount,
  depthOffsetArray = pathArrayCount,
  reverberationArray,
  reverberationErrorArray,
  reverberationNpArray,
  binArrayCount
};

struct BinArrays
{
  float of[pathArrayCount];
};

/// Of the means of batches, and its standard error.
struct MeanAndError
{
  float mean;
  float error;
};

/// The same of their sum and that of their squares.
SONO_HD inline MeanAndError meanAndErrorOf(int batches, double sum, double squares)
{
  const double mean = batches > 0 ? sum / batches : 0.0;
  const double spread = squares - batches * mean * mean;
  return { float(mean), batches > 1 && spread > 0.0 ? float(sqrt(spread / (double(batches) * (batches - 1)))) : 0.0f };
}

template<class MeanOf>
SONO_HD inline MeanAndError meanAndError(int batches, const MeanOf& meanOf)
{
  double sum = 0.0;
  double squares = 0.0;
  for (int batch = 0; batch < batches; ++batch)
  {
    const double mean = meanOf(batch);
    sum += mean;
    squares += mean * mean;
  }
  return meanAndErrorOf(batches, sum, squares);
}

/// Of the first `sums` sums (binSumsOf): of what all paths of a line leave and, for each of the batches, the mean of
/// what its paths leave besides: `meanOf(batch)`. A path's intensity falls as the amplitude of the round trip does, so
/// what is absorbed is B f. The standard error comes from the spread of the batches' means.
template<class MeanOf>
SONO_HD inline BinArrays finishBin(const BinSums<double>& shared, int batches, const MeanOf& meanOf, int sums,
                                   double frequencyMHz)
{
  float means[batchCount];
  double mean = 0.0;
  BinSums<double> all = shared;
  for (int batch = 0; batch < batches; ++batch)
  {
    const BinSums<double> ofBatch = meanOf(batch);
    means[batch] = float(ofBatch.of[intensitySum]);
    mean += double(means[batch]);
    for (int sum = 0; sum < binSumCount; ++sum)
    {
      all.of[sum] += ofBatch.of[sum] / batches;
    }
  }
  mean = batches > 0 ? mean / batches : 0.0;
  double spread = 0.0;
  for (int batch = 0; batch < batches; ++batch)
  {
    spread += (means[batch] - mean) * (means[batch] - mean);
  }
  const float intensity = float(shared.of[intensitySum]) + float(mean);
  BinArrays arrays;
  arrays.of[intensityArray] = intensity;
  arrays.of[standardErrorArray] = batches > 1 ? float(sqrt(spread / (double(batches) * (batches - 1)))) : 0.0f;
  arrays.of[attenuationArray] =
    sums > absorbedSum && intensity > 0.0f ? float(all.of[absorbedSum] / (double(intensity) * frequencyMHz)) : 0.0f;
  return arrays;
}

} // namespace sono
