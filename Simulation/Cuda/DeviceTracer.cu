#include "Cuda/DeviceTracer.cuh"

#include "Cuda/WarpDeposit.cuh"
#include "Trace/PathBatches.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace sono {

namespace {

constexpr int blockWarps = 4;
constexpr int blocksAtOnce =
  9; // on a multiprocessor: more warps, that hide their waits, are worth some spilled registers
constexpr int launchWarps = 4096; // few lines of many paths are cut into so many warps, to fill a device
constexpr int blockPaths = blockWarps * warpLanes;
constexpr unsigned allLanes = 0xffffffffu;
constexpr double bouncesPerLaunch = 1.4e9;     // a second or so, then progress is asked
constexpr double binsPerLaunch = 2.5e8;        // 1 GB of partial sums
constexpr std::size_t sharedBytes = 96 * 1024; // more would keep other blocks away

/// What the kernels of one launch share.
template<class Targets>
struct TraceLaunch
{
  TraceView view;
  CellSpace<Targets, RowCells> space;
  const TraceLine* lines; // of the launch
  LineStart* starts;
  float* shared;  // what all paths of a line leave: lines x bins
  float* partial; // sums of parts of batches: lines x batches x slices x bins
  float* intensity;
  float* error;
  EchoSum* echo;
  std::uint64_t* segments;
  int firstInImage; // number of the launch's first line, to be taken modulo linesPerImage
  int linesPerImage;
  int paths;
  int batches;
  int slices; // parts of a batch, each summed by one block
  int binCount;
  float binMm;
  int echoCount;
  float echoSampleMm;
  float radPerMm;
  float echoScale;

  __device__ std::uint32_t keyOf(int line) const { return std::uint32_t((firstInImage + line) % linesPerImage); }
};

template<class Launch>
__device__ void addEcho(const Launch& launch, int line, const Vec3f& point, float amplitude)
{
  const EchoSplit split = splitEcho(launch.lines[line], point, amplitude, launch.view.coherenceMm, launch.echoSampleMm,
                                    launch.echoCount, launch.radPerMm);
  if (split.sample < 0)
  {
    return;
  }
  EchoSum* to = launch.echo + 2 * (std::size_t(line) * launch.echoCount + split.sample);
  for (int c = 0; c < 4; ++c)
  {
    atomicAdd(to + c, EchoSum(__float2ll_rn(split.amplitude[c] * launch.echoScale)));
  }
}

/// All lanes follow the same path.
template<class Launch>
struct CommonSink
{
  const Launch& launch;
  int line;
  int lane;
  unsigned segments = 0;

