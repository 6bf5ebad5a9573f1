#include "Cuda/DevicePieces.cuh"

#include "Cuda/IdleByDevice.h"
#include "Cuda/WithKind.cuh"
#include "Scene/FindFace.h"
#include "Scene/FitPiece.h"

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_select.cuh>
#include <thrust/iterator/counting_iterator.h>

#include <algorithm>
#include <map>
#include <new>
#include <utility>

namespace sono {

namespace {

using namespace stepfit;

constexpr int threads = 128;
// Warps that fit faces on a multiprocessor, for which registers are shared out: as many as find room for their maps.
constexpr int fittingWarps = 24;
// Lines that a face is looked at for together.
constexpr int runLines = 16;

/// Of a face.
enum FaceState : std::uint8_t
{
  unheard, // so far
  heard,   // by one of the beams that are asked now
  fitted
};

struct IsHeard
{
  const std::uint8_t* state;
  __device__ bool operator()(int face) const { return state[face] == heard; }
};

/// Whether there is a piece: where columns of another axis stand for a face its share is 0.
struct HasShare
{
  const SurfacePiece* pieces;
  __device__ bool operator()(int piece) const { return pieces[piece].share > 0.0f; }
};

/// Where faces are looked for: the bricks of blocks.
struct FaceSearch
{
  TissueVolume volume;
  Vec3f spacingMm;
  float edgeMm;
  Vec3i bricks;
  const Vec3i* firstBrick; // of each block
};

/// So many blocks of threads take a block of bricks together: there are few of those.
constexpr int searchers = 8;

/// visit(face) for each face of the searchers' block of bricks, in any order.
template<class Visit>
__device__ void forFaces(const FaceSearch& search, const Visit& visit)
{
  const Vec3i from = search.firstBrick[blockIdx.x];
  const Vec3i to = glm::min(from + SurfacePieces::blockBricks, search.bricks);
  const BrickVoxels voxels(from, to, search.edgeMm, search.spacingMm, search.volume.size);
  const Vec3i count = voxels.last - voxels.first;
  for (int n = int(blockIdx.y * blockDim.x + threadIdx.x); n < count.x * count.y * count.z;
       n += int(searchers * blockDim.x))
  {
    const Vec3i voxel = voxels.first + Vec3i(n % count.x, n / count.x % count.y, n / (count.x * count.y));
    for (int axis = 0; axis < 3; ++axis)
    {
      SurfaceFace face;
      if (findFace(search.volume, search.spacingMm, voxel, axis, face))
      {
        visit(face);
      }
    }
  }
}

__global__ void countFaces(FaceSearch search, int* count)
{
  int own = 0;
  forFaces(search, [&](const SurfaceFace&) { ++own; });
  atomicAdd(count, own);
}

/// From faces[next] on; their order does not matter.
__global__ void listFaces(FaceSearch search, int* next, SurfaceFace* faces, int* brick)
{
  forFaces(search, [&](const SurfaceFace& face) {
    const int n = atomicAdd(next, 1);
    faces[n] = face;
    const Vec3i b = glm::min(Vec3i((Vec3f(face.voxel) + 0.5f) * search.spacingMm / search.edgeMm), search.bricks - 1);
    brick[n] = b.x + search.bricks.x * (b.y + search.bricks.y * b.z);
  });
}

unsigned blocksFor(int count)
{
  return unsigned((count + threads - 1) / threads);
}

__global__ void makeRuns(const Beam* beams, int lines, BeamRun* runs)
{
  const int first = runLines * (int(blockIdx.x) * threads + int(threadIdx.x));
  if (first < lines)
  {
    runs[first / runLines] = beamRun(beams, first, min(runLines, lines - first));
  }
}

/// As SurfaceEchoes::findPieces marks them. Most faces that nobody has heard yet lie far from each run of lines.
template<BeamKind kind>
__global__ void __launch_bounds__(threads)
  markHeardFaces(PieceHearers hearers, const BeamRun* runs, int runCount, const SurfaceFace* faces, int count,
                 Vec3f spacingMm, float radiusMm, std::uint8_t* state)
{
  __shared__ BeamTables tables;
  wholeBeam(hearers.splat, 0, tables);
  __syncthreads();
  const int n = int(blockIdx.x) * threads + int(threadIdx.x);
  if (n >= count || state[n] != unheard)
  {
    return;
  }
  const SurfaceFace face = faces[n];
  const int row = surfaceRow(hearers.media, face.below, face.above);
  if (!hearers.table.counts(row))
  {
    return;
  }
  const Vec3f middle = faceMiddleMm(face.voxel, face.axis, spacingMm);
  const auto withTables = [&](Beam& beam) {
    beam.kind = kind;
    beam.field = &tables.field;
    beam.array = &tables.array;
    beam.arraySight = &tables.arraySight;
  };
  for (int r = 0; r < runCount; ++r)
  {
    BeamRun run = runs[r];
    withTables(run.middle);
    if (!someMayHearSurface(middle, face.roughNormal, radiusMm, row, run, hearers.splat.grid, hearers.table))
    {
      continue;
    }
    for (int line = run.first; line < run.first + run.count; ++line)
    {
      Beam beam = hearers.splat.beams[line];
      withTables(beam);
      if (mayHearSurface(middle, face.roughNormal, radiusMm, row, beam, hearers.splat.grid, hearers.table))
      {
        state[n] = heard;
        return;
      }
    }
  }
}

__global__ void __launch_bounds__(lanes, fittingWarps)
  fitFaces(const std::uint8_t* tissues, Vec3i size, Vec3f spacingMm, const Window* windows, const SurfaceFace* faces,
           const int* list, std::uint8_t* state, SurfacePiece* pieces)
{
  __shared__ alignas(StepMap) unsigned char memory[sizeof(StepMap)];
  StepMap& map = *new (memory) StepMap(tissues, size, windows); // by each lane, the same
  const int face = list[blockIdx.x];
  const SurfacePiece piece = fitPiece(map, spacingMm, faces[face]);
  if (lane() == 0)
  {
    pieces[blockIdx.x] = piece;
    state[face] = fitted;
  }
}

/// The kept of the new pieces, behind those before.
__global__ void appendPieces(const int* kept, int count, const SurfacePiece* made, const int* list, const int* brickOf,
                             SurfacePiece* pieces, int* brick)
{
  const int n = int(blockIdx.x) * threads + int(threadIdx.x);
  if (n < count)
  {
    pieces[n] = made[kept[n]];
    brick[n] = brickOf[list[kept[n]]];
  }
}

__global__ void countUp(int* values, int count)
{
  const int n = int(blockIdx.x) * threads + int(threadIdx.x);
  if (n < count)
  {
    values[n] = n;
  }
}

__global__ void takeInOrder(const SurfacePiece* from, const int* order, int count, SurfacePiece* to)
{
  const int n = int(blockIdx.x) * threads + int(threadIdx.x);
  if (n < count)
  {
    to[n] = from[order[n]];
  }
}

/// The balls around the groups' pieces.
__global__ void boundGroups(const SurfacePiece* pieces, float longestStepMm, SurfaceGroup* groups, int count)
{
  const int n = int(blockIdx.x) * threads + int(threadIdx.x);
  if (n >= count)
  {
    return;
  }
  SurfaceGroup& group = groups[n];
  Vec3f low(1e30f);
  Vec3f high(-1e30f);
  for (int p = group.first; p < group.first + group.count; ++p)
  {
    const Vec3f centre = pieces[p].positionMm;
    const float radius = pieceBounds(pieces[p], longestStepMm).radiusMm;
    low = glm::min(low, centre - radius);
    high = glm::max(high, centre + radius);
  }
  group.centreMm = 0.5f * (low + high);
  group.radiusMm = 0.5f * glm::length(high - low);
}

/// The windows' tables, on a device as long as the process.
class DeviceWindows
{
public:
  /// Those of the thread's device.
  static const Window* all(Traffic& traffic)
  {
    static std::mutex mutex;
    static auto* const known = new std::map<int, DeviceWindows>;
    const int device = currentDevice();
    const std::lock_guard<std::mutex> lock(mutex);
    DeviceWindows& here = (*known)[device];
    if (!here.isThere_)
    {
      const cudaStream_t stream = deviceStream();
      const WindowTables& tables = windowTables();
      here.weight_.upload(tables.weight, stream, traffic);
      here.strictness_.upload(tables.strictness, stream, traffic);
      here.windows_.upload(tables.windows(here.weight_.data(), here.strictness_.data()), stream, traffic);
      check(await(stream), "uploading");
      here.isThere_ = true;
    }
    return here.windows_.data();
  }

private:
  DeviceArray<float> weight_, strictness_;
  DeviceArray<Window> windows_;
  bool isThere_ = false;
};

/// Lanes that nobody works in.
IdleByDevice<DeviceLane>& idleLanes()
{
  static auto* const lanes = new IdleByDevice<DeviceLane>;
  return *lanes;
}

} // namespace

std::shared_ptr<DevicePieces> DevicePieces::of(const SurfacePieces& pieces)
{
  static std::mutex mutex;
  static auto* const known = new std::map<std::pair<int, std::uint64_t>, std::weak_ptr<DevicePieces>>;
  const int device = currentDevice();
  const std::lock_guard<std::mutex> lock(mutex);
  for (auto it = known->begin(); it != known->end();)
  {
    it = it->second.expired() ? known->erase(it) : std::next(it);
  }
  std::weak_ptr<DevicePieces>& here = (*known)[{ device, pieces.id() }];
  std::shared_ptr<DevicePieces> shared = here.lock();
  if (!shared)
  {
    shared.reset(new DevicePieces(device));
    here = shared;
  }
  return shared;
}

DevicePieces::DevicePieces(int device)
  : device_(device)
  , lane_(idleLanes().take(device))
{
  lane_ = lane_ ? lane_ : openLane(device, Waiting::Asleep);
}

DevicePieces::~DevicePieces()
{
  idleLanes().give(device_, lane_);
}

std::shared_ptr<const PieceList> DevicePieces::heardBy(const SurfaceJob& job, const std::uint8_t* voxels,
                                                       const PieceHearers& hearers, cudaEvent_t uploaded,
                                                       Traffic& traffic)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const OnLane lane(lane_);
  check(cudaStreamWaitEvent(deviceStream(), uploaded), "looking for surfaces");
  if (!isWhole_)
  {
    blocks_.assign(std::size_t(job.pieces->blockCount()), false);
    faces_.resize(0);
    brickOfFace_.resize(0);
    state_.resize(0);
    list_ = std::make_shared<PieceList>();
    brickOfPiece_.resize(0);
  }
  isWhole_ = false; // stays so when something fails
  takeFaces(job, voxels, traffic);
  const int count = faces_.size() > 0 ? markHeard(job, hearers, traffic) : 0;
  if (count > 0)
  {
    fit(job, voxels, count, traffic);
  }
  check(await(deviceStream()), "fitting surfaces");
  isWhole_ = true;
  return list_;
}

