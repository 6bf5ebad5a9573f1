#include "Cuda/DeviceTracer.cuh"

#include "Cuda/FinishTrace.cuh"
#include "Cuda/TraceKernels.cuh"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace sono {

namespace {

constexpr int launchWarps = 4096; // few lines of many paths are cut into so many warps, to fill a device
constexpr int fewWarps = 2048;    // of a launch: all at once on a large device, however many registers they take
constexpr int startWarps = 4;     // of a block that starts lines
constexpr int fullWarps = 512;    // of a launch: with fewer, lanes that idle cost less than a device that does
constexpr double bouncesPerLaunch = 1.4e9;     // a second or so, then progress is asked
constexpr double binsPerLaunch = 6.25e7;       // 1 GB of sums
constexpr int fewPaths = 1024;                 // of a line: nothing is lost of their sums, so nothing need be folded
constexpr std::size_t sharedBytes = 96 * 1024; // more would keep other blocks away

/// From blocks to rows, border included; a block takes a row.
__global__ void layOutRows(TissueCells blocks, RowCells rows, std::uint16_t* words)
{
  const int y = int(blockIdx.x % unsigned(rows.size.y + 2)) - 1;
  const int z = int(blockIdx.x / unsigned(rows.size.y + 2)) - 1;
  for (int x = int(threadIdx.x) - 1; x <= rows.size.x; x += blockDim.x)
  {
    words[rows.rowOffset(x, y, z)] = std::uint16_t(blocks.wordAt(x, y, z));
  }
}

/// Adds what rounding left to the sums.
__global__ void carryRests(EchoSum* echo, const EchoSum* rest, std::size_t count)
{
  const std::size_t i = std::size_t(blockIdx.x) * blockDim.x + threadIdx.x;
  if (i < count)
  {
    echo[i] += EchoSum((static_cast<long long>(rest[i]) + (1ll << (restBits - 1))) >> restBits);
  }
}

int ceilDiv(int a, int b)
{
  return (a + b - 1) / b;
}

std::size_t sharedBesideBins(const TraceView& view, int warps, int batches)
{
  return std::size_t(warps * warpLanes) * sizeof(StagedSegment) +
         std::size_t(batches * scrambleCount(view)) * sizeof(BounceScramble);
}

/// How many batches of so many paths at most a warp takes at once; `fits` tells for how many there is room. What they
/// leave does not depend on it.
template<class Fits>
int batchesOfWarp(int lines, int batches, int longest, const Fits& fits)
{
  int together = std::min(batches, std::max(1, warpLanes / longest));
  while (together > 1 && (lines * ceilDiv(batches, together) < fullWarps || !fits(together)))
  {
    --together;
  }
  return together;
}

template<class Targets>
void launchKernels(TraceLaunch<Targets> launch, int lines, bool inShared, bool manyPaths, cudaStream_t stream)
{
  launch.slicesOfLine = ceilDiv(launch.batches, launch.batchesTogether) * launch.slices;
  launch.sliceCount = lines * launch.slicesOfLine;
  const bool few = inShared && !manyPaths && launch.sliceCount * launch.warps <= fewWarps;
  const auto kernel = !inShared   ? tracePaths<false, true, false, Targets>
                      : manyPaths ? tracePaths<true, true, false, Targets>
                      : few       ? tracePaths<true, false, true, Targets>
                                  : tracePaths<true, false, false, Targets>;
  const std::size_t most = std::min(sharedMemoryFor(kernel), sharedBytes);
  const auto bytesOf = [&](int together) {
    const int batches = together * launch.batchesTogether;
    return sharedBesideBins(launch.view, together * launch.warps, batches) +
           (inShared ? batches * launch.warps * launch.binCount * sizeof(BinSums<float>) : 0);
  };
  launch.slicesTogether = (few ? shapeOfFew : shapeOfMany).warps / launch.warps;
  while (launch.slicesTogether > 1 && bytesOf(launch.slicesTogether) > most)
  {
    --launch.slicesTogether;
  }
  if (!launch.view.startsApart)
  {
    startLines<<<ceilDiv(lines, startWarps), startWarps * warpLanes, 0, stream>>>(launch, lines);
  }
  if (launch.depthOffset)
  {
    timeLines<<<lines, flightThreads, 0, stream>>>(launch);
  }
  kernel<<<ceilDiv(launch.sliceCount, launch.slicesTogether), launch.slicesTogether * launch.warps * warpLanes,
           bytesOf(launch.slicesTogether), stream>>>(launch);
  const int parts = manyPaths ? launch.slices * launch.warps : launch.slices;
  finishLines<<<dim3(ceilDiv(launch.binCount, 128), lines), 128, 0, stream>>>(launch, parts);
  check(cudaGetLastError(), "tracing");
}

/// Of all lines of a run, whose launches need not end where an image does.
void launchReverberation(const TraceLaunch<NoTargets>& launch, int lines, cudaStream_t stream)
{
  constexpr int linesPerGrid = 32768;
  const auto forLines = [&](auto kernel) {
    for (int from = 0; from < lines; from += linesPerGrid)
    {
      const dim3 blocks(ceilDiv(TissueBins(launch.binCount, launch.binMm).count, 128),
                        std::min(linesPerGrid, lines - from));
      kernel<<<blocks, 128, 0, stream>>>(launch, from, lines);
    }
  };
  forLines(averageReverberation<NoTargets>);
  forLines(sumReverberationAlong<NoTargets>);
  forLines(sumReverberationAcross<NoTargets>);
  forLines(finishReverberation<NoTargets>);
  check(cudaGetLastError(), "tracing");
}

} // namespace