  __device__ void segment(const PathSegment& piece)
  {
    ++segments;
    depositByWarp(stage(launch.lines[line], piece, launch.view.coherenceMm, launch.binMm, launch.binCount),
                  launch.binMm, lane, launch.shared + std::size_t(line) * launch.binCount);
  }
  __device__ void echo(const Vec3f& point, float amplitude)
  {
    if (lane == 0)
    {
      addEcho(launch, line, point, amplitude * float(launch.paths)); // sums are divided by the paths
    }
  }
};

/// One warp a line: what all its paths share.
template<class Targets>
__global__ void startLines(TraceLaunch<Targets> launch, int count)
{
  const int line = blockIdx.x * blockWarps + threadIdx.x / warpLanes;
  if (line >= count)
  {
    return;
  }
  CommonSink<TraceLaunch<Targets>> sink{ launch, line, int(threadIdx.x % warpLanes) };
  const LineStart start = startLine(launch.view, launch.space, launch.lines[line], sink);
  if (sink.lane == 0)
  {
    atomicAdd(reinterpret_cast<unsigned long long*>(launch.segments), static_cast<unsigned long long>(sink.segments));
    launch.starts[line] = start;
  }
}

/// What a path is doing, kept while the other paths of its warp march.
struct Walker
{
  PathState path;
  PieceLimit limit;
  int index;  // of the path within the batch
  int pieces; // since the last boundary
  bool walking;
};

/// Starts the next piece of a path.
template<class Launch>
__device__ void startPiece(const Launch& launch, const TraceLine& line, Walker& walker)
{
  walker.limit = limitPiece(launch.view, launch.space, line, walker.path);
}

/// Leaves a boundary. Returns false when the path ends there.
template<class Launch>
__device__ bool passBoundary(const Launch& launch, const PathKey& key, const PathBoundary& boundary, Walker& walker)
{
  leaveBoundary(launch.view, launch.space, boundary,
                drawBounce(launch.view, key, std::uint32_t(walker.path.collisions)), walker.path);
  walker.pieces = 0;
  return walker.path.intensity > 0.0f && survivesRoulette(launch.view, key, walker.path);
}

/// Takes up the lane's next path that gets away from the first boundary.
template<class Launch>
__device__ void nextPath(const Launch& launch, const TraceLine& line, const LineStart& start, PathKey& key, int end,
                         int step, Walker& walker)
{
  walker.walking = false;
  while (!walker.walking && walker.index + step < end)
  {
    walker.index += step;
    key.path = std::uint32_t(walker.index);
    walker.path = start.path;
    walker.walking = passBoundary(launch, key, start.boundary, walker);
  }
  if (walker.walking)
  {
    startPiece(launch, line, walker);
  }
}

/// Ends a piece: its echo, and the path's next piece or the lane's next path.
template<class Launch>
__device__ StagedSegment finishPiece(const Launch& launch, int lineIndex, const TraceLine& line, const LineStart& start,
                                     const CellHit& hit, PathKey& key, int end, int step, Walker& walker)
{
  PathSegment piece;
  PathBoundary boundary;
  const PieceEnd pieceEnd = endPiece(launch.view, launch.space, walker.limit, hit, walker.path, boundary, piece);
  bool goesOn = pieceEnd == PieceEnd::Medium && ++walker.pieces < mostPieces(launch.space);
  if (pieceEnd == PieceEnd::Boundary && walker.path.collisions < launch.view.maxCollisions)
  {
    const TraceMedium& from = launch.view.media[boundary.before.medium];
    const TraceMedium& to = launch.view.media[boundary.after.medium];
    const float amplitude = boundaryEcho(launch.view.model, from.impedance, to.impedance, walker.path.intensity,
                                         boundary.cosine, to.tau, to.gamma);
    addEcho(launch, lineIndex, walker.path.ray.position + walker.path.ray.direction * boundary.surface.t, amplitude);
    goesOn = passBoundary(launch, key, boundary, walker);
  }
  if (goesOn)
  {
    startPiece(launch, line, walker);
  }
  else
  {
    nextPath(launch, line, start, key, end, step, walker);
  }
  return stage(line, piece, launch.view.coherenceMm, launch.binMm, launch.binCount);
}

/// One block traces one slice of a batch of a line, each lane one path after the other. The paths of a warp go on
/// together, from boundary to boundary; what they leave is added to the warp's bins by all its lanes, one segment
/// after the other.
template<bool BinsInShared, class Targets>
__global__ void __launch_bounds__(blockPaths, blocksAtOnce) tracePaths(TraceLaunch<Targets> launch)
{
  extern __shared__ float dynamic[];
  __shared__ StagedSegment staged[blockWarps][warpLanes];
  const int slice = blockIdx.x % launch.slices;
  const int batch = blockIdx.x / launch.slices;
  const int line = blockIdx.y;
  const int lane = threadIdx.x % warpLanes;
  const int warp = threadIdx.x / warpLanes;

  // Bins of the block's warps, then the batch's scrambles.
  const int slots = BinsInShared ? blockWarps : 0;
  auto* scrambles = reinterpret_cast<BounceScramble*>(dynamic + std::size_t(slots) * launch.binCount);
  const std::size_t row = (std::size_t(line) * launch.batches + batch) * launch.slices + slice;
  float* bins = BinsInShared ? dynamic + std::size_t(warp) * launch.binCount
                             : launch.partial + (row * blockWarps + warp) * launch.binCount;
  for (int b = lane; b < launch.binCount; b += warpLanes)
  {
    bins[b] = 0.0f;
  }
  const std::uint32_t lineKey = launch.keyOf(line);
  for (int b = threadIdx.x; b < launch.view.maxCollisions; b += blockPaths)
  {
    scrambles[b] = makeBounceScramble(launch.view.seed, lineKey, std::uint32_t(batch), std::uint32_t(b));
  }
  __syncthreads();

  const PathRange range = batchRange(launch.paths, launch.batches, batch);
  const int end = range.last - range.first;
  const int step = launch.slices * blockPaths;
  const TraceLine axis = launch.lines[line];
  const LineStart& start = launch.starts[line];
  PathKey key{ lineKey, std::uint32_t(batch), 0u, scrambles };
  Walker walker;
  walker.index = slice * blockPaths + int(threadIdx.x) - step;
  walker.walking = false;
  if (start.meets)
  {
    nextPath(launch, axis, start, key, end, step, walker);
  }
  unsigned segments = 0;
  while (__any_sync(allLanes, walker.walking))
  {
    const bool walks = walker.walking;
    if (walks)
    {
      const PathState& path = walker.path;
      CellHit hit{};
      if (path.target < 0)
      {
        hit = launch.space.toBoundary(path.ray, path.tissue, path.ignored, path.ignoreUntil, walker.limit.t);
      }
      staged[warp][lane] = finishPiece(launch, line, axis, start, hit, key, end, step, walker);
      ++segments;
    }
    __syncwarp();
    unsigned waiting = __ballot_sync(allLanes, walks && staged[warp][lane].binHigh >= 0);
    for (; waiting; waiting &= waiting - 1)
    {
      depositByWarp(staged[warp][__ffs(int(waiting)) - 1], launch.binMm, lane, bins);
    }
    __syncwarp();
  }
  for (int s = warpLanes / 2; s > 0; s /= 2)
  {
    segments += __shfl_down_sync(allLanes, segments, unsigned(s));
  }
  if (lane == 0)
  {
    atomicAdd(reinterpret_cast<unsigned long long*>(launch.segments), static_cast<unsigned long long>(segments));
  }
  if (BinsInShared)
  {
    __syncthreads();
    for (int b = threadIdx.x; b < launch.binCount; b += blockPaths)
    {
      float sum = 0.0f;
      for (int g = 0; g < blockWarps; ++g)
      {
        sum += dynamic[std::size_t(g) * launch.binCount + b];
      }
      launch.partial[row * launch.binCount + b] = sum;
    }
  }
}

/// Mean over the batches and its standard error, for each bin.
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
  launch.error[at] = 0.0f;
  launch.intensity[at] = launch.shared[at];
  if (!launch.starts[line].meets)
  {
    return;
  }
  float means[batchCount];
  double mean = 0.0;
  for (int batch = 0; batch < launch.batches; ++batch)
  {
    const PathRange range = batchRange(launch.paths, launch.batches, batch);
    float sum = 0.0f;
    for (int p = 0; p < parts; ++p)
    {
      sum += launch.partial[((std::size_t(line) * launch.batches + batch) * parts + p) * launch.binCount + b];
    }
    means[batch] = sum / float(range.last - range.first);
    mean += means[batch];
  }
  mean /= launch.batches;
  double spread = 0.0;
  for (int batch = 0; batch < launch.batches; ++batch)
  {
    spread += (means[batch] - mean) * (means[batch] - mean);
  }
  launch.intensity[at] += float(mean);
  launch.error[at] = launch.batches > 1 ? float(sqrt(spread / (double(launch.batches) * (launch.batches - 1)))) : 0.0f;
}

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

