#pragma once

#include "Kernel/Reverberation.h"
#include "Trace/TracedBin.h"

// What paths that have been reflected leave in a bin of range, and the level of speckle that comes of it
// (Data/docs/physics.md 13.4). It stands here once, for the CPU and the GPU.

namespace sono {

/// What the paths of a batch leave in one of the TissueBins (BinEcho).
enum ReverberationSum
{
  plusSum,          ///< levels of own ways where the cell's sign is +
  minusSum,         ///< and where it is -
  straightPowerSum, ///< of ways straight back
  reverberationSumCount
};

struct ReverberationSums
{
  double of[reverberationSumCount] = {};
};

/// What the media have taken, Np, weighted, and the weights: of tissue in its absorptionBin, of boundaries in each
/// radial bin.
struct AbsorbedSums
{
  double weight = 0.0;
  double weightedNp = 0.0;
};

/// Of all that reverberates in a bin.
SONO_HD inline float absorbedNp(const AbsorbedSums& tissue, const AbsorbedSums& boundaries)
{
  const double weight = tissue.weight + boundaries.weight;
  return weight > 0.0 ? float((tissue.weightedNp + boundaries.weightedNp) / weight) : 0.0f;
}

/// Of a bin, of all batches.
struct ReverberationMeans
{
  float ownLevel;      ///< of own ways, without signs
  float cellPower;     ///< of the mean with signs, less what chance adds to its square
  float straightPower; ///< of what comes straight back, less its error: what one path says is no haze yet
  float error;         ///< standard error of both levels
};

template<class MeanOf>
SONO_HD inline ReverberationMeans reverberationMeans(int batches, const MeanOf& meanOf)
{
  double own = 0.0;
  const MeanAndError cells = meanAndError(batches, [&](int batch) {
    const ReverberationSums sums = meanOf(batch);
    own += (sums.of[plusSum] + sums.of[minusSum]) / batches;
    return sums.of[plusSum] - sums.of[minusSum];
  });
  const MeanAndError straight = meanAndError(batches, [&](int batch) { return meanOf(batch).of[straightPowerSum]; });
  const float straightError = straight.mean > 0.0f ? 0.5f * straight.error / sqrtf(straight.mean) : 0.0f;
  return { float(own), cells.mean * cells.mean - cells.error * cells.error,
           larger(0.0f, straight.mean - straight.error),
           sqrtf(cells.error * cells.error + straightError * straightError) };
}

/// What is known of how far the paths of own ways have spread: sums over bins.
struct SpreadSums
{
  float cellPower = 0.0f; ///< ReverberationMeans::cellPower
  float power = 0.0f;     ///< mean level without signs, squared
};

/// Both change slowly: so many bins and lines to either side are asked, of the same image. What comes straight back, by
/// few paths and from far around, is the mean of as many lines.
SONO_HD inline int spreadBins(float binMm)
{
  constexpr float spreadMm = 3.0f;
  return int(spreadMm / binMm + 0.5f);
}
constexpr int spreadLines = 4;

/// The level of a bin's speckle: `own`, the mean level of own ways, is less by sqrt(M) where the paths have spread over
/// M resolution cells. `unspread` is that of ResolutionCell.
SONO_HD inline float reverberationLevel(const SpreadSums& around, float unspread, float own, float straightPower)
{
  float amplitude = 0.0f;
  if (around.cellPower > 0.0f && around.power > 0.0f)
  {
    const float cells = 1.0f + around.power / around.cellPower - 1.0f / unspread;
    amplitude = cells > 1.0f ? 1.0f / sqrtf(cells) : 1.0f;
  }
  return own * amplitude + sqrtf(straightPower);
}

} // namespace sono
