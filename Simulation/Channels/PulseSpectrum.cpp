#include "Channels/PulseSpectrum.h"

#include "Channels/EvenSpectrum.h"
#include "Core/Error.h"
#include "Core/Simd.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double faintest = 3e-4;
constexpr double leastShare = 0.08; // of the strongest frequency: from there on the taper rises,
constexpr double wholeShare = 0.24; // up to here; half of it at 0.16, as surfaces' echoes end, section 12.6
constexpr int together = 64;        // frequencies that are summed together

bool isFinite(double a)
{
  return std::isfinite(a);
}

/// Clenshaw's recurrence for sums of a_n exp(i n w), b_n = a_n + 2 cos(w) b_(n+1) - b_(n+2): b_0 and b_1.
SONO_SIMD_CLONES void sumTones(const std::vector<double>& amplitudes, const double* cosines, double* sums,
                               double* before)
{
  for (std::size_t k = amplitudes.size(); k-- > 0;)
  {
    const double amplitude = amplitudes[k];
    for (int n = 0; n < together; ++n)
    {
      const double next = amplitude + 2.0 * cosines[n] * sums[n] - before[n];
      before[n] = sums[n];
      sums[n] = next;
    }
  }
}

} // namespace

PulseSpectrum::PulseSpectrum(double centreMHz, double fractionalBandwidth)
  : strongestMHz_(centreMHz)
{
  const double root = pi * centreMHz * fractionalBandwidth;
  const double k = root * root / (4.0 * 0.3 * std::log(10.0)); // eq. 4.4
  spreadMHz_ = std::sqrt(2.0 * k) / (2.0 * pi);
  const double reachMHz = spreadMHz_ * std::sqrt(-2.0 * std::log(faintest));
  lowMHz_ = std::max(leastShare * centreMHz, centreMHz - reachMHz);
  highMHz_ = centreMHz + reachMHz;
  endUs_ = std::sqrt(-std::log(faintest) / k);
  startUs_ = -endUs_;
}

PulseSpectrum::PulseSpectrum(std::shared_ptr<const SampledPulse> pulse)
  : pulse_(std::move(pulse))
{
  const SampledPulse& p = *pulse_;
  if (p.amplitude.empty() || !(p.stepUs > 0.0) || !std::isfinite(p.startUs + p.stepUs) ||
      !std::all_of(p.amplitude.begin(), p.amplitude.end(), isFinite) ||
      std::all_of(p.amplitude.begin(), p.amplitude.end(), [](double a) { return a == 0.0; }))
  {
    throw Error("the sampled pulse has no samples, only zeros, or a time or amplitude that is not finite: give the "
                "echo of a point at evenly spaced times");
  }
  startUs_ = p.startUs;
  endUs_ = p.startUs + p.stepUs * double(p.amplitude.size() - 1);
  std::vector<double> moduli = evenSpectrum(p.amplitude);
  moduli.front() = 0.0; // nothing echoes what does not swing
  const double stepMHz = 0.5 / p.stepUs / double(moduli.size() - 1);
  const auto strongest = std::max_element(moduli.begin(), moduli.end());
  strongestMHz_ = stepMHz * double(strongest - moduli.begin());
  const auto counts = [&](double modulus) { return modulus > faintest * *strongest; };
  const auto first = std::find_if(moduli.begin(), moduli.end(), counts);
  const auto last = std::find_if(moduli.rbegin(), moduli.rend(), counts);
  lowMHz_ = std::max(leastShare * strongestMHz_, stepMHz * double(first - moduli.begin()));
  highMHz_ = stepMHz * double(moduli.rend() - last - 1);
}

double PulseSpectrum::taperAt(double frequencyMHz) const
{
  const double risen = std::clamp((frequencyMHz / strongestMHz_ - leastShare) / (wholeShare - leastShare), 0.0, 1.0);
  return 0.5 - 0.5 * std::cos(pi * risen);
}

std::complex<double> PulseSpectrum::at(double frequencyMHz) const
{
  return at(frequencyMHz, 0.0, 1).front();
}

std::vector<std::complex<double>> PulseSpectrum::at(double firstMHz, double stepMHz, int count) const
{
  std::vector<std::complex<double>> values;
  if (!pulse_)
  {
    for (int n = 0; n < count; ++n)
    {
      const double f = firstMHz + n * stepMHz;
      const double off = (f - strongestMHz_) / spreadMHz_;
      values.emplace_back(taperAt(f) * 0.5 / (spreadMHz_ * std::sqrt(2.0 * pi)) * std::exp(-0.5 * off * off));
    }
    return values;
  }
  const double radPerMHz = 2.0 * pi * pulse_->stepUs;
  for (int first = 0; first < count; first += together)
  {
    double cosines[together];
    double sums[together] = {};
    double before[together] = {};
    for (int n = 0; n < together; ++n)
    {
      cosines[n] = std::cos(radPerMHz * (firstMHz + (first + n) * stepMHz));
    }
    sumTones(pulse_->amplitude, cosines, sums, before);
    for (int n = 0; n < std::min(together, count - first); ++n)
    {
      const double f = firstMHz + (first + n) * stepMHz;
      const std::complex<double> sum(sums[n] - before[n] * cosines[n], before[n] * std::sin(radPerMHz * f));
      values.push_back(std::polar(taperAt(f) * pulse_->stepUs, 2.0 * pi * f * pulse_->startUs) * sum);
    }
  }
  return values;
}

} // namespace sono