/// Of blocks that are new.
void DevicePieces::takeFaces(const SurfaceJob& job, const std::uint8_t* voxels, Traffic& traffic)
{
  const cudaStream_t stream = deviceStream();
  const SurfacePieces& scene = *job.pieces;
  std::vector<Vec3i> firstBrick;
  for (const int block : job.blocks)
  {
    if (!blocks_[std::size_t(block)])
    {
      blocks_[std::size_t(block)] = true;
      firstBrick.push_back(scene.firstBrick(block));
    }
  }
  if (firstBrick.empty())
  {
    return;
  }
  DeviceArray<Vec3i> blocks;
  blocks.upload(firstBrick, stream, traffic);
  count_.resize(1);
  const FaceSearch search{
    { voxels, job.voxels.size }, scene.spacingMm(), scene.edgeMm(), scene.bricks(), blocks.data()
  };
  const auto beginAt = [&](int first) { count_.upload({ first }, stream, traffic); };
  beginAt(0);
  countFaces<<<dim3(unsigned(firstBrick.size()), searchers), threads, 0, stream>>>(search, count_.data());
  check(cudaGetLastError(), "looking for surfaces");
  const int count = bring(count_.data(), traffic);
  const int before = int(faces_.size());
  faces_.grow(std::size_t(before + count), stream);
  brickOfFace_.grow(std::size_t(before + count), stream);
  state_.grow(std::size_t(before + count), stream);
  beginAt(before);
  listFaces<<<dim3(unsigned(firstBrick.size()), searchers), threads, 0, stream>>>(search, count_.data(), faces_.data(),
                                                                                  brickOfFace_.data());
  check(cudaGetLastError(), "looking for surfaces");
  check(cudaMemsetAsync(state_.data() + before, unheard, std::size_t(count), stream), "clearing memory");
}

