#pragma once

#include "Cuda/LineChunk.cuh"
#include "Kernel/ApertureProfile.h"
#include "Kernel/ArrayBeam.h"
#include "Kernel/ArraySightView.h"
#include "Kernel/BeamField.h"
#include "Kernel/BeamSight.h"
#include "Kernel/EchoSplat.h"

#include <type_traits>

namespace sono {

constexpr int warpLanes = 32;
constexpr unsigned allLanes = 0xffffffffu;
constexpr int blockThreads = 128;
constexpr float darkIntensity = 1e-8f; // -160 dB

/// What all kinds of scatterers share. Which of the tables are there depends on the kind of the beams.
struct SplatLaunch
{
  const Beam* beams;
  LineGrid grid;
  float sampleMm;
  int sumCount;
  float scale; // of a sum's unit
  BeamFieldView field;
  BeamSightView sight; // of the field, for the scatterers' bricks
  ArrayBeamView array;
  ArraySightView arraySight;
  const BeamPiece* pieces; // of each chunk, what a line straight ahead sees
  float perLateralSigma;   // of a Gaussian
  float perElevationalSigma;
  float2* sum;
};

/// A piece of a line: its samples and the depths that scatterers into them have.
struct Chunk
{
  int line;
  int number;
  int first;
  int count;
  float fromMm;
  float toMm;

  __device__ bool holds(float position) const
  {
    return position >= float(first - 1) && position < float(first + count);
  }
};

/// The deep ones, where beams are wide, come first.
inline __device__ Chunk chunkOf(const SplatLaunch& launch)
{
  const int number = int(gridDim.y - 1 - blockIdx.y);
  const int first = number * chunkSamples;
  const int count = min(chunkSamples, launch.sumCount - first);
  return {
    int(blockIdx.x), number, first, count, float(first - 1) * launch.sampleMm, float(first + count) * launch.sampleMm
  };
}

/// What a line of a kind sees of a chunk.
template<BeamKind kind>
__device__ BeamPiece pieceOf(const SplatLaunch& launch, const Beam& beam, const Chunk& chunk)
{
  BeamPiece piece = launch.pieces[chunk.number];
  if (kind == BeamKind::Aperture)
  {
    piece.lateralMm /= sqrtf(beam.profile.lateral.cosine2);
    piece.elevationalMm /= sqrtf(beam.profile.elevational.cosine2);
  }
  if (kind == BeamKind::Array)
  {
    piece.lateralMm /= beam.lateralCosine;
    piece.elevationalMm /= beam.elevationalCosine;
  }
  return piece;
}

/// The weight of a beam of a kind.
template<BeamKind kind>
using KindsWeight = std::conditional_t<kind == BeamKind::Array, ComplexWeight, float>;

__device__ inline float times(float weight, float a)
{
  return weight * a;
}
__device__ inline ComplexWeight times(const ComplexWeight& weight, float a)
{
  return { weight.re * a, weight.im * a };
}
__device__ inline bool isZero(float weight)
{
  return weight == 0.0f;
}
__device__ inline bool isZero(const ComplexWeight& weight)
{
  return weight.re == 0.0f && weight.im == 0.0f;
}

/// What a beam makes of a unit scatterer, and from where on the line it echoes, in samples.
template<BeamKind kind>
struct SeenEcho
{
  KindsWeight<kind> weight;
  float position;
};

/// Of a scatterer at a place; 0 where the beam does not see it or it echoes into another chunk.
template<BeamKind kind>
__device__ SeenEcho<kind> seenEcho(const SplatLaunch& launch, const Beam& beam, const Chunk& chunk, const BeamPlace& p)
{
  const LineGrid& grid = launch.grid;
  const auto isOnLine = [&](float position) { return chunk.holds(position) && position < grid.lastSample; };
  if constexpr (kind == BeamKind::Array)
  {
    const float depthMm = p.position * launch.sampleMm;
    const float rangeMm = sqrtf(depthMm * depthMm + p.lateral * p.lateral + p.elevational * p.elevational);
    const float position = rangeMm * grid.samplesPerMm;
    if (!(p.position >= 0.0f && isOnLine(position)))
    {
      return { { 0.0f, 0.0f }, position };
    }
    const ComplexWeight w =
      arrayBeamWeight(launch.array, p.lateral * beam.lateralCosine, p.elevational * beam.elevationalCosine, rangeMm);
    return { times(w, beam.gain), position };
  }
  else
  {
    if (!(p.position >= 0.0f && isOnLine(p.position)))
    {
      return { 0.0f, p.position };
    }
    if constexpr (kind == BeamKind::Field)
    {
      const float depthMm = fminf(p.position * launch.sampleMm, launch.field.depth.highMm);
      return { beamWeight(launch.field, p.lateral, p.elevational, depthMm), p.position };
    }
    ProfileAt at{ launch.perLateralSigma * launch.perLateralSigma,
                  launch.perElevationalSigma * launch.perElevationalSigma, 1.0f };
    if constexpr (kind == BeamKind::Aperture)
    {
      at = profileAt(beam.profile, p.position * launch.sampleMm);
    }
    const float squared = p.lateral * p.lateral * at.perLateral2 + p.elevational * p.elevational * at.perElevational2;
    return { squared < beamCutSigma * beamCutSigma ? at.amplitude * expNegative(-0.5f * squared) : 0.0f, p.position };
  }
}

/// Which bricks a beam must visit, as on the CPU (see BrickWalk): half a brick's extent along the beam's directions.
template<BeamKind kind>
class BrickSight
{
public:
  /// What a brick holds may lie `marginMm` outside.
  __device__ BrickSight(const SplatLaunch& launch, const Beam& beam, float edgeMm, float marginMm = 0.0f)
    : launch_(launch)
    , beam_(beam)
    , axial_(halfExtent(beam.axis, edgeMm) + marginMm)
    , lateral_(halfExtent(beam.lateral, edgeMm) + marginMm)
    , elevation_(halfExtent(beam.elevation, edgeMm) + marginMm)
  {
  }

