#pragma once

#include "Kernel/ApertureProfile.h"
#include "Kernel/ArrayBeam.h"
#include "Kernel/ArraySightView.h"
#include "Kernel/BeamField.h"
#include "Kernel/FastMath.h"
#include "Kernel/Vec.h"

#include <cstdint>

namespace sono {

/// What the weight of a beam comes from.
enum class BeamKind
{
  Gaussian, ///< the same two sigmas at each depth
  Aperture, ///< Gaussians of an aperture
  Field,    ///< a table of weights
  Array     ///< a computed complex beam
};

/// A main beam in its scatterers' coordinates.
struct Beam
{
  Vec3f origin;
  Vec3f axis;
  Vec3f lateral;
  Vec3f elevation;
  float lateralSigmaMm; ///< of a Gaussian profile: w = exp(-(dL^2 / sL^2 + dE^2 / sE^2) / 2)
  float elevationalSigmaMm;
  const BeamFieldView* field; ///< of a Field
  BeamKind kind;
  ApertureProfile profile;          ///< of an Aperture
  const ArrayBeamView* array;       ///< of an Array
  const ArraySightView* arraySight; ///< the same
  float lateralCosine;              ///< of an Array: of the line's angle, from where the aperture is narrower
  float elevationalCosine;
  float gain; ///< of an Array
};

/// Beyond this many sigma a Gaussian beam does not see a scatterer: it would add less than exp(-16/2) of its amplitude.
constexpr float beamCutSigma = 4.0f;

/// The sampling of a line as the inner loop wants it.
struct LineGrid
{
  float samplesPerMm;
  float radPerSample;
  float halfTurnRe; ///< exp(i radPerSample / 2)
  float halfTurnIm;
  float lastSample;
};

/// `radPerMm` is 2 k; a sample's turn must be below pi (Nyquist).
inline LineGrid makeLineGrid(float sampleMm, double radPerMm, int sampleCount)
{
  const double turn = radPerMm * double(sampleMm);
  return { 1.0f / sampleMm, float(turn), float(std::cos(0.5 * turn)), float(std::sin(0.5 * turn)),
           float(sampleCount - 1) };
}

/// A scatterer in the beam's frame: depth in samples, distances from the axis in mm.
struct BeamPlace
{
  float position;
  float lateral;
  float elevational;
};

SONO_HD inline BeamPlace placeInBeam(float x, float y, float z, const Beam& b, const LineGrid& g)
{
  const float px = x - b.origin.x;
  const float py = y - b.origin.y;
  const float pz = z - b.origin.z;
  return { (px * b.axis.x + py * b.axis.y + pz * b.axis.z) * g.samplesPerMm,
           px * b.lateral.x + py * b.lateral.y + pz * b.lateral.z,
           px * b.elevation.x + py * b.elevation.y + pz * b.elevation.z };
}

/// What a scatterer adds: (re, im) to the sample before it and to the one behind it.
struct ScattererSplit
{
  float sample;
  float added[4];
};

/// Splits amplitude a, seen at a position on the line, between its two samples.
SONO_HD inline ScattererSplit splitScatterer(float a, float position, const LineGrid& g)
{
  const float whole = floorf(position);
  const float fraction = position - whole;
  // Phase as seen from halfway between the two samples, which keeps it below pi / 2; each is half a turn away.
  const float phase = g.radPerSample * (fraction - 0.5f);
  const float re = a * cosSmall(phase);
  const float im = -a * sinSmall(phase);
  const float near = 1.0f - fraction;
  return { whole,
           { (re * g.halfTurnRe + im * g.halfTurnIm) * near, (im * g.halfTurnRe - re * g.halfTurnIm) * near,
             (re * g.halfTurnRe - im * g.halfTurnIm) * fraction, (im * g.halfTurnRe + re * g.halfTurnIm) * fraction } };
}

/// The same of a complex amplitude.
SONO_HD inline ScattererSplit splitScatterer(const ComplexWeight& a, float position, const LineGrid& g)
{
  const float whole = floorf(position);
  const float fraction = position - whole;
  const float phase = g.radPerSample * (fraction - 0.5f);
  const float c = cosSmall(phase);
  const float s = sinSmall(phase);
  const float re = a.re * c + a.im * s;
  const float im = a.im * c - a.re * s;
  const float near = 1.0f - fraction;
  return { whole,
           { (re * g.halfTurnRe + im * g.halfTurnIm) * near, (im * g.halfTurnRe - re * g.halfTurnIm) * near,
             (re * g.halfTurnRe - im * g.halfTurnIm) * fraction, (im * g.halfTurnRe + re * g.halfTurnIm) * fraction } };
}

SONO_HD inline bool isGaussian(const Beam& b)
{
  return b.kind == BeamKind::Aperture || b.kind == BeamKind::Gaussian;
}

/// The weight of a Gaussian beam at a depth >= 0.
SONO_HD inline ProfileAt gaussianAt(const Beam& b, float depthMm)
{
  return b.kind == BeamKind::Aperture ? profileAt(b.profile, depthMm)
                                      : ProfileAt{ 1.0f / (b.lateralSigmaMm * b.lateralSigmaMm),
                                                   1.0f / (b.elevationalSigmaMm * b.elevationalSigmaMm), 1.0f };
}

/// What a beam makes of a unit scatterer: its complex weight, and the depth from which it echoes.
struct BeamEcho
{
  ComplexWeight weight;
  float depthMm;
};

/// At a place of a line, depth `depthMm` >= 0, beyond the cut of its Gaussians too.
SONO_HD inline BeamEcho beamEchoAt(const Beam& b, float lateralMm, float elevationalMm, float depthMm)
{
  const float l2 = lateralMm * lateralMm;
  const float e2 = elevationalMm * elevationalMm;
  switch (b.kind)
  {
    case BeamKind::Array:
    {
      const float rangeMm = quickSqrt(depthMm * depthMm + l2 + e2);
      const ComplexWeight w =
        arrayBeamWeight(*b.array, lateralMm * b.lateralCosine, elevationalMm * b.elevationalCosine, rangeMm);
      return { { b.gain * w.re, b.gain * w.im }, rangeMm };
    }
    case BeamKind::Field:
      return { { beamWeight(*b.field, lateralMm, elevationalMm, smaller(depthMm, b.field->depth.highMm)), 0.0f },
               depthMm };
    case BeamKind::Aperture:
    {
      const ProfileAt at = profileAt(b.profile, depthMm);
      return { { at.amplitude * expNegative(-0.5f * (l2 * at.perLateral2 + e2 * at.perElevational2)), 0.0f }, depthMm };
    }
    default:
      break;
  }
  const float squared = l2 / (b.lateralSigmaMm * b.lateralSigmaMm) + e2 / (b.elevationalSigmaMm * b.elevationalSigmaMm);
  return { { expNegative(-0.5f * squared), 0.0f }, depthMm };
}

/// The modulus of a beam's weight at a place, relative to that on its axis; or at the place nearest to the axis that
/// lies no further away than this in either direction.
SONO_HD inline float relativeWeight(const Beam& b, const Vec3f& fromOrigin, float depthMm,
                                    const Vec2f& withinMm = Vec2f(0.0f))
{
  const float l = larger(0.0f, fabsf(glm::dot(fromOrigin, b.lateral)) - withinMm.x);
  const float e = larger(0.0f, fabsf(glm::dot(fromOrigin, b.elevation)) - withinMm.y);
  const float depth = larger(depthMm, 0.0f);
  if (isGaussian(b))
  {
    const ProfileAt at = gaussianAt(b, depth);
    return expNegative(-0.5f * (l * l * at.perLateral2 + e * e * at.perElevational2));
  }
  const ComplexWeight on = beamEchoAt(b, 0.0f, 0.0f, depth).weight;
  const ComplexWeight off = beamEchoAt(b, l, e, depth).weight;
  const float onAxis = sqrtf(on.re * on.re + on.im * on.im);
  const float here = sqrtf(off.re * off.re + off.im * off.im);
  return here < onAxis ? here / onAxis : 1.0f;
}

/// Squared distance from the axis in sigmas.
SONO_HD inline float squaredSigmas(const BeamPlace& p, float perLateralSigma, float perElevationalSigma)
{
  const float dl = p.lateral * perLateralSigma;
  const float de = p.elevational * perElevationalSigma;
  return dl * dl + de * de;
}

} // namespace sono