/// Of the numbers from 0 to count - 1 those that are wanted, in their order; how many.
template<class IsWanted>
int DevicePieces::select(int count, const IsWanted& isWanted, DeviceArray<int>& to, Traffic& traffic)
{
  const cudaStream_t stream = deviceStream();
  to.resize(std::size_t(count));
  count_.resize(1);
  const thrust::counting_iterator<int> numbers(0);
  const auto run = [&](void* scratch, std::size_t& bytes) {
    check(cub::DeviceSelect::If(scratch, bytes, numbers, to.data(), count_.data(), count, isWanted, stream),
          "looking for surfaces");
  };
  std::size_t bytes = 0;
  run(nullptr, bytes);
  scratch_.resize(bytes);
  run(scratch_.data(), bytes);
  return bring(count_.data(), traffic);
}

/// How many faces there are to fit.
int DevicePieces::markHeard(const SurfaceJob& job, const PieceHearers& hearers, Traffic& traffic)
{
  const cudaStream_t stream = deviceStream();
  const int count = int(faces_.size());
  const int runs = (hearers.lines + runLines - 1) / runLines;
  runs_.resize(std::size_t(runs));
  makeRuns<<<blocksFor(runs), threads, 0, stream>>>(hearers.splat.beams, hearers.lines, runs_.data());
  withKind(hearers.kind, [&](auto kind) {
    markHeardFaces<kind.value><<<blocksFor(count), threads, 0, stream>>>(hearers, runs_.data(), runs, faces_.data(),
                                                                         count, job.pieces->spacingMm(),
                                                                         2.0f * job.longestStepMm, state_.data());
  });
  check(cudaGetLastError(), "looking for surfaces");
  return select(count, IsHeard{ state_.data() }, selected_, traffic);
}

