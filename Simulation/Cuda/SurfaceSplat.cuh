#pragma once

#include "Cuda/DeviceEcho.cuh"
#include "Cuda/SplatChunk.cuh"
#include "Kernel/SurfaceEcho.h"
#include "Kernel/SurfacePiece.h"

#include <type_traits>

// Echoes of surfaces, as SurfaceEchoes on the CPU.

namespace sono {

struct SurfaceLaunch
{
  SplatLaunch splat;
  TracedOnDevice traced;
  SurfaceSet set;
};

/// The samples of a chunk, for addSurface.
struct ChunkSurfaceSum
{
  LongSums* sums;
  float scale;
  int first;
  int last;

  SONO_HD void add([[maybe_unused]] int sample, [[maybe_unused]] float re, [[maybe_unused]] float im)
  {
#if defined(__CUDA_ARCH__)
    const int at = 2 * (sample - first);
    if (sample >= first && sample <= last)
    {
      sums->add(at, re * scale);
      sums->add(at + 1, im * scale);
    }
#endif
  }
};

/// A block adds what pieces (or points) of surfaces echo into a chunk of a line. A warp takes a row of bricks, brick by
/// brick; its lanes look which pieces count and work on those once there are enough.
template<BeamKind kind, class Item>
__global__ void __launch_bounds__(blockThreads) splatSurfaceBricks(SurfaceLaunch launch)
{
  constexpr bool arePieces = std::is_same_v<Item, SurfacePiece>;
  __shared__ LongSums sums;
  __shared__ WarpQueue<int> queues[blockThreads / warpLanes];
  __shared__ BeamTables tables;
  const SplatLaunch& splat = launch.splat;
  const SurfaceSet& set = launch.set;
  const Chunk chunk = chunkOf(splat);
  const Beam beam = wholeBeam(splat, chunk.line, tables);
  const TracedOnDevice& traced = launch.traced;
  const float deepestMm = float(splat.sumCount) * splat.sampleMm;
  const float litToMm = litMm(traced.intensity, traced.binCount, traced.binMm, chunk.line, deepestMm);
  // Of what lies beside its brick, and what reaches into the chunk from beside it.
  const BeamPiece seen = pieceOf<kind>(splat, beam, chunk);
  const float besideMm = set.marginMm + set.reachMm;
  BeamPiece piece = seen;
  const float grown = 1.0f + set.marginMm / fminf(seen.lateralMm, seen.elevationalMm);
  piece.lateralMm *= grown;
  piece.elevationalMm *= grown;
  piece.fromMm -= besideMm;
  piece.toMm = fminf(piece.toMm + besideMm, litToMm + set.marginMm);
  if (!(litToMm > 0.0f && piece.fromMm < piece.toMm))
  {
    return; // all of the block
  }
  sums.clear();
  __syncthreads();

  SurfaceIntensity intensity{};
  if (traced.intensity)
  {
    intensity = { traced.intensity + std::size_t(chunk.line) * traced.binCount, traced.binCount, 1.0f / traced.binMm };
  }
  ChunkSurfaceSum sum{ &sums, splat.scale, chunk.first, chunk.first + chunk.count - 1 };
  // Whether any of a piece's points can reach the chunk.
  const float aroundMm = set.spreadMm + set.reachMm;
  // Of a table's beam the ellipse holds the bricks' centres.
  const bool isTable = kind == BeamKind::Field || kind == BeamKind::Array;
  const float acrossMm = set.spreadMm + (isTable ? 0.8660254f * set.edgeMm + set.marginMm : 0.0f);
  const auto isNear = [&](const Vec3f& position) {
    const BeamPlace place = placeInBeam(position.x, position.y, position.z, beam, splat.grid);
    const float depthMm = place.position * splat.sampleMm;
    if (depthMm < seen.fromMm - aroundMm || depthMm > seen.toMm + aroundMm)
    {
      return false;
    }
    const float l = fmaxf(0.0f, fabsf(place.lateral) - acrossMm) / seen.lateralMm;
    const float e = fmaxf(0.0f, fabsf(place.elevational) - acrossMm) / seen.elevationalMm;
    return l * l + e * e < 1.0f;
  };
  const auto counts = [&](int p) {
    if constexpr (arePieces)
    {
      const SurfacePiece& item = set.pieces[p];
      const int row = surfaceRow(set.media, item.below, item.above);
      return isNear(item.positionMm) && pieceCounts(set.table, item, row, beam.axis);
    }
    else
    {
      return isNear(set.points[p].position);
    }
  };
  // Whether a point's blob reaches the chunk: most of those that are near do not.
  const auto reaches = [&](const SurfacePoint& point) {
    const BeamPlace place = placeInBeam(point.position.x, point.position.y, point.position.z, beam, splat.grid);
    float depth = place.position;
    if (kind == BeamKind::Array)
    {
      const float aside = place.lateral * place.lateral + place.elevational * place.elevational;
      depth = sqrtf(depth * depth + aside * splat.grid.samplesPerMm * splat.grid.samplesPerMm);
    }
    const float du = glm::dot(beam.axis, point.tangentU) * splat.grid.samplesPerMm;
    const float dv = glm::dot(beam.axis, point.tangentV) * splat.grid.samplesPerMm;
    const float reach = surfaceBlobReach * sqrtf(du * du + dv * dv + 1.0f / 6.0f) + 1.0f;
    return depth + reach >= float(sum.first) && depth - reach <= float(sum.last);
  };
  const auto splatItem = [&](int p) {
    if constexpr (arePieces)
    {
      const SurfacePiece item = set.pieces[p];
      const int cuts = set.net.cuts[(item.axis + 1) % 3];
      const int count = set.net.points(item.axis);
      const int row = surfaceRow(set.media, item.below, item.above);
      for (int n = 0; n < count; ++n)
      {
        SurfacePoint point = piecePoint(item, set.net, n % cuts, n / cuts);
        if (!reaches(point))
        {
          continue;
        }
        point.row = row;
        const std::uint32_t phase = surfacePhase(set.seed, item.voxel, item.axis, std::uint32_t(n));
        sincospif(float(phase) * (1.0f / 128.0f), &point.phaseIm, &point.phaseRe);
        addSurface(point, beam, splat.grid, set.table, intensity, sum);
      }
    }
    else
    {
      if (reaches(set.points[p]))
      {
        addSurface(set.points[p], beam, splat.grid, set.table, intensity, sum);
      }
    }
  };

  const Vec3f low = Vec3f(set.firstBrick) * set.edgeMm;
  const Vec3f high = Vec3f(set.firstBrick + set.bricks) * set.edgeMm;
  const BrickSight<kind> sight(splat, beam, set.edgeMm, set.marginMm);
  const CellRows rows(beam, piece, set.edgeMm, low, high);
  const int rowCount = rows.rowCount();
  const int lane = int(threadIdx.x) % warpLanes;
  const int warp = int(threadIdx.x) / warpLanes;
  int queued = 0;
  for (int r = warp; r < rowCount; r += blockThreads / warpLanes)
  {
    const CellRows::Row row = rows.row(r);
    for (int n = 0; n < row.count; ++n)
    {
      const Vec3i cell = rows.cell(row.layer, row.v, row.first + n);
      const Vec3i brick = cell - set.firstBrick;
      const Vec3f centre = (Vec3f(cell) + 0.5f) * set.edgeMm;
      if (unsigned(brick.x) >= unsigned(set.bricks.x) || unsigned(brick.y) >= unsigned(set.bricks.y) ||
          unsigned(brick.z) >= unsigned(set.bricks.z) || !sight.isAbove(centre, litToMm) || !sight.meets(centre))
      {
        continue;
      }
      const BrickRange range = set.ranges[brick.x + set.bricks.x * (brick.y + set.bricks.y * brick.z)];
      for (int first = 0; first < range.count; first += warpLanes)
      {
        const int p = range.first + first + lane;
        queues[warp].push(first + lane < range.count && counts(p), p, queued, splatItem);
      }
    }
  }
  queues[warp].finish(queued, splatItem);
  __syncthreads();
  writeChunk(splat, chunk, sums, true);
}

} // namespace sono
