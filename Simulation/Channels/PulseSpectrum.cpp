#include "Channels/PulseSpectrum.h"

#include "Core/Error.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double faintest = 3e-4;
constexpr double leastShare = 0.08; // of the strongest frequency: from there on the taper rises,
constexpr double wholeShare = 0.24; // up to here; half of it at 0.16, as surfaces' echoes end, section 12.6
constexpr int searched = 2048;      // frequencies of a sampled pulse

bool isFinite(double a)
{
  return std::isfinite(a);
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
  , strongestMHz_(1e-9) // no taper until it is known
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
  const double stepMHz = 0.5 / p.stepUs / searched;
  std::vector<double> moduli;
  for (int n = 0; n <= searched; ++n)
  {
    moduli.push_back(std::abs(at(n * stepMHz)));
  }
  const auto strongest = std::max_element(moduli.begin(), moduli.end());
  strongestMHz_ = stepMHz * double(strongest - moduli.begin());
  const auto counts = [&](double modulus) { return modulus > faintest * *strongest; };
  const auto first = std::find_if(moduli.begin(), moduli.end(), counts);
  const auto last = std::find_if(moduli.rbegin(), moduli.rend(), counts);
  lowMHz_ = std::max(leastShare * strongestMHz_, stepMHz * double(first - moduli.begin()));
  highMHz_ = stepMHz * double(moduli.rend() - last - 1);
}

std::complex<double> PulseSpectrum::at(double frequencyMHz) const
{
  const double risen = std::clamp((frequencyMHz / strongestMHz_ - leastShare) / (wholeShare - leastShare), 0.0, 1.0);
  const double taper = 0.5 - 0.5 * std::cos(pi * risen);
  if (!pulse_)
  {
    const double off = (frequencyMHz - strongestMHz_) / spreadMHz_;
    return taper * 0.5 / (spreadMHz_ * std::sqrt(2.0 * pi)) * std::exp(-0.5 * off * off);
  }
  const std::complex<double> turn = std::polar(1.0, 2.0 * pi * frequencyMHz * pulse_->stepUs);
  std::complex<double> phase = std::polar(taper * pulse_->stepUs, 2.0 * pi * frequencyMHz * pulse_->startUs);
  std::complex<double> sum = 0.0;
  for (const double amplitude : pulse_->amplitude)
  {
    sum += amplitude * phase;
    phase *= turn;
  }
  return sum;
}

} // namespace sono
