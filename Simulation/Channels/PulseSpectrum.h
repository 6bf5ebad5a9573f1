#pragma once

#include "Probe/PulseFile.h"

#include <complex>
#include <memory>
#include <vector>

namespace sono {

/// The spectrum of a round trip's pulse, P(f) = integral of p(t) exp(2 pi i f t) dt, us: of a Gaussian one,
/// exp(-(t / s)^2 / 2) cos(2 pi f0 t) with the bandwidth's s (Data/docs/physics.md section 4.3), or of one that is
/// given, as it is. No transducer hears low frequencies: from 0.24 to 0.08 of the strongest one it falls to 0.
class PulseSpectrum
{
public:
  PulseSpectrum(double centreMHz, double fractionalBandwidth);
  /// Throws Error where the pulse has no samples, only zeros, or numbers that are not finite.
  explicit PulseSpectrum(std::shared_ptr<const SampledPulse> pulse);

  std::complex<double> at(double frequencyMHz) const;
  /// At evenly spaced frequencies, all at once.
  std::vector<std::complex<double>> at(double firstMHz, double stepMHz, int count) const;
  /// Where it is above -70 dB of its largest modulus.
  double lowMHz() const { return lowMHz_; }
  double highMHz() const { return highMHz_; }
  double strongestMHz() const { return strongestMHz_; }
  /// When the pulse of an echo at time 0 begins and ends.
  double startUs() const { return startUs_; }
  double endUs() const { return endUs_; }

private:
  double taperAt(double frequencyMHz) const;

  std::shared_ptr<const SampledPulse> pulse_; // null: the Gaussian
  double strongestMHz_;
  double spreadMHz_ = 0.0;
  double lowMHz_ = 0.0;
  double highMHz_ = 0.0;
  double startUs_ = 0.0;
  double endUs_ = 0.0;
};

} // namespace sono
