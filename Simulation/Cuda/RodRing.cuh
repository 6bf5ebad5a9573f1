#pragma once

#include "Cuda/DeviceTracer.cuh"
#include "Kernel/ArrayBeam.h"

// What follows the echoes of a rod that rings, as addRung on the CPU.

namespace sono {

constexpr int rungThreads = 256;

struct RungLaunch
{
  const EchoSum* surface; // lines x sumCount x (re, im): the rod's surface
  EchoSum* sums;          // of all surfaces
  const ComplexWeight* taps;
  int tapCount;
  int stride;
  int lead;
  int sumCount;
};

/// A thread a sample, which asks what came before it: sums in one order. Where nothing did, a block has nothing to do.
inline __global__ void __launch_bounds__(rungThreads) addRungOf(RungLaunch launch)
{
  const EchoSum* surface = launch.surface + 2 * std::size_t(blockIdx.x) * launch.sumCount;
  const auto at = [&](int sample, int part) { return float((long long)(surface[2 * sample + part])); };
  const int first = int(blockIdx.y) * rungThreads;
  const int from = max(0, first - (launch.tapCount - 1 - launch.lead) * launch.stride);
  const int to = min(launch.sumCount, first + rungThreads + launch.lead * launch.stride);
  bool any = false;
  for (int s = from + int(threadIdx.x); s < to; s += rungThreads)
  {
    any = any || surface[2 * s] != 0 || surface[2 * s + 1] != 0;
  }
  const int sample = first + int(threadIdx.x);
  if (!__syncthreads_or(any) || sample >= launch.sumCount)
  {
    return;
  }
  float re = 0.0f;
  float im = 0.0f;
  int s = sample + launch.lead * launch.stride;
  for (int j = 0; j < launch.tapCount && s >= 0; ++j, s -= launch.stride)
  {
    if (s < launch.sumCount)
    {
      const ComplexWeight tap = launch.taps[j];
      re += tap.re * at(s, 0) - tap.im * at(s, 1);
      im += tap.re * at(s, 1) + tap.im * at(s, 0);
    }
  }
  EchoSum* out = launch.sums + 2 * (std::size_t(blockIdx.x) * launch.sumCount + sample);
  out[0] += surface[2 * sample] + EchoSum(llrintf(re));
  out[1] += surface[2 * sample + 1] + EchoSum(llrintf(im));
}

} // namespace sono