/// The selected faces, with the pieces before.
void DevicePieces::fit(const SurfaceJob& job, const std::uint8_t* voxels, int count, Traffic& traffic)
{
  const cudaStream_t stream = deviceStream();
  DeviceArray<SurfacePiece> made;
  DeviceArray<int> kept;
  made.resize(std::size_t(count));
  const Window* windows = DeviceWindows::all(traffic);
  fitFaces<<<unsigned(count), lanes, 0, stream>>>(voxels, job.voxels.size, job.voxels.spacing, windows, faces_.data(),
                                                  selected_.data(), state_.data(), made.data());
  check(cudaGetLastError(), "fitting surfaces");
  const int keptCount = select(count, HasShare{ made.data() }, kept, traffic);
  if (keptCount > 0)
  {
    const std::size_t before = list_->pieces.size();
    DeviceArray<SurfacePiece> pieces;
    DeviceArray<int> brickOf;
    pieces.resize(before + std::size_t(keptCount));
    brickOf.resize(pieces.size());
    copyOnDevice(list_->pieces.data(), before, pieces.data(), stream);
    copyOnDevice(brickOfPiece_.data(), before, brickOf.data(), stream);
    appendPieces<<<blocksFor(keptCount), threads, 0, stream>>>(kept.data(), keptCount, made.data(), selected_.data(),
                                                               brickOfFace_.data(), pieces.data() + before,
                                                               brickOf.data() + before);
    check(cudaGetLastError(), "fitting surfaces");
    list_ = inGroups(job, pieces, brickOf, traffic);
  }
}

