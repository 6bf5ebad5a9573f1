#pragma once

#include "Cuda/DeviceEcho.cuh"
#include "Cuda/DevicePieces.cuh"
#include "Cuda/SplatChunk.cuh"
#include "Kernel/SurfaceEcho.h"
#include "Kernel/SurfacePiece.h"
#include "Scene/SurfaceFace.h"

#include <type_traits>

// Echoes of surfaces, as SurfaceEchoes on the CPU.

namespace sono {

constexpr int surfaceThreads = 128;
constexpr int surfaceSlices = 16; // blocks of a line at most

struct SurfaceLaunch
{
  SplatLaunch splat;
  TracedOnDevice traced;
  SurfaceSet set;
  EchoSum* sums; // lines x sumCount x (re, im)
};

/// A line's sums in units of 1 / scale: integers, so that their order does not matter.
struct LineSurfaceSum
{
  EchoSum* sums;
  float scale;

  SONO_HD void add([[maybe_unused]] int sample, [[maybe_unused]] float re, [[maybe_unused]] float im)
  {
#if defined(__CUDA_ARCH__)
    // One value fits into 32 bits, which are made faster; coherent echoes of a beam with a real weight have no second.
    atomicAdd(sums + 2 * sample, EchoSum((long long)(__float2int_rn(re * scale))));
    const int units = __float2int_rn(im * scale);
    if (units != 0)
    {
      atomicAdd(sums + 2 * sample + 1, EchoSum((long long)(units)));
    }
#endif
  }
};

/// Which groups of pieces a line may hear.
template<BeamKind kind>
class GroupSight
{
public:
  __device__ GroupSight(const SurfaceLaunch& launch, const Beam& beam, float reachMm)
    : beam_(beam)
    , bricks_(launch.splat, beam, launch.set.edgeMm, launch.set.marginMm)
    , reachMm_(reachMm)
  {
  }

  __device__ bool sees(const SurfaceGroup& group) const
  {
    const Vec3f q = group.centreMm - beam_.origin;
    const float r = glm::dot(q, beam_.axis);
    if (r < -group.radiusMm || r > reachMm_ + group.radiusMm)
    {
      return false;
    }
    const float l = fmaxf(0.0f, fabsf(glm::dot(q, beam_.lateral)) - group.radiusMm);
    const float e = fmaxf(0.0f, fabsf(glm::dot(q, beam_.elevation)) - group.radiusMm);
    if (kind == BeamKind::Array || kind == BeamKind::Field)
    {
      return bricks_.meets(group.brickMm);
    }
    // Between two depths a beam is widest at one of them.
    const ProfileAt near = gaussianAt(beam_, fmaxf(0.0f, r - group.radiusMm));
    const ProfileAt far = gaussianAt(beam_, fmaxf(0.0f, r + group.radiusMm));
    return l * l * fminf(near.perLateral2, far.perLateral2) + e * e * fminf(near.perElevational2, far.perElevational2) <
           1.1f * beamCutSigma * beamCutSigma;
  }

private:
  const Beam& beam_;
  BrickSight<kind> bricks_;
  float reachMm_;
};

/// A piece that a line hears.
struct HeardPiece
{
  int item;
  SurfaceHearing hearing;
};

constexpr int groupsAtOnce = 4; // of a warp

/// What the threads of a block found.
struct HeardPieces
{
  HeardPiece items[groupsAtOnce * surfaceThreads];
  int count;

