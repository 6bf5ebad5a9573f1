#include "Echo/HeardSurfaces.h"

#include "Core/Simd.h"
#include "Echo/WithProfile.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int chunk = vectorWidth;

/// By how they face the beam, and whether they lie on the line.
SONO_SIMD_CLONES __attribute__((flatten)) void markFacing(const FaceList& faces, float radiusMm, const Beam b,
                                                          const LineGrid g, std::int32_t* heard)
{
  const float *x = faces.x.data(), *y = faces.y.data(), *z = faces.z.data();
  const float *nx = faces.normalX.data(), *ny = faces.normalY.data(), *nz = faces.normalZ.data();
  const float *below = faces.cosineBelow.data(), *above = faces.cosineAbove.data();
  const int count = inWholeVectors(faces.count);
  const auto mark = [&](const auto& sees) {
#pragma GCC ivdep
    for (int n = 0; n < count; ++n)
    {
      const float along = nx[n] * b.axis.x + ny[n] * b.axis.y + nz[n] * b.axis.z;
      const BeamPlace place = placeInBeam(x[n], y[n], z[n], b, g);
      const bool faced = std::fabs(along) >= (along < 0.0f ? above[n] : below[n]);
      const bool unknown = !(nx[n] * nx[n] + ny[n] * ny[n] + nz[n] * nz[n] > 0.0f);
      const float depthMm = place.position / g.samplesPerMm;
      const bool isOnLine = (depthMm + radiusMm >= 0.0f) & (place.position - radiusMm * g.samplesPerMm <= g.lastSample);
      const float l = larger(0.0f, std::fabs(place.lateral) - radiusMm);
      const float e = larger(0.0f, std::fabs(place.elevational) - radiusMm);
      heard[n] = (faced | unknown) & isOnLine & sees(larger(depthMm, 0.0f), l, e) ? 1 : 0;
    }
  };
  if (!isGaussian(b))
  {
    mark([](float, float, float) { return true; });
    return;
  }
  withProfile(b, [&](const auto& profile) {
    mark([&](float depthMm, float l, float e) { return maySee(profile(depthMm), l, e); });
  });
}

/// Of each piece how it is met, chunk by chunk.
struct PieceMeetings
{
  float position[chunk], lateral[chunk], elevational[chunk], along[chunk];
  float reach[chunk], coherentReach[chunk], decayPerMm[chunk], fromMm[chunk], depthMm[chunk];
};

inline void meetPieces(const PieceList& pieces, int from, const Beam& b, const LineGrid& g, const SurfaceTable& t,
                       PieceMeetings& m)
{
  const float *x = pieces.x.data() + from, *y = pieces.y.data() + from, *z = pieces.z.data() + from;
  const float *nx = pieces.normalX.data() + from, *ny = pieces.normalY.data() + from;
  const float* nz = pieces.normalZ.data() + from;
  const bool isByRange = b.kind == BeamKind::Array;
#pragma GCC ivdep
  for (int i = 0; i < chunk; ++i)
  {
    const BeamPlace place = placeInBeam(x[i], y[i], z[i], b, g);
    const float along = across(nx, ny, nz, i, b.axis);
    const float straightMm = place.position / g.samplesPerMm;
    const float rangeMm =
      quickSqrt(straightMm * straightMm + place.lateral * place.lateral + place.elevational * place.elevational);
    const float depthMm = isByRange ? rangeMm : straightMm;
    const float faced = std::fabs(along) > 1e-6f ? along : 1e-6f; // nobody hears what faces away further
    m.position[i] = place.position;
    m.lateral[i] = place.lateral;
    m.elevational[i] = place.elevational;
    m.along[i] = along;
    m.depthMm[i] = depthMm;
    m.fromMm[i] =
      litFromMm(place, depthMm, across(nx, ny, nz, i, b.lateral), across(nx, ny, nz, i, b.elevation), faced, t);
  }
  const float *reachA = pieces.reachA.data() + from, *reachB = pieces.reachB.data() + from;
  const float *coherentA = pieces.coherentReachA.data() + from, *coherentB = pieces.coherentReachB.data() + from;
  const float *decayA = pieces.decayPerMmA.data() + from, *decayB = pieces.decayPerMmB.data() + from;
#pragma GCC ivdep
  for (int i = 0; i < chunk; ++i)
  {
    const bool fromB = m.along[i] < 0.0f;
    m.reach[i] = fromB ? reachB[i] : reachA[i];
    m.coherentReach[i] = fromB ? coherentB[i] : coherentA[i];
    m.decayPerMm[i] = fromB ? decayB[i] : decayA[i];
  }
}

