#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/PixelMath.h"
#include "Kernel/Rng.h"
#include "Kernel/Vec.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

// From the envelope of an echo to its grey level, for one sample of a line.

namespace sono {

constexpr float smallestNormalFloat = 1.17549435e-38f;
constexpr float largestFiniteFloat = 3.40282347e+38f;

/// The grey of a compressed level x in [0, 1] from `count` >= 2 values at equal steps, straight in between.
SONO_HD inline float mapGrey(const float* map, int count, float x)
{
  const float position = x * float(count - 1);
  const int i = position < float(count - 1) ? int(position) : count - 2;
  return map[i] + (position - float(i)) * (map[i + 1] - map[i]);
}

/// Log compression; `offsetDb` is the sample's gain over the bottom of the range. A comparison with NaN is false, so
/// that NaN ends up black.
SONO_HD inline float compressedLevel(float envelope, float offsetDb, float rangeDb, float rejectDb)
{
  const float floored = envelope > smallestNormalFloat ? envelope : smallestNormalFloat;
  const float usable = floored < largestFiniteFloat ? floored : largestFiniteFloat;
  const float aboveBottomDb = fastDecibels(usable) + offsetDb;
  const float capped = aboveBottomDb < rangeDb ? aboveBottomDb : rangeDb;
  const bool shown = (envelope >= smallestNormalFloat) & (capped > 0.0f) & (capped >= rejectDb);
  return shown ? capped * (1.0f / rangeDb) : 0.0f;
}

/// The bits of the gained envelope, which order as the non-negative floats do; 0 for what is no amplitude.
SONO_HD inline std::uint32_t gainedBits(float envelope, float factor)
{
  const bool usable = envelope > 0.0f && envelope <= largestFiniteFloat;
  const float product = usable ? envelope * factor : 0.0f;
  const float gained = product < largestFiniteFloat ? product : largestFiniteFloat;
  std::uint32_t bits;
  memcpy(&bits, &gained, sizeof bits);
  return bits;
}

/// Receiver noise is a band-limited complex normal process: independent normals at equidistant nodes of a line, blended
/// by cubic B-splines, whose bell is the pulse's to a few per cent where nodes are sqrt(3) of its sigmas apart.
constexpr float noiseNodesPerSigma = 0.577350269f;

/// A node's normal, circular and of mean square 1, a function of (seed, line, node) alone (Box and Muller: sqrt(-log u)
/// exp(i angle)).
SONO_HD inline Vec2f noiseNode(std::uint64_t seed, std::uint32_t line, std::uint32_t node)
{
  constexpr float pi = 3.14159265f;
  constexpr std::uint32_t noiseUse = 0x6e6f6973u; // keeps the stream apart from others of the same seed
  const RandomWords words = philox(seed, line, node, 0u, noiseUse);
  const float radius = sqrtf(-logPositive(uniformFrom(words.v[0])));
  const float half = pi * (uniformFrom(words.v[1]) - 0.5f);
  const float c = cosSmall(half);
  const float d = sinSmall(half);
  return { radius * (c * c - d * d), radius * 2.0f * c * d };
}

/// Weights of four neighbouring nodes at a share f in [0, 1) of the way from the second to the third.
struct SplineWeights
{
  float w[4];
};
SONO_HD inline SplineWeights cubicSpline(float f)
{
  const float g = 1.0f - f;
  const float sixth = 1.0f / 6.0f;
  return { { sixth * g * g * g, sixth * (4.0f + 3.0f * f * f * (f - 2.0f)), sixth * (4.0f + 3.0f * g * g * (g - 2.0f)),
             sixth * f * f * f } };
}

/// |envelope + n| with n of mean square rms^2 everywhere: the blend of four nodes, as long as one. Being circular, it
/// needs not know the echo's phase. What is no amplitude stays.
SONO_HD inline float noisyEnvelope(float envelope, float rms, const Vec2f* nodes, float f)
{
  const SplineWeights s = cubicSpline(f);
  const float length2 = s.w[0] * s.w[0] + s.w[1] * s.w[1] + s.w[2] * s.w[2] + s.w[3] * s.w[3];
  const float scale = rms / sqrtf(length2);
  const float re =
    envelope + scale * (s.w[0] * nodes[0].x + s.w[1] * nodes[1].x + s.w[2] * nodes[2].x + s.w[3] * nodes[3].x);
  const float im = scale * (s.w[0] * nodes[0].y + s.w[1] * nodes[1].y + s.w[2] * nodes[2].y + s.w[3] * nodes[3].y);
  return envelope >= 0.0f ? sqrtf(re * re + im * im) : envelope;
}

/// The envelope with haze, whose many arrivals add as power. `power` is that of haze at nodes of a line, straight in
/// between. What is no amplitude stays.
SONO_HD inline float hazyEnvelope(float envelope, const float* power, float position)
{
  const int i = int(position);
  const float here = power[i] + (position - float(i)) * (power[i + 1] - power[i]);
  return envelope >= 0.0f && envelope < 1e18f ? sqrtf(envelope * envelope + here) : envelope;
}

/// Weighted mean of the amplitudes about the s-th of a row of `count`, `stride` apart: samples of a line, or lines at a
/// depth; `weights` are those of 0 to `half` places away. What is no amplitude does not count, and stays.
SONO_HD inline float smoothedEnvelope(const float* row, int count, std::ptrdiff_t stride, int s, const float* weights,
                                      int half)
{
  const int first = s - half > 0 ? s - half : 0;
  const int last = s + half < count - 1 ? s + half : count - 1;
  float sum = 0.0f;
  float total = 0.0f;
  for (int i = first; i <= last; ++i)
  {
    const float weight = weights[i < s ? s - i : i - s];
    const float value = row[i * stride];
    const bool usable = value >= 0.0f && value <= largestFiniteFloat;
    sum += usable ? weight * value : 0.0f;
    total += usable ? weight : 0.0f;
  }
  const float here = row[s * stride];
  return here >= 0.0f && here <= largestFiniteFloat ? sum / total : here;
}

} // namespace sono
