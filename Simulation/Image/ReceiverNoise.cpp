#include "Image/ReceiverNoise.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Kernel/GreyLevel.h"

#include <cmath>

namespace sono {

namespace {

SONO_SIMD_CLONES void addNoise(float* envelope, int count, float rms, std::uint64_t seed, std::uint32_t line)
{
  for (int s = 0; s < count; ++s)
  {
    envelope[s] = noisyEnvelope(envelope[s], rms, seed, line, std::uint32_t(s));
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
