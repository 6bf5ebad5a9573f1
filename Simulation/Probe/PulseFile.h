#pragma once

#include <complex>
#include <string>
#include <vector>

namespace sono {

/// A round trip's pulse as somebody measured it: the echo of a point, whose place is time 0, at evenly spaced times.
struct SampledPulse
{
  double startUs = 0.0;
  double stepUs = 0.0; ///< > 0
  std::vector<double> amplitude;
};

/// Reads a pulse from a CSV file with the columns time_us (microseconds, ascending, evenly spaced within 1 % of a step)
/// and amplitude (any unit). Throws Error naming file and line for a value that is no number or out of order, and for
/// fewer than 4 or more than 8192 samples, or only zeros.
SampledPulse readPulse(const std::string& path);

/// The complex envelope e of a pulse p(t) = Re(e(t) exp(i 2 pi f t)) at radial steps of `sampleMm`, t = 2 r / c0: e is
/// the analytic signal, of positive frequencies only, times exp(-i 2 pi f t), interpolated without loss of band by its
/// Fourier sum. The count is odd; element count / 2 + n belongs to the depth n sampleMm behind the scatterer. Scaled to
/// a peak of 1, as a Gaussian pulse is; ends below 1e-5 of it are cut off.
///
/// Where amplitudes were split linearly between samples, `splitMm` is the samples' distance: the split's average loss,
/// sinc^2(pi (f' - f) 2 splitMm / c0) at frequency f', is undone. 0 where they were not.
///
/// Throws Error when the frequency or a distance makes no sense, or when the pulse has more than 1e-3 of its amplitude
/// (in the root mean square) outside of the band that the steps carry about the centre frequency.
std::vector<std::complex<float>> pulseBaseband(const SampledPulse& pulse, double centreFrequencyMHz, double sampleMm,
                                               double splitMm = 0.0);

} // namespace sono
