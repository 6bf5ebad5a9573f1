#include "Cuda/DevicePieces.cuh"

#include "Cuda/WithKind.cuh"
#include "Scene/FindFace.h"
#include "Scene/FitPiece.h"

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_select.cuh>
#include <thrust/iterator/counting_iterator.h>

#include <algorithm>
#include <new>

namespace sono {

namespace {

using namespace stepfit;

constexpr int threads = 128;

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

/// A block of threads takes a block of bricks; visit(face) for each face, in any order.
template<class Visit>
__device__ void forFaces(const FaceSearch& search, const Visit& visit)
{
  const Vec3i from = search.firstBrick[blockIdx.x];
  const Vec3i to = glm::min(from + SurfacePieces::blockBricks, search.bricks);
  const BrickVoxels voxels(from, to, search.edgeMm, search.spacingMm, search.volume.size);
  const Vec3i count = voxels.last - voxels.first;
  for (int n = int(threadIdx.x); n < count.x * count.y * count.z; n += int(blockDim.x))
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

/// As SurfaceEchoes::findPieces marks them.
template<BeamKind kind>
__global__ void __launch_bounds__(threads) markHeardFaces(PieceHearers hearers, const SurfaceFace* faces, int count,
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
  const Vec3f middle = faceMiddleMm(face, spacingMm);
  for (int line = 0; line < hearers.lines; ++line)
  {
    Beam beam = hearers.splat.beams[line];
    beam.kind = kind;
    beam.field = &tables.field;
    beam.array = &tables.array;
    beam.arraySight = &tables.arraySight;
    if (mayHearSurface(middle, face.roughNormal, radiusMm, row, beam, hearers.splat.grid, hearers.table))
    {
      state[n] = heard;
      return;
    }
  }
}

__global__ void __launch_bounds__(lanes)
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

} // namespace

void DevicePieces::prepare(const SurfaceJob& job, const std::uint8_t* voxels, const PieceHearers& hearers,
                           cudaStream_t stream, Traffic& traffic)
{
  if (windows_.size() == 0)
  {
    const WindowTables& tables = windowTables();
    weight_.upload(tables.weight, stream, traffic);
    strictness_.upload(tables.strictness, stream, traffic);
    windows_.upload(tables.windows(weight_.data(), strictness_.data()), stream, traffic);
  }
  if (id_ != job.pieces->id())
  {
    blocks_.assign(std::size_t(job.pieces->blockCount()), false);
    faces_.resize(0);
    brickOfFace_.resize(0);
    state_.resize(0);
    pieces_.resize(0);
    brickOfPiece_.resize(0);
    groups_.resize(0);
  }
  id_ = 0; // stays so when something fails
  takeFaces(job, voxels, stream, traffic);
  const int count = faces_.size() > 0 ? markHeard(job, hearers, stream, traffic) : 0;
  if (count > 0)
  {
    fit(job, voxels, count, stream, traffic);
    group(job, stream, traffic);
  }
  id_ = job.pieces->id();
}

/// Of blocks that are new.
void DevicePieces::takeFaces(const SurfaceJob& job, const std::uint8_t* voxels, cudaStream_t stream, Traffic& traffic)
{
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
  countFaces<<<unsigned(firstBrick.size()), threads, 0, stream>>>(search, count_.data());
  check(cudaGetLastError(), "looking for surfaces");
  const int count = bring(count_.data(), stream, traffic);
  const int before = int(faces_.size());
  faces_.grow(std::size_t(before + count), stream);
  brickOfFace_.grow(std::size_t(before + count), stream);
  state_.grow(std::size_t(before + count), stream);
  beginAt(before);
  listFaces<<<unsigned(firstBrick.size()), threads, 0, stream>>>(search, count_.data(), faces_.data(),
                                                                 brickOfFace_.data());
  check(cudaGetLastError(), "looking for surfaces");
  check(cudaMemsetAsync(state_.data() + before, unheard, std::size_t(count), stream), "clearing memory");
}

/// Of the numbers from 0 to count - 1 those that are wanted, in their order; how many.
template<class IsWanted>
int DevicePieces::select(int count, const IsWanted& isWanted, DeviceArray<int>& to, cudaStream_t stream,
                         Traffic& traffic)
{
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
  return bring(count_.data(), stream, traffic);
}

/// How many faces there are to fit.
int DevicePieces::markHeard(const SurfaceJob& job, const PieceHearers& hearers, cudaStream_t stream, Traffic& traffic)
{
  const int count = int(faces_.size());
  withKind(hearers.kind, [&](auto kind) {
    markHeardFaces<kind.value><<<blocksFor(count), threads, 0, stream>>>(
      hearers, faces_.data(), count, job.pieces->spacingMm(), 2.0f * job.longestStepMm, state_.data());
  });
  check(cudaGetLastError(), "looking for surfaces");
  return select(count, IsHeard{ state_.data() }, list_, stream, traffic);
}

/// The list's faces, behind the pieces before.
void DevicePieces::fit(const SurfaceJob& job, const std::uint8_t* voxels, int count, cudaStream_t stream,
                       Traffic& traffic)
{
  DeviceArray<SurfacePiece> made;
  DeviceArray<int> kept;
  made.resize(std::size_t(count));
  fitFaces<<<unsigned(count), lanes, 0, stream>>>(voxels, job.voxels.size, job.voxels.spacing, windows_.data(),
                                                  faces_.data(), list_.data(), state_.data(), made.data());
  check(cudaGetLastError(), "fitting surfaces");
  const int keptCount = select(count, HasShare{ made.data() }, kept, stream, traffic);
  if (keptCount > 0)
  {
    const std::size_t before = pieces_.size();
    pieces_.grow(before + std::size_t(keptCount), stream);
    brickOfPiece_.grow(before + std::size_t(keptCount), stream);
    appendPieces<<<blocksFor(keptCount), threads, 0, stream>>>(kept.data(), keptCount, made.data(), list_.data(),
                                                               brickOfFace_.data(), pieces_.data() + before,
                                                               brickOfPiece_.data() + before);
    check(cudaGetLastError(), "fitting surfaces");
  }
}

/// Brings all pieces into the order of their bricks, and those of a brick into groups.
void DevicePieces::group(const SurfaceJob& job, cudaStream_t stream, Traffic& traffic)
{
  const int count = int(pieces_.size());
  if (count == 0)
  {
    return;
  }
  DeviceArray<int> numbers;
  DeviceArray<int> order;
  DeviceArray<int> sortedBricks;
  DeviceArray<SurfacePiece> sorted;
  numbers.resize(std::size_t(count));
  order.resize(std::size_t(count));
  sortedBricks.resize(std::size_t(count));
  sorted.resize(std::size_t(count));
  countUp<<<blocksFor(count), threads, 0, stream>>>(numbers.data(), count);
  const auto sort = [&](void* scratch, std::size_t& bytes) {
    check(cub::DeviceRadixSort::SortPairs(scratch, bytes, brickOfPiece_.data(), sortedBricks.data(), numbers.data(),
                                          order.data(), count, 0, 32, stream),
          "ordering surfaces");
  };
  std::size_t bytes = 0;
  sort(nullptr, bytes);
  scratch_.resize(bytes);
  sort(scratch_.data(), bytes);
  takeInOrder<<<blocksFor(count), threads, 0, stream>>>(pieces_.data(), order.data(), count, sorted.data());
  check(cudaGetLastError(), "ordering surfaces");
  pieces_ = std::move(sorted);
  brickOfPiece_ = std::move(sortedBricks);

  std::vector<int> brickOf(std::size_t(count), 0);
  download(brickOfPiece_.data(), std::size_t(count), brickOf.data(), stream, traffic);
  check(await(stream), "ordering surfaces");
  const Vec3i bricks = job.pieces->bricks();
  std::vector<SurfaceGroup> groups;
  for (int first = 0; first < count;)
  {
    const int brick = brickOf[std::size_t(first)];
    int end = first + 1;
    while (end < count && end < first + warpLanes && brickOf[std::size_t(end)] == brick)
    {
      ++end;
    }
    const Vec3i at(brick % bricks.x, brick / bricks.x % bricks.y, brick / bricks.x / bricks.y);
    groups.push_back({ (Vec3f(at) + 0.5f) * job.pieces->edgeMm(), Vec3f(0.0f), 0.0f, first, end - first });
    first = end;
  }
  groups_.upload(groups, stream, traffic);
  boundGroups<<<blocksFor(int(groups.size())), threads, 0, stream>>>(pieces_.data(), job.longestStepMm, groups_.data(),
                                                                     int(groups.size()));
  check(cudaGetLastError(), "ordering surfaces");
}

int DevicePieces::bring(const int* count, cudaStream_t stream, Traffic& traffic)
{
  int value = 0;
  download(count, 1, &value, stream, traffic);
  check(await(stream), "looking for surfaces");
  return value;
}

} // namespace sono
