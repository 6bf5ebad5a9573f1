#pragma once

#include "Trace/TracedBin.h"

#include <cuda_runtime.h>

// A warp leaves the segments of its paths in the bins of their line, one after the other.

namespace sono {

constexpr int warpLanes = 32;

/// A segment and the bins that it covers, as lanes share it: no more than this, since bins fill what is left of the
/// shared memory.
struct StagedSegment
{
  BeamSegment beam;
  float low;
  float high;
  int binLow;
  int binHigh;
  float scale; ///< of a bin's value at its middle, 0: the coherence weight is not smooth enough for that
  bool reverberates;
};

__device__ inline StagedSegment stage(const BeamSegment& seen, float length, float binMm, int binCount,
                                      bool reverberates)
{
  StagedSegment staged;
  staged.beam = seen;
  staged.reverberates = reverberates;
  const DepthSpan span = depthSpan(staged.beam, length, binMm * float(binCount));
  staged.low = span.low;
  staged.high = span.high;
  const BinSpan covered = binSpan(span, binMm);
  staged.binLow = covered.first;
  staged.binHigh = covered.last;
  // At a bin's middle w is within step^2 / 12 C0^2 of its mean: here 1e-4.
  const float step = binMm / fabsf(staged.beam.mu);
  const float half = 0.5f * staged.beam.decay * step;
  const bool smooth = step < 0.035f * staged.beam.coherence && half < 0.3f;
  staged.scale = smooth ? seen.intensity * (1.0f + half * half * (1.0f / 6.0f)) / binMm : 0.0f;
  return staged;
}

__device__ inline void addToBin(const StagedSegment& s, float value, float at, BinSums<float>& bin)
{
#pragma unroll
  for (int sum = 0; sum < binSumCount; ++sum)
  {
    bin.of[sum] += value * binFactor(sum, s.beam, at, 1.0f);
  }
}

/// A warp adds a segment to its bins; a bin always belongs to the same lane, so that the sum's order is that of the
/// segments.
__device__ inline void depositByWarp(const StagedSegment s, float binMm, int lane, BinSums<float>* __restrict__ bins)
{
  int b = s.binLow + ((lane - s.binLow) & (warpLanes - 1));
  const float inverseMu = 1.0f / s.beam.mu;
  if (s.scale > 0.0f)
  {
    float from = fmaxf(s.low, float(b) * binMm);
    for (; b <= s.binHigh; b += warpLanes)
    {
      const float to = fminf(s.high, float(b + 1) * binMm);
      const float at = (0.5f * (from + to) - s.beam.r0) * inverseMu;
      addToBin(s, s.scale * (to - from) * expNegative(-s.beam.decay * at) * beamWeightAt(s.beam, at), at, bins[b]);
      from = float(b + warpLanes) * binMm;
    }
    return;
  }
  const float perMm = 1.0f / binMm;
  for (; b <= s.binHigh; b += warpLanes)
  {
    const float from = fmaxf(s.low, float(b) * binMm);
    const float to = fminf(s.high, float(b + 1) * binMm);
    const float at = (0.5f * (from + to) - s.beam.r0) * inverseMu;
    addToBin(s, meanOver(s.beam, from, to, inverseMu) * (to - from) * perMm, at, bins[b]);
  }
}

/// How much of what reverberates the media have taken, weighted: integers, of which a hundredth does for it, so that no
/// boundary's weight overflows.
__device__ inline void addReverberated(unsigned long long* sums, float weight, float absorbedNp, float scale)
{
  const float units = 0.01f * scale * weight;
  atomicAdd(sums, (unsigned long long)(__float2ll_rn(units)));
  atomicAdd(sums + 1, (unsigned long long)(__float2ll_rn(units * absorbedNp)));
}

/// The same for the level of what reverberates, by range: sums of integers, since warps share them.
__device__ inline void reverberateByWarp(const StagedSegment& s, float binMm, float scale, int lane,
                                         unsigned long long* sums, unsigned long long* reverberated)
{
  const float inverseMu = 1.0f / s.beam.mu;
  for (int b = s.binLow + lane; b <= s.binHigh; b += warpLanes)
  {
    const float from = fmaxf(s.low, float(b) * binMm);
    const float to = fminf(s.high, float(b + 1) * binMm);
    const float level = meanOver(s.beam, from, to, inverseMu) * fmaxf(0.0f, to - from) / binMm;
    atomicAdd(sums + b, (unsigned long long)(__float2ll_rn(level * scale)));
    addReverberated(reverberated + 2 * b, level,
                    s.beam.absorbed + s.beam.decay * (0.5f * (from + to) - s.beam.r0) * inverseMu, scale);
  }
}

} // namespace sono
