#include "Image/ReceiverNoise.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Kernel/GreyLevel.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

SONO_SIMD_CLONES void addNoise(float* envelope, int count, float rms, const Vec2f* nodes, float nodesPerSample)
{
  for (int s = 0; s < count; ++s)
  {
    const float position = float(s) * nodesPerSample;
    const int node = int(position);
    envelope[s] = noisyEnvelope(envelope[s], rms, nodes + node, position - float(node));
  }
}

} // namespace

float noiseNodesPerSample(double pulseSigmaSamples)
{
  return float(std::min(noiseNodesPerSigma / pulseSigmaSamples, 4.0)); // from there on each sample has its own
}

void addReceiverNoise(std::vector<float>& envelope, int sampleCount, double levelDb, double pulseSigmaSamples,
                      std::uint64_t seed)
{
  const auto rms = float(std::pow(10.0, levelDb / 20.0));
  const float nodesPerSample = noiseNodesPerSample(pulseSigmaSamples);
  parallelFor(int(envelope.size() / std::size_t(sampleCount)), {}, [&](int line) {
    std::vector<Vec2f> nodes(std::size_t(float(sampleCount - 1) * nodesPerSample) + 4);
    for (std::size_t node = 0; node < nodes.size(); ++node)
    {
      nodes[node] = noiseNode(seed, std::uint32_t(line), std::uint32_t(node));
    }
    addNoise(envelope.data() + std::size_t(line) * std::size_t(sampleCount), sampleCount, rms, nodes.data(),
             nodesPerSample);
  });
}

} // namespace sono