void DeviceTracer::prepare(const TraceJob& job, int linesPerImage, cudaStream_t stream, Traffic& traffic)
{
  static_cast<TissueCells&>(cells_) = job.region->view();
  cells_.pitch = RowCells::pitchFor(cells_.size);
  if (region_ != job.region)
  {
    region_ = nullptr; // stays so when the upload fails
    DeviceArray<std::uint16_t> blocks;
    blocks.upload(job.region->cell, stream, traffic);
    firstRecord_.upload(job.region->firstRecord, stream, traffic);
    record_.upload(job.region->record, stream, traffic);
    bakedBlocks_ = job.bakedBlocks;
    words_.resize(std::size_t(cells_.pitch.z) * std::size_t(cells_.size.z + 2));
    cells_.cell = blocks.data();
    const std::size_t rows = std::size_t(cells_.size.y + 2) * std::size_t(cells_.size.z + 2);
    layOutRows<<<unsigned(rows), 128, 0, stream>>>(cells_, cells_, words_.data());
    check(cudaGetLastError(), "laying out the tissues");
    check(await(stream), "laying out the tissues");
    region_ = job.region;
  }
  else if (bakedBlocks_ != job.bakedBlocks)
  {
    record_.upload(job.region->record, stream, traffic);
    bakedBlocks_ = job.bakedBlocks;
  }
  cells_.cell = nullptr;
  cells_.words = words_.data();
  cells_.firstRecord = firstRecord_.data();
  cells_.record = record_.data();
  nodes_.upload(job.targets.nodes, stream, traffic);
  triangles_.upload(job.targets.triangles, stream, traffic);
  targets_ = { nodes_.data(), triangles_.data(), std::int32_t(job.targets.nodes.size()) };
  media_.upload(job.media, stream, traffic);
  lines_.upload(job.lines, stream, traffic);
  seeds_.upload(job.seeds, stream, traffic);
  view_ = job.view;
  view_.media = media_.data();
  linesPerImage_ = linesPerImage;
  paths_ = job.paths;
  binCount_ = job.binCount;
  binMm_ = job.binMm;
  frequencyMHz_ = job.frequencyMHz;
  rangeIsTime_ = job.rangeIsTime;
  reverberates_ = job.rangeIsTime && job.view.reverberates;
  echoCount_ = job.echoCount;
  echoSampleMm_ = job.echoSampleMm;
  radPerMm_ = job.radPerMm;
  // A path may leave 2^21 at a sample before a sum of 64 bits overflows.
  const int pathBits = int(std::ceil(std::log2(double(paths_))));
  echoScale_ = std::ldexp(1.0f, 41 - pathBits);
  echoPerUnit_ = float(std::ldexp(1.0, pathBits - 41) / paths_);
}