int ceilDiv(int a, int b)
{
  return (a + b - 1) / b;
}

template<class Targets>
void launchKernels(const TraceLaunch<Targets>& launch, int lines, bool inShared, cudaStream_t stream)
{
  const std::size_t scrambleBytes = std::size_t(launch.view.maxCollisions) * sizeof(BounceScramble);
  const std::size_t bytes = scrambleBytes + (inShared ? blockWarps * launch.binCount * sizeof(float) : 0);
  const auto kernel = inShared ? tracePaths<true, Targets> : tracePaths<false, Targets>;
  check(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, int(bytes)), "preparing to trace");
  startLines<<<ceilDiv(lines, blockWarps), blockPaths, 0, stream>>>(launch, lines);
  kernel<<<dim3(launch.batches * launch.slices, lines), blockPaths, bytes, stream>>>(launch);
  const int parts = inShared ? launch.slices : launch.slices * blockWarps;
  finishLines<<<dim3(ceilDiv(launch.binCount, 128), lines), 128, 0, stream>>>(launch, parts);
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
    words_.resize(std::size_t(cells_.pitch.z) * std::size_t(cells_.size.z + 2));
    cells_.cell = blocks.data();
    const std::size_t rows = std::size_t(cells_.size.y + 2) * std::size_t(cells_.size.z + 2);
    layOutRows<<<unsigned(rows), 128, 0, stream>>>(cells_, cells_, words_.data());
    check(cudaGetLastError(), "laying out the tissues");
    check(cudaStreamSynchronize(stream), "laying out the tissues");
    region_ = job.region;
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
  view_ = job.view;
  view_.media = media_.data();
  linesPerImage_ = linesPerImage;
  paths_ = job.paths;
  binCount_ = job.binCount;
  binMm_ = job.binMm;
  echoCount_ = job.echoCount;
  echoSampleMm_ = job.echoSampleMm;
  radPerMm_ = job.radPerMm;
  // A path may leave 2^21 at a sample before a sum of 64 bits overflows.
  const int pathBits = int(std::ceil(std::log2(double(paths_))));
  echoScale_ = std::ldexp(1.0f, 41 - pathBits);
  echoPerUnit_ = float(std::ldexp(1.0, pathBits - 41) / paths_);
  segments_.resize(1);
  segments_.clear(stream);
}

