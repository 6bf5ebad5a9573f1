#include "Image/ReceiverNoise.h"

#include "Kernel/FastMath.h"
#include "Kernel/Rng.h"
#include "ParallelFor.h"
#include "Simd.h"

#include <cmath>

namespace sono {

namespace {

constexpr std::uint32_t noiseUse = 0x6e6f6973u; // keeps the stream apart from others of the same seed

/// Box and Muller: sqrt(-log u) exp(i angle) is circular with a mean square of 1.
SONO_SIMD_CLONES void addNoise(float* envelope, int count, float rms, std::uint64_t seed, std::uint32_t line)
{
  constexpr float pi = 3.14159265f;
  for (int s = 0; s < count; ++s)
  {
    const RandomWords words = philox(seed, line, std::uint32_t(s), 0u, noiseUse);
    const float radius = rms * std::sqrt(-logPositive(uniformFrom(words.v[0])));
    const float half = pi * (uniformFrom(words.v[1]) - 0.5f);
    const float c = cosSmall(half);
    const float d = sinSmall(half);
    const float e = envelope[s];
    const float re = e + radius * (c * c - d * d);
    const float im = radius * 2.0f * c * d;
    envelope[s] = e >= 0.0f ? std::sqrt(re * re + im * im) : e;
  }
}

} // namespace

void addReceiverNoise(std::vector<float>& envelope, int sampleCount, double levelDb, std::uint64_t seed)
{
  const auto rms = float(std::pow(10.0, levelDb / 20.0));
  parallelFor(int(envelope.size() / std::size_t(sampleCount)), {}, [&](int line) {
    addNoise(envelope.data() + std::size_t(line) * std::size_t(sampleCount), sampleCount, rms, seed,
             std::uint32_t(line));
  });
}

} // namespace sono
