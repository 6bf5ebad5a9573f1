#include "Trace/Deposit.h"

#include "Kernel/FastMath.h"
#include "Simd.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

/// A segment seen from its line: depth r(s) = r0 + mu s; squared distance from the axis a + 2 b s + c s^2.
struct BeamSegment
{
  float r0;
  float mu;
  float length;
  float intensity;
  float decay;
  float a;
  float b;
  float c;
  float coherence;
};

inline float weightAt(const BeamSegment& g, float s)
{
  const float squared = std::max(0.0f, g.a + s * (2.0f * g.b + s * g.c));
  const float distance = std::sqrt(squared);
  const float weight = g.coherence / (g.coherence + std::max(distance, 1e-3f));
  return distance < 1e-3f ? 1.0f : weight;
}

/// Mean of I w_R over the depths [from, to] of the segment: the decay is integrated exactly, the coherence weight,
/// which is smooth on the scale of a bin, by two Gauss points.
inline float meanOver(const BeamSegment& g, float from, float to, float inverseMu)
{
  const float s0 = (from - g.r0) * inverseMu;
  const float s1 = (to - g.r0) * inverseMu;
  const float near = std::max(0.0f, std::min(s0, s1));
  const float step = std::max(0.0f, std::max(s0, s1) - near);
  const float x = g.decay * step;
  const float share = x > 1e-3f ? (1.0f - expNegative(-x)) / x : 1.0f - 0.5f * x;
  const float w = 0.5f * (weightAt(g, near + 0.21132487f * step) + weightAt(g, near + 0.78867513f * step));
  return g.intensity * expNegative(-g.decay * near) * share * w;
}

/// Adds the segment's mean over the whole bins [first, last) to them.
SONO_SIMD_CLONES void depositWholeBins(const BeamSegment& g, float binMm, int first, int last, float* bins)
{
  const float inverseMu = 1.0f / g.mu;
  const float step = binMm * std::fabs(inverseMu);
  const float x = g.decay * step;
  const float share = x > 1e-3f ? (1.0f - expNegative(-x)) / x : 1.0f - 0.5f * x;
  const float scale = 0.5f * g.intensity * share;
  // Where a bin begins as seen by the path: its near end for either sense of travel.
  const float nearEdge = g.mu > 0.0f ? 0.0f : binMm;
  const BeamSegment local = g;
  for (int b = first; b < last; ++b)
  {
    const float near = (float(b) * binMm + nearEdge - local.r0) * inverseMu;
    const float w = weightAt(local, near + 0.21132487f * step) + weightAt(local, near + 0.78867513f * step);
    bins[b] += scale * expNegative(-local.decay * near) * w;
  }
}

} // namespace

LineTally::LineTally(int binCount, double binMm, int echoCount, double echoSampleMm, double wavesPerMm)
  : bins_(std::size_t(binCount), 0.0f)
  , binMm_(float(binMm))
  , echoCount_(echoCount)
  , echoSampleMm_(float(echoSampleMm))
  , radPerMm_(float(4.0 * 3.14159265358979323846 * wavesPerMm))
{
}

void LineTally::start(const TraceLine& line, float coherenceMm, std::complex<float>* echo)
{
  line_ = line;
  coherenceMm_ = coherenceMm;
  echo_ = echo;
}

void LineTally::clearBins()
{
  std::fill(bins_.begin(), bins_.end(), 0.0f);
}

SONO_SIMD_CLONES void LineTally::segment(const PathSegment& s)
{
  ++segments_;
  const Vec3f q = s.start - line_.origin;
  const float r0 = glm::dot(q, line_.axis);
  const float mu = glm::dot(s.direction, line_.axis);
  const float r1 = r0 + mu * s.length;
  const float low = std::max(0.0f, std::min(r0, r1));
  const float high = std::min(std::max(r0, r1), binMm_ * float(bins_.size()));
  // A segment across the beam crosses no plane.
  if (!(high - low > 1e-6f) || std::fabs(mu) < 1e-6f)
  {
    return;
  }
  const Vec3f offAxis = q - line_.axis * r0;
  const Vec3f drift = s.direction - line_.axis * mu;
  const BeamSegment g{ r0,
                       mu,
                       s.length,
                       s.intensity,
                       s.decayPerMm,
                       glm::dot(offAxis, offAxis),
                       glm::dot(offAxis, drift),
                       glm::dot(drift, drift),
                       coherenceMm_ };
  const int last = int(bins_.size()) - 1;
  const int binLow = std::min(int(low / binMm_), last);
  const int binHigh = std::min(int(high / binMm_), last);
  const float inverseMu = 1.0f / mu;
  const auto part = [&](int bin, float from, float to) {
    bins_[std::size_t(bin)] += meanOver(g, from, to, inverseMu) * (to - from) / binMm_;
  };
  if (binLow == binHigh)
  {
    part(binLow, low, high);
    return;
  }
  part(binLow, low, float(binLow + 1) * binMm_);
  depositWholeBins(g, binMm_, binLow + 1, binHigh, bins_.data());
  part(binHigh, float(binHigh) * binMm_, high);
}

void LineTally::echo(const Vec3f& point, float amplitude)
{
  const Vec3f q = point - line_.origin;
  const float r = glm::dot(q, line_.axis);
  const float distance = glm::length(q - line_.axis * r);
  const float position = r / echoSampleMm_;
  const int sample = int(std::floor(position));
  if (sample < 0 || sample + 1 >= echoCount_)
  {
    return;
  }
  const float fraction = position - float(sample);
  const float phase = radPerMm_ * fraction * echoSampleMm_;
  const float a = amplitude * coherenceWeight(coherenceMm_, distance) * echoWeight_;
  echo_[sample] += std::polar(a * (1.0f - fraction), -phase);
  echo_[sample + 1] += std::polar(a * fraction, radPerMm_ * echoSampleMm_ - phase);
}

} // namespace sono
