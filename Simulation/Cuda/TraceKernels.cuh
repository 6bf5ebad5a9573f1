#pragma once

#include "Cuda/DeviceTracer.cuh"
#include "Cuda/WarpDeposit.cuh"
#include "Kernel/TimeOfFlight.h"
#include "Trace/PathBatches.h"
#include "Trace/TracedReverberation.h"

#include <cuda_runtime.h>

#include <cstdint>

// The kernels that trace lines: what all paths of a line share, if anything, and the paths.

namespace sono {

/// Warps of a block, which step together, and such blocks on a multiprocessor, for which registers are shared out.
struct BlockShape
{
  int warps;
  int together;
};
constexpr BlockShape shapeOfMany{ 8, 2 };
constexpr BlockShape shapeOfFew{ 4, 3 }; // few warps are faster with all the registers that they can use
constexpr int mostSliceWarps = 4;
constexpr unsigned allLanes = 0xffffffffu;
constexpr int restBits = 28; // of what rounding leaves of an echo

/// What the kernels of one launch share.
template<class Targets>
struct TraceLaunch
{
  TraceView view;
  CellSpace<Targets, RowCells> space;
  const TraceLine* lines; // of the launch
  LineStart* starts;      // where paths do not start apart
  BinSums<float>* shared; // what all paths of a line leave: lines x bins; null: nothing
  BinSums<double>* sums;  // of parts of batches: lines x batches x parts x bins
  BinSums<float>* bins;   // of the warps, where they do not lie in shared memory
  EchoSum* echo;
  EchoSum* echoRest; // what rounding left of each echo, 2^restBits a unit of `echo`; null: not kept
  std::uint64_t* segments;
  const std::uint64_t* seeds; // of the images' paths
  int first;                  // of all images' lines, the launch's first
  int linesPerImage;
  int paths;
  int batches;
  int slices;          // of a batch, each traced by warps of one block
  int warps;           // of a slice: no more than have paths
  int batchesTogether; // in a warp, where they are small; 1: a batch has warps of its own
  int slicesOfLine;    // of all its batches
  int sliceCount;      // of all lines
  int slicesTogether;  // in a block
  int batchLanes;      // of a warp, that each of those has
  int binCount;
  float binMm;
  double frequencyMHz;
  int echoCount; // 0: boundaries do not echo
  float echoSampleMm;
  float radPerMm;
  float echoScale;
  float* arrays[pathArrayCount];
  float* depthOffset;   // lines x bins; null: range is depth
  float* axisRange;     // lines x (bins + 1), see StraightWay
  float* axisAmplitude; // the same
  float* axisAbsorbed;
  int flightCount; // steps of the axis, and their length
  float flightMm;
  EchoSum* absorbedByTissue;     // lines x bins x (weight, weight times Np), of TissueBins
  EchoSum* absorbedToBoundaries; // the same
  float* reverberationNp;        // lines x bins
  EchoSum*
    reverberation; // lines x batches x TissueBins x ReverberationSum, times echoScale; null: nothing reverberates
  float* cellMm;   // lines x bins: of TissueBins, see resolutionCell
  float* ownLevel; // the same, as the next two
  ReverberationAround* inBin;     // later of the bins and lines around each
  ReverberationAround* alongLine; // of the bins around each
  float* reverberationMean;       // lines x bins
  float* reverberationError;

  __device__ StraightWay wayOf(int line) const
  {
    const std::size_t first = std::size_t(line) * (flightCount + 1);
    return { axisRange + first, axisAmplitude + first, axisAbsorbed + first, flightCount, flightMm };
  }
  __device__ TissueBins tissueBins() const { return TissueBins(binCount, binMm); }
  __device__ EchoSum* batchReverberation(int line, int batch) const
  {
    return reverberation +
           (std::size_t(line) * batches + std::size_t(batch)) * reverberationSumCount * tissueBins().count;
  }
  __device__ std::uint32_t keyOf(int line) const { return std::uint32_t((first + line) % linesPerImage); }
  __device__ std::uint64_t seedOf(int line) const { return seeds[(first + line) / linesPerImage]; }
};

template<bool KeepsRest, class Launch>
__device__ void addEcho(const Launch& launch, int line, float rangeMm, float amplitude)
{
  const EchoSplit split = splitEcho(rangeMm, amplitude, launch.echoSampleMm, launch.echoCount, launch.radPerMm);
  if (split.sample < 0 || amplitude == 0.0f)
  {
    return;
  }
  const std::size_t at = 2 * (std::size_t(line) * launch.echoCount + split.sample);
  for (int c = 0; c < 4; ++c)
  {
    const float units = split.amplitude[c] * launch.echoScale;
    const float whole = rintf(units);
    atomicAdd(launch.echo + at + c, EchoSum(__float2ll_rn(whole)));
    if (KeepsRest)
    {
      atomicAdd(launch.echoRest + at + c, EchoSum(__float2ll_rn((units - whole) * float(1 << restBits))));
    }
  }
}

/// The echo of a boundary that a path meets: in Acoustic surfaces echo by themselves.
template<bool KeepsRest, class Launch>
__device__ void addPathEcho(const Launch& launch, int line, const TraceLine& beam, const Vec3f& point, float amplitude)
{
  if (launch.echoCount > 0 && launch.view.model != InterfaceModel::Acoustic)
  {
    const EchoPlace place = echoPlace(beam, point, launch.view.coherenceMm);
    addEcho<KeepsRest>(launch, line, place.depthMm, amplitude * place.weight);
  }
}

/// All lanes follow the same path.
template<class Launch>
struct CommonSink : PathSink
{
  __device__ CommonSink(const Launch& theLaunch, int theLine, int theLane)
    : launch(theLaunch)
    , line(theLine)
    , lane(theLane)
  {
  }