/// In the order of their bricks, and those of a brick in groups.
std::shared_ptr<const PieceList> DevicePieces::inGroups(const SurfaceJob& job, const DeviceArray<SurfacePiece>& pieces,
                                                        const DeviceArray<int>& brickOf, Traffic& traffic)
{
  const cudaStream_t stream = deviceStream();
  const int count = int(pieces.size());
  const auto list = std::make_shared<PieceList>();
  DeviceArray<int> numbers;
  DeviceArray<int> order;
  numbers.resize(pieces.size());
  order.resize(pieces.size());
  brickOfPiece_.resize(pieces.size());
  list->pieces.resize(pieces.size());
  countUp<<<blocksFor(count), threads, 0, stream>>>(numbers.data(), count);
  const auto sort = [&](void* scratch, std::size_t& bytes) {
    check(cub::DeviceRadixSort::SortPairs(scratch, bytes, brickOf.data(), brickOfPiece_.data(), numbers.data(),
                                          order.data(), count, 0, 32, stream),
          "ordering surfaces");
  };
  std::size_t bytes = 0;
  sort(nullptr, bytes);
  scratch_.resize(bytes);
  sort(scratch_.data(), bytes);
  takeInOrder<<<blocksFor(count), threads, 0, stream>>>(pieces.data(), order.data(), count, list->pieces.data());
  check(cudaGetLastError(), "ordering surfaces");

  const std::shared_ptr<void> memory = pinnedMemory(pieces.size() * sizeof(int));
  const int* const ordered = static_cast<const int*>(memory.get());
  download(brickOfPiece_.data(), pieces.size(), static_cast<int*>(memory.get()), stream, traffic);
  check(await(stream), "ordering surfaces");
  const Vec3i bricks = job.pieces->bricks();
  std::vector<SurfaceGroup> groups;
  for (int first = 0; first < count;)
  {
    const int brick = ordered[first];
    int end = first + 1;
    while (end < count && end < first + warpLanes && ordered[end] == brick)
    {
      ++end;
    }
    const Vec3i at(brick % bricks.x, brick / bricks.x % bricks.y, brick / bricks.x / bricks.y);
    groups.push_back({ (Vec3f(at) + 0.5f) * job.pieces->edgeMm(), Vec3f(0.0f), 0.0f, first, end - first });
    first = end;
  }
  list->groups.upload(groups, stream, traffic);
  boundGroups<<<blocksFor(int(groups.size())), threads, 0, stream>>>(list->pieces.data(), job.longestStepMm,
                                                                     list->groups.data(), int(groups.size()));
  check(cudaGetLastError(), "ordering surfaces");
  return list;
}

/// Through pinned memory: a copy to any other keeps a core busy until the device gets there.
int DevicePieces::bring(const int* count, Traffic& traffic)
{
  const std::shared_ptr<void> memory = pinnedMemory(sizeof(int));
  download(count, 1, static_cast<int*>(memory.get()), deviceStream(), traffic);
  check(await(deviceStream()), "looking for surfaces");
  return *static_cast<const int*>(memory.get());
}

} // namespace sono
