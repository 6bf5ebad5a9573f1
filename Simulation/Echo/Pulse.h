#pragma once

#include <complex>
#include <vector>

namespace sono {

/// Standard deviation, in mm of depth, of the round trip's Gaussian envelope exp(-r^2 / (2 sigma^2)) for a pulse
/// exp(-k t^2) cos(2 pi f t) with fractional bandwidth b at -6 dB: k = (pi f b)^2 / (4 ln 10^0.3), r = c0 t / 2
/// (PHYSICS section 4).
double pulseSigmaMm(double centreFrequencyMHz, double fractionalBandwidth);

/// The envelope sampled every `sampleMm` (odd count, centred), for amplitudes that were split linearly between two
/// samples: the split adds a variance of sampleMm^2 / 6 on average, which the kernel takes off. Throws Error when the
/// pulse is shorter than the samples can carry.
std::vector<float> pulseEnvelope(double sigmaMm, double sampleMm);

/// out[s] = sum over k of envelope[k] in[s + k] for s in [0, count); `in` has count + envelope.size() - 1 samples.
void convolve(const float* in, const std::vector<float>& envelope, int count, float* out);

} // namespace sono
