#pragma once

#include "Cuda/DeviceEcho.cuh"
#include "Cuda/SplatChunk.cuh"
#include "Kernel/FibreView.h"
#include "Kernel/NestedCells.h"

// Scatterers whose density follows the resolution cell, as NestedScatterers and the walk over its bricks on the CPU.

namespace sono {

struct NestedLaunch
{
  SplatLaunch splat;
  TracedOnDevice traced;
  const std::uint8_t* voxels;
  Vec3i size;
  Vec3f perMm;
  Vec3f extentMm;
  const NestedMedium* media; // 256
  const float* fibreScale;   // 256
  FibreView fibres;
  DensityView density;
  std::uint64_t seed;
  int level;
  float fromMm; // between which bricks of the level may be taken
  float toMm;
};

/// A block adds what the bricks of one level echo into a chunk of a line. Lanes of a warp look at rows of bricks, then
/// at their bricks, then at the bricks' candidates, each time as many at once as there are.
template<BeamKind kind>
__global__ void __launch_bounds__(blockThreads, 8) splatNestedCells(NestedLaunch launch)
{
  __shared__ ShortSums sums;
  __shared__ NestedMedium media[256];
  __shared__ float fibreScale[256];
  __shared__ BeamTables tables;
  const SplatLaunch& splat = launch.splat;
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
  piece.fromMm = fmaxf(piece.fromMm, launch.fromMm);
  piece.toMm = fminf(piece.toMm, fminf(launch.toMm, litToMm));
  if (!(piece.fromMm < piece.toMm))
  {
    return; // all of the block
  }
  for (int m = threadIdx.x; m < 256; m += blockThreads)
  {
    media[m] = launch.media[m];
    fibreScale[m] = launch.fibreScale[m];
  }
  sums.clear();
  __syncthreads();

  const float brickMm = nestedCellMm(launch.level) * float(nestedBrickCells);
  const BrickSight<kind> sight(splat, beam, brickMm);
  const Vec2f halfMm = nestedHalfExtent(beam, launch.level);
  const auto shareOf = [&](const Vec3i& brick) {
    const NestedShare none{ 0, 0, 0.0f, 0.0f };
    const Vec3f centre = nestedBrickCentre(brick, launch.level);
    const Vec3f end = launch.extentMm + 0.5f * brickMm;
    const bool isInside =
      brick.x >= 0 && brick.y >= 0 && brick.z >= 0 && centre.x < end.x && centre.y < end.y && centre.z < end.z;
    if (!isInside || !sight.isAbove(centre, litToMm) || !sight.meets(centre))
    {
      return none;
    }
    // An array echoes from the range.
    if (kind != BeamKind::Array && !(sight.isBelow(centre, chunk.fromMm) && sight.isAbove(centre, chunk.toMm)))
    {
      return none;
    }
    const Vec3f parent = nestedBrickCentre({ brick.x >> 1, brick.y >> 1, brick.z >> 1 }, launch.level + 1);
    const float depthMm = glm::dot(centre - beam.origin, beam.axis);
    if (!launch.density.takes(launch.level, depthMm, glm::dot(parent - beam.origin, beam.axis)))
    {
      return none;
    }
    const Vec3f q = centre - beam.origin;
    return relativeWeight(beam, q, depthMm, halfMm) >= nestedLeastWeight
             ? launch.density.share(launch.level, depthMm, relativeWeight(beam, q, depthMm))
             : none;
  };
  const auto splatCandidate = [&](const NestedCell& brick, float scale, int number) {
    const NestedCandidate c = nestedCandidate(nestedFinestCell(brick, launch.level, number));
    const Vec3f p = c.positionMm;
    const SeenEcho<kind> echo = seenEcho<kind>(splat, beam, chunk, placeInBeam(p.x, p.y, p.z, beam, splat.grid));
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
    if (fibreScale[tissue] > 0.0f)
    {
      const float cosine = glm::dot(launch.fibres.at(voxel), beam.axis) * fibreScale[tissue];
      amplitude *= expNegative(-cosine * cosine);
    }
    addScatterer(sums, splitScatterer(times(echo.weight, amplitude), echo.position, splat.grid), chunk.first,
                 splat.scale);
  };

  const CellRows bricks(beam, piece, brickMm, Vec3f(0.0f), launch.extentMm);
  forCells(bricks, [&](bool exists, const Vec3i& own) {
    const NestedShare share = exists ? shareOf(own) : NestedShare{ 0, 0, 0.0f, 0.0f };
    const std::uint32_t ownHash = share.count > 0 ? nestedBrickHash(launch.seed, own, launch.level) : 0u;
    forItemsOfWarp(share.count, [&](int owner, int number) {
      const NestedCell brick{ { __shfl_sync(allLanes, own.x, owner), __shfl_sync(allLanes, own.y, owner),
                                __shfl_sync(allLanes, own.z, owner) },
                              __shfl_sync(allLanes, ownHash, owner) };
      const NestedShare part{ 0, __shfl_sync(allLanes, share.whole, owner), __shfl_sync(allLanes, share.last, owner),
                              __shfl_sync(allLanes, share.scale, owner) };
      if (owner >= 0)
      {
        splatCandidate(brick, part.scaleOf(number), number);
      }
    });
  });
  __syncthreads();
  writeChunk(splat, chunk, sums, true);
}

} // namespace sono
