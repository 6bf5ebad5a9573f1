#include "Echo/FaintPieces.h"

#include "Core/Simd.h"
#include "Echo/ResizeAll.h"
#include "Echo/WithProfile.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int chunk = vectorWidth;
/// By so much a beam's variance and amplitude may differ within a piece: see maySee.
constexpr float beamSlack = 1.1f;
constexpr float rounding = 1.001f; // of a bound

/// What decides about the pieces of a chunk.
struct Bounds
{
  float weight[chunk]; ///< the beam's, at most
  float left[chunk];   ///< of a blob by the pulse's band, at most
  float along[chunk];  ///< the normal's component along the axis
  float cosLow[chunk], cosHigh[chunk], node[chunk];
  float impedanceBefore[chunk], impedanceBehind[chunk], speedRatio[chunk], roughness[chunk], diffuse[chunk];
};

/// How far the points of a piece lie from an axis of the beam at least, and what of a Gaussian's variance is left where
/// a blob's is taken off (smoothedWeight), times the inverse variance.
struct Aside
{
  float squared;
  float left;
};

inline Aside asideOf(float awayMm, float u, float v, float riseMm, float blobU, float blobV, float per2)
{
  const float away = larger(0.0f, std::fabs(awayMm) - u - v - riseMm);
  return { away * away * per2, larger(surfaceWidthShare, 1.0f - beamSlack * (blobU * blobU + blobV * blobV) * per2) };
}

template<class Profile>
inline void boundWeights(const PieceList& pieces, const PieceExtents& extents, int from, const Beam& b,
                         const LineGrid& g, const SurfaceTable& t, const Profile& profile, Bounds& m)
{
  const float *x = pieces.x.data() + from, *y = pieces.y.data() + from, *z = pieces.z.data() + from;
  const float *nx = pieces.normalX.data() + from, *ny = pieces.normalY.data() + from;
  const float* nz = pieces.normalZ.data() + from;
  const float *ux = extents.uX.data() + from, *uy = extents.uY.data() + from, *uz = extents.uZ.data() + from;
  const float *vx = extents.vX.data() + from, *vy = extents.vY.data() + from, *vz = extents.vZ.data() + from;
  const float *rise = extents.riseMm.data() + from, *turn = extents.turn.data() + from;
  const float *blobU = extents.blobUMm.data() + from, *blobV = extents.blobVMm.data() + from;
  const float *perU = extents.blobUPerHalf.data() + from, *perV = extents.blobVPerHalf.data() + from;
#pragma GCC ivdep
  for (int i = 0; i < chunk; ++i)
  {
    const BeamPlace place = placeInBeam(x[i], y[i], z[i], b, g);
    const ProfileAt at = profile(larger(0.0f, place.position / g.samplesPerMm));
    const float turnU = blobU[i] * turn[i];
    const float turnV = blobV[i] * turn[i];
    const float lateralU = std::fabs(across(ux, uy, uz, i, b.lateral));
    const float lateralV = std::fabs(across(vx, vy, vz, i, b.lateral));
    const float elevationalU = std::fabs(across(ux, uy, uz, i, b.elevation));
    const float elevationalV = std::fabs(across(vx, vy, vz, i, b.elevation));
    const Aside l = asideOf(place.lateral, lateralU, lateralV, rise[i], lateralU * perU[i] + turnU,
                            lateralV * perV[i] + turnV, at.perLateral2);
    const Aside e = asideOf(place.elevational, elevationalU, elevationalV, rise[i], elevationalU * perU[i] + turnU,
                            elevationalV * perV[i] + turnV, at.perElevational2);
    const float squared = l.squared + e.squared;
    const float weight =
      quickDivide(beamSlack * at.amplitude * expNegative(-0.5f / beamSlack * squared), quickSqrt(l.left * e.left));
    m.weight[i] = squared < beamSlack * beamCutSigma * beamCutSigma ? rounding * weight : 0.0f;
    const float alongU = std::fabs(across(ux, uy, uz, i, b.axis)) * perU[i] - turnU;
    const float alongV = std::fabs(across(vx, vy, vz, i, b.axis)) * perV[i] - turnV;
    m.left[i] = blobOnLine(larger(0.0f, alongU), larger(0.0f, alongV), g, t.pulseSigmaMm).left;
    m.along[i] = across(nx, ny, nz, i, b.axis);
    const float cosine = std::fabs(m.along[i]);
    m.cosLow[i] = larger(0.0f, cosine - turn[i]);
    m.cosHigh[i] = smaller(1.0f, cosine + turn[i]);
    m.node[i] = diffuseNode(t, m.cosHigh[i], 1.0f - m.cosHigh[i] * m.cosHigh[i]);
  }
}

