#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/PixelMath.h"
#include "Kernel/Rng.h"

#include <cstdint>
#include <cstring>

// From the envelope of an echo to its grey level, for one sample of a line.

namespace sono {

constexpr float smallestNormalFloat = 1.17549435e-38f;
constexpr float largestFiniteFloat = 3.40282347e+38f;

/// Grey level g in [0, 1] of a compressed level x in [0, 1]; each keeps black and white.
enum class GreyMap
{
  Linear,     ///< g = x
  SquareRoot, ///< g = sqrt(x): weak echoes brighter
  Sigmoid     ///< g = x^2 (3 - 2 x): more contrast in the middle, less at both ends
};

SONO_HD inline float mapGrey(GreyMap map, float x)
{
  return map == GreyMap::Linear ? x : (map == GreyMap::SquareRoot ? sqrtf(x) : x * x * (3.0f - 2.0f * x));
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

/// |envelope + n| with n complex, normal, circular, of mean square rms^2, a function of (seed, line, sample) alone
/// (Box and Muller: sqrt(-log u) exp(i angle) is circular with a mean square of 1). What is no amplitude stays.
SONO_HD inline float noisyEnvelope(float envelope, float rms, std::uint64_t seed, std::uint32_t line,
                                   std::uint32_t sample)
{
  constexpr float pi = 3.14159265f;
  constexpr std::uint32_t noiseUse = 0x6e6f6973u; // keeps the stream apart from others of the same seed
  const RandomWords words = philox(seed, line, sample, 0u, noiseUse);
  const float radius = rms * sqrtf(-logPositive(uniformFrom(words.v[0])));
  const float half = pi * (uniformFrom(words.v[1]) - 0.5f);
  const float c = cosSmall(half);
  const float d = sinSmall(half);
  const float re = envelope + radius * (c * c - d * d);
  const float im = radius * 2.0f * c * d;
  return envelope >= 0.0f ? sqrtf(re * re + im * im) : envelope;
}

} // namespace sono