  const Launch& launch;
  int line;
  int lane;
  unsigned segments = 0;

  __device__ void segment(const PathSegment& piece)
  {
    ++segments;
    StagedSegment staged;
    stage(beamSegment(launch.lines[line], piece, launch.view.coherenceMm), piece.length, launch.binMm, launch.binCount,
          staged);
    depositByWarp(staged, launch.binMm, lane, launch.shared + std::size_t(line) * launch.binCount);
  }
  __device__ void echo(const Vec3f& point, float amplitude)
  {
    if (lane == 0)
    {
      // Sums are divided by the paths.
      addPathEcho<false>(launch, line, launch.lines[line], point, amplitude * float(launch.paths));
    }
  }
};

/// One warp a line: what all its paths share.
template<class Targets>
__global__ void startLines(TraceLaunch<Targets> launch, int count)
{
  const int line = int(blockIdx.x * blockDim.x + threadIdx.x) / warpLanes;
  if (line >= count)
  {
    return;
  }
  CommonSink<TraceLaunch<Targets>> sink(launch, line, int(threadIdx.x % warpLanes));
  const LineStart start = startLine(launch.view, launch.space, launch.lines[line], sink);
  if (sink.lane == 0)
  {
    atomicAdd(reinterpret_cast<unsigned long long*>(launch.segments), static_cast<unsigned long long>(sink.segments));
    launch.starts[line] = start;
  }
}

/// Each lane follows a path of its own, and stages its segment for the warp.
template<bool ManyPaths, class Launch>
struct LaneSink : PathSink
{
  __device__ LaneSink(const Launch& theLaunch, int theLine, const TraceLine& theBeam, StagedSegment& theStaged)
    : launch(theLaunch)
    , line(theLine)
    , beam(theBeam)
    , staged(theStaged)
  {
  }

  const Launch& launch;
  int line;
  const TraceLine& beam; // that the path's segments are seen from
  StagedSegment& staged;
  TissueEcho straight; // of the same segment, waits until that has been left
  DepthSpan heard{ 0.0f, 0.0f };
  unsigned segments = 0;

