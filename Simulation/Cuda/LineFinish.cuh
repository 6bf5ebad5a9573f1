#pragma once

#include "Cuda/DeviceEcho.cuh"
#include "Kernel/Downshift.h"
#include "Kernel/ReverberationNoise.h"
#include "Kernel/TimeOfFlight.h"

// From a line's scatterer sum, by depth, to its IQ and envelope, by range, as LineFinisher on the CPU.

namespace sono {

struct FinishLaunch
{
  const float2* sum; // or null: no scatterers but nested ones
  const int* nested; // (re, im) of those; or null
  float nestedPerUnit;
  const EchoSum* surfaces; // (re, im) of surfaces, intensity included; or null
  float surfacePerUnit;
  TracedOnDevice traced;
  const float* level;    // of boundaries at each sample, or null
  const float2* speckle; // that reverberates, at level 1, behind the pulse: linesPerImage x sampleCount
  int linesPerImage;
  Downshift downshift;
  const float* turns; // lines x rangeCount, of the downshift's phase; null: the frequency stays
  const float2* carrier;
  float2 halfTurn;    // of the carrier from a sample to halfway behind it
  const float* pulse; // re, then im where it is complex
  int half;
  int sumCount;   // samples by depth
  int rangeCount; // samples by range before the pulse
  int sampleCount;
  float sampleMm;
  float radPerSample;
  double binsPerSample; // of the tracer
  float2* iq;           // null: not wanted
  float* envelope;
};

constexpr int outputsOfThread = 8; // and taps that are taken together
constexpr int finishThreads = 128;
constexpr int tileSamples = outputsOfThread * finishThreads;

/// Taps of a pulse, and zeros up to whole groups of them.
SONO_HD inline int paddedTaps(int half)
{
  return (2 * half + outputsOfThread) / outputsOfThread * outputsOfThread;
}

/// Samples of a tile and around it lie in rows of each eighth: threads that read side by side find them side by side,
/// and the rows begin so that a half warp writes two columns into different banks.
SONO_HD inline int tilePitch(int half)
{
  const int columns = finishThreads + paddedTaps(half) / outputsOfThread;
  return columns + (18 - columns % 16) % 16;
}

/// Bytes that a block keeps of a tile and the pulse.
inline std::size_t finishBytes(int half, bool complexPulse)
{
  return std::size_t(tilePitch(half)) * outputsOfThread * sizeof(float2) +
         std::size_t(paddedTaps(half)) * (complexPulse ? 2 : 1) * sizeof(float);
}

/// Where a sample falls between the centres of the tracer's bins: the first of two, the step to the other, its share.
struct BinPlace
{
  int bin;
  int step;
  float share;
};

__device__ inline BinPlace binPlace(const FinishLaunch& launch, int s)
{
  const TracedOnDevice& traced = launch.traced;
  const double wanted = s * launch.binsPerSample - 0.5;
  const double position = fmin(fmax(wanted, 0.0), double(traced.binCount - 1));
  const int bin = min(int(position), max(0, traced.binCount - 2));
  return { bin, traced.binCount > 1 ? 1 : 0, float(position - bin) };
}

__device__ inline float valueAt(const float* bins, const BinPlace& p)
{
  const float value = bins[p.bin];
  return value + (bins[p.bin + p.step] - value) * p.share;
}

__device__ inline RangeMap rangeMap(const FinishLaunch& launch, int line)
{
  const TracedOnDevice& traced = launch.traced;
  return { traced.depthOffset ? traced.depthOffset + std::size_t(line) * traced.binCount : nullptr, traced.binCount,
           1.0f / traced.binMm };
}

/// B of a line at a sample of range, as far as it lowers the frequency.
__device__ inline float exponentAt(const FinishLaunch& launch, const RangeMap& map, const float* bins, int s)
{
  const int d = depthSample(map, launch.sampleMm, s, launch.sumCount);
  return shiftingExponent(launch.downshift, valueAt(bins, binPlace(launch, d)));
}

constexpr int turnThreads = 1024;

/// A block adds up the turns of the downshift's phase along a line, whole ones left out; each thread has neighbouring
/// samples.
__global__ void __launch_bounds__(turnThreads) sumTurns(FinishLaunch launch, float* turns)
{
  __shared__ double sums[turnThreads];
  const int line = blockIdx.x;
  const float* bins = launch.traced.attenuation + std::size_t(line) * launch.traced.binCount;
  const RangeMap map = rangeMap(launch, line);
  const int each = (launch.rangeCount + turnThreads - 1) / turnThreads;
  const int first = min(int(threadIdx.x) * each, launch.rangeCount);
  const int last = min(first + each, launch.rangeCount);
  const auto forTurns = [&](const auto& visit) { // from each sample to the next
    float here = first < last ? exponentAt(launch, map, bins, first) : 0.0f;
    for (int s = first; s < last; ++s)
    {
      const float next = s + 1 < launch.rangeCount ? exponentAt(launch, map, bins, s + 1) : here;
      visit(s, double(downshiftTurns(launch.downshift, 0.5f * (here + next))));
      here = next;
    }
  };
  double own = 0.0;
  forTurns([&](int, double step) { own += step; });
  sums[threadIdx.x] = own;
  __syncthreads();
  for (int step = 1; step < turnThreads; step *= 2)
  {
    const double before = int(threadIdx.x) >= step ? sums[threadIdx.x - step] : 0.0;
    __syncthreads();
    sums[threadIdx.x] += before;
    __syncthreads();
  }
  double sum = sums[threadIdx.x] - own;
  forTurns([&](int s, double step) {
    turns[std::size_t(line) * launch.rangeCount + s] = float(sum - floor(sum + 0.5));
    sum += step;
  });
}

/// The sum at a sample of depth: scatterers times the intensity, and surfaces.
__device__ inline float2 summedAt(const FinishLaunch& launch, int line, int d)
{
  float2 v{ 0.0f, 0.0f };
  const std::size_t at = std::size_t(line) * launch.sumCount + d;
  if (launch.sum)
  {
    v = launch.sum[at];
  }
  if (launch.nested)
  {
    v.x += float(launch.nested[2 * at]) * launch.nestedPerUnit;
    v.y += float(launch.nested[2 * at + 1]) * launch.nestedPerUnit;
  }
  const TracedOnDevice& traced = launch.traced;
  if (traced.intensity)
  {
    const float intensity = valueAt(traced.intensity + std::size_t(line) * traced.binCount, binPlace(launch, d));
    v.x *= intensity;
    v.y *= intensity;
  }
  if (launch.surfaces)
  {
    v.x += float((long long)(launch.surfaces[2 * at])) * launch.surfacePerUnit;
    v.y += float((long long)(launch.surfaces[2 * at + 1])) * launch.surfacePerUnit;
  }
  return v;
}

/// What of the depths behind a sample of range, up to the next, is shown at either, demodulated.
struct ShownPair
{
  float2 here;
  float2 next;
};

__device__ inline ShownPair shownBehind(const FinishLaunch& launch, const RangeStep& step, int line, int s)
{
  ShownPair v{ { 0.0f, 0.0f }, { 0.0f, 0.0f } };
  const float2 c = launch.carrier[s];
  const float2 t = launch.halfTurn;
  const float2 middle{ c.x * t.x - c.y * t.y, c.x * t.y + c.y * t.x };
  for (int d = step.first; d < min(step.end, launch.sumCount); ++d)
  {
    const float2 sum = summedAt(launch, line, d);
    const float share = step.shareOf(d);
    const ShownSample shown = shownSample(sum.x, sum.y, (share - 0.5f) * launch.radPerSample, middle.x, middle.y);
    v.here.x += (1.0f - share) * shown.re;
    v.here.y += (1.0f - share) * shown.im;
    v.next.x += share * shown.re;
    v.next.y += share * shown.im;
  }
  return v;
}

/// How much stronger what reverberates is in a line's bin, by the frequency that its own way leaves of the pulse's.
__device__ inline float reverberationGain(const FinishLaunch& launch, int line, int bin)
{
  const TracedOnDevice& traced = launch.traced;
  if (!traced.reverberation || !traced.attenuation)
  {
    return 1.0f;
  }
  const float taken = traced.reverberationNp[std::size_t(line) * traced.binCount + bin];
  return downshiftGain(launch.downshift, shiftingExponent(launch.downshift, taken));
}

/// The boundary echoes of paths at a sample of range, demodulated. Of Acoustic they have been attenuated by ways of
/// their own.
__device__ inline float2 reflectedAt(const FinishLaunch& launch, int line, int s)
{
  const TracedOnDevice& traced = launch.traced;
  float2 v{ 0.0f, 0.0f };
  const float level = launch.level ? launch.level[s] : 1.0f;
  if (traced.echoSums && s < traced.echoCount)
  {
    const EchoSum* echo = traced.echoSums + 2 * (std::size_t(line) * traced.echoCount + s);
    v.x += float((long long)(echo[0])) * traced.echoPerUnit * level;
    v.y += float((long long)(echo[1])) * traced.echoPerUnit * level;
  }
  if (traced.echo)
  {
    const std::size_t at = std::size_t(line) * launch.rangeCount + s;
    v.x += traced.echo[at].x;
    v.y += traced.echo[at].y;
  }
  if (v.x != 0.0f || v.y != 0.0f)
  {
    const float2 c = launch.carrier[s];
    const int bin = min(int(float(s) * float(launch.binsPerSample)), traced.binCount - 1);
    const float gain = reverberationGain(launch, line, bin);
    v = { gain * (v.x * c.x - v.y * c.y), gain * (v.x * c.y + v.y * c.x) };
  }
  return v;
}

/// The speckle that reverberates at a sample of range, behind the pulse. It knows nothing of what the line attenuates.
__device__ inline float2 reverberatingAt(const FinishLaunch& launch, int line, int s)
{
  const TracedOnDevice& traced = launch.traced;
  const float* bins = traced.reverberation + std::size_t(line) * traced.binCount;
  const auto levelOf = [&](int bin) {
    return bins[bin] > 0.0f ? bins[bin] * reverberationGain(launch, line, bin) : 0.0f;
  };
  const float level = levelAtRange(levelOf, traced.binCount, float(launch.binsPerSample), s);
  if (level <= faintestReverberation)
  {
    return { 0.0f, 0.0f };
  }
  const float2 noise = launch.speckle[std::size_t(line % launch.linesPerImage) * launch.sampleCount + s];
  return { level * noise.x, level * noise.y };
}

/// What is shown at a sample of range, and the boundary echoes, demodulated; where the frequency sinks, as strong as it
/// then is and turned by the phase. All lanes of a warp have neighbouring samples, and the first one's is not wanted:
/// what is shown between two samples is found once, by the lane of the earlier.
__device__ inline float2 demodulated(const FinishLaunch& launch, int line, int s)
{
  const bool exists = s >= 0 && s < launch.rangeCount;
  const RangeMap map = rangeMap(launch, line);
  const TracedOnDevice& traced = launch.traced;
  float2 v{ 0.0f, 0.0f };
  if (map.offsetMm)
  {
    const float depth = depthInSamples(map, launch.sampleMm, max(s, 0));
    const float next = __shfl_down_sync(0xffffffffu, depth, 1);
    ShownPair shown{ { 0.0f, 0.0f }, { 0.0f, 0.0f } };
    if (exists)
    {
      const bool isLast = threadIdx.x % 32 == 31;
      const float end = isLast ? depthInSamples(map, launch.sampleMm, s + 1) : next;
      shown = shownBehind(launch, stepBetween(depth, end), line, s);
    }
    v.x = shown.here.x + __shfl_up_sync(0xffffffffu, shown.next.x, 1);
    v.y = shown.here.y + __shfl_up_sync(0xffffffffu, shown.next.y, 1);
  }
  else if (exists)
  {
    const float2 c = launch.carrier[s];
    const float2 sum = summedAt(launch, line, s);
    v = { sum.x * c.x - sum.y * c.y, sum.x * c.y + sum.y * c.x };
  }
  if (!exists)
  {
    return { 0.0f, 0.0f };
  }
  const bool sinks = launch.turns != nullptr;
  if (sinks)
  {
    const float* bins = traced.attenuation + std::size_t(line) * traced.binCount;
    const float gain = downshiftGain(launch.downshift, exponentAt(launch, map, bins, s));
    v = { gain * v.x, gain * v.y };
  }
  const float2 late = reflectedAt(launch, line, s);
  v = { v.x + late.x, v.y + late.y };
  if (sinks)
  {
    const DownshiftAt turned = downshiftRotation(launch.turns[std::size_t(line) * launch.rangeCount + s]);
    v = { v.x * turned.re - v.y * turned.im, v.x * turned.im + v.y * turned.re };
  }
  return v;
}

/// Convolves a tile of a line with the pulse; each thread keeps the sums of neighbouring samples in registers. Of these
/// it has as many as let all blocks of an image run at once.
template<bool ComplexPulse>
__global__ void __launch_bounds__(finishThreads, 12) convolveLines(FinishLaunch launch)
{
  extern __shared__ float2 tile[];
  const int taps = paddedTaps(launch.half);
  const int pitch = tilePitch(launch.half);
  float* pulse = reinterpret_cast<float*>(tile + pitch * outputsOfThread);
  const int line = blockIdx.x;
  const int first = blockIdx.y * tileSamples;
  constexpr int wanted = 31; // of a warp's samples
  const int lane = int(threadIdx.x) % 32;
  const int samples = tileSamples + taps;
  for (int from = int(threadIdx.x) / 32 * wanted; from < samples; from += finishThreads / 32 * wanted)
  {
    const int i = from + lane - 1;
    const float2 v = demodulated(launch, line, first + i - launch.half);
    if (lane > 0 && i < samples)
    {
      tile[i % outputsOfThread * pitch + i / outputsOfThread] = v;
    }
  }
  const int given = 2 * launch.half + 1;
  for (int k = threadIdx.x; k < taps * (ComplexPulse ? 2 : 1); k += finishThreads)
  {
    const int part = k / taps;
    pulse[k] = k - part * taps < given ? launch.pulse[k - part * taps + part * given] : 0.0f;
  }
  __syncthreads();

  float sumRe[outputsOfThread] = {};
  float sumIm[outputsOfThread] = {};
  float2 window[2 * outputsOfThread];
#pragma unroll
  for (int j = 0; j < outputsOfThread; ++j)
  {
    window[outputsOfThread + j] = tile[j * pitch + threadIdx.x];
  }
  const int base = threadIdx.x * outputsOfThread;
  for (int group = 0; group * outputsOfThread < taps; ++group)
  {
#pragma unroll
    for (int j = 0; j < outputsOfThread; ++j)
    {
      window[j] = window[outputsOfThread + j];
      window[outputsOfThread + j] = tile[j * pitch + threadIdx.x + group + 1];
    }
#pragma unroll
    for (int k = 0; k < outputsOfThread; ++k)
    {
      const float p = pulse[group * outputsOfThread + k];
      const float q = ComplexPulse ? pulse[taps + group * outputsOfThread + k] : 0.0f;
#pragma unroll
      for (int j = 0; j < outputsOfThread; ++j)
      {
        const float2 v = window[k + j];
        sumRe[j] += p * v.x;
        sumIm[j] += p * v.y;
        if (ComplexPulse)
        {
          sumRe[j] -= q * v.y;
          sumIm[j] += q * v.x;
        }
      }
    }
  }
  for (int j = 0; j < outputsOfThread; ++j)
  {
    const int s = first + base + j;
    if (s < launch.sampleCount)
    {
      const std::size_t at = std::size_t(line) * launch.sampleCount + s;
      float2 iq{ sumRe[j], sumIm[j] };
      if (launch.turns)
      {
        const DownshiftAt turned = downshiftRotation(launch.turns[std::size_t(line) * launch.rangeCount + s]);
        iq = { iq.x * turned.re + iq.y * turned.im, iq.y * turned.re - iq.x * turned.im };
      }
      if (launch.traced.reverberation)
      {
        const float2 speckle = reverberatingAt(launch, line, s);
        iq = { iq.x + speckle.x, iq.y + speckle.y };
      }
      if (launch.iq)
      {
        launch.iq[at] = iq;
      }
      launch.envelope[at] = sqrtf(iq.x * iq.x + iq.y * iq.y);
    }
  }
}

} // namespace sono
