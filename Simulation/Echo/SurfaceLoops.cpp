#include "Echo/SurfaceLoops.h"

#include "Core/Simd.h"
#include "Echo/WithProfile.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int chunk = vectorWidth;

/// How a beam meets the points of a chunk.
struct Meetings
{
  float position[chunk], lateral[chunk], elevational[chunk];
  float along[chunk]; ///< the normal's component along the axis
  float lit[chunk], most[chunk];
  float reach[chunk];    ///< of the point's boundary
  float strength[chunk]; ///< 0 where nothing is heard
  float heard[chunk];    ///< what has to be loud enough, times the weight
  float faintest[chunk]; ///< for that
  float re[chunk], im[chunk];
};

bool hearsAny(const float* lit, const std::int32_t* piece)
{
  float most = 0.0f;
  for (int p = piece[0]; p <= piece[chunk - 1]; ++p)
  {
    most = std::max(most, lit[p]);
  }
  return most > 0.0f;
}

bool anyIsHeard(const Meetings& m)
{
  float most = 0.0f;
  for (int i = 0; i < chunk; ++i)
  {
    most = larger(most, std::fabs(m.strength[i]));
  }
  return most > 0.0f;
}

struct PointArrays
{
  const float *x, *y, *z, *normalX, *normalY, *normalZ, *uX, *uY, *uZ, *vX, *vY, *vZ, *areaMm2, *phaseRe, *phaseIm;
  const std::int32_t *row, *piece;
};

PointArrays arraysOf(const PointList& p)
{
  return { p.x.data(),       p.y.data(),       p.z.data(),       p.normalX.data(), p.normalY.data(), p.normalZ.data(),
           p.uX.data(),      p.uY.data(),      p.uZ.data(),      p.vX.data(),      p.vY.data(),      p.vZ.data(),
           p.areaMm2.data(), p.phaseRe.data(), p.phaseIm.data(), p.row.data(),     p.piece.data() };
}

/// Where points lie on a line and how they face it.
inline void facePoints(const PointArrays& p, int from, const Beam& b, const LineGrid& g, Meetings& m)
{
  const float *x = p.x + from, *y = p.y + from, *z = p.z + from;
  const float *nx = p.normalX + from, *ny = p.normalY + from, *nz = p.normalZ + from;
#pragma GCC ivdep
  for (int i = 0; i < chunk; ++i)
  {
    const BeamPlace place = placeInBeam(x[i], y[i], z[i], b, g);
    m.position[i] = place.position;
    m.lateral[i] = place.lateral;
    m.elevational[i] = place.elevational;
    m.along[i] = across(nx, ny, nz, i, b.axis);
  }
}

/// How strong each echo is that is within its boundary's reach, and loud enough for a beam's axis.
inline void keepLoud(const LineGrid& g, Meetings& m)
{
#pragma GCC ivdep
  for (int i = 0; i < chunk; ++i)
  {
    const float cosSquared = m.along[i] * m.along[i];
    const float sinSquared = larger(0.0f, 1.0f - cosSquared);
    const float faintest = faintestAt(m.lit[i]);
    const bool isOnLine = (m.position[i] >= 0.0f) & (m.position[i] < g.lastSample);
    const bool isWithinReach = (m.reach[i] >= 0.0f) & (sinSquared < m.reach[i] * m.reach[i] * cosSquared);
    const bool isLoud = std::fabs(m.heard[i]) * m.most[i] > faintest;
    m.faintest[i] = faintest;
    m.strength[i] = isOnLine & isWithinReach & isLoud ? m.strength[i] : 0.0f;
  }
}

/// meetSurface where a point is heard: of beams that are no Gaussians, one by one.
void weighOneByOne(const Beam& b, const LineGrid& g, Meetings& m)
{
  for (int i = 0; i < chunk; ++i)
  {
    m.re[i] = m.im[i] = 0.0f;
    if (m.strength[i] != 0.0f)
    {
      const BeamEcho echo = beamEchoAt(b, m.lateral[i], m.elevational[i], m.position[i] / g.samplesPerMm);
      m.position[i] = echo.depthMm * g.samplesPerMm;
      const bool isOnLine = m.position[i] < g.lastSample;
      m.re[i] = isOnLine ? echo.weight.re : 0.0f;
      m.im[i] = isOnLine ? echo.weight.im : 0.0f;
      m.strength[i] = isHeard(m.heard[i], { m.re[i], m.im[i] }, m.faintest[i]) ? m.strength[i] : 0.0f;
    }
  }
}

inline bool isSeen(const ProfileAt& at, float lateral, float elevational)
{
  return lateral * lateral * at.perLateral2 + elevational * elevational * at.perElevational2 <
         beamCutSigma * beamCutSigma;
}

