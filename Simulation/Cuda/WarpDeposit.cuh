#pragma once

#include "Kernel/Reverberation.h"
#include "Trace/TracedBin.h"
#include "Trace/TracedReverberation.h"

#include <cuda_runtime.h>

// A warp leaves the segments of its paths in the bins of their line, one after the other.

namespace sono {

constexpr int warpLanes = 32;

/// A segment and the bins that it covers, as lanes share it: no more than this, since bins fill what is left of the
/// shared memory.
struct StagedSegment
{
  struct Direct
  {
    BeamSegment beam;
    float scale; ///< of a bin's value at its middle, 0: the coherence weight is not smooth enough for that
  };
  union
  {
    Direct direct;
    TissueEcho echo; ///< where it reverberates
  };
  float low;
  float high;
  int binHigh;
  unsigned binLow : 31;
  unsigned reverberates : 1;
};

/// Which bins it covers.
__device__ inline void stageSpan(const DepthSpan& span, float binMm, bool reverberates, StagedSegment& staged)
{
  staged.low = span.low;
  staged.high = span.high;
  const BinSpan covered = binSpan(span, binMm);
  staged.binLow = unsigned(covered.first);
  staged.binHigh = covered.last;
  staged.reverberates = reverberates ? 1u : 0u;
}

__device__ inline void stage(const BeamSegment& seen, float length, float binMm, int binCount, StagedSegment& staged)
{
  stageSpan(depthSpan(seen.r0, seen.mu, length, binMm * float(binCount)), binMm, false, staged);
  staged.direct.beam = seen;
  // At a bin's middle w is within step^2 / 12 C0^2 of its mean: here 1e-4.
  const float step = binMm / fabsf(seen.mu);
  const float half = 0.5f * seen.decay * step;
  const bool smooth = step < 0.035f * seen.coherence && half < 0.3f;
  staged.direct.scale = smooth ? seen.intensity * (1.0f + half * half * (1.0f / 6.0f)) / binMm : 0.0f;
}

__device__ inline void stage(const TissueEcho& echo, const DepthSpan& span, const TissueBins& bins,
                             StagedSegment& staged)
{
  stageSpan(span, bins.mm, true, staged);
  staged.echo = echo;
}

__device__ inline void stage(const TissueEcho& echo, float length, const TissueBins& bins, StagedSegment& staged)
{
  stage(echo, depthSpan(echo.r0, echo.mu, length, echo.level != 0.0f ? bins.endMm() : 0.0f), bins, staged);
}

__device__ inline void addToBin(const BeamSegment& beam, float value, float at, BinSums<float>& bin)
{
#pragma unroll
  for (int sum = 0; sum < binSumCount; ++sum)
  {
    bin.of[sum] += value * binFactor(sum, beam, at, 1.0f);
  }
}

/// A warp adds a segment to its bins; a bin always belongs to the same lane, so that the sum's order is that of the
/// segments.
__device__ inline void depositByWarp(const StagedSegment s, float binMm, int lane, BinSums<float>* __restrict__ bins)
{
  const BeamSegment& beam = s.direct.beam;
  const int first = int(s.binLow);
  int b = first + ((lane - first) & (warpLanes - 1));
  const float inverseMu = 1.0f / beam.mu;
  if (s.direct.scale > 0.0f)
  {
    float from = fmaxf(s.low, float(b) * binMm);
    for (; b <= s.binHigh; b += warpLanes)
    {
      const float to = fminf(s.high, float(b + 1) * binMm);
      const float at = (0.5f * (from + to) - beam.r0) * inverseMu;
      addToBin(beam, s.direct.scale * (to - from) * expNegative(-beam.decay * at) * beamWeightAt(beam, at), at,
               bins[b]);
      from = float(b + warpLanes) * binMm;
    }
    return;
  }
  const float perMm = 1.0f / binMm;
  for (; b <= s.binHigh; b += warpLanes)
  {
    const float from = fmaxf(s.low, float(b) * binMm);
    const float to = fminf(s.high, float(b + 1) * binMm);
    const float at = (0.5f * (from + to) - beam.r0) * inverseMu;
    addToBin(beam, meanOver(beam, from, to, inverseMu) * (to - from) * perMm, at, bins[b]);
  }
}

__device__ inline void addUnits(unsigned long long& sum, float units)
{
  atomicAdd(&sum, (unsigned long long)(__float2ll_rn(units)));
}

/// Weights need not be exact: a hundredth of the unit keeps a boundary's from overflowing.
constexpr float weightUnit = 0.01f;

/// Adds to (weight, weight times Np).
__device__ inline void addAbsorbed(unsigned long long* sums, float weightUnits, float absorbedNp)
{
  addUnits(sums[0], weightUnit * weightUnits);
  addUnits(sums[1], weightUnit * weightUnits * absorbedNp);
}

/// Where a line's reverberation goes.
struct ReverberationRow
{
  unsigned long long* batch;            ///< batches x TissueBins x ReverberationSum
  int batchLanes;                       ///< of the warp, that each batch has
  unsigned long long* absorbedByTissue; ///< bins x (weight, weight times Np)
  const float* cellMm;                  ///< bins: see resolutionCell
  std::uint32_t lineKey;
  TissueBins bins;
};

/// Segments that reverberate are short, and what a bin takes is long: groups of lanes have a segment each, and lanes
/// some bins at a time.
constexpr int echoLanes = 8;
constexpr int echoBins = 2;

/// What reverberates of a segment, on its own way or straight back, by range, by a group's lane. Sums of integers,
/// since warps share them.
template<bool StraightBack>
__device__ inline void reverberateByLanes(const StagedSegment& s, const ReverberationRow& row, int batch, float scale,
                                          int lane)
{
  unsigned long long* const sums = row.batch + batch * reverberationSumCount * row.bins.count;
  const DepthSpan span{ s.low, s.high };
  for (int first = int(s.binLow) + lane; first <= s.binHigh; first += echoLanes * echoBins)
  {
    BinEcho inBin[echoBins];
    int sum[echoBins];
#pragma unroll
    for (int i = 0; i < echoBins; ++i)
    {
      const int b = min(first + i * echoLanes, row.bins.count - 1);
      inBin[i] = echoInBin(s.echo, span, b, row.bins.mm);
      if (StraightBack)
      {
        sum[i] = straightPowerSum;
        inBin[i].level *= heardInBin(inBin[i]);
      }
      else
      {
        sum[i] = signInBin(s.echo, inBin[i], row.lineKey, b, __ldg(row.cellMm + b)) > 0.0f ? plusSum : minusSum;
      }
    }
#pragma unroll
    for (int i = 0; i < echoBins; ++i)
    {
      const int b = first + i * echoLanes;
      if (b > s.binHigh)
      {
        break;
      }
      const float units = scale * inBin[i].level * inBin[i].share;
      addUnits(sums[reverberationSumCount * b + sum[i]], StraightBack ? units * inBin[i].level : units);
      if (b == row.bins.absorptionBin(b))
      {
        addAbsorbed(row.absorbedByTissue + 2 * b, units, inBin[i].absorbedNp);
      }
    }
  }
}

/// The staged segments that `waiting` has a bit for.
template<bool StraightBack>
__device__ inline void reverberateByWarp(const StagedSegment* staged, unsigned waiting, const ReverberationRow& row,
                                         float scale, int lane)
{
  while (waiting != 0u)
  {
    int mine = -1;
#pragma unroll
    for (int group = 0; group < warpLanes / echoLanes; ++group)
    {
      mine = group == lane / echoLanes && waiting != 0u ? __ffs(int(waiting)) - 1 : mine;
      waiting &= waiting - 1u;
    }
    if (mine >= 0)
    {
      reverberateByLanes<StraightBack>(staged[mine], row, mine / row.batchLanes, scale, lane % echoLanes);
    }
  }
}

} // namespace sono
