#pragma once

#include "Cuda/TraceKernels.cuh"

// The kernels around the paths: where a line's axis leads by time, before, and the arrays of lines, behind them.

namespace sono {

/// The arrays of each bin.
template<class Targets>
__global__ void finishLines(TraceLaunch<Targets> launch, int parts)
{
  const int b = blockIdx.x * blockDim.x + threadIdx.x;
  const int line = blockIdx.y;
  if (b >= launch.binCount)
  {
    return;
  }
  const std::size_t at = std::size_t(line) * launch.binCount + b;
  BinSums<double> shared{};
  if (launch.shared)
  {
    addBins(launch.shared[at], shared);
  }
  const auto meanOf = [&](int batch) {
    BinSums<double> mean{};
    for (int p = 0; p < parts; ++p)
    {
      addBins(launch.sums[((std::size_t(line) * launch.batches + batch) * parts + p) * launch.binCount + b], mean);
    }
    const PathRange range = batchRange(launch.paths, launch.batches, batch);
    for (double& sum : mean.of)
    {
      sum /= double(range.last - range.first);
    }
    return mean;
  };
  const bool hasPaths = launch.view.startsApart || launch.starts[line].meets;
  const BinArrays bin =
    finishBin(shared, hasPaths ? launch.batches : 0, meanOf, binSumsOf(launch.view.model), launch.frequencyMHz);
#pragma unroll
  for (int array = 0; array < pathArrayCount; ++array)
  {
    launch.arrays[array][at] = bin.of[array];
  }
}

/// What reverberates, of each of the TissueBins: of `lines` lines, those from `from` on.
template<class Targets>
__global__ void averageReverberation(TraceLaunch<Targets> launch, int from, int)
{
  const TissueBins tissueBins = launch.tissueBins();
  const int t = blockIdx.x * blockDim.x + threadIdx.x;
  const int line = from + int(blockIdx.y);
  if (t >= tissueBins.count)
  {
    return;
  }
  const auto meanOf = [&](int batch) {
    const EchoSum* sums = launch.batchReverberation(line, batch) + reverberationSumCount * t;
    const PathRange range = batchRange(launch.paths, launch.batches, batch);
    const double perUnit = 1.0 / (double(launch.echoScale) * double(range.last - range.first));
    ReverberationSums means;
    for (int sum = 0; sum < reverberationSumCount; ++sum)
    {
      means.of[sum] = double((long long)(sums[sum])) * perUnit;
    }
    return means;
  };
  const bool hasPaths = launch.view.startsApart || launch.starts[line].meets;
  const ReverberationMeans means = reverberationMeans(hasPaths ? launch.batches : 0, meanOf);
  const std::size_t first = std::size_t(line) * launch.binCount;
  launch.ownLevel[first + t] = means.ownLevel;
  launch.inBin[first + t] = aroundOf(means);
  const auto absorbed = [&](const EchoSum* sums, int bin) {
    const EchoSum* of = sums + 2 * (first + bin);
    return AbsorbedSums{ double((long long)(of[0])), double((long long)(of[1])) };
  };
  const AbsorbedSums tissue = absorbed(launch.absorbedByTissue, tissueBins.absorptionBin(t));
  for (int b = t * tissueBins.each; b < min(launch.binCount, (t + 1) * tissueBins.each); ++b)
  {
    launch.reverberationError[first + b] = means.error;
    const float takenNp = absorbedNp(tissue, absorbed(launch.absorbedToBoundaries, b));
    launch.reverberationNp[first + b] = float(double(takenNp) / launch.frequencyMHz);
  }
}

/// Of the line's bins around each.
template<class Targets>
__global__ void sumReverberationAlong(TraceLaunch<Targets> launch, int from, int)
{
  const TissueBins tissueBins = launch.tissueBins();
  const int t = blockIdx.x * blockDim.x + threadIdx.x;
  if (t >= tissueBins.count)
  {
    return;
  }
  const std::size_t first = std::size_t(from + int(blockIdx.y)) * launch.binCount;
  launch.alongLine[first + t] =
    sumAlongLine(t, tissueBins.count, tissueBins.mm, [&](int near) { return launch.inBin[first + near]; });
}

/// The lines of a line's image.
struct LinesOfImage
{
  int first;
  int end;
};

template<class Targets>
__device__ LinesOfImage linesOfImage(const TraceLaunch<Targets>& launch, int line, int lines)
{
  const int inImage = (launch.first + line) % launch.linesPerImage;
  return { max(0, line - inImage), min(lines, line - inImage + launch.linesPerImage) };
}

/// And of the lines around each.
template<class Targets>
__global__ void sumReverberationAcross(TraceLaunch<Targets> launch, int from, int lines)
{
  const int t = blockIdx.x * blockDim.x + threadIdx.x;
  const int line = from + int(blockIdx.y);
  if (t >= launch.tissueBins().count)
  {
    return;
  }
  const LinesOfImage image = linesOfImage(launch, line, lines);
  launch.inBin[std::size_t(line) * launch.binCount + t] = sumOverLines(
    line, image.first, image.end, [&](int near) { return launch.alongLine[std::size_t(near) * launch.binCount + t]; });
}

/// The levels of what reverberates.
template<class Targets>
__global__ void finishReverberation(TraceLaunch<Targets> launch, int from, int lines)
{
  const TissueBins tissueBins = launch.tissueBins();
  const int t = blockIdx.x * blockDim.x + threadIdx.x;
  const int line = from + int(blockIdx.y);
  if (t >= tissueBins.count)
  {
    return;
  }
  const auto aroundOf = [&](int l, int b) { return launch.inBin[std::size_t(l) * launch.binCount + b]; };
  const LinesOfImage image = linesOfImage(launch, line, lines);
  const ReverberationAround further =
    sumFurther(line, image.first, image.end, t, tissueBins.count, tissueBins.mm, aroundOf);
  const std::size_t first = std::size_t(line) * launch.binCount;
  const float unspread = resolutionCell(launch.view, launch.lines[line], (float(t) + 0.5f) * tissueBins.mm).unspread;
  const float level = reverberationLevel(aroundOf(line, t), further, unspread, launch.ownLevel[first + t]);
  for (int b = t * tissueBins.each; b < min(launch.binCount, (t + 1) * tissueBins.each); ++b)
  {
    launch.reverberationMean[first + b] = level;
  }
}

constexpr int flightThreads = 1024; // few steps each: a single image's trace waits for them

/// A block finds where a line's axis leads by time (Trace/Trace.cpp does the same): each thread adds up the bins next
/// to each other, then where each range lies is looked up among the sums.
template<class Targets>
__global__ void __launch_bounds__(flightThreads) timeLines(TraceLaunch<Targets> launch)
{
  __shared__ double sums[3][flightThreads];
  __shared__ TargetSpans spans;
  const std::size_t row = std::size_t(blockIdx.x) * (launch.flightCount + 1);
  float* values[3] = { launch.axisRange + row, launch.axisAmplitude + row, launch.axisAbsorbed + row };
  const TraceLine& line = launch.lines[blockIdx.x];
  if (threadIdx.x == 0)
  {
    spans = targetSpans(launch.view, launch.space, line);
    for (float* value : values)
    {
      value[0] = 0.0f;
    }
  }
  __syncthreads();
  const int each = (launch.flightCount + flightThreads - 1) / flightThreads;
  const int first = min(int(threadIdx.x) * each, launch.flightCount);
  const int last = min(first + each, launch.flightCount);
  double own[3] = {};
  int medium = mediumOnAxis(launch.view, launch.space, line, spans, float(first) * launch.flightMm);
  for (int s = first; s < last; ++s)
  {
    const FlightStep step = flightStepOn(launch.view, launch.space, line, spans, launch.flightMm, s, medium);
    own[0] += double(step.rangeMm);
    own[1] += double(step.lostNp);
    own[2] += double(step.absorbedNp);
    for (int v = 0; v < 3; ++v)
    {
      values[v][s + 1] = float(own[v]);
    }
  }
  for (int v = 0; v < 3; ++v)
  {
    sums[v][threadIdx.x] = own[v];
  }
  __syncthreads();
  for (int step = 1; step < flightThreads; step *= 2)
  {
    double before[3];
    for (int v = 0; v < 3; ++v)
    {
      before[v] = int(threadIdx.x) >= step ? sums[v][threadIdx.x - step] : 0.0;
    }
    __syncthreads();
    for (int v = 0; v < 3; ++v)
    {
      sums[v][threadIdx.x] += before[v];
    }
    __syncthreads();
  }
  for (int v = 0; v < 3; ++v)
  {
    const double before = sums[v][threadIdx.x] - own[v];
    for (int s = first; s < last; ++s)
    {
      values[v][s + 1] = float(before + double(values[v][s + 1]));
    }
  }
  __syncthreads();
  for (int s = threadIdx.x; s <= launch.flightCount; s += flightThreads)
  {
    values[1][s] = expf(-0.5f * values[1][s]);
  }
  const TissueBins tissueBins = launch.tissueBins();
  for (int b = threadIdx.x; launch.reverberation && b < tissueBins.count; b += flightThreads)
  {
    launch.cellMm[std::size_t(blockIdx.x) * launch.binCount + b] =
      resolutionCell(launch.view, line, (float(b) + 0.5f) * tissueBins.mm).sideMm;
  }
  for (int b = threadIdx.x; b < launch.binCount; b += flightThreads)
  {
    const float wanted = float(b) * launch.binMm;
    launch.depthOffset[std::size_t(blockIdx.x) * launch.binCount + b] =
      depthOfRange(values[0], launch.flightCount, launch.flightMm, wanted) - wanted;
  }
}

} // namespace sono
