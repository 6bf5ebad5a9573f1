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
  float cellError;     ///< standard error of the mean with signs
  float straightPower; ///< of what comes straight back
  float error;         ///< standard error of both levels
};

SONO_HD inline ReverberationMeans reverberationMeansOf(float ownLevel, const MeanAndError& cells,
                                                       const MeanAndError& straight)
{
  const float straightError = straight.mean > 0.0f ? 0.5f * straight.error / sqrtf(straight.mean) : 0.0f;
  return { ownLevel, cells.mean * cells.mean - cells.error * cells.error, cells.error, straight.mean,
           sqrtf(cells.error * cells.error + straightError * straightError) };
}

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
  return reverberationMeansOf(float(own), cells, straight);
}

/// Few paths tell how far sound has spread and what comes straight back; both change slowly, so that a bin takes them
/// from the bins around: weights fall straight, in range and over the lines of its image, to nothing beyond this. A
/// window with edges would show them in the picture.
constexpr float spreadAroundMm = 6.0f;
constexpr float straightAroundMm = 2.0f;
constexpr int linesAround = 8;

SONO_HD inline float weightAround(int apart, int reach)
{
  return larger(0.0f, float(reach + 1 - (apart < 0 ? -apart : apart)));
}

/// Weighted sums over the bins around one.
struct ReverberationAround
{
  float cellPower = 0.0f; ///< ReverberationMeans
  float power = 0.0f;     ///< mean level of own ways without signs, squared
  float chance = 0.0f;    ///< the variance that cellPower has by chance
  float straightPower = 0.0f;
  float straightWeight = 0.0f;

  SONO_HD void add(const ReverberationAround& other, float by, float byStraight)
  {
    cellPower += by * other.cellPower;
    power += by * other.power;
    chance += by * by * other.chance;
    straightPower += byStraight * other.straightPower;
    straightWeight += byStraight * other.straightWeight;
  }
};

SONO_HD inline ReverberationAround aroundOf(const ReverberationMeans& means)
{
  const float variance = means.cellError * means.cellError;
  return { means.cellPower, means.ownLevel * means.ownLevel, 2.0f * variance * variance, means.straightPower, 1.0f };
}

/// How far the windows around a bin reach along its line, in bins.
struct WindowAlong
{
  int reach;
  int straightReach; ///< of what comes straight back

  SONO_HD explicit WindowAlong(float tissueBinMm)
    : reach(int(spreadAroundMm / tissueBinMm + 0.5f))
    , straightReach(int(straightAroundMm / tissueBinMm + 0.5f))
  {
  }
};

/// Over the line's bins around one of `count`; `binOf` gives that of each.
template<class BinOf>
SONO_HD inline ReverberationAround sumAlongLine(int bin, int count, float tissueBinMm, const BinOf& binOf)
{
  const WindowAlong window(tissueBinMm);
  const int reach = window.reach;
  ReverberationAround sum;
  for (int b = bin > reach ? bin - reach : 0; b < count && b <= bin + reach; ++b)
  {
    sum.add(binOf(b), weightAround(b - bin, reach), weightAround(b - bin, window.straightReach));
  }
  return sum;
}

/// Over the lines around one, of those from `first` up to before `end`.
template<class LineOf>
SONO_HD inline ReverberationAround sumOverLines(int line, int first, int end, const LineOf& lineOf)
{
  ReverberationAround sum;
  for (int l = line - linesAround > first ? line - linesAround : first; l < end && l <= line + linesAround; ++l)
  {
    const float weight = weightAround(l - line, linesAround);
    sum.add(lineOf(l), weight, weight);
  }
  return sum;
}

/// Windows like the one around a bin of a line, side by side: where they lie, to either side.
struct WindowsFurther
{
  int lines = 2 * linesAround;
  int bins;
  int step; ///< of bins, from one to the next

  SONO_HD explicit WindowsFurther(float tissueBinMm)
  {
    const int inWindow = WindowAlong(tissueBinMm).reach;
    step = inWindow > 0 ? inWindow : 1; // bins wider than windows
    bins = 2 * step;
  }
};

/// Over these windows: three times as far each way and more. `aroundOf` gives that of a line, from `first` up to before
/// `end`, and a bin, of `count`.
template<class AroundOf>
SONO_HD inline ReverberationAround sumFurther(int line, int first, int end, int bin, int count, float tissueBinMm,
                                              const AroundOf& aroundOf)
{
  const WindowsFurther windows(tissueBinMm);
  ReverberationAround sum;
  for (int l = line - windows.lines; l <= line + windows.lines; l += linesAround)
  {
    for (int b = bin - windows.bins; b <= bin + windows.bins; b += windows.step)
    {
      if (l >= first && l < end && b >= 0 && b < count)
      {
        sum.add(aroundOf(l, b), 1.0f, 1.0f);
      }
    }
  }
  return sum;
}

/// The level of a bin's speckle: `own`, the mean level of own ways, is less by sqrt(M) where the paths have spread over
/// M resolution cells. As far as M is chance around the bin, it is that of the windows further out. `unspread` is that
/// of ResolutionCell.
SONO_HD inline float reverberationLevel(const ReverberationAround& around, const ReverberationAround& further,
                                        float unspread, float own)
{
  float perCells = around.power > 0.0f ? around.cellPower / around.power : 0.0f;
  if (around.chance > 0.0f)
  {
    const float known = larger(0.0f, around.cellPower);
    const float there = further.power > 0.0f ? larger(0.0f, further.cellPower / further.power) : 0.0f;
    perCells += (there - perCells) * around.chance / (around.chance + known * known);
  }
  float amplitude = 0.0f;
  if (perCells > 0.0f)
  {
    const float cells = 1.0f + 1.0f / perCells - 1.0f / unspread;
    amplitude = cells > 1.0f ? 1.0f / sqrtf(cells) : 1.0f;
  }
  const float straight = around.straightWeight > 0.0f ? sqrtf(around.straightPower / around.straightWeight) : 0.0f;
  return own * amplitude + straight;
}

} // namespace sono