  __device__ void segment(const PathSegment& piece)
  {
    ++segments;
    if (piece.reflections > 0 && launch.view.model == InterfaceModel::Acoustic)
    {
      const TissueBins bins = launch.tissueBins();
      stage(ownWayEcho(launch.view, piece), piece.length, bins, staged);
      if (isStraightBack(launch.lines[line], piece))
      {
        straight = straightBackEcho(launch.wayOf(line), launch.lines[line], beam, piece);
        heard = heardSpan(straight, piece.length, straight.level != 0.0f ? bins.endMm() : 0.0f);
      }
    }
    else
    {
      stage(beamSegment(beam, piece, launch.view.coherenceMm), piece.length, launch.binMm, launch.binCount, staged);
    }
  }
  __device__ void echo(const Vec3f& point, float amplitude)
  {
    addPathEcho<ManyPaths>(launch, line, beam, point, amplitude);
  }
  __device__ void arrives(const PathState& path, const PathBoundary& boundary)
  {
    if (launch.echoCount > 0)
    {
      const Arrival arrival =
        boundaryArrival(launch.view, launch.wayOf(line), launch.lines[line], beam, path, boundary);
      addEcho<ManyPaths>(launch, line, arrival.rangeMm, arrival.amplitude);
      for (int side = 0; side < 2 && arrival.amplitude != 0.0f; ++side) // an echo may end a bin and begin the next
      {
        const int bin = int(fmaxf(0.0f, arrival.rangeMm / launch.binMm + (side == 0 ? -0.5f : 0.5f)));
        if (bin < launch.binCount)
        {
          addAbsorbed(launch.absorbedToBoundaries + 2 * (std::size_t(line) * launch.binCount + bin),
                      launch.echoScale * fabsf(arrival.amplitude) / boundaryPerSpeckle, arrival.absorbedNp);
        }
      }
    }
  }
  /// Whether the last segment falls into a bin: there is room for one.
  __device__ bool holdsSegment() const { return staged.binHigh >= 0; }
  __device__ bool holdsStraightBack() const { return heard.high > heard.low; }
  __device__ void stageStraightBack() { stage(straight, heard, launch.tissueBins(), staged); }
  __device__ void clear()
  {
    staged.binHigh = -1;
    heard.high = heard.low;
  }
};

/// A path at its start: in the body, from its own place on the aperture, or behind the first boundary that all paths of
/// the line share. Returns whether it walks on; `beam` is its line.
template<class Launch, class Sink>
__device__ bool beginPath(const Launch& launch, int line, const PathKey& key, TraceLine& beam, PathState& path,
                          Sink& sink)
{
  if (launch.view.startsApart)
  {
    beam = pathLine(launch.view, launch.lines[line], key);
    path = PathState();
    return startPath(launch.view, launch.space, beam, path, sink);
  }
  const LineStart& start = launch.starts[line];
  path = start.path;
  return passBoundary(launch.view, start.boundary, key, path, sink);
}

template<class Real>
__device__ inline void addBins(const BinSums<Real>& bin, BinSums<double>& sums)
{
#pragma unroll
  for (int sum = 0; sum < binSumCount; ++sum)
  {
    sums.of[sum] += double(bin.of[sum]);
  }
}

/// A warp's bins go over into its doubles; each lane has its own (see depositByWarp).
__device__ inline void foldBins(int binCount, int lane, BinSums<float>* bins, BinSums<double>* sums)
{
  for (int b = lane; b < binCount; b += warpLanes)
  {
    addBins(bins[b], sums[b]);
    bins[b] = {};
  }
}

/// A slice is a part of a batch of a line, or some small batches whole; a block traces a few, each lane one path after
/// the other. The paths of a block step together, each to its next boundary, and lanes whose paths have ended begin the
/// next ones together; what they leave is added to their warp's bins by all its lanes, one segment after the other.
/// Warps wait for each other at every part of a step, or each would ask for other instructions, which are far more than
/// a multiprocessor's cache holds: two thirds of the time would go into that (see notes.md). As on the CPU
/// (LineTally), a long sum of floats would lose its last digits: where there are many paths, warps fold their bins into
/// doubles of their own, which are added up in the end, and keep what rounding leaves of echoes. No sum depends on
/// which warp is first.
template<bool BinsInShared, bool ManyPaths, bool FewWarps, class Targets>
__global__ void __launch_bounds__((FewWarps ? shapeOfFew : shapeOfMany).warps* warpLanes,
                                  (FewWarps ? shapeOfFew : shapeOfMany).together)
  tracePaths(TraceLaunch<Targets> launch)
{
  extern __shared__ BinSums<float> dynamic[];
  const int lane = threadIdx.x % warpLanes;
  const int warp = threadIdx.x / warpLanes; // of the block
  const int sliceThreads = launch.warps * warpLanes;
  const int thread = threadIdx.x % sliceThreads; // of the slice
  const int sliceOfBlock = threadIdx.x / sliceThreads;
  const int number = int(blockIdx.x) * launch.slicesTogether + sliceOfBlock; // of the slice
  const bool isThere = number < launch.sliceCount;
  const int line = isThere ? number / launch.slicesOfLine : 0;
  const int slice = number % launch.slicesOfLine % launch.slices;
  const int firstBatch = number % launch.slicesOfLine / launch.slices * launch.batchesTogether;
  const int batches = isThere ? min(launch.batchesTogether, launch.batches - firstBatch) : 0;
  const int ofBatches = lane / launch.batchLanes; // in the warp
  const int batch = firstBatch + ofBatches;

  // Bins of the block's warps, then their segments, then the batch's scrambles.
  const int warps = launch.slicesTogether * launch.warps;
  const int slots = BinsInShared ? warps * launch.batchesTogether : 0;
  auto* segmentsOfWarps = reinterpret_cast<StagedSegment*>(dynamic + std::size_t(slots) * launch.binCount);
  const int scrambled = scrambleCount(launch.view);
  auto* scrambles = reinterpret_cast<BounceScramble*>(segmentsOfWarps + warps * warpLanes) +
                    sliceOfBlock * launch.batchesTogether * scrambled;
  StagedSegment* staged = segmentsOfWarps + warp * warpLanes;
  const std::size_t row = (std::size_t(line) * launch.batches + firstBatch) * launch.slices + slice;
  const std::size_t warpRow = (row * launch.warps + warp % launch.warps) * launch.binCount;
  BinSums<float>* ofSlice =
    dynamic + std::size_t(sliceOfBlock) * launch.warps * launch.batchesTogether * launch.binCount;
  BinSums<float>* bins =
    BinsInShared ? ofSlice + std::size_t(warp % launch.warps) * launch.binCount : launch.bins + warpRow;
  for (int b = lane; b < batches * launch.binCount; b += warpLanes)
  {
    bins[b] = {};
    if (ManyPaths)
    {
      launch.sums[warpRow + b] = {};
    }
  }
  const std::uint32_t lineKey = launch.keyOf(line);
  const std::uint64_t seed = launch.seedOf(line);
  const std::size_t lineBins = std::size_t(line) * launch.binCount;
  const ReverberationRow reverberation{ launch.batchReverberation(line, firstBatch),
                                        launch.batchLanes,
                                        launch.absorbedByTissue + 2 * lineBins,
                                        launch.cellMm + lineBins,
                                        lineKey,
                                        launch.tissueBins() };
  for (int b = thread; b < batches * scrambled; b += sliceThreads)
  {
    scrambles[b] = makeScramble(launch.view, seed, lineKey, std::uint32_t(firstBatch + b / scrambled), b % scrambled);
  }
  __syncthreads();

  const int end = ofBatches < batches ? batchRange(launch.paths, launch.batches, batch).count() : 0;
  const int step = launch.slices * sliceThreads;
  const int place = slice * sliceThreads + thread - ofBatches * launch.batchLanes;
  TraceLine beam = launch.lines[line];
  LaneSink<ManyPaths, TraceLaunch<Targets>> sink(launch, line, beam, staged[lane]);
  PathKey key{ lineKey, std::uint32_t(batch), std::uint32_t(place - step), seed, scrambles + ofBatches * scrambled };
  PathState path;
  bool walks = false;
  bool active = launch.view.startsApart || launch.starts[line].meets; // until the lane has no more paths
  int untilFold = pathsPerFold;                                       // a path adds to a bin but a few times
  while (__syncthreads_or(active))
  {
    sink.clear();
    if (active && !walks)
    {
      key.path += std::uint32_t(step);
      active = int(key.path) < end;
      walks = active && beginPath(launch, line, key, beam, path, sink);
    }
    // A path that has met coupling leaves that first.
    const bool steps = walks && !sink.holdsSegment();
    PathBoundary boundary;
    PieceEnd pieceEnd = PieceEnd::Path;
    if (steps)
    {
      pieceEnd = walkPiece(launch.view, launch.space, beam, path, boundary, sink);
      walks = pieceEnd == PieceEnd::Medium;
    }
    __syncthreads();
    if (steps && pieceEnd == PieceEnd::Boundary)
    {
      walks =
        arriveAtBoundary(launch.view, path, boundary, sink) && passBoundary(launch.view, boundary, key, path, sink);
    }
    __syncthreads();
    unsigned waiting = __ballot_sync(allLanes, sink.holdsSegment());
    untilFold -= __popc(waiting);
    const unsigned reverberating = waiting & __ballot_sync(allLanes, staged[lane].reverberates != 0u);
    for (waiting &= ~reverberating; waiting; waiting &= waiting - 1)
    {
      const int from = __ffs(int(waiting)) - 1;
      depositByWarp(staged[from], launch.binMm, lane, bins + from / launch.batchLanes * launch.binCount);
    }
    reverberateByWarp<false>(staged, reverberating, reverberation, launch.echoScale, lane);
    const unsigned straightBack = __ballot_sync(allLanes, sink.holdsStraightBack());
    if (straightBack != 0u)
    {
      __syncwarp();
      if (sink.holdsStraightBack())
      {
        sink.stageStraightBack();
      }
      __syncwarp();
      reverberateByWarp<true>(staged, straightBack, reverberation, launch.echoScale, lane);
    }
    if (ManyPaths && untilFold <= 0)
    {
      foldBins(launch.binCount, lane, bins, launch.sums + warpRow);
      untilFold = pathsPerFold;
    }
    __syncwarp();
  }
  unsigned segments = sink.segments;
  for (int s = warpLanes / 2; s > 0; s /= 2)
  {
    segments += __shfl_down_sync(allLanes, segments, unsigned(s));
  }
  if (lane == 0)
  {
    atomicAdd(reinterpret_cast<unsigned long long*>(launch.segments), static_cast<unsigned long long>(segments));
  }
  if (ManyPaths)
  {
    if (isThere)
    {
      foldBins(launch.binCount, lane, bins, launch.sums + warpRow);
    }
    return;
  }
  __syncthreads();
  for (int b = thread; b < batches * launch.binCount; b += sliceThreads)
  {
    BinSums<double> sum{};
    for (int g = 0; g < launch.warps; ++g)
    {
      addBins(ofSlice[std::size_t(g) * launch.binCount + b], sum);
    }
    launch.sums[row * launch.binCount + b] = sum;
  }
}

} // namespace sono