/// 1 for pieces that the beam sees and faces, otherwise 0; whether there are any.
template<class Sees>
inline bool findFaced(const PieceMeetings& m, const float* radiusMm, const LineGrid& g, const Sees& sees,
                      float* diffuse, float* coherent)
{
  std::int32_t any = 0;
#pragma GCC ivdep
  for (int i = 0; i < chunk; ++i)
  {
    const float cosSquared = m.along[i] * m.along[i];
    const float sinSquared = larger(0.0f, 1.0f - cosSquared);
    const float straightMm = m.position[i] / g.samplesPerMm;
    const bool isOnLine =
      (straightMm + radiusMm[i] >= 0.0f) & (m.position[i] - radiusMm[i] * g.samplesPerMm <= g.lastSample);
    const float l = larger(0.0f, std::fabs(m.lateral[i]) - radiusMm[i]);
    const float e = larger(0.0f, std::fabs(m.elevational[i]) - radiusMm[i]);
    const bool isThere = isOnLine & sees(larger(straightMm, 0.0f), l, e);
    const float reach = m.reach[i] + surfaceTangentSlack; // withinTangent
    const float coherentReach = m.coherentReach[i] + surfaceTangentSlack;
    const bool isDiffuse = (m.reach[i] >= 0.0f) & (sinSquared < reach * reach * cosSquared);
    const bool isCoherent = (m.coherentReach[i] >= 0.0f) & (sinSquared < coherentReach * coherentReach * cosSquared);
    diffuse[i] = isThere & isDiffuse ? 1.0f : 0.0f;
    coherent[i] = isThere & isCoherent ? 1.0f : 0.0f;
    any |= (isThere & (isDiffuse | isCoherent)) ? 1 : 0;
  }
  return any != 0;
}

/// The intensity at them, unshaped, in place of 1.
inline void lightFaced(const PieceMeetings& m, const SurfaceIntensity& intensity, float* diffuse, float* coherent)
{
  const SurfaceIntensity known = intensity;
#pragma GCC ivdep
  for (int i = 0; i < chunk; ++i)
  {
    const float lit = intensityOfBins(known, m.fromMm[i], m.depthMm[i], m.decayPerMm[i]);
    diffuse[i] *= lit;
    coherent[i] *= lit;
  }
}

/// Whether any of a chunk is not 0.
inline bool anyOf(const std::int32_t* values)
{
  std::int32_t any = 0;
  for (int i = 0; i < chunk; ++i)
  {
    any |= values[i];
  }
  return any != 0;
}

SONO_SIMD_CLONES __attribute__((flatten)) void hearFacing(const PieceList& pieces, const std::int32_t* mayHear,
                                                          const Beam b, const LineGrid g, const SurfaceTable t,
                                                          const SurfaceIntensity intensity, HeardList& heard)
{
  const auto hearAll = [&](const auto& sees) {
    PieceMeetings m;
    for (int from = 0; from < pieces.count; from += chunk)
    {
      float* const diffuse = heard.diffuse.data() + from;
      float* const coherent = heard.coherent.data() + from;
      if (mayHear && !anyOf(mayHear + from))
      {
        std::fill_n(diffuse, chunk, 0.0f);
        std::fill_n(coherent, chunk, 0.0f);
        continue;
      }
      meetPieces(pieces, from, b, g, t, m);
      if (findFaced(m, pieces.radiusMm.data() + from, g, sees, diffuse, coherent))
      {
        lightFaced(m, intensity, diffuse, coherent);
      }
    }
  };
  if (!isGaussian(b))
  {
    hearAll([](float, float, float) { return true; });
    return;
  }
  withProfile(b, [&](const auto& profile) {
    hearAll([&](float depthMm, float l, float e) { return maySee(profile(depthMm), l, e); });
  });
}

