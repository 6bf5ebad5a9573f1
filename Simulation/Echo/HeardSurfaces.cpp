#include "Echo/HeardSurfaces.h"

#include "Core/Simd.h"
#include "Echo/WithProfile.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int chunk = vectorWidth;

/// By how they face the beam, and whether they lie on the line.
SONO_SIMD_CLONES __attribute__((flatten)) void markFacing(FaceList& faces, float radiusMm, const Beam b,
                                                          const LineGrid g)
{
  const float *x = faces.x.data(), *y = faces.y.data(), *z = faces.z.data();
  const float *nx = faces.normalX.data(), *ny = faces.normalY.data(), *nz = faces.normalZ.data();
  const float *below = faces.cosineBelow.data(), *above = faces.cosineAbove.data();
  float* seen = faces.seen.data();
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
      seen[n] = (faced | unknown) & isOnLine & sees(larger(depthMm, 0.0f), l, e) ? 1.0f : 0.0f;
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
  for (int i = 0; i < chunk; ++i)
  {
    const SurfaceRow& row = t.rows[pieces.row[std::size_t(from + i)] ^ (m.along[i] < 0.0f ? 1 : 0)];
    m.reach[i] = row.reach;
    m.coherentReach[i] = pieces.isCoarse[std::size_t(from + i)] != 0.0f ? row.coherentReach : row.finestReach;
    m.decayPerMm[i] = row.decayPerMm;
  }
}

/// The intensity at the pieces, unshaped, where the beam sees and faces them.
template<class Sees>
inline void hearMet(const PieceMeetings& m, const float* radiusMm, const LineGrid& g, const SurfaceIntensity& intensity,
                    const Sees& sees, float* diffuse, float* coherent)
{
  float lit[chunk];
  const SurfaceIntensity known = intensity;
#pragma GCC ivdep
  for (int i = 0; i < chunk; ++i)
  {
    lit[i] = intensityOfBins(known, m.fromMm[i], m.depthMm[i], m.decayPerMm[i]);
  }
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
    diffuse[i] = isThere & isDiffuse ? lit[i] : 0.0f;
    coherent[i] = isThere & isCoherent ? lit[i] : 0.0f;
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void hearFacing(const PieceList& pieces, const Beam b, const LineGrid g,
                                                          const SurfaceTable t, const SurfaceIntensity intensity,
                                                          HeardList& heard)
{
  const auto hearAll = [&](const auto& sees) {
    PieceMeetings m;
    for (int from = 0; from < pieces.count; from += chunk)
    {
      meetPieces(pieces, from, b, g, t, m);
      hearMet(m, pieces.radiusMm.data() + from, g, intensity, sees, heard.diffuse.data() + from,
              heard.coherent.data() + from);
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

} // namespace

void markHeard(FaceList& faces, float radiusMm, const Beam& beam, const LineGrid& grid, std::int32_t* heard)
{
  markFacing(faces, radiusMm, beam, grid);
  for (std::size_t n = 0; n < std::size_t(faces.count); ++n)
  {
    const bool sees = faces.seen[n] != 0.0f && (isGaussian(beam) || mostWeight({ faces.x[n], faces.y[n], faces.z[n] },
                                                                               radiusMm, beam, grid) > 0.0f);
    heard[n] = sees ? 1 : 0;
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
  heard.most.assign(std::size_t(pieces.count), 1.0f);
  hearFacing(pieces, beam, grid, table, known, heard);
  heard.anyDiffuse = heard.anyCoherent = false;
  for (int n = 0; n < pieces.count; ++n)
  {
    const std::size_t at = std::size_t(n);
    const float lit = std::max(heard.diffuse[at], heard.coherent[at]);
    if (!(lit > 0.0f))
    {
      continue;
    }
    const float along = glm::dot(Vec3f(pieces.normalX[at], pieces.normalY[at], pieces.normalZ[at]), beam.axis);
    const float shaped = shapedLit(lit, along, table.rows[along < 0.0f ? pieces.row[at] ^ 1 : pieces.row[at]]);
    if (!isGaussian(beam))
    {
      heard.most[at] = mostWeight({ pieces.x[at], pieces.y[at], pieces.z[at] }, pieces.radiusMm[at], beam, grid);
    }
    const bool isHeard = shaped > surfaceFaintestLit && heard.most[at] > 0.0f && (!mayHear || mayHear[n]);
    const float arrives = isHeard ? shaped : 0.0f;
    heard.diffuse[at] = heard.diffuse[at] > 0.0f ? arrives : 0.0f;
    heard.coherent[at] = heard.coherent[at] > 0.0f ? arrives : 0.0f;
    heard.anyDiffuse |= heard.diffuse[at] > 0.0f;
    heard.anyCoherent |= heard.coherent[at] > 0.0f;
  }
}

} // namespace sono
