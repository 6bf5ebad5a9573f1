#pragma once

#include "Cuda/DeviceTracer.cuh"
#include "Kernel/HarmonicGrowth.h"

#include <cuda_runtime.h>

namespace sono {

/// The lines of two traces, and what their harmonic takes.
struct HarmonicLaunch
{
  const float* sent;         ///< intensity, lines x bins
  const float* sourcesPerMm; ///< the same
  const double2* gains;      ///< bins
  float* doubled[binArrayCount];
  EchoSum* echo; ///< lines x echoCount x (re, im)
  int binCount;
  int echoCount;
  double binMm;
  double echoSampleMm;
};

__device__ inline EchoSum grownSum(EchoSum sum, float growth)
{
  return EchoSum(__double2ll_rn(double((long long)(sum)) * double(growth)));
}

/// One block a line turns the trace of the doubled tone into that of the harmonic (secondHarmonic, on the CPU). Shared:
/// a double and a float a bin.
__global__ void growHarmonic(HarmonicLaunch launch)
{
  extern __shared__ double amounts[]; // of a bin: first what it adds, then C squared
  auto* growth = reinterpret_cast<float*>(amounts + launch.binCount);
  const std::size_t first = std::size_t(blockIdx.x) * launch.binCount;
  const float* sent = launch.sent + first;
  float* doubled = launch.doubled[intensityArray] + first;
  for (int b = threadIdx.x; b < launch.binCount; b += blockDim.x)
  {
    amounts[b] = harmonicStrength(sent[b], doubled[b], launch.sourcesPerMm[first + b], launch.binMm);
    if (!(doubled[b] > leastDoubledIntensity))
    {
      launch.doubled[attenuationArray][first + b] = 0.0f; // see secondHarmonic
    }
  }
  __syncthreads();
  if (threadIdx.x == 0)
  {
    HarmonicSum sum;
    for (int b = 0; b < launch.binCount; ++b)
    {
      amounts[b] = sum.add(amounts[b], launch.gains[b].x, launch.gains[b].y);
    }
  }
  __syncthreads();
  for (int b = threadIdx.x; b < launch.binCount; b += blockDim.x)
  {
    growth[b] = harmonicGrowth(sent[b], doubled[b], amounts[b]);
    doubled[b] *= growth[b];
    launch.doubled[standardErrorArray][first + b] *= growth[b];
  }
  __syncthreads();
  for (int b = threadIdx.x; b < launch.binCount && launch.doubled[reverberationArray]; b += blockDim.x)
  {
    launch.doubled[reverberationArray][first + b] *= growth[b / 2];
    launch.doubled[reverberationErrorArray][first + b] *= growth[b / 2];
  }
  EchoSum* echo = launch.echo + 2 * std::size_t(blockIdx.x) * launch.echoCount;
  for (int s = threadIdx.x; s < launch.echoCount; s += blockDim.x)
  {
    const float grown = growth[binOfEchoSample(s, launch.echoSampleMm, launch.binMm, launch.binCount)];
    echo[2 * s] = grownSum(echo[2 * s], grown);
    echo[2 * s + 1] = grownSum(echo[2 * s + 1], grown);
  }
}

/// Adds one trace's count of segments to another's.
__global__ void addSegments(const std::uint64_t* from, std::uint64_t* to)
{
  *to += *from;
}

} // namespace sono