void DeviceTracer::run(int first, int count, const Progress& progress, cudaStream_t stream)
{
  const std::size_t lineCount = std::size_t(count);
  const std::size_t bins = std::size_t(binCount_);
  const int batches = std::min(batchCount, paths_);
  const int longest = ceilDiv(paths_, batches);
  // The cut depends on the job alone, and so does the result.
  const int wanted = std::max(1, launchWarps / (blockWarps * std::max(1, batches * linesPerImage_)));
  const int slices = std::max(1, std::min(wanted, ceilDiv(longest, blockPaths)));
  const std::size_t scrambleBytes = std::size_t(view_.maxCollisions) * sizeof(BounceScramble);
  const std::size_t binBytes = blockWarps * bins * sizeof(float);
  const std::size_t sharedLimit = std::min(sharedBytes, sharedMemoryFor(tracePaths<true, BvhTargets>));
  const bool inShared = binBytes + scrambleBytes <= sharedLimit;
  const int parts = inShared ? slices : slices * blockWarps;

  starts_.resize(lineCount * sizeof(LineStart));
  shared_.resize(lineCount * bins);
  shared_.clear(stream);
  intensity_.resize(lineCount * bins);
  error_.resize(lineCount * bins);
  echo_.resize(lineCount * std::size_t(echoCount_) * 2);
  echo_.clear(stream);

  const double partsOfLine = double(batches) * parts * double(bins);
  const double fitting = std::min(
    { 32768.0, bouncesPerLaunch / (double(paths_) * std::max(1, view_.maxCollisions)), binsPerLaunch / partsOfLine });
  const int perLaunch = std::max(1, std::min(count, int(fitting)));
  partial_.resize(std::size_t(perLaunch) * batches * parts * bins);
  for (int from = 0; from < count; from += perLaunch)
  {
    const int lines = std::min(perLaunch, count - from);
    const std::size_t skip = std::size_t(from);
    const auto launchOf = [&](const auto& targets) {
      using Launch = TraceLaunch<std::decay_t<decltype(targets)>>;
      return Launch{ view_,
                     { cells_, targets },
                     lines_.data() + first + from,
                     reinterpret_cast<LineStart*>(starts_.data()) + from,
                     shared_.data() + skip * bins,
                     partial_.data(),
                     intensity_.data() + skip * bins,
                     error_.data() + skip * bins,
                     echo_.data() + skip * std::size_t(echoCount_) * 2,
                     segments_.data(),
                     first + from,
                     linesPerImage_,
                     paths_,
                     batches,
                     slices,
                     binCount_,
                     binMm_,
                     echoCount_,
                     echoSampleMm_,
                     radPerMm_,
                     echoScale_ };
    };
    if (targets_.any())
    {
      launchKernels(launchOf(targets_), lines, inShared, stream);
    }
    else
    {
      launchKernels(launchOf(NoTargets()), lines, inShared, stream);
    }
    if (progress && perLaunch < count)
    {
      check(cudaStreamSynchronize(stream), "tracing");
      report(progress, double(from + lines) / count);
    }
  }
}

} // namespace sono
