#pragma once

#include "Kernel/GreyLevel.h"

namespace sono {

/// The speckle of what reverberates, before the pulse: many places that lie at one range, complex normal and of mean
/// square 1. Samples are independent, lines alike as their beams overlap: normals at nodes across the lines, blended by
/// cubic B-splines. It belongs to the probe, not to the body.
struct ReverberationNoise
{
  std::uint64_t seed = 0;
  float nodesPerLine = 1.0f;

  friend bool operator==(const ReverberationNoise& a, const ReverberationNoise& b)
  {
    return a.seed == b.seed && a.nodesPerLine == b.nodesPerLine;
  }

  SONO_HD Vec2f node(int index, int sample) const
  {
    constexpr std::uint64_t ownStream = 0x7265766572623aull;
    return noiseNode(seed ^ ownStream, std::uint32_t(index), std::uint32_t(sample));
  }
  /// The first of the four nodes that a line blends.
  SONO_HD int firstNode(int line) const { return int(float(line) * nodesPerLine); }
  /// Of the four nodes that a line blends; their squares add up to 1.
  SONO_HD SplineWeights weights(int line) const
  {
    SplineWeights s = cubicSpline(float(line) * nodesPerLine - float(firstNode(line)));
    const float length = sqrtf(s.w[0] * s.w[0] + s.w[1] * s.w[1] + s.w[2] * s.w[2] + s.w[3] * s.w[3]);
    for (float& w : s.w)
    {
      w /= length;
    }
    return s;
  }
  SONO_HD Vec2f at(int line, int sample) const
  {
    const SplineWeights s = weights(line);
    Vec2f sum(0.0f);
    for (int k = 0; k < 4; ++k)
    {
      sum += s.w[k] * node(firstNode(line) + k, sample);
    }
    return sum;
  }
};

/// A level below this is not worth its noise.
constexpr float faintestReverberation = 1e-5f;

/// Values in the middles of bins, `levelOf(bin)`, at a range.
template<class LevelOf>
SONO_HD inline float levelAtRange(const LevelOf& levelOf, int count, float binsPerSample, int sample)
{
  const float wanted = float(sample) * binsPerSample - 0.5f;
  const float position = wanted < 0.0f ? 0.0f : (wanted < float(count - 1) ? wanted : float(count - 1));
  const int bin = int(position);
  const int next = bin + 1 < count ? bin + 1 : bin;
  const float level = levelOf(bin);
  return level + (levelOf(next) - level) * (position - float(bin));
}

} // namespace sono