/// The boundaries' numbers, one by one.
inline void takeRows(const PieceList& pieces, int from, const SurfaceTable& t, const float* diffuseMost, Bounds& m)
{
  for (int i = 0; i < chunk; ++i)
  {
    const SurfaceRow& row = t.rows[pieces.row[std::size_t(from + i)] ^ (m.along[i] < 0.0f ? 1 : 0)];
    m.impedanceBefore[i] = row.impedanceBefore;
    m.impedanceBehind[i] = row.impedanceBehind;
    m.speedRatio[i] = row.speedRatio;
    m.roughness[i] = row.roughness;
    m.diffuse[i] = row.logDiffuse + diffuseMost[row.profile * t.nodes + int(m.node[i])];
  }
}

inline void leaveIn(const PieceExtents& extents, int from, const SurfaceTable& t, const Bounds& m, float* diffuse,
                    float* coherent)
{
  const float* root = extents.diffuseRootMm.data() + from;
  const float* area = extents.coherentMm2.data() + from;
#pragma GCC ivdep
  for (int i = 0; i < chunk; ++i)
  {
    SurfaceRow row{};
    row.impedanceBefore = m.impedanceBefore[i];
    row.impedanceBehind = m.impedanceBehind[i];
    row.speedRatio = m.speedRatio[i];
    const float lit = larger(diffuse[i], coherent[i]);
    const float faintest = faintestAt(larger(lit, 1e-12f));
    // r is monotonic in the cosine.
    const float r =
      larger(std::fabs(surfaceReflection(row, m.cosLow[i])), std::fabs(surfaceReflection(row, m.cosHigh[i])));
    const float ofBlob =
      r * m.cosHigh[i] * expNegative(-m.roughness[i] * m.cosLow[i] * m.cosLow[i]) * area[i] * t.perBeamArea * m.left[i];
    const float ofPoint = expNegative(smaller(0.0f, m.diffuse[i])) * root[i];
    const bool isEdgeOn = !(m.cosLow[i] > 0.0f); // points may be met from either side
    diffuse[i] = isEdgeOn | (ofPoint * m.weight[i] > faintest) ? diffuse[i] : 0.0f;
    coherent[i] = isEdgeOn | (ofBlob * m.weight[i] > faintest) ? coherent[i] : 0.0f;
  }
}

inline float mostOf(const float* values)
{
  float most = 0.0f;
  for (int i = 0; i < chunk; ++i)
  {
    most = larger(most, values[i]);
  }
  return most;
}

SONO_SIMD_CLONES __attribute__((flatten)) void leaveFaintIn(const PieceList& pieces, const PieceExtents& extents,
                                                            const Beam b, const LineGrid g, const SurfaceTable t,
                                                            const float* diffuseMost, HeardList& heard)
{
  withProfile(b, [&](const auto& profile) {
    Bounds m;
    float mostDiffuse = 0.0f;
    float mostCoherent = 0.0f;
    for (int from = 0; from < pieces.count; from += chunk)
    {
      float* diffuse = heard.diffuse.data() + from;
      float* coherent = heard.coherent.data() + from;
      if (mostOf(diffuse) > 0.0f || mostOf(coherent) > 0.0f)
      {
        boundWeights(pieces, extents, from, b, g, t, profile, m);
        takeRows(pieces, from, t, diffuseMost, m);
        leaveIn(extents, from, t, m, diffuse, coherent);
        mostDiffuse = larger(mostDiffuse, mostOf(diffuse));
        mostCoherent = larger(mostCoherent, mostOf(coherent));
      }
    }
    heard.anyDiffuse = mostDiffuse > 0.0f;
    heard.anyCoherent = mostCoherent > 0.0f;
  });
}

} // namespace

void PieceExtents::reserve(int count)
{
  resizeAll({ &uX, &uY, &uZ, &vX, &vY, &vZ, &riseMm, &turn, &blobUMm, &blobVMm, &blobUPerHalf, &blobVPerHalf,
              &diffuseRootMm, &coherentMm2 },
            std::size_t(inWholeVectors(count)));
}

void leaveFaint(const PieceList& pieces, const PieceExtents& extents, const Beam& beam, const LineGrid& grid,
                const SurfaceTable& table, const float* diffuseMost, HeardList& heard)
{
  if (isGaussian(beam) && (heard.anyDiffuse || heard.anyCoherent))
  {
    leaveFaintIn(pieces, extents, beam, grid, table, diffuseMost, heard);
  }
}

} // namespace sono
