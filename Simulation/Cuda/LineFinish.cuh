#pragma once

#include "Cuda/DeviceEcho.cuh"

// From a line's scatterer sum to its IQ and envelope, as LineFinisher on the CPU.

namespace sono {

struct FinishLaunch
{
  const float2* sum; // or null: no scatterers
  TracedOnDevice traced;
  const float* level; // of boundaries at each sample, or null
  const float2* carrier;
  const float* pulse; // re, then im where it is complex
  int half;
  int sumCount;
  int sampleCount;
  float sampleMm;
  float2* iq; // null: not wanted
  float* envelope;
};

constexpr int outputsOfThread = 4;
constexpr int finishThreads = 128;
constexpr int tileSamples = outputsOfThread * finishThreads;

/// Shifts rows of 32 apart, so that threads that are some samples apart use different banks.
__device__ inline int padded(int i)
{
  return i + (i >> 5);
}

/// The sum at a sample: times the intensity, plus the boundary echoes, demodulated.
__device__ inline float2 demodulated(const FinishLaunch& launch, int line, int s)
{
  if (s < 0 || s >= launch.sumCount)
  {
    return { 0.0f, 0.0f };
  }
  float2 v{ 0.0f, 0.0f };
  const std::size_t at = std::size_t(line) * launch.sumCount + s;
  if (launch.sum)
  {
    v = launch.sum[at];
  }
  const TracedOnDevice& traced = launch.traced;
  if (traced.intensity)
  {
    // Linear between the centres of the tracer's bins.
    const float* bins = traced.intensity + std::size_t(line) * traced.binCount;
    const double wanted = s * double(launch.sampleMm) / double(traced.binMm) - 0.5;
    const float position = float(fmin(fmax(wanted, 0.0), double(traced.binCount - 1)));
    const int bin = min(int(position), max(0, traced.binCount - 2));
    const int next = min(bin + 1, traced.binCount - 1);
    const float intensity = bins[bin] + (bins[next] - bins[bin]) * (position - float(bin));
    v.x *= intensity;
    v.y *= intensity;
  }
  const float level = launch.level ? launch.level[s] : 1.0f;
  if (traced.echoSums && s < traced.echoCount)
  {
    const EchoSum* echo = traced.echoSums + 2 * (std::size_t(line) * traced.echoCount + s);
    v.x += float((long long)(echo[0])) * traced.echoPerUnit * level;
    v.y += float((long long)(echo[1])) * traced.echoPerUnit * level;
  }
  if (traced.echo)
  {
    v.x += traced.echo[at].x;
    v.y += traced.echo[at].y;
  }
  const float2 c = launch.carrier[s];
  return { v.x * c.x - v.y * c.y, v.x * c.y + v.y * c.x };
}

/// Convolves a tile of a line with the pulse; each thread keeps the sums of neighbouring samples in registers.
template<bool ComplexPulse>
__global__ void __launch_bounds__(finishThreads) convolveLines(FinishLaunch launch)
{
  extern __shared__ float memory[];
  const int taps = 2 * launch.half + 1;
  const int width = tileSamples + 2 * launch.half;
  float* re = memory;
  float* im = re + padded(width) + 1;
  float* pulse = im + padded(width) + 1;
  const int line = blockIdx.x;
  const int first = blockIdx.y * tileSamples;
  for (int i = threadIdx.x; i < width; i += finishThreads)
  {
    const float2 v = demodulated(launch, line, first + i - launch.half);
    re[padded(i)] = v.x;
    im[padded(i)] = v.y;
  }
  for (int k = threadIdx.x; k < taps * (ComplexPulse ? 2 : 1); k += finishThreads)
  {
    pulse[k] = launch.pulse[k];
  }
  __syncthreads();

  float sumRe[outputsOfThread] = {};
  float sumIm[outputsOfThread] = {};
  float windowRe[outputsOfThread];
  float windowIm[outputsOfThread];
  const int base = threadIdx.x * outputsOfThread;
  for (int j = 0; j + 1 < outputsOfThread; ++j)
  {
    windowRe[j + 1] = re[padded(base + j)];
    windowIm[j + 1] = im[padded(base + j)];
  }
  for (int k = 0; k < taps; ++k)
  {
#pragma unroll
    for (int j = 0; j + 1 < outputsOfThread; ++j)
    {
      windowRe[j] = windowRe[j + 1];
      windowIm[j] = windowIm[j + 1];
    }
    windowRe[outputsOfThread - 1] = re[padded(base + k + outputsOfThread - 1)];
    windowIm[outputsOfThread - 1] = im[padded(base + k + outputsOfThread - 1)];
    const float p = pulse[k];
    const float q = ComplexPulse ? pulse[taps + k] : 0.0f;
#pragma unroll
    for (int j = 0; j < outputsOfThread; ++j)
    {
      sumRe[j] += p * windowRe[j];
      sumIm[j] += p * windowIm[j];
      if (ComplexPulse)
      {
        sumRe[j] -= q * windowIm[j];
        sumIm[j] += q * windowRe[j];
      }
    }
  }
  for (int j = 0; j < outputsOfThread; ++j)
  {
    const int s = first + base + j;
    if (s < launch.sampleCount)
    {
      const std::size_t at = std::size_t(line) * launch.sampleCount + s;
      if (launch.iq)
      {
        launch.iq[at] = { sumRe[j], sumIm[j] };
      }
      launch.envelope[at] = sqrtf(sumRe[j] * sumRe[j] + sumIm[j] * sumIm[j]);
    }
  }
}

} // namespace sono
