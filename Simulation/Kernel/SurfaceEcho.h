#pragma once

#include "Kernel/EchoSplat.h"
#include "Kernel/Vec.h"

#include <cmath>
#include <cstdint>

// What a small piece of a surface adds to a line (Data/docs/physics.md sections 10.4 and 10.5).
//
// Pieces are Gaussian blobs on their tangent planes, so wide that together they cover a surface evenly. A blob has a
// closed form: seen along the beam it is a Gaussian of some deviation d. Its coherent echo is that Gaussian laid on the
// samples of the line as a density, without a carrier; the pulse, which comes last, takes from it what its band holds.
// A steep blob thus cancels within itself, and no difference of large parts is left to the sum over pieces.

namespace sono {

/// A blob: `tangentU` and `tangentV` span its covariance, mm. The normal points from medium A into medium B.
struct SurfacePoint
{
  Vec3f position;
  Vec3f normal; ///< unit
  Vec3f tangentU;
  Vec3f tangentV;
  float areaMm2;
  std::int32_t row; ///< of the table, A onto B; row ^ 1 is B onto A
  float phaseRe;    ///< exp(i phase) of its diffuse echo
  float phaseIm;
};

/// A boundary as it is met from one side.
struct SurfaceRow
{
  float impedanceBefore; ///< MRayl
  float impedanceBehind;
  float speedRatio; ///< behind over before
  float logDiffuse; ///< log |r| across it
  float roughness;  ///< 2 (k h)^2
  float tau;        ///< of the tissue behind: exponents of the intensity and of cos t
  float gamma;
  float reach; ///< tangent beyond which its echo does not count; < 0: it never does
  std::int32_t profile;
};

/// Number of the row from medium a onto b, of so many media.
SONO_HD inline int surfaceRow(int media, int a, int b)
{
  const int low = a < b ? a : b;
  const int high = a < b ? b : a;
  return 2 * (low * media + high) + (a < b ? 0 : 1);
}

/// What boundaries echo. A profile is the diffuse echo of a roughness with r = 1 by the tangent of the angle between
/// beam and normal: the log of sqrt(dq/dA) lambda / A_b, `nodes` values at multiples of 1 / perTangent. Trivially
/// copyable.
struct SurfaceTable
{
  const SurfaceRow* rows = nullptr;
  const float* diffuseL = nullptr; ///< the tilt in the lateral direction
  const float* diffuseE = nullptr; ///< the same, in the elevational one
  int nodes = 0;
  float perTangent = 1.0f;
  float perBeamArea = 1.0f;  ///< 1 / A_b, 1/mm^2
  float slackMm = 0.0f;      ///< how far in front of a surface the tracer may have met it
  float pulseSigmaMm = 0.0f; ///< of a Gaussian pulse of the same bandwidth
};

/// r of a plane wave, with its sign; 1 beyond the critical angle.
SONO_HD inline float surfaceReflection(const SurfaceRow& row, float cosine)
{
  const float sinBehind = row.speedRatio * row.speedRatio * larger(0.0f, 1.0f - cosine * cosine);
  const float cosBehind = sqrtf(larger(0.0f, 1.0f - sinBehind));
  const float a = row.impedanceBehind * cosine;
  const float b = row.impedanceBefore * cosBehind;
  return (a - b) / (a + b);
}

/// One way's intensity of a line; null: 1 everywhere.
struct SurfaceIntensity
{
  const float* bins = nullptr;
  int count = 0;
  float perMm = 0.0f;
};

/// The largest intensity from a bin in front of `frontMm` to `depthMm`.
SONO_HD inline float intensityInFront(const SurfaceIntensity& intensity, float frontMm, float depthMm)
{
  if (!intensity.bins)
  {
    return 1.0f;
  }
  const int end = intensity.count - 1;
  int last = int(depthMm * intensity.perMm);
  int first = int(frontMm * intensity.perMm) - 1;
  last = last < end ? last : end;
  first = first < 0 ? 0 : (first < last ? first : last);
  float largest = intensity.bins[first];
  for (int b = first + 1; b <= last; ++b)
  {
    largest = intensity.bins[b] > largest ? intensity.bins[b] : largest;
  }
  return largest;
}

constexpr float surfaceFaintest = 1e-6f;    ///< echoes fainter than this against a perfect mirror are left out
constexpr float surfaceCrossingMm = 4.0f;   ///< the axis' own crossing of the surface is looked for no further in front
constexpr float surfaceBlobReach = 5.0f;    ///< deviations of a blob that are laid on the line
constexpr float surfaceWidthShare = 0.25f;  ///< of a beam's variance are left at least when a blob's is taken off
constexpr float surfaceShortestBlob = 0.7f; ///< samples: a Gaussian of less is no density on them

/// What a Gaussian beam's weight has to be multiplied by, so that a blob smooths it to the beam's own.
struct BlobWeight
{
  bool isSeen;
  float share;
};

SONO_HD inline BlobWeight blobWeight(const SurfacePoint& p, const Beam& b, const BeamPlace& place, float depthMm)
{
  float perLateral2 = 1.0f / (b.lateralSigmaMm * b.lateralSigmaMm);
  float perElevational2 = 1.0f / (b.elevationalSigmaMm * b.elevationalSigmaMm);
  if (b.kind == BeamKind::Aperture)
  {
    const ProfileAt at = profileAt(b.profile, depthMm);
    perLateral2 = at.perLateral2;
    perElevational2 = at.perElevational2;
  }
  else if (b.kind != BeamKind::Gaussian)
  {
    return { true, 1.0f }; // a table's beam is wide against a blob
  }
  const float l2 = place.lateral * place.lateral * perLateral2;
  const float e2 = place.elevational * place.elevational * perElevational2;
  const float lu = glm::dot(b.lateral, p.tangentU);
  const float lv = glm::dot(b.lateral, p.tangentV);
  const float eu = glm::dot(b.elevation, p.tangentU);
  const float ev = glm::dot(b.elevation, p.tangentV);
  const float leftL = larger(surfaceWidthShare, 1.0f - (lu * lu + lv * lv) * perLateral2);
  const float leftE = larger(surfaceWidthShare, 1.0f - (eu * eu + ev * ev) * perElevational2);
  const float narrower = -0.5f * (l2 / leftL - l2 + e2 / leftE - e2);
  return { l2 + e2 < beamCutSigma * beamCutSigma, expNegative(narrower) / sqrtf(leftL * leftE) };
}

/// Adds what a point echoes to the line's sum; intensity included. sum.add(sample, re, im) takes samples in [sum.first,
/// sum.last], of which all that the point reaches are offered, and some beyond.
template<class Sum>
SONO_HD inline void addSurface(const SurfacePoint& p, const Beam& b, const LineGrid& g, const SurfaceTable& table,
                               const SurfaceIntensity& intensity, Sum& sum)
{
  // Where the beam sees it, and how steeply.
  BeamPlace place = placeInBeam(p.position.x, p.position.y, p.position.z, b, g);
  if (!(place.position >= 0.0f && place.position < g.lastSample))
  {
    return;
  }
  const float signedCosine = glm::dot(p.normal, b.axis);
  const float cosine = fabsf(signedCosine);
  const SurfaceRow& row = table.rows[signedCosine < 0.0f ? p.row ^ 1 : p.row];
  const float sine = sqrtf(larger(0.0f, 1.0f - cosine * cosine));
  if (!(sine < row.reach * cosine))
  {
    return;
  }
  const float mmPerSample = 1.0f / g.samplesPerMm;

  // The beam's weight at the point, and that which, smoothed by the blob, is the beam's.
  const BeamEcho echo = beamEchoAt(b, place.lateral, place.elevational, place.position * mmPerSample);
  const float depthMm = echo.depthMm;
  place.position = depthMm * g.samplesPerMm;
  if (!(place.position < g.lastSample))
  {
    return;
  }
  const BlobWeight blob = blobWeight(p, b, place, depthMm);
  if (!blob.isSeen)
  {
    return;
  }

  // The intensity in front of where the line's own axis meets the surface: behind that it has fallen already.
  const float normalL = glm::dot(p.normal, b.lateral);
  const float normalE = glm::dot(p.normal, b.elevation);
  const float ahead = (normalL * place.lateral + normalE * place.elevational) / signedCosine;
  const float front = depthMm + larger(-surfaceCrossingMm, smaller(0.0f, ahead)) - table.slackMm;
  float shaped = intensityInFront(intensity, front, depthMm);
  if (row.tau != 1.0f)
  {
    shaped = powf(shaped, row.tau);
  }
  if (row.gamma != 0.0f)
  {
    shaped *= powf(cosine, row.gamma);
  }

  // Diffuse: a scatterer of random phase.
  const float node = sine / cosine * table.perTangent;
  const int before = int(node);
  const float share = node - float(before);
  const int at = row.profile * table.nodes + before;
  const float logL = table.diffuseL[at] + share * (table.diffuseL[at + 1] - table.diffuseL[at]);
  const float logE = table.diffuseE[at] + share * (table.diffuseE[at + 1] - table.diffuseE[at]);
  const float across = normalL * normalL + normalE * normalE;
  const float lateralShare = across > 1e-12f ? normalL * normalL / across : 0.5f;
  const float diffuse =
    expNegative(smaller(0.0f, row.logDiffuse + logE + lateralShare * (logL - logE))) * sqrtf(p.areaMm2);
  const ComplexWeight w = echo.weight;
  const float modulus = larger(fabsf(w.re), fabsf(w.im));
  const bool isDiffuse = diffuse * modulus > surfaceFaintest;
  const float coherent = surfaceReflection(row, cosine) * cosine * expNegative(-row.roughness * cosine * cosine) *
                         p.areaMm2 * table.perBeamArea * blob.share;

  // Coherent: a Gaussian of this deviation in depth. Splitting a point between two samples widens by a sixth of a
  // sample's square, which the pulse takes off again: so does the density.
  const float du = glm::dot(b.axis, p.tangentU) * g.samplesPerMm;
  const float dv = glm::dot(b.axis, p.tangentV) * g.samplesPerMm;
  const float spread = du * du + dv * dv;
  const float phaseSquared = spread * g.radPerSample * g.radPerSample;
  const float deviation = sqrtf(spread + 1.0f / 6.0f);
  const bool isPoint = deviation < surfaceShortestBlob;
  // What the pulse's band leaves of it (eq. 10.6).
  const float pulse = table.pulseSigmaMm * g.samplesPerMm;
  const float left = expNegative(-0.5f * phaseSquared * pulse * pulse / (pulse * pulse + spread));
  const bool isCoherent = fabsf(coherent) * modulus * left > surfaceFaintest;
  if (isDiffuse || (isCoherent && isPoint))
  {
    const ScattererSplit split = splitScatterer(shaped, place.position, g);
    const float point = isCoherent && isPoint ? coherent * expNegative(-0.5f * phaseSquared) : 0.0f;
    const float unitRe = point + (isDiffuse ? diffuse * p.phaseRe : 0.0f);
    const float unitIm = isDiffuse ? diffuse * p.phaseIm : 0.0f;
    const float re = w.re * unitRe - w.im * unitIm;
    const float im = w.re * unitIm + w.im * unitRe;
    const int sample = int(split.sample);
    sum.add(sample, split.added[0] * re - split.added[1] * im, split.added[1] * re + split.added[0] * im);
    sum.add(sample + 1, split.added[2] * re - split.added[3] * im, split.added[3] * re + split.added[2] * im);
  }
  if (isCoherent && !isPoint)
  {
    const float reach = surfaceBlobReach * deviation;
    const float peak = coherent * shaped * 0.39894228f / deviation;
    const float perVariance = -0.5f / (deviation * deviation);
    int first = int(place.position - reach) + 1;
    int last = int(place.position + reach);
    first = first > sum.first ? first : sum.first;
    last = last < sum.last ? last : sum.last;
    for (int s = first; s <= last; ++s)
    {
      const float d = float(s) - place.position;
      const float density = peak * expNegative(perVariance * d * d);
      sum.add(s, w.re * density, w.im * density);
    }
  }
}

/// The samples of a whole line, re and im of each.
struct SurfaceSum
{
  float* iq;
  int first;
  int last;

  SONO_HD void add(int sample, float re, float im)
  {
    iq[2 * sample] += re;
    iq[2 * sample + 1] += im;
  }
};

inline void addSurface(const SurfacePoint& p, const Beam& b, const LineGrid& g, const SurfaceTable& table,
                       const SurfaceIntensity& intensity, float* iq)
{
  SurfaceSum sum{ iq, 0, int(g.lastSample) };
  addSurface(p, b, g, table, intensity, sum);
}

} // namespace sono
