#include "Echo/Pulse.h"

#include "Core/Progress.h"
#include "Core/Simd.h"
#include "Core/SoundSpeed.h"
#include "Echo/FormRf.h"
#include "Trace/Trace.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;

/// out[s] = sum over k of kernel[k] in[s + k]
SONO_SIMD_CLONES void weightedSums(const float* in, const float* kernel, int taps, int count, float* out)
{
  constexpr int tile = 64; // the sums of a tile stay in registers
  for (int next = 0; next < count && count >= tile; next += tile)
  {
    const int s = std::min(next, count - tile); // the last one begins within the one before
    float sum[tile] = {};
    for (int k = 0; k < taps; ++k)
    {
      for (int i = 0; i < tile; ++i)
      {
        sum[i] += kernel[k] * in[s + k + i];
      }
    }
    std::copy(sum, sum + tile, out + s);
  }
  for (int s = 0; s < count && count < tile; ++s)
  {
    float sum = 0.0f;
    for (int k = 0; k < taps; ++k)
    {
      sum += kernel[k] * in[s + k];
    }
    out[s] = sum;
  }
}

/// A Gaussian's envelope every `sampleMm` (odd count, centred). The split adds a variance of sampleMm^2 / 6 on average,
/// which is taken off.
std::vector<float> gaussianEnvelope(double sigmaMm, double sampleMm)
{
  const double sigma = sigmaMm / sampleMm;
  if (sigma < 0.8)
  {
    throw Error("the sampling frequency is too low for the pulse (" + std::to_string(sigma) +
                " samples a standard deviation of its envelope): raise it or lower the bandwidth");
  }
  const double narrowed = std::sqrt(sigma * sigma - 1.0 / 6.0);
  const int half = int(std::ceil(4.2 * sigma));
  std::vector<float> envelope;
  for (int i = -half; i <= half; ++i)
  {
    envelope.push_back(float(sigma / narrowed * std::exp(-0.5 * (i / narrowed) * (i / narrowed))));
  }
  return envelope;
}

void requireSampled(const SampledPulse& pulse)
{
  const auto finite = [](double a) { return std::isfinite(a); };
  if (pulse.amplitude.empty() || !(pulse.stepUs > 0.0) || !std::isfinite(pulse.startUs + pulse.stepUs) ||
      !std::all_of(pulse.amplitude.begin(), pulse.amplitude.end(), finite) ||
      std::all_of(pulse.amplitude.begin(), pulse.amplitude.end(), [](double a) { return a == 0.0; }))
  {
    throw Error("the sampled pulse has no samples, only zeros, or a time or amplitude that is not finite: give the "
                "echo of a point at evenly spaced times");
  }
}

} // namespace

double pulseSigmaMm(double centreFrequencyMHz, double fractionalBandwidth)
{
  const double root = pi * centreFrequencyMHz * fractionalBandwidth;
  const double k = root * root / (4.0 * 0.3 * std::log(10.0)); // per microsecond squared
  return assumedSoundSpeedMmPerUs / (2.0 * std::sqrt(2.0 * k));
}

double pulseEnergyMm(const EchoSettings& settings)
{
  if (!settings.pulse)
  {
    return std::sqrt(pi) * pulseSigmaMm(settings.centreFrequencyMHz, settings.fractionalBandwidth);
  }
  requireSampled(*settings.pulse);
  double sum = 0.0;
  for (const std::complex<float> e : pulseBaseband(*settings.pulse, settings.centreFrequencyMHz, settings.sampleMm()))
  {
    sum += double(std::norm(e));
  }
  return sum * settings.sampleMm();
}

std::optional<Downshift> pulseDownshift(const EchoSettings& settings)
{
  if (settings.pulse)
  {
    return std::nullopt;
  }
  const double spectrumMHz =
    assumedSoundSpeedMmPerUs / (4.0 * pi * pulseSigmaMm(settings.centreFrequencyMHz, settings.fractionalBandwidth));
  const double spectrumMHz2 = spectrumMHz * spectrumMHz;
  return Downshift{ float(spectrumMHz2), float(std::max(0.0, settings.centreFrequencyMHz - spectrumMHz) / spectrumMHz2),
                    float(2.0 * settings.sampleMm() / assumedSoundSpeedMmPerUs) };
}

PulseKernel::PulseKernel(const EchoSettings& settings)
{
  const double sampleMm = settings.sampleMm();
  if (!settings.pulse)
  {
    re_ = gaussianEnvelope(pulseSigmaMm(settings.centreFrequencyMHz, settings.fractionalBandwidth), sampleMm);
    return;
  }
  requireSampled(*settings.pulse);
  const auto envelope = pulseBaseband(*settings.pulse, settings.centreFrequencyMHz, sampleMm, sampleMm);
  for (auto e = envelope.rbegin(); e != envelope.rend(); ++e)
  {
    re_.push_back(e->real());
    im_.push_back(e->imag());
  }
}

void PulseKernel::convolve(const float* re, const float* im, int count, SamplePair out) const
{
  const int taps = int(re_.size());
  weightedSums(re, re_.data(), taps, count, out.re);
  weightedSums(im, re_.data(), taps, count, out.im);
  if (!im_.empty())
  {
    std::vector<float> crossRe(std::size_t(count), 0.0f);
    std::vector<float> crossIm(std::size_t(count), 0.0f);
    weightedSums(im, im_.data(), taps, count, crossRe.data());
    weightedSums(re, im_.data(), taps, count, crossIm.data());
    for (std::size_t s = 0; s < std::size_t(count); ++s)
    {
      out.re[s] -= crossRe[s];
      out.im[s] += crossIm[s];
    }
  }
}

} // namespace sono
