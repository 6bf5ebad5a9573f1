#pragma once

#include "Cuda/DeviceEcho.cuh"
#include "Cuda/SplatChunk.cuh"
#include "Kernel/DetailCode.h"
#include "Kernel/FibreView.h"
#include "Kernel/NestedCells.h"

// Scatterers whose density follows the resolution cell, as NestedScatterers and the walk over its bricks on the CPU.

namespace sono {

/// A level in use.
struct NestedLevel
{
  BeamSightView sight;     // of a field
  const BeamPiece* pieces; // of each chunk
  int level;
  float fromMm; // between which bricks of the level may be taken
  float toMm;
};

struct NestedLaunch
{
  SplatLaunch splat;
  TracedOnDevice traced;
  NestedLevel levels[nestedLevels];
  int* sums; // lines x sumCount x (re, im)
  const std::uint8_t* voxels;
  const std::uint8_t* detail; // codes, or null
  Vec3i size;
  Vec3f perMm;
  Vec3f extentMm;
  const NestedMedium* media; // 256
  const float* fibreScale;   // 256
  FibreView fibres;
  DensityView density;
  std::uint64_t seed;
};

/// How far what a brick of a level holds may lie in front of its middle or behind it, mm.
SONO_HD inline float nestedHaloMm(int level)
{
  return halfDiagonal * nestedCellMm(level) * float(nestedBrickCells);
}

/// Samples of the window that the bricks of a chunk of a line echo into. An array's echo from the range: they are asked
/// for by every chunk.
SONO_HD inline int nestedHaloSamples(BeamKind kind, int level, float samplesPerMm)
{
  return kind == BeamKind::Array ? 0 : int(nestedHaloMm(level) * samplesPerMm) + 2;
}

/// A block adds what the bricks of one level whose middles lie in a chunk of a line echo. Lanes of a warp look at rows
/// of bricks, then at their bricks, then at the bricks' candidates, each time as many at once as there are.
template<BeamKind kind>
__global__ void __launch_bounds__(blockThreads, 8) splatNestedCells(NestedLaunch launch)
{
  extern __shared__ int window[];
  __shared__ NestedMedium media[256];
  __shared__ float fibreScale[256];
  __shared__ BeamTables tables;
  const NestedLevel& own = launch.levels[blockIdx.z];
  SplatLaunch splat = launch.splat;
  splat.sight = own.sight;
  splat.pieces = own.pieces;
  const Chunk chunk = chunkOf(splat);
  const Beam beam = wholeBeam(splat, chunk.line, tables);
  const float deepestMm = float(splat.sumCount) * splat.sampleMm;
  const float litToMm =
    litMm(launch.traced.intensity, launch.traced.binCount, launch.traced.binMm, chunk.line, deepestMm);
  BeamPiece piece = pieceOf<kind>(splat, beam, chunk);
  if (kind == BeamKind::Gaussian || kind == BeamKind::Aperture)
  {
    piece.lateralMm *= nestedReach;
    piece.elevationalMm *= nestedReach;
  }
  piece.fromMm = fmaxf(piece.fromMm, own.fromMm);
  // The middle of a brick whose front is lit may lie in the dark.
  piece.toMm = fminf(piece.toMm, fminf(own.toMm, litToMm + nestedHaloMm(own.level)));
  if (!(piece.fromMm < piece.toMm))
  {
    return; // all of the block
  }
  for (int m = threadIdx.x; m < 256; m += blockThreads)
  {
    media[m] = launch.media[m];
    fibreScale[m] = launch.fibreScale[m];
  }
  const int halo = nestedHaloSamples(kind, own.level, splat.grid.samplesPerMm);
  Chunk seen = chunk; // with all that its bricks hold
  seen.first = chunk.first - halo;
  seen.count = chunk.count + 2 * halo;
  WindowSums sums{ window, seen.count };
  sums.clear();
  __syncthreads();

  const float brickMm = nestedCellMm(own.level) * float(nestedBrickCells);
  const BrickSight<kind> sight(splat, beam, brickMm);
  const Vec2f halfMm = nestedHalfExtent(beam, own.level);
  const bool isFirst = chunk.first == 0;
  const bool isLast = chunk.first + chunk.count == splat.sumCount;
  const float firstMm = float(chunk.first) * splat.sampleMm;
  const float endMm = float(chunk.first + chunk.count) * splat.sampleMm;
  const auto shareOf = [&](const Vec3i& brick) {
    const NestedShare none{ 0, 0, 0.0f, 0.0f };
    const Vec3f centre = nestedBrickCentre(brick, own.level);
    const Vec3f end = launch.extentMm + 0.5f * brickMm;
    const bool isInside =
      brick.x >= 0 && brick.y >= 0 && brick.z >= 0 && centre.x < end.x && centre.y < end.y && centre.z < end.z;
    if (!isInside || !sight.isAbove(centre, litToMm) || !sight.meets(centre))
    {
      return none;
    }
    const Vec3f q = centre - beam.origin;
    const float depthMm = nestedBrickDepth(brick, own.level, beam.origin, beam.axis);
    if (kind != BeamKind::Array && !((isFirst || depthMm >= firstMm) && (isLast || depthMm < endMm)))
    {
      return none;
    }
    const Vec3i parent(brick.x >> 1, brick.y >> 1, brick.z >> 1);
    if (!launch.density.takes(own.level, depthMm, nestedBrickDepth(parent, own.level + 1, beam.origin, beam.axis)))
    {
      return none;
    }
    return relativeWeight(beam, q, depthMm, halfMm) >= nestedLeastWeight
             ? launch.density.share(own.level, depthMm, relativeWeight(beam, q, depthMm, nestedInward * halfMm))
             : none;
  };
  const auto splatCandidate = [&](const NestedCell& brick, float scale, int number) {
    const NestedCandidate c = nestedCandidate(nestedFinestCell(brick, own.level, number));
    const Vec3f p = c.positionMm;
    const SeenEcho<kind> echo = seenEcho<kind>(splat, beam, seen, placeInBeam(p.x, p.y, p.z, beam, splat.grid));
    if (isZero(echo.weight))
    {
      return;
    }
    const Vec3i voxel(int(floorf(p.x * launch.perMm.x)), int(floorf(p.y * launch.perMm.y)),
                      int(floorf(p.z * launch.perMm.z)));
    if (unsigned(voxel.x) >= unsigned(launch.size.x) || unsigned(voxel.y) >= unsigned(launch.size.y) ||
        unsigned(voxel.z) >= unsigned(launch.size.z))
    {
      return;
    }
    const std::size_t at =
      std::size_t(voxel.x) + std::size_t(launch.size.x) * (std::size_t(voxel.y) + std::size_t(launch.size.y) * voxel.z);
    const int tissue = launch.voxels[at];
    float amplitude = c.amplitude(media[tissue]) * scale;
    if (amplitude == 0.0f)
    {
      return;
    }
    amplitude *= launch.detail ? detailFactor(launch.detail[at]) : 1.0f;
    if (fibreScale[tissue] > 0.0f)
    {
      const float cosine = glm::dot(launch.fibres.at(voxel), beam.axis) * fibreScale[tissue];
      amplitude *= expNegative(-cosine * cosine);
    }
    addScatterer(sums, splitScatterer(times(echo.weight, amplitude), echo.position, splat.grid), seen.first,
                 splat.scale);
  };

  const CellRows bricks(beam, piece, brickMm, Vec3f(0.0f), launch.extentMm);
  forCells(bricks, [&](bool exists, const Vec3i& lanes) {
    const NestedShare share = exists ? shareOf(lanes) : NestedShare{ 0, 0, 0.0f, 0.0f };
    const std::uint32_t lanesHash = share.count > 0 ? nestedBrickHash(launch.seed, lanes, own.level) : 0u;
    forItemsOfWarp(share.count, [&](int owner, int number) {
      const NestedCell brick{ { __shfl_sync(allLanes, lanes.x, owner), __shfl_sync(allLanes, lanes.y, owner),
                                __shfl_sync(allLanes, lanes.z, owner) },
                              __shfl_sync(allLanes, lanesHash, owner) };
      const NestedShare part{ 0, __shfl_sync(allLanes, share.whole, owner), __shfl_sync(allLanes, share.last, owner),
                              __shfl_sync(allLanes, share.scale, owner) };
      if (owner >= 0)
      {
        splatCandidate(brick, part.scaleOf(number), number);
      }
    });
  });
  __syncthreads();
  int* to = launch.sums + 2 * std::size_t(chunk.line) * splat.sumCount;
  for (int i = threadIdx.x; i < 2 * sums.samples(); i += blockThreads)
  {
    const int sample = seen.first + i / 2;
    const int value = window[i];
    if (value != 0 && sample >= 0 && sample < splat.sumCount)
    {
      atomicAdd(to + 2 * seen.first + i, value);
    }
  }
}

} // namespace sono