/// What arrives at the pieces from the tissue in front, shaped by that behind.
void shape(const PieceList& pieces, const Beam& beam, const SurfaceTable& table, HeardList& heard)
{
  for (std::size_t n = 0; n < std::size_t(pieces.count); ++n)
  {
    const float along = across(pieces.normalX.data(), pieces.normalY.data(), pieces.normalZ.data(), int(n), beam.axis);
    const SurfaceRow& row = table.rows[along < 0.0f ? pieces.row[n] ^ 1 : pieces.row[n]];
    for (float* lit : { &heard.diffuse[n], &heard.coherent[n] })
    {
      *lit = *lit > 0.0f ? shapedLit(*lit, along, row) : 0.0f;
    }
  }
}

/// Leaves what is loud enough, of pieces that the line may hear; null: of all.
SONO_SIMD_CLONES void leaveLoud(const std::int32_t* mayHear, int count, HeardList& heard)
{
  float* const diffuse = heard.diffuse.data();
  float* const coherent = heard.coherent.data();
  const float* const most = heard.most.data();
  const std::int32_t* const may = mayHear;
  const bool mayAll = !mayHear;
  const int whole = inWholeVectors(count);
  std::int32_t anyDiffuse = 0;
  std::int32_t anyCoherent = 0;
#pragma GCC ivdep
  for (int n = 0; n < whole; ++n)
  {
    const bool isLoud = (larger(diffuse[n], coherent[n]) > surfaceFaintestLit) & (most[n] > 0.0f) & (n < count);
    const bool isHeard = isLoud && (mayAll || may[n] != 0);
    diffuse[n] = isHeard ? diffuse[n] : 0.0f;
    coherent[n] = isHeard ? coherent[n] : 0.0f;
    anyDiffuse |= diffuse[n] > 0.0f ? 1 : 0;
    anyCoherent |= coherent[n] > 0.0f ? 1 : 0;
  }
  heard.anyDiffuse = anyDiffuse != 0;
  heard.anyCoherent = anyCoherent != 0;
}

} // namespace

void markHeard(const FaceList& faces, float radiusMm, const Beam& beam, const LineGrid& grid, std::int32_t* heard)
{
  markFacing(faces, radiusMm, beam, grid, heard);
  for (std::size_t n = 0; n < std::size_t(faces.count) && !isGaussian(beam); ++n)
  {
    const Vec3f middle(faces.x[n], faces.y[n], faces.z[n]);
    heard[n] = heard[n] != 0 && mostWeight(middle, radiusMm, beam, grid) > 0.0f ? 1 : 0;
  }
}

void hearPieces(const PieceList& pieces, const std::int32_t* mayHear, const Beam& beam, const LineGrid& grid,
                const SurfaceTable& table, const SurfaceIntensity& intensity, HeardList& heard)
{
  static constexpr float everywhere = 1.0f;
  const SurfaceIntensity known = intensity.bins ? intensity : SurfaceIntensity{ &everywhere, 1, 0.0f };
  const std::size_t room = std::size_t(inWholeVectors(pieces.count));
  heard.diffuse.resize(std::max(heard.diffuse.size(), room));
  heard.coherent.resize(std::max(heard.coherent.size(), room));
  heard.most.assign(room, 1.0f);
  hearFacing(pieces, mayHear, beam, grid, table, known, heard);
  if (table.isShaped)
  {
    shape(pieces, beam, table, heard);
  }
  for (std::size_t n = 0; n < std::size_t(pieces.count) && !isGaussian(beam); ++n)
  {
    heard.most[n] = larger(heard.diffuse[n], heard.coherent[n]) > 0.0f
                      ? mostWeight({ pieces.x[n], pieces.y[n], pieces.z[n] }, pieces.radiusMm[n], beam, grid)
                      : 0.0f;
  }
  leaveLoud(mayHear, pieces.count, heard);
}

} // namespace sono
