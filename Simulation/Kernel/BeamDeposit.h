#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/PathState.h"
#include "Kernel/TraceView.h"

namespace sono {

/// A segment seen from its line: depth r(s) = r0 + mu s; squared distance from the axis a + 2 b s + c s^2.
/// A path deposits where it crosses the plane at r, whatever its slope: I(r) is the sum of I w_R over those crossings.
struct BeamSegment
{
  float r0;
  float mu;
  float intensity;
  float decay;
  float a;
  float b;
  float c;
  float coherence;
  float absorbed; ///< of PathSegment, at its start
};

SONO_HD inline BeamSegment beamSegment(const TraceLine& line, const PathSegment& s, float coherenceMm)
{
  const Vec3f q = s.start - line.origin;
  const float r0 = glm::dot(q, line.axis);
  const float mu = glm::dot(s.direction, line.axis);
  const Vec3f offAxis = q - line.axis * r0;
  const Vec3f drift = s.direction - line.axis * mu;
  return { r0,
           mu,
           s.intensity,
           s.decayPerMm,
           glm::dot(offAxis, offAxis),
           glm::dot(offAxis, drift),
           glm::dot(drift, drift),
           coherenceMm,
           s.absorbed };
}

/// The depths that a segment covers of [0, endMm]; nothing where high <= low. A segment across the beam crosses no
/// plane.
struct DepthSpan
{
  float low;
  float high;
};

SONO_HD inline DepthSpan depthSpan(float r0, float mu, float length, float endMm)
{
  const float r1 = r0 + mu * length;
  const float low = larger(0.0f, smaller(r0, r1));
  const float high = smaller(larger(r0, r1), endMm);
  return high - low > 1e-6f && fabsf(mu) >= 1e-6f ? DepthSpan{ low, high } : DepthSpan{ 0.0f, 0.0f };
}

/// The bins [first, last] that a span reaches into; none, last < first, where it is empty.
struct BinSpan
{
  int first;
  int last;
};

/// By the edges as they are computed where a span is cut at them, float(b) * binMm: a quotient that is rounded past one
/// would leave a negative rest behind it.
SONO_HD inline BinSpan binSpan(const DepthSpan& span, float binMm)
{
  const int low = int(span.low / binMm);
  const int high = int(span.high / binMm);
  return { low + int(float(low + 1) * binMm <= span.low) - int(float(low) * binMm > span.low),
           high + int(float(high + 1) * binMm < span.high) - int(float(high) * binMm >= span.high) };
}

SONO_HD inline float beamWeightAt(const BeamSegment& g, float s)
{
  const float distance = quickSqrt(larger(0.0f, g.a + s * (2.0f * g.b + s * g.c)));
  const float weight = quickDivide(g.coherence, g.coherence + larger(distance, 1e-3f));
  return distance < 1e-3f ? 1.0f : weight;
}

/// Mean of exp(-x t) over t in [0, 1], x >= 0.
SONO_HD inline float meanDecay(float x)
{
  return x > 0.04f ? quickDivide(1.0f - expNegative(-x), x)
                   : 1.0f - x * (0.5f - x * (1.0f / 6.0f - x * (1.0f / 24.0f)));
}

/// Sum of the coherence weights at the two Gauss points of the piece [near, near + step] of the segment: they are
/// smooth on the scale of a bin.
SONO_HD inline float gaussWeights(const BeamSegment& g, float near, float step)
{
  return beamWeightAt(g, near + 0.21132487f * step) + beamWeightAt(g, near + 0.78867513f * step);
}

/// Mean of I w_R over the depths [from, to] of the segment; the decay is integrated exactly.
SONO_HD inline float meanOver(const BeamSegment& g, float from, float to, float inverseMu)
{
  const float s0 = (from - g.r0) * inverseMu;
  const float s1 = (to - g.r0) * inverseMu;
  const float near = larger(0.0f, smaller(s0, s1));
  const float step = larger(0.0f, larger(s0, s1) - near);
  return g.intensity * expNegative(-g.decay * near) * meanDecay(g.decay * step) * 0.5f * gaussWeights(g, near, step);
}

/// Where a boundary's echo lies along a line, and the coherence weight there.
struct EchoPlace
{
  float depthMm;
  float weight;
};

SONO_HD inline EchoPlace echoPlace(const TraceLine& line, const Vec3f& point, float coherenceMm)
{
  const Vec3f q = point - line.origin;
  const float r = glm::dot(q, line.axis);
  return { r, coherenceWeight(coherenceMm, glm::length(q - line.axis * r)) };
}

/// Where an echo falls on a line's grid of samples: amplitudes (re, im) of the sample before it and of the one behind
/// it, each with the phase of its distance from there.
struct EchoSplit
{
  int sample; ///< -1: not on the grid
  float amplitude[4];
};

SONO_HD inline EchoSplit splitEcho(float r, float a, float sampleMm, int sampleCount, float radPerMm)
{
  const float position = r / sampleMm;
  const int sample = int(floorf(position));
  if (!(position >= 0.0f) || sample + 1 >= sampleCount)
  {
    return { -1, {} };
  }
  const float fraction = position - float(sample);
  const float near = radPerMm * fraction * sampleMm;
  const float far = radPerMm * sampleMm - near;
  float sinNear;
  float cosNear;
  float sinFar;
  float cosFar;
  sinCos(near, sinNear, cosNear);
  sinCos(far, sinFar, cosFar);
  return { sample,
           { a * (1.0f - fraction) * cosNear, -a * (1.0f - fraction) * sinNear, a * fraction * cosFar,
             a * fraction * sinFar } };
}

} // namespace sono
