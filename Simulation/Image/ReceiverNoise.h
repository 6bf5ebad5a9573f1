#pragma once

#include <cstdint>
#include <vector>

namespace sono {

/// Adds the receiver's electronic noise before detection: envelope = |envelope + n| with n complex, normal, circular,
/// of mean square 10^(levelDb / 10), and as long along a line as the receive filter's pulse, whose standard deviation
/// is `pulseSigmaSamples` > 0 samples; independent from line to line. Being circular, it needs not know the echo's
/// phase. The noise of a sample depends on (seed, line, sample) and on that length alone. `envelope` is lines of
/// `sampleCount` values; NaN and negative ones, which are no amplitudes, stay.
void addReceiverNoise(std::vector<float>& envelope, int sampleCount, double levelDb, double pulseSigmaSamples,
                      std::uint64_t seed);

/// Nodes of the noise for each sample; see noisyEnvelope.
float noiseNodesPerSample(double pulseSigmaSamples);

} // namespace sono