  /// Whether a brick begins above a depth.
  __device__ bool isAbove(const Vec3f& centre, float depthMm) const
  {
    return glm::dot(centre - beam_.origin, beam_.axis) < depthMm + axial_;
  }
  __device__ bool meets(const Vec3f& centre) const
  {
    if (kind != BeamKind::Field && kind != BeamKind::Array)
    {
      return true;
    }
    const Vec3f q = centre - beam_.origin;
    const float r = glm::dot(q, beam_.axis);
    const float lateral = glm::dot(q, beam_.lateral);
    const float elevational = glm::dot(q, beam_.elevation);
    if (kind == BeamKind::Field)
    {
      return launch_.sight.sees(lateral, elevational, r);
    }
    return launch_.arraySight.sees(fmaxf(0.0f, fabsf(lateral) - lateral_) * beam_.lateralCosine,
                                   fmaxf(0.0f, fabsf(elevational) - elevation_) * beam_.elevationalCosine, r - axial_,
                                   r + axial_);
  }

private:
  __device__ static float halfExtent(const Vec3f& direction, float edgeMm)
  {
    return 0.5f * edgeMm * (fabsf(direction.x) + fabsf(direction.y) + fabsf(direction.z));
  }

  const SplatLaunch& launch_;
  const Beam& beam_;
  float axial_;
  float lateral_;
  float elevation_;
};

/// Tables that a whole beam points to, in a block's shared memory.
struct BeamTables
{
  BeamFieldView field;
  ArrayBeamView array;
  ArraySightView arraySight;
};

/// A line's beam with its tables, for functions that take any kind. All threads of a block; they must synchronise
/// before they use it.
inline __device__ Beam wholeBeam(const SplatLaunch& launch, int line, BeamTables& tables)
{
  if (threadIdx.x == 0)
  {
    tables.field = launch.field;
    tables.array = launch.array;
    tables.arraySight = launch.arraySight;
  }
  Beam beam = launch.beams[line];
  beam.field = &tables.field;
  beam.array = &tables.array;
  beam.arraySight = &tables.arraySight;
  return beam;
}

/// Depth below which a line sees nothing, as on the CPU (see LineFinisher). All threads of a block.
inline __device__ float litMm(const float* intensity, int binCount, float binMm, int line, float deepestMm)
{
  if (!intensity)
  {
    return deepestMm;
  }
  __shared__ int lit; // bins up to the last one that is lit
  if (threadIdx.x == 0)
  {
    lit = 0;
  }
  __syncthreads();
  const float* bins = intensity + std::size_t(line) * binCount;
  int own = 0;
  for (int b = threadIdx.x; b < binCount; b += blockDim.x)
  {
    own = bins[b] > darkIntensity ? b + 1 : own;
  }
  atomicMax(&lit, own);
  __syncthreads();
  return lit == 0 ? 0.0f : (lit == binCount ? deepestMm : fminf(deepestMm, (float(lit) + 0.5f) * binMm));
}

/// The block goes through the cells of all rows; lanes of a warp together. visit(exists, cell).
template<class Visit>
__device__ void forCells(const CellRows& rows, const Visit& visit)
{
  const int rowCount = rows.rowCount();
  for (int first = int(threadIdx.x) / warpLanes * warpLanes; first < rowCount; first += blockThreads)
  {
    const int r = first + int(threadIdx.x) % warpLanes;
    const CellRows::Row row = r < rowCount ? rows.row(r) : CellRows::Row{ 0, 0, 0, 0 };
    forItemsOfWarp(row.count, [&](int owner, int place) {
      const int layer = __shfl_sync(allLanes, row.layer, owner);
      const int v = __shfl_sync(allLanes, row.v, owner);
      const int u = __shfl_sync(allLanes, row.first, owner) + place;
      visit(owner >= 0, rows.cell(layer, v, u));
    });
  }
}

/// Writes or adds the chunk's sums.
template<class Sums>
__device__ void writeChunk(const SplatLaunch& launch, const Chunk& chunk, const Sums& sums, bool add)
{
  float2* to = launch.sum + std::size_t(chunk.line) * launch.sumCount + chunk.first;
  const float perUnit = 1.0f / launch.scale;
  for (int s = threadIdx.x; s < chunk.count; s += blockDim.x)
  {
    float2 v{ sums.value(2 * s, perUnit), sums.value(2 * s + 1, perUnit) };
    if (add)
    {
      v.x += to[s].x;
      v.y += to[s].y;
    }
    to[s] = v;
  }
}

} // namespace sono
