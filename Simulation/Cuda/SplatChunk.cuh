#pragma once

#include "Kernel/BeamDeposit.h"
#include "Kernel/BeamField.h"
#include "Kernel/BeamSight.h"
#include "Kernel/EchoSplat.h"

#include "Cuda/LineChunk.cuh"

namespace sono {

/// What both kinds of scatterers share.
struct SplatLaunch
{
  const Beam* beams;
  LineGrid grid;
  float sampleMm;
  int sumCount;
  float scale; // of a sum's unit
  bool hasField;
  BeamFieldView field;
  bool hasSight;
  BeamSightView sight;
  float lateralMm; // half axes of the ellipse around the axis that holds all that the beam sees
  float elevationalMm;
  float perLateralSigma;
  float perElevationalSigma;
  float2* sum;

  /// Weight of the beam at a place, 0 where it does not see.
  __device__ float weight(const BeamPlace& p) const
  {
    if (!(p.position >= 0.0f && p.position < grid.lastSample))
    {
      return 0.0f;
    }
    if (hasField)
    {
      return beamWeight(field, p.lateral, p.elevational, fminf(p.position * sampleMm, field.depth.highMm));
    }
    const float squared = squaredSigmas(p, perLateralSigma, perElevationalSigma);
    return squared < beamCutSigma * beamCutSigma ? expNegative(-0.5f * squared) : 0.0f;
  }
  __device__ bool sightMeets(const Beam& beam, const Vec3f& centre) const
  {
    const Vec3f q = centre - beam.origin;
    return !hasSight || sight.sees(glm::dot(q, beam.lateral), glm::dot(q, beam.elevation), glm::dot(q, beam.axis));
  }
};

/// A piece of a line: its samples and the depths that scatterers into them have.
struct Chunk
{
  int line;
  int first;
  int count;
  float fromMm;
  float toMm;

  __device__ bool holds(const BeamPlace& p) const
  {
    return p.position >= float(first - 1) && p.position < float(first + count);
  }
};

inline __device__ Chunk chunkOf(const SplatLaunch& launch)
{
  const int first = int(blockIdx.y) * chunkSamples;
  const int count = min(chunkSamples, launch.sumCount - first);
  return { int(blockIdx.x), first, count, float(first - 1) * launch.sampleMm, float(first + count) * launch.sampleMm };
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
