#pragma once

#include <cstdint>
#include <vector>

namespace sono {

/// Adds the receiver's electronic noise before detection: envelope = |envelope + n| with n complex, normal, circular,
/// independent from sample to sample, and of mean square 10^(levelDb / 10). Being circular, it needs not know the
/// echo's phase. The noise of a sample depends on (seed, line, sample) alone. `envelope` is lines of `sampleCount`
/// values; NaN and negative ones, which are no amplitudes, stay.
void addReceiverNoise(std::vector<float>& envelope, int sampleCount, double levelDb, std::uint64_t seed);

} // namespace sono
