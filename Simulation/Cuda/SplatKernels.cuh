#pragma once

#include "Cuda/SplatChunk.cuh"
#include "Kernel/DetailCode.h"
#include "Kernel/Scatterer.h"

#include <cstdint>

// The kernels that sum the scatterers of a line, a block a chunk: those of the tissues, which are drawn cell by cell,
// and explicit ones.

namespace sono {

constexpr int brickCells = 4; // cells along an edge of a brick of procedural scatterers (see TissueScatterers)

struct TissueLaunch
{
  SplatLaunch splat;
  const std::uint8_t* voxels;
  const std::uint8_t* detail; // codes, or null
  Vec3i size;
  Vec3f perMm;
  Vec3f extentMm;
  const ScatteringMedium* media; // 256
  float cellMm;
  std::uint64_t seed;
  const float* intensity; // or null
  int binCount;
  float binMm;
};

/// Whether any of the paths' intensity reaches a chunk; the last bin's holds below it.
__device__ inline bool isLit(const TissueLaunch& launch, const Chunk& chunk)
{
  if (!launch.intensity)
  {
    return true;
  }
  const float* bins = launch.intensity + std::size_t(chunk.line) * launch.binCount;
  const int firstBin = min(max(0, int(chunk.fromMm / launch.binMm) - 1), launch.binCount - 1);
  const int lastBin = min(int(chunk.toMm / launch.binMm) + 2, launch.binCount);
  bool lit = false;
  for (int b = firstBin + int(threadIdx.x); b < lastBin; b += blockDim.x)
  {
    lit |= bins[b] > darkIntensity;
  }
  return __syncthreads_or(lit);
}

template<BeamKind kind>
__global__ void __launch_bounds__(blockThreads) splatTissueCells(TissueLaunch launch)
{
  __shared__ ShortSums sums;
  __shared__ ScatteringMedium media[256];
  const SplatLaunch& splat = launch.splat;
  const Chunk chunk = chunkOf(splat);
  for (int m = threadIdx.x; m < 256; m += blockThreads)
  {
    media[m] = launch.media[m];
  }
  sums.clear();
  const bool lit = isLit(launch, chunk);
  __syncthreads();
  const Beam beam = splat.beams[chunk.line];
  const float brickMm = launch.cellMm * brickCells;
  const BrickSight<kind> sight(splat, beam, brickMm);
  const auto splatCell = [&](const Vec3i& cell) {
    const ScattererSeed seed = scattererSeed(launch.seed, cell);
    const float x = (float(cell.x) + seed.fraction.x) * launch.cellMm;
    const float y = (float(cell.y) + seed.fraction.y) * launch.cellMm;
    const float z = (float(cell.z) + seed.fraction.z) * launch.cellMm;
    const SeenEcho<kind> echo = seenEcho<kind>(splat, beam, chunk, placeInBeam(x, y, z, beam, splat.grid));
    const Vec3i voxel(int(floorf(x * launch.perMm.x)), int(floorf(y * launch.perMm.y)),
                      int(floorf(z * launch.perMm.z)));
    if (isZero(echo.weight) || unsigned(voxel.x) >= unsigned(launch.size.x) ||
        unsigned(voxel.y) >= unsigned(launch.size.y) || unsigned(voxel.z) >= unsigned(launch.size.z))
    {
      return;
    }
    const std::size_t at =
      std::size_t(voxel.x) + std::size_t(launch.size.x) * (std::size_t(voxel.y) + std::size_t(launch.size.y) * voxel.z);
    float amplitude = scattererAmplitude(media[launch.voxels[at]], seed.presence, seed.deviate);
    if (amplitude != 0.0f)
    {
      amplitude *= launch.detail ? detailFactor(launch.detail[at]) : 1.0f;
      addScatterer(sums, splitScatterer(times(echo.weight, amplitude), echo.position, splat.grid), chunk.first,
                   splat.scale);
    }
  };
  if (lit && kind == BeamKind::Array)
  {
    // Its side lobes reach far, but only some bricks count: a lane asks for each, then the warp takes those that do.
    const CellRows bricks(beam, pieceOf<kind>(splat, beam, chunk), brickMm, Vec3f(0.0f), launch.extentMm);
    forCells(bricks, [&](bool exists, const Vec3i& brick) {
      const bool seen = exists && sight.meets((Vec3f(brick) + 0.5f) * brickMm);
      for (unsigned waiting = __ballot_sync(allLanes, seen); waiting; waiting &= waiting - 1)
      {
        const int lane = __ffs(int(waiting)) - 1;
        const Vec3i first =
          brickCells * Vec3i(__shfl_sync(allLanes, brick.x, lane), __shfl_sync(allLanes, brick.y, lane),
                             __shfl_sync(allLanes, brick.z, lane));
        for (int n = int(threadIdx.x) % warpLanes; n < brickCells * brickCells * brickCells; n += warpLanes)
        {
          splatCell(first + Vec3i(n & 3, (n >> 2) & 3, n >> 4));
        }
      }
    });
  }
  else if (lit)
  {
    const CellRows cells(beam, pieceOf<kind>(splat, beam, chunk), launch.cellMm, Vec3f(0.0f), launch.extentMm);
    forCells(cells, [&](bool exists, const Vec3i& cell) {
      const Vec3i brick(cell.x >> 2, cell.y >> 2, cell.z >> 2);
      if (exists && sight.meets((Vec3f(brick) + 0.5f) * brickMm))
      {
        splatCell(cell);
      }
    });
  }
  __syncthreads();
  writeChunk(splat, chunk, sums, false);
}

struct PointLaunch
{
  SplatLaunch splat;
  const float* x;
  const float* y;
  const float* z;
  const float* amplitude;
  const int* begin;
  Vec3i firstBrick;
  Vec3i bricks;
  float edgeMm;
  bool add;
};

struct PointRange
{
  int first;
  int count;
};

/// The points of a brick that the beam may see.
template<BeamKind kind>
__device__ PointRange pointsOf(const PointLaunch& launch, const BrickSight<kind>& sight, const Vec3i& cell)
{
  const Vec3i brick = cell - launch.firstBrick;
  if (unsigned(brick.x) >= unsigned(launch.bricks.x) || unsigned(brick.y) >= unsigned(launch.bricks.y) ||
      unsigned(brick.z) >= unsigned(launch.bricks.z) || !sight.meets((Vec3f(cell) + 0.5f) * launch.edgeMm))
  {
    return { 0, 0 };
  }
  const int b = brick.x + launch.bricks.x * (brick.y + launch.bricks.y * brick.z);
  return { launch.begin[b], launch.begin[b + 1] - launch.begin[b] };
}

template<BeamKind kind>
__global__ void __launch_bounds__(blockThreads) splatPointBricks(PointLaunch launch)
{
  using SeenPoint = SeenEcho<kind>; // of the point's amplitude
  __shared__ LongSums sums;
  __shared__ WarpQueue<SeenPoint> queues[blockThreads / warpLanes];
  const SplatLaunch& splat = launch.splat;
  const Chunk chunk = chunkOf(splat);
  sums.clear();
  __syncthreads();
  const Beam beam = splat.beams[chunk.line];
  const Vec3f low = Vec3f(launch.firstBrick) * launch.edgeMm;
  const Vec3f high = Vec3f(launch.firstBrick + launch.bricks) * launch.edgeMm;
  const BrickSight<kind> sight(splat, beam, launch.edgeMm);
  const CellRows rows(beam, pieceOf<kind>(splat, beam, chunk), launch.edgeMm, low, high);
  const auto splatPoint = [&](const SeenPoint& p) {
    addScatterer(sums, splitScatterer(p.weight, p.position, splat.grid), chunk.first, splat.scale);
  };
  const int lane = int(threadIdx.x) % warpLanes;
  const int warp = int(threadIdx.x) / warpLanes;
  const int rowCount = rows.rowCount();
  int queued = 0;
  // Rows of bricks are few: a warp takes a row, then brick by brick.
  for (int r = warp; r < rowCount; r += blockThreads / warpLanes)
  {
    const CellRows::Row row = rows.row(r);
    for (int n = 0; n < row.count; ++n)
    {
      const PointRange range = pointsOf(launch, sight, rows.cell(row.layer, row.v, row.first + n));
      for (int first = 0; first < range.count; first += warpLanes)
      {
        const int p = range.first + first + lane;
        SeenPoint point{};
        if (first + lane < range.count)
        {
          const BeamPlace at = placeInBeam(launch.x[p], launch.y[p], launch.z[p], beam, splat.grid);
          point = seenEcho<kind>(splat, beam, chunk, at);
          point.weight = times(point.weight, launch.amplitude[p]);
        }
        queues[warp].push(!isZero(point.weight), point, queued, splatPoint);
      }
    }
  }
  queues[warp].finish(queued, splatPoint);
  __syncthreads();
  writeChunk(splat, chunk, sums, launch.add);
}

} // namespace sono