void DeviceTracer::run(int first, int count, const Progress& progress, cudaStream_t stream)
{
  const std::size_t lineCount = std::size_t(count);
  const std::size_t bins = std::size_t(binCount_);
  const int batches = std::min(batchCount, paths_);
  const int longest = ceilDiv(paths_, batches);
  // The cut depends on the job alone, and so does the result.
  const int warps = std::min(mostSliceWarps, ceilDiv(longest, warpLanes));
  const int wanted = std::max(1, launchWarps / (warps * std::max(1, batches * linesPerImage_)));
  const int slices = std::max(1, std::min(wanted, ceilDiv(longest, warps * warpLanes)));
  const std::size_t binBytes = warps * bins * sizeof(BinSums<float>);
  const std::size_t sharedLimit = std::min(sharedBytes, sharedMemoryFor(tracePaths<true, true, false, BvhTargets>));
  const bool inShared = binBytes + sharedBesideBins(view_, warps, 1) <= sharedLimit;
  const bool manyPaths = !inShared || paths_ > fewPaths;
  const int parts = manyPaths ? slices * warps : slices;

  starts_.resize(lineCount * sizeof(LineStart));
  shared_.resize(view_.startsApart ? 0 : lineCount * bins);
  for (DeviceArray<float>& array : arrays_)
  {
    array.resize(lineCount * bins);
  }
  arrays_[depthOffsetArray].resize(rangeIsTime_ ? lineCount * bins : 0);
  arrays_[reverberationArray].resize(reverberates_ ? lineCount * bins : 0);
  arrays_[reverberationErrorArray].resize(reverberates_ ? lineCount * bins : 0);
  arrays_[reverberationNpArray].resize(reverberates_ ? lineCount * bins : 0);
  const std::size_t flights = bins * std::size_t(flightSteps(binMm_)) + 1;
  axisRange_.resize(rangeIsTime_ ? lineCount * flights : 0);
  axisAmplitude_.resize(axisRange_.size());
  axisAbsorbed_.resize(axisRange_.size());
  const std::size_t reverberant = reverberates_ ? lineCount * bins : 0;
  absorbed_.resize(4 * reverberant);
  absorbed_.clear(stream);
  const std::size_t reverberations =
    reverberates_ ? reverberationSumCount * std::size_t(batches) * std::size_t(TissueBins(binCount_, binMm_).count) : 0;
  reverberation_.resize(lineCount * reverberations);
  reverberation_.clear(stream);
  reverberationAround_.resize(2 * reverberant);
  ownLevel_.resize(reverberant);
  cellMm_.resize(reverberant);
  echo_.resize(lineCount * std::size_t(echoCount_) * 2);
  echoRest_.resize(manyPaths ? echo_.size() : 0);
  segments_.resize(1);
  const double partsOfLine = double(batches) * parts * double(bins);
  const double fitting = std::min(
    { 32768.0, bouncesPerLaunch / (double(paths_) * std::max(1, view_.maxCollisions)), binsPerLaunch / partsOfLine });
  const int perLaunch = std::max(1, std::min(count, int(fitting)));
  const auto fitTogether = [&](int together) {
    return !manyPaths && slices == 1 && warps == 1 &&
           together * binBytes + sharedBesideBins(view_, warps, together) <= sharedLimit;
  };
  const int together = batchesOfWarp(perLaunch, batches, longest, fitTogether);
  sums_.resize(std::size_t(perLaunch) * batches * parts * bins);
  bins_.resize(inShared ? 0 : sums_.size());
  shared_.clear(stream);
  echo_.clear(stream);
  echoRest_.clear(stream);
  segments_.clear(stream);

  const auto launchFrom = [&](int from, const auto& targets) {
    const std::size_t skip = std::size_t(from);
    using Launch = TraceLaunch<std::decay_t<decltype(targets)>>;
    Launch launch{ view_,
                   { cells_, targets },
                   lines_.data() + first + from,
                   reinterpret_cast<LineStart*>(starts_.data()) + from,
                   view_.startsApart ? nullptr : shared_.data() + skip * bins,
                   sums_.data(),
                   bins_.data(),
                   echo_.data() + skip * std::size_t(echoCount_) * 2,
                   manyPaths ? echoRest_.data() + skip * std::size_t(echoCount_) * 2 : nullptr,
                   segments_.data(),
                   seeds_.data(),
                   first + from,
                   linesPerImage_,
                   paths_,
                   batches,
                   slices,
                   warps,
                   together,
                   0,
                   0,
                   1,
                   together > 1 ? longest : warpLanes,
                   binCount_,
                   binMm_,
                   frequencyMHz_,
                   echoCount_,
                   echoSampleMm_,
                   radPerMm_,
                   echoScale_,
                   {},
                   rangeIsTime_ ? arrays_[depthOffsetArray].data() + skip * bins : nullptr,
                   axisRange_.data() + (rangeIsTime_ ? skip * flights : 0),
                   axisAmplitude_.data() + (rangeIsTime_ ? skip * flights : 0),
                   axisAbsorbed_.data() + (rangeIsTime_ ? skip * flights : 0),
                   int(flights) - 1,
                   binMm_ / float(flightSteps(binMm_)),
                   absorbed_.data() + (reverberates_ ? 2 * skip * bins : 0),
                   absorbed_.data() + (reverberates_ ? 2 * (lineCount + skip) * bins : 0),
                   arrays_[reverberationNpArray].data() + (reverberates_ ? skip * bins : 0),
                   reverberates_ ? reverberation_.data() + skip * reverberations : nullptr,
                   cellMm_.data() + (reverberates_ ? skip * bins : 0),
                   ownLevel_.data() + (reverberates_ ? skip * bins : 0),
                   reverberationAround_.data() + (reverberates_ ? skip * bins : 0),
                   reverberationAround_.data() + (reverberates_ ? (lineCount + skip) * bins : 0),
                   reverberates_ ? arrays_[reverberationArray].data() + skip * bins : nullptr,
                   reverberates_ ? arrays_[reverberationErrorArray].data() + skip * bins : nullptr };
    for (std::size_t array = 0; array < pathArrayCount; ++array)
    {
      launch.arrays[array] = arrays_[array].data() + skip * bins;
    }
    return launch;
  };
  for (int from = 0; from < count; from += perLaunch)
  {
    const int lines = std::min(perLaunch, count - from);
    if (targets_.any())
    {
      launchKernels(launchFrom(from, targets_), lines, inShared, manyPaths, stream);
    }
    else
    {
      launchKernels(launchFrom(from, NoTargets()), lines, inShared, manyPaths, stream);
    }
    if (progress && perLaunch < count)
    {
      check(await(stream), "tracing");
      report(progress, double(from + lines) / count);
    }
  }
  if (reverberates_)
  {
    launchReverberation(launchFrom(0, NoTargets()), count, stream);
  }
  if (manyPaths && echo_.size() > 0)
  {
    const std::size_t sums = echo_.size();
    carryRests<<<unsigned((sums + 255) / 256), 256, 0, stream>>>(echo_.data(), echoRest_.data(), sums);
    check(cudaGetLastError(), "tracing");
  }
}

} // namespace sono