/// The same of Gaussians.
template<class Profile>
inline void weigh(const Profile& profile, const LineGrid& g, Meetings& m)
{
  for (int i = 0; i < chunk; ++i)
  {
    const ProfileAt at = profile(larger(0.0f, m.position[i] / g.samplesPerMm));
    const float squared =
      m.lateral[i] * m.lateral[i] * at.perLateral2 + m.elevational[i] * m.elevational[i] * at.perElevational2;
    const float weight = at.amplitude * expNegative(-0.5f * squared);
    const bool isLoud = isSeen(at, m.lateral[i], m.elevational[i]) & (std::fabs(m.heard[i]) * weight > m.faintest[i]);
    m.strength[i] = isLoud ? m.strength[i] : 0.0f;
    m.re[i] = weight;
    m.im[i] = 0.0f;
  }
}

/// The same of blobs, by which the weight is smoothed.
template<class Profile>
inline void weighBlobs(const Profile& profile, const PointArrays& p, int from, const Beam& b, const LineGrid& g,
                       Meetings& m)
{
  for (int i = 0; i < chunk; ++i)
  {
    const int n = from + i;
    const ProfileAt at = profile(larger(0.0f, m.position[i] / g.samplesPerMm));
    const float weight =
      smoothedWeight(at, { m.position[i], m.lateral[i], m.elevational[i] }, across(p.uX, p.uY, p.uZ, n, b.lateral),
                     across(p.vX, p.vY, p.vZ, n, b.lateral), across(p.uX, p.uY, p.uZ, n, b.elevation),
                     across(p.vX, p.vY, p.vZ, n, b.elevation));
    const bool isLoud = isSeen(at, m.lateral[i], m.elevational[i]) & (std::fabs(m.heard[i]) * weight > m.faintest[i]);
    m.strength[i] = isLoud ? m.strength[i] : 0.0f;
    m.re[i] = weight;
    m.im[i] = 0.0f;
  }
}

/// Adds to the samples before and behind each point.
inline void splitAndAdd(const PointArrays& p, int from, const LineGrid& g, const Meetings& m, float* iq)
{
  std::int32_t sample[chunk];
  float added[4][chunk];
  for (int i = 0; i < chunk; ++i)
  {
    const float a = m.strength[i] * m.lit[i];
    const float re = a * p.phaseRe[from + i];
    const float im = a * p.phaseIm[from + i];
    const bool isHeard = m.strength[i] != 0.0f;
    const ScattererSplit s = splitScatterer(ComplexWeight{ m.re[i] * re - m.im[i] * im, m.re[i] * im + m.im[i] * re },
                                            isHeard ? m.position[i] : 0.0f, g);
    for (int c = 0; c < 4; ++c)
    {
      added[c][i] = s.added[c];
    }
    sample[i] = std::int32_t(s.sample);
  }
  for (int i = 0; i < chunk; ++i)
  {
    if (m.strength[i] != 0.0f)
    {
      float* to = iq + 2 * std::ptrdiff_t(sample[i]);
      for (int c = 0; c < 4; ++c)
      {
        to[c] += added[c][i];
      }
    }
  }
}

inline void meetDiffuse(const PointArrays& p, int from, const float* lit, const float* most, const Beam& b,
                        const LineGrid& g, const SurfaceTable& t, Meetings& m)
{
  float profile[chunk], logDiffuse[chunk], node[chunk], logL[chunk], logE[chunk];
  facePoints(p, from, b, g, m);
  for (int i = 0; i < chunk; ++i)
  {
    const SurfaceRow& row = t.rows[p.row[from + i] ^ (m.along[i] < 0.0f ? 1 : 0)];
    m.lit[i] = lit[p.piece[from + i]];
    m.most[i] = most[p.piece[from + i]];
    m.reach[i] = row.reach;
    logDiffuse[i] = row.logDiffuse;
    profile[i] = float(row.profile);
  }
#pragma GCC ivdep
  for (int i = 0; i < chunk; ++i)
  {
    node[i] = diffuseNode(t, std::fabs(m.along[i]), larger(0.0f, 1.0f - m.along[i] * m.along[i]));
  }
  const float* ofL = t.diffuseL;
  const float* ofE = t.diffuseE;
#pragma GCC ivdep
  for (int i = 0; i < chunk; ++i)
  {
    const std::int32_t before = std::int32_t(node[i]);
    const float share = node[i] - float(before);
    const std::int32_t n = std::int32_t(profile[i]) * t.nodes + before;
    logL[i] = ofL[n] + share * (ofL[n + 1] - ofL[n]);
    logE[i] = ofE[n] + share * (ofE[n + 1] - ofE[n]);
  }
  const float *nx = p.normalX + from, *ny = p.normalY + from, *nz = p.normalZ + from;
  const float* area = p.areaMm2 + from;
#pragma GCC ivdep
  for (int i = 0; i < chunk; ++i)
  {
    const float strength = diffuseStrength(logDiffuse[i], logL[i], logE[i], across(nx, ny, nz, i, b.lateral),
                                           across(nx, ny, nz, i, b.elevation), area[i]);
    m.strength[i] = strength;
    m.heard[i] = strength;
  }
  keepLoud(g, m);
}

