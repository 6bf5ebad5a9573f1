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

/// A blob: `tangentU` and `tangentV` span its covariance, mm. The normal points from medium A into medium B. Points of
/// coherent echoes have no phase, those of diffuse ones no tangents; a triangle of a target is both.
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
  float roughness;  ///< 2 (k h)^2, averaged over the band
  float tau;        ///< of the tissue behind: exponents of the intensity and of cos t
  float gamma;
  float decayPerMm;    ///< in front: the intensity falls by exp(-decay l)
  float reach;         ///< tangent beyond which its diffuse echo does not count; < 0: it never does
  float coherentReach; ///< the same of its coherent echo, for the coarsest blobs
  float finestReach;   ///< and for the finest
  float roughCosine;   ///< below it, that of a rough normal, nothing counts
  std::int32_t profile;
};

/// Number of the row from medium a onto b, of so many media.
SONO_HD inline int surfaceRow(int media, int a, int b)
{
  const int low = a < b ? a : b;
  const int high = a < b ? b : a;
  return 2 * (low * media + high) + (a < b ? 0 : 1);
}

SONO_HD inline bool echoes(const SurfaceRow& row)
{
  return row.reach >= 0.0f || row.finestReach >= 0.0f;
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
  bool isShaped = true;      ///< whether any boundary has a tau but 1 or a gamma but 0

  /// Whether a boundary echoes to either side.
  SONO_HD bool counts(int row) const { return echoes(rows[row]) || echoes(rows[row ^ 1]); }
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

/// The intensity at a depth, by bins that lie whole before another, in front of it, and a medium from there on;
/// continuous. There must be bins.
SONO_HD inline float intensityOfBins(const SurfaceIntensity& intensity, float frontMm, float depthMm, float decayPerMm)
{
  const float last = larger(0.0f, smaller(frontMm * intensity.perMm, float(intensity.count)) - 1.0f);
  const int bin = int(last);
  const float before = intensity.bins[bin > 0 ? bin - 1 : 0];
  const float known = before + (last - float(bin)) * (intensity.bins[bin] - before);
  const float restMm = depthMm - larger(0.5f, last - 0.5f) / intensity.perMm; // from between the middles of bins
  return known * expNegative(-decayPerMm * larger(0.0f, restMm));
}

constexpr float surfaceFaintest = 1e-6f;    ///< echoes fainter than this against a perfect mirror are left out
constexpr float surfaceFaintestLit = 1e-9f; ///< the same with the intensity that reaches them; many may be in phase
constexpr float surfaceCrossingMm = 4.0f;   ///< the axis' own crossing of the surface is looked for no further in front
constexpr float surfaceBlobReach = 5.0f;    ///< deviations of a blob that are laid on the line
constexpr float surfaceWidthShare = 0.25f;  ///< of a beam's variance are left at least when a blob's is taken off
constexpr float surfaceShortestBlob = 0.7f; ///< samples: a Gaussian of less is no density on them
constexpr float surfaceTangentSlack = 0.1f; ///< by so much the slope of a point may differ from its piece's

/// What a line hears of a piece of a surface. Nothing where the intensity is 0.
struct SurfaceHearing
{
  float lit;  ///< intensity that arrives there, shaped by the tissue behind (section 1.3)
  float most; ///< see mostWeight
  bool diffuse;
  bool coherent;
};

/// Whether a tangent, given by the squares of cosine and sine, counts for some point of a piece.
SONO_HD inline bool withinTangent(float reach, float cosSquared, float sinSquared)
{
  const float wider = reach + surfaceTangentSlack;
  return reach >= 0.0f && sinSquared < wider * wider * cosSquared;
}

/// Whether a Gaussian beam may see something at least so far from its axis; it may be a little wider at a piece's other
/// end.
SONO_HD inline bool maySee(const ProfileAt& at, float lateralMm, float elevationalMm)
{
  return lateralMm * lateralMm * at.perLateral2 + elevationalMm * elevationalMm * at.perElevational2 <=
         1.1f * beamCutSigma * beamCutSigma;
}

/// A bound on the share of its strongest value that a beam has within `radiusMm` of a place; 0 where it sees nothing.
SONO_HD inline float mostWeight(const Vec3f& position, float radiusMm, const Beam& b, const LineGrid& g)
{
  const BeamPlace place = placeInBeam(position.x, position.y, position.z, b, g);
  const float depthMm = place.position / g.samplesPerMm;
  if (depthMm + radiusMm < 0.0f || place.position - radiusMm * g.samplesPerMm > g.lastSample)
  {
    return 0.0f;
  }
  const float l = larger(0.0f, fabsf(place.lateral) - radiusMm);
  const float e = larger(0.0f, fabsf(place.elevational) - radiusMm);
  if (b.kind == BeamKind::Array)
  {
    const float most = b.arraySight->most(l * b.lateralCosine, e * b.elevationalCosine, depthMm - radiusMm,
                                          quickSqrt(depthMm * depthMm + l * l + e * e) + 2.0f * radiusMm);
    return most > ArraySightView::faintest ? most : 0.0f;
  }
  if (!isGaussian(b))
  {
    return 1.0f;
  }
  return maySee(gaussianAt(b, larger(depthMm, 0.0f)), l, e) ? 1.0f : 0.0f;
}

/// The depth from which the intensity of a piece is taken, whose normal has these components in the beam's directions:
/// in front of where the line's own axis meets its plane, since behind that it has fallen already.
SONO_HD inline float litFromMm(const BeamPlace& place, float depthMm, float normalL, float normalE, float along,
                               const SurfaceTable& table)
{
  const float ahead = (normalL * place.lateral + normalE * place.elevational) / along;
  return depthMm + larger(-surfaceCrossingMm, smaller(0.0f, ahead)) - table.slackMm;
}

/// Shaped by the tissue behind (section 1.3).
SONO_HD inline float shapedLit(float lit, float along, const SurfaceRow& row)
{
  const float shaped = row.tau != 1.0f ? powf(lit, row.tau) : lit;
  return row.gamma != 0.0f ? shaped * powf(fabsf(along), row.gamma) : shaped;
}

/// For a piece all of whose points lie within `radiusMm` of a position, cut as coarsely as pieces are or not.
SONO_HD inline SurfaceHearing hearSurface(const Vec3f& position, const Vec3f& normal, float radiusMm, bool isCoarse,
                                          int rowFromA, const Beam& b, const LineGrid& g, const SurfaceTable& table,
                                          const SurfaceIntensity& intensity)
{
  const SurfaceHearing nothing{ 0.0f, 0.0f, false, false };
  const float along = glm::dot(normal, b.axis);
  const float cosSquared = along * along;
  const float sinSquared = larger(0.0f, 1.0f - cosSquared);
  const SurfaceRow& row = table.rows[along < 0.0f ? rowFromA ^ 1 : rowFromA];
  const bool diffuse = withinTangent(row.reach, cosSquared, sinSquared);
  const bool coherent = withinTangent(isCoarse ? row.coherentReach : row.finestReach, cosSquared, sinSquared);
  if (!diffuse && !coherent)
  {
    return nothing;
  }
  const float most = mostWeight(position, radiusMm, b, g);
  if (!(most > 0.0f))
  {
    return nothing;
  }
  const BeamPlace place = placeInBeam(position.x, position.y, position.z, b, g);
  float depthMm = place.position / g.samplesPerMm;
  if (b.kind == BeamKind::Array)
  {
    depthMm = quickSqrt(depthMm * depthMm + place.lateral * place.lateral + place.elevational * place.elevational);
  }
  const float fromMm =
    litFromMm(place, depthMm, glm::dot(normal, b.lateral), glm::dot(normal, b.elevation), along, table);
  const float arrives = intensity.bins ? intensityOfBins(intensity, fromMm, depthMm, row.decayPerMm) : 1.0f;
  const float lit = shapedLit(arrives, along, row);
  return lit > surfaceFaintestLit ? SurfaceHearing{ lit, most, diffuse, coherent } : nothing;
}

/// Whether a line may hear a piece of which only a rough normal is known (0: none), from either side.
SONO_HD inline bool mayHearSurface(const Vec3f& position, const Vec3f& roughNormal, float radiusMm, int row,
                                   const Beam& b, const LineGrid& g, const SurfaceTable& table)
{
  const float along = glm::dot(roughNormal, b.axis);
  const SurfaceRow& met = table.rows[along < 0.0f ? row ^ 1 : row];
  if (fabsf(along) < met.roughCosine && glm::dot(roughNormal, roughNormal) > 0.0f)
  {
    return false;
  }
  return mostWeight(position, radiusMm, b, g) > 0.0f;
}

/// How a beam meets a point of a surface.
struct SurfaceMeeting
{
  BeamPlace place;
  float signedCosine;
  float cosSquared;
  float sinSquared;
  const SurfaceRow* row;
  ComplexWeight weight;
  ProfileAt at; ///< of a Gaussian
};

/// Where a point lies on a line and how it faces it; false beside the line.
SONO_HD inline bool faceSurface(const SurfacePoint& p, const Beam& b, const LineGrid& g, const SurfaceTable& table,
                                SurfaceMeeting& m)
{
  m.place = placeInBeam(p.position.x, p.position.y, p.position.z, b, g);
  m.signedCosine = glm::dot(p.normal, b.axis);
  m.cosSquared = m.signedCosine * m.signedCosine;
  m.sinSquared = larger(0.0f, 1.0f - m.cosSquared);
  m.row = &table.rows[m.signedCosine < 0.0f ? p.row ^ 1 : p.row];
  return m.place.position >= 0.0f && m.place.position < g.lastSample;
}

/// Whether a point counts at so large a tangent, given by the squares of cosine and sine.
SONO_HD inline bool isWithin(float reach, float cosSquared, float sinSquared)
{
  return reach >= 0.0f && sinSquared < reach * reach * cosSquared;
}

/// The beam's weight there; false where the beam does not see the point.
SONO_HD inline bool meetSurface(const Beam& b, const LineGrid& g, SurfaceMeeting& m)
{
  const float alongMm = m.place.position / g.samplesPerMm;
  if (!isGaussian(b))
  {
    const BeamEcho echo = beamEchoAt(b, m.place.lateral, m.place.elevational, alongMm);
    m.weight = echo.weight;
    m.place.position = echo.depthMm * g.samplesPerMm;
    return m.place.position < g.lastSample;
  }
  m.at = gaussianAt(b, alongMm);
  const float squared = m.place.lateral * m.place.lateral * m.at.perLateral2 +
                        m.place.elevational * m.place.elevational * m.at.perElevational2;
  m.weight = { m.at.amplitude * expNegative(-0.5f * squared), 0.0f };
  return squared < beamCutSigma * beamCutSigma;
}

/// Whether so strong an echo counts at the beam's weight.
SONO_HD inline bool isHeard(float echo, const ComplexWeight& w, float faintest)
{
  return fabsf(echo) * larger(fabsf(w.re), fabsf(w.im)) > faintest;
}

/// What is too faint where so much light falls.
SONO_HD inline float faintestAt(float lit)
{
  return larger(surfaceFaintest, quickDivide(surfaceFaintestLit, lit));
}

/// An amplitude at a place between two samples.
template<class Sum>
SONO_HD inline void addBetween(const ComplexWeight& w, const ComplexWeight& a, float lit, float position,
                               const LineGrid& g, Sum& sum)
{
  const ScattererSplit split = splitScatterer(lit, position, g);
  const float re = w.re * a.re - w.im * a.im;
  const float im = w.re * a.im + w.im * a.re;
  const int sample = int(split.sample);
  sum.add(sample, split.added[0] * re - split.added[1] * im, split.added[1] * re + split.added[0] * im);
  sum.add(sample + 1, split.added[2] * re - split.added[3] * im, split.added[3] * re + split.added[2] * im);
}

/// Where a point's slope falls in the table of a profile.
SONO_HD inline float diffuseNode(const SurfaceTable& table, float cosine, float sinSquared)
{
  const float node = quickSqrt(sinSquared) / larger(cosine, 1e-6f) * table.perTangent;
  return smaller(node, float(table.nodes - 2));
}

/// The amplitude of a point's diffuse echo, from its profile's for tilts along both of the beam's axes.
SONO_HD inline float diffuseStrength(float logDiffuse, float logL, float logE, float normalL, float normalE,
                                     float areaMm2)
{
  const float across = normalL * normalL + normalE * normalE;
  const float lateralShare = across > 1e-12f ? normalL * normalL / across : 0.5f;
  return expNegative(smaller(0.0f, logDiffuse + logE + lateralShare * (logL - logE))) * quickSqrt(areaMm2);
}

/// Adds the diffuse echo of a point, a scatterer of random phase, to the line's sum. sum.add(sample, re, im).
template<class Sum>
SONO_HD inline void addDiffuse(const SurfacePoint& p, const Beam& b, const LineGrid& g, const SurfaceTable& table,
                               const SurfaceHearing& heard, Sum& sum)
{
  SurfaceMeeting m;
  if (!faceSurface(p, b, g, table, m))
  {
    return;
  }
  const SurfaceRow& row = *m.row;
  if (!isWithin(row.reach, m.cosSquared, m.sinSquared))
  {
    return;
  }
  const float node = diffuseNode(table, fabsf(m.signedCosine), m.sinSquared);
  const int before = int(node);
  const float share = node - float(before);
  const int n = row.profile * table.nodes + before;
  const float logL = table.diffuseL[n] + share * (table.diffuseL[n + 1] - table.diffuseL[n]);
  const float logE = table.diffuseE[n] + share * (table.diffuseE[n + 1] - table.diffuseE[n]);
  const float diffuse = diffuseStrength(row.logDiffuse, logL, logE, glm::dot(p.normal, b.lateral),
                                        glm::dot(p.normal, b.elevation), p.areaMm2);
  const float faintest = faintestAt(heard.lit);
  if (diffuse * heard.most > faintest && meetSurface(b, g, m) && isHeard(diffuse, m.weight, faintest))
  {
    addBetween(m.weight, { diffuse * p.phaseRe, diffuse * p.phaseIm }, heard.lit, m.place.position, g, sum);
  }
}

/// Adds a Gaussian density of this sum and deviation, in samples, to a line; on as few samples as its smoothness
/// allows: with a stride m its images lie 2 pi / m away in phase, where six deviations of its spectrum and twice the
/// carrier are kept free. Its values follow from each other: the quotients of neighbouring ones are a geometric series.
template<class Sum>
SONO_HD inline void addDensity(float total, const ComplexWeight& w, float position, float deviation, const LineGrid& g,
                               Sum& sum)
{
  const int stride = int(larger(1.0f, 6.2831853f * deviation / (6.0f + 2.0f * deviation * g.radPerSample)));
  const float step = float(stride);
  const float a = 0.5f * step * step / (deviation * deviation);
  const float peak = total * step * 0.39894228f / deviation;
  const float quotient = expNegative(-2.0f * a);
  const float reach = surfaceBlobReach * deviation;
  const int middle = int(position);
  const float before = (position - float(middle)) / step;
  const float behind = 1.0f - before;
  int last = int(position + reach);
  const int first = int(larger(position - reach, -1.0f) + 1.0f);
  last = last < int(g.lastSample) ? last : int(g.lastSample);
  float value = peak * expNegative(-a * behind * behind);
  float falls = expNegative(-a * (2.0f * behind + 1.0f));
  for (int s = middle + stride; s <= last; s += stride)
  {
    sum.add(s, w.re * value, w.im * value);
    value *= falls;
    falls *= quotient;
  }
  value = peak * expNegative(-a * before * before);
  falls = expNegative(-a * (2.0f * before + 1.0f));
  for (int s = middle; s >= first; s -= stride)
  {
    sum.add(s, w.re * value, w.im * value);
    value *= falls;
    falls *= quotient;
  }
}

/// A blob as a line sees it: its variance in depth, in samples, and what the pulse's band leaves of it (eq. 10.6).
struct BlobOnLine
{
  float spread;
  float left;
};

/// `alongU` and `alongV` are its tangents' components along the beam's axis, mm.
SONO_HD inline BlobOnLine blobOnLine(float alongU, float alongV, const LineGrid& g, float pulseSigmaMm)
{
  const float du = alongU * g.samplesPerMm;
  const float dv = alongV * g.samplesPerMm;
  const float spread = du * du + dv * dv;
  const float phaseSquared = spread * g.radPerSample * g.radPerSample;
  const float pulse = pulseSigmaMm * g.samplesPerMm;
  return { spread, expNegative(-0.5f * phaseSquared * pulse * pulse / (pulse * pulse + spread)) };
}

/// The amplitude of a point's coherent echo, with its sign.
SONO_HD inline float coherentStrength(const SurfaceTable& table, const SurfaceRow& row, float cosine, float areaMm2)
{
  return surfaceReflection(row, cosine) * cosine * expNegative(-row.roughness * cosine * cosine) * areaMm2 *
         table.perBeamArea;
}

/// A Gaussian beam's weight that, smoothed by a blob, is the beam's own; from the components of the blob's tangents
/// across the beam. A table's beam is wide against a blob.
SONO_HD inline float smoothedWeight(const ProfileAt& at, const BeamPlace& place, float lateralU, float lateralV,
                                    float elevationalU, float elevationalV)
{
  const float leftL = larger(surfaceWidthShare, 1.0f - (lateralU * lateralU + lateralV * lateralV) * at.perLateral2);
  const float leftE =
    larger(surfaceWidthShare, 1.0f - (elevationalU * elevationalU + elevationalV * elevationalV) * at.perElevational2);
  const float squared = place.lateral * place.lateral * at.perLateral2 / leftL +
                        place.elevational * place.elevational * at.perElevational2 / leftE;
  return at.amplitude * expNegative(-0.5f * squared) / quickSqrt(leftL * leftE);
}

/// Adds a blob of this amplitude and variance in depth, in samples. Splitting a point between two samples widens by a
/// sixth of a sample's square, which the pulse takes off again: so does the density.
template<class Sum>
SONO_HD inline void addBlob(float amplitude, const ComplexWeight& w, float lit, float position, float spread,
                            const LineGrid& g, Sum& sum)
{
  const float deviation = quickSqrt(spread + 1.0f / 6.0f);
  if (deviation < surfaceShortestBlob)
  {
    const float turned = expNegative(-0.5f * spread * g.radPerSample * g.radPerSample);
    addBetween(w, { amplitude * turned, 0.0f }, lit, position, g, sum);
  }
  else
  {
    addDensity(amplitude * lit, w, position, deviation, g, sum);
  }
}

/// Adds the coherent echo of a point: a Gaussian of its blob's deviation in depth. What the pulse's band leaves of it
/// is nothing for most points, so that this comes before the beam.
template<class Sum>
SONO_HD inline void addCoherent(const SurfacePoint& p, const Beam& b, const LineGrid& g, const SurfaceTable& table,
                                const SurfaceHearing& heard, Sum& sum)
{
  SurfaceMeeting m;
  if (!faceSurface(p, b, g, table, m))
  {
    return;
  }
  const SurfaceRow& row = *m.row;
  if (!isWithin(row.finestReach, m.cosSquared, m.sinSquared))
  {
    return;
  }
  const BlobOnLine blob = blobOnLine(glm::dot(b.axis, p.tangentU), glm::dot(b.axis, p.tangentV), g, table.pulseSigmaMm);
  const float faintest = faintestAt(heard.lit);
  const float coherent = coherentStrength(table, row, fabsf(m.signedCosine), p.areaMm2);
  if (!(fabsf(coherent) * blob.left * heard.most > faintest) || !meetSurface(b, g, m))
  {
    return;
  }
  ComplexWeight w = m.weight;
  if (isGaussian(b))
  {
    w.re = smoothedWeight(m.at, m.place, glm::dot(b.lateral, p.tangentU), glm::dot(b.lateral, p.tangentV),
                          glm::dot(b.elevation, p.tangentU), glm::dot(b.elevation, p.tangentV));
  }
  if (isHeard(coherent * blob.left, w, faintest))
  {
    addBlob(coherent, w, heard.lit, m.place.position, blob.spread, g, sum);
  }
}

/// The samples of a whole line, re and im of each.
struct SurfaceSum
{
  float* iq;

  SONO_HD void add(int sample, float re, float im)
  {
    iq[2 * sample] += re;
    iq[2 * sample + 1] += im;
  }
};

} // namespace sono