  __device__ void push(bool found, const HeardPiece& item)
  {
    if (found)
    {
      items[atomicAdd(&count, 1)] = item;
    }
  }
};

/// Adds what pieces (or points of targets) echo into a line; the groups are shared out among the line's blocks and
/// their warps. The lanes of a warp look which groups are near, then at the pieces of one group at a time.
template<BeamKind kind, class Item>
__global__ void __launch_bounds__(surfaceThreads) splatSurfaceGroups(SurfaceLaunch launch)
{
  constexpr bool arePieces = std::is_same_v<Item, SurfacePiece>;
  constexpr int warps = surfaceThreads / warpLanes;
  __shared__ HeardPieces diffuse;
  __shared__ HeardPieces coherent;
  __shared__ BeamTables tables;
  const SplatLaunch& splat = launch.splat;
  const SurfaceSet& set = launch.set;
  const int line = int(blockIdx.x);
  Beam beam = wholeBeam(splat, line, tables);
  beam.kind = kind;
  const TracedOnDevice& traced = launch.traced;
  const float litToMm =
    litMm(traced.intensity, traced.binCount, traced.binMm, line, float(splat.sumCount) * splat.sampleMm);
  if (!(litToMm > 0.0f))
  {
    return; // all of the block
  }
  SurfaceIntensity intensity{};
  if (traced.intensity)
  {
    intensity = { traced.intensity + std::size_t(line) * traced.binCount, traced.binCount, 1.0f / traced.binMm };
  }
  LineSurfaceSum sum{ launch.sums + 2 * std::size_t(line) * splat.sumCount, splat.scale };

  const int lane = int(threadIdx.x) % warpLanes;
  const int warp = int(threadIdx.x) / warpLanes;

  const auto hear = [&](int p) {
    if constexpr (arePieces)
    {
      const SurfacePiece& item = set.pieces[p];
      const PieceBounds bounds = pieceBounds(item, set.longestStepMm);
      const bool isCoarse = set.nets.isCoarsest(set.nets.coherentCuts(item));
      const int row = surfaceRow(set.media, item.below, item.above);
      SurfaceHearing heard = hearSurface(item.positionMm, bounds.normal, bounds.radiusMm, isCoarse, row, beam,
                                         splat.grid, set.table, intensity);
      // Also where only other lines, or other images, had the piece fitted.
      const bool isHeard = (heard.diffuse || heard.coherent) &&
                           mayHearSurface(faceMiddleMm(item.voxel, item.axis, set.nets.spacingMm), item.roughNormal,
                                          2.0f * set.longestStepMm, row, beam, splat.grid, set.table);
      heard.diffuse = heard.diffuse && isHeard;
      heard.coherent = heard.coherent && isHeard;
      return heard;
    }
    else
    {
      const SurfacePoint& item = set.points[p];
      return hearSurface(item.position, item.normal, 0.0f, false, item.row, beam, splat.grid, set.table, intensity);
    }
  };
  const auto diffusePoints = [&](int p) { return arePieces ? set.nets.diffuseNet(set.pieces[p]).points() : 1; };
  const auto coherentPoints = [&](int p) { return arePieces ? set.nets.coherentNet(set.pieces[p]).points() : 1; };
  const auto addDiffuseOf = [&](const HeardPiece& heard, [[maybe_unused]] int number) {
    if constexpr (arePieces)
    {
      const SurfacePiece item = set.pieces[heard.item];
      SurfacePoint point = piecePoint(item, set.nets.diffuseNet(item), number);
      point.row = surfaceRow(set.media, item.below, item.above);
      const std::uint32_t phase = surfacePhase(set.seed, item.voxel, item.axis, std::uint32_t(number));
      sincospif(float(phase) * (1.0f / 128.0f), &point.phaseIm, &point.phaseRe);
      addDiffuse(point, beam, splat.grid, set.table, heard.hearing, sum);
    }
    else
    {
      addDiffuse(set.points[heard.item], beam, splat.grid, set.table, heard.hearing, sum);
    }
  };
  const auto addCoherentOf = [&](const HeardPiece& heard, [[maybe_unused]] int number) {
    if constexpr (arePieces)
    {
      const SurfacePiece item = set.pieces[heard.item];
      SurfacePoint point = piecePoint(item, set.nets.coherentNet(item), number);
      point.row = surfaceRow(set.media, item.below, item.above);
      addCoherent(point, beam, splat.grid, set.table, heard.hearing, sum);
    }
    else
    {
      addCoherent(set.points[heard.item], beam, splat.grid, set.table, heard.hearing, sum);
    }
  };
  // Pieces have different numbers of points: warps take turns with the pieces, and a warp shares out the points of its
  // own evenly.
  const auto addPoints = [&](const HeardPieces& heard, const auto& points, const auto& add) {
    for (int first = warp; first < heard.count; first += surfaceThreads)
    {
      const int n = first + lane * warps;
      forItemsOfWarp(n < heard.count ? points(heard.items[n].item) : 0, [&](int owner, int number) {
        if (owner >= 0)
        {
          add(heard.items[first + owner * warps], number);
        }
      });
    }
  };

  // The block looks at groups until enough pieces are heard, then all its threads work on those.
  const GroupSight<kind> sight(launch, beam, litToMm + surfaceCrossingMm + set.marginMm);
  // Neighbouring groups go to different warps: lines hear them together.
  const int stride = int(gridDim.y) * warps;
  int base = int(blockIdx.y) * warps + warp - stride * warpLanes;
  unsigned near = 0u;
  bool isLeft = true;
  while (__syncthreads_or(isLeft))
  {
    if (threadIdx.x == 0)
    {
      diffuse.count = 0;
      coherent.count = 0;
    }
    __syncthreads();
    for (int looked = 0; isLeft && looked < groupsAtOnce;)
    {
      if (near == 0u)
      {
        base += stride * warpLanes;
        isLeft = base < set.groupCount;
        const int own = base + lane * stride;
        near = __ballot_sync(allLanes, own < set.groupCount && sight.sees(set.groups[own]));
        continue;
      }
      const SurfaceGroup& group = set.groups[base + (__ffs(int(near)) - 1) * stride];
      near &= near - 1u;
      ++looked;
      const int p = group.first + lane;
      const SurfaceHearing heard = lane < group.count ? hear(p) : SurfaceHearing{ 0.0f, 0.0f, false, false };
      diffuse.push(heard.diffuse, { p, heard });
      coherent.push(heard.coherent, { p, heard });
    }
    __syncthreads();
    addPoints(diffuse, diffusePoints, addDiffuseOf);
    addPoints(coherent, coherentPoints, addCoherentOf);
  }
}

} // namespace sono
