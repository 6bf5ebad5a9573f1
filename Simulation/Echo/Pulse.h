#pragma once

#include "Echo/SampleLoops.h"
#include "Kernel/Downshift.h"

#include <optional>
#include <vector>

namespace sono {

struct EchoSettings;

/// Standard deviation, in mm of depth, of the round trip's Gaussian envelope exp(-r^2 / (2 sigma^2)) for a pulse
/// exp(-k t^2) cos(2 pi f t) with fractional bandwidth b at -6 dB: k = (pi f b)^2 / (4 ln 10^0.3), r = c0 t / 2
/// (Data/docs/physics.md section 4).
double pulseSigmaMm(double centreFrequencyMHz, double fractionalBandwidth);

/// Integral over depth, mm, of the squared envelope of the settings' pulse. Throws as PulseKernel.
double pulseEnergyMm(const EchoSettings& settings);

/// How attenuation lowers the frequency of the settings' pulse; nothing for a sampled one, which it leaves alone.
std::optional<Downshift> pulseDownshift(const EchoSettings& settings);

/// The envelope of the settings' pulse at the RF samples, for amplitudes that were split linearly between two samples:
/// the loss that the split means on average (for a Gaussian: a variance of sampleMm^2 / 6) is taken off.
class PulseKernel
{
public:
  /// Throws Error when the samples cannot carry the pulse, or a sampled pulse makes no sense.
  explicit PulseKernel(const EchoSettings& settings);

  /// Samples that it reaches to either side.
  int half() const { return int(re_.size() / 2); }
  /// From its end to its start; the imaginary part is empty where it would be zero.
  const std::vector<float>& re() const { return re_; }
  const std::vector<float>& im() const { return im_; }
  /// out[s] = sum over n in [-half, half] of envelope(n) in[s - n] for s in [0, count); in[s - n] is given as re and
  /// im at [s - n + half], count + 2 half values each.
  void convolve(const float* re, const float* im, int count, SamplePair out) const;

private:
  std::vector<float> re_; // envelope(half), ..., envelope(-half)
  std::vector<float> im_; // empty where it would be zero
};

} // namespace sono