inline void meetCoherent(const PointArrays& p, int from, const float* lit, const float* most, const Beam& b,
                         const LineGrid& g, const SurfaceTable& t, Meetings& m, float* spread)
{
  float impedanceBefore[chunk], impedanceBehind[chunk], speedRatio[chunk], roughness[chunk];
  facePoints(p, from, b, g, m);
  for (int i = 0; i < chunk; ++i)
  {
    const SurfaceRow& row = t.rows[p.row[from + i] ^ (m.along[i] < 0.0f ? 1 : 0)];
    m.lit[i] = lit[p.piece[from + i]];
    m.most[i] = most[p.piece[from + i]];
    m.reach[i] = row.finestReach;
    impedanceBefore[i] = row.impedanceBefore;
    impedanceBehind[i] = row.impedanceBehind;
    speedRatio[i] = row.speedRatio;
    roughness[i] = row.roughness;
  }
  const float *ux = p.uX + from, *uy = p.uY + from, *uz = p.uZ + from;
  const float *vx = p.vX + from, *vy = p.vY + from, *vz = p.vZ + from;
  const float* area = p.areaMm2 + from;
#pragma GCC ivdep
  for (int i = 0; i < chunk; ++i)
  {
    SurfaceRow row{};
    row.impedanceBefore = impedanceBefore[i];
    row.impedanceBehind = impedanceBehind[i];
    row.speedRatio = speedRatio[i];
    row.roughness = roughness[i];
    const BlobOnLine blob = blobOnLine(across(ux, uy, uz, i, b.axis), across(vx, vy, vz, i, b.axis), g, t.pulseSigmaMm);
    const float strength = coherentStrength(t, row, std::fabs(m.along[i]), area[i]);
    m.strength[i] = strength;
    m.heard[i] = strength * blob.left;
    spread[i] = blob.spread;
  }
  keepLoud(g, m);
}

SONO_SIMD_CLONES __attribute__((flatten)) void addDiffuseTo(const PointArrays p, int count, const float* lit,
                                                            const float* most, const Beam b, const LineGrid g,
                                                            const SurfaceTable t, float* iq)
{
  const auto addAll = [&](const auto& weighAll) {
    Meetings m;
    for (int from = 0; from < count; from += chunk)
    {
      if (hearsAny(lit, p.piece + from))
      {
        meetDiffuse(p, from, lit, most, b, g, t, m);
        if (anyIsHeard(m))
        {
          weighAll(m);
          splitAndAdd(p, from, g, m, iq);
        }
      }
    }
  };
  if (!isGaussian(b))
  {
    addAll([&](Meetings& m) { weighOneByOne(b, g, m); });
    return;
  }
  withProfile(b, [&](const auto& profile) { addAll([&](Meetings& m) { weigh(profile, g, m); }); });
}

SONO_SIMD_CLONES __attribute__((flatten)) void addCoherentTo(const PointArrays p, int count, const float* lit,
                                                             const float* most, const Beam b, const LineGrid g,
                                                             const SurfaceTable t, float* iq)
{
  float spread[chunk];
  const auto addAll = [&](const auto& weighAll) {
    Meetings m;
    SurfaceSum sum{ iq };
    for (int from = 0; from < count; from += chunk)
    {
      if (!hearsAny(lit, p.piece + from))
      {
        continue;
      }
      meetCoherent(p, from, lit, most, b, g, t, m, spread);
      if (!anyIsHeard(m))
      {
        continue;
      }
      weighAll(from, m);
      for (int i = 0; i < chunk; ++i)
      {
        if (m.strength[i] != 0.0f)
        {
          addBlob(m.strength[i], { m.re[i], m.im[i] }, m.lit[i], m.position[i], spread[i], g, sum);
        }
      }
    }
  };
  if (!isGaussian(b))
  {
    addAll([&](int, Meetings& m) { weighOneByOne(b, g, m); });
    return;
  }
  withProfile(
    b, [&](const auto& profile) { addAll([&](int from, Meetings& m) { weighBlobs(profile, p, from, b, g, m); }); });
}

} // namespace

void addDiffusePoints(const PointList& points, const HeardList& heard, const Beam& beam, const LineGrid& grid,
                      const SurfaceTable& table, float* iq)
{
  addDiffuseTo(arraysOf(points), points.count, heard.diffuse.data(), heard.most.data(), beam, grid, table, iq);
}

void addCoherentPoints(const PointList& points, const HeardList& heard, const Beam& beam, const LineGrid& grid,
                       const SurfaceTable& table, float* iq)
{
  addCoherentTo(arraysOf(points), points.count, heard.coherent.data(), heard.most.data(), beam, grid, table, iq);
}

} // namespace sono
