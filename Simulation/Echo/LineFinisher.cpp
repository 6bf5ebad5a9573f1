#include "Echo/LineFinisher.h"
#include "Core/SoundSpeed.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr float darkIntensity = 1e-8f; // -160 dB

bool isWorthItsNoise(float level)
{
  return level > faintestReverberation;
}

} // namespace

LineFinisher::LineFinisher(const EchoSettings& settings, InterfaceModel model, const TracedLines* traced,
                           const FieldLevel* level, ReverberationSpeckle speckle)
  : traced_(traced)
  , samples_(settings.sampleCount())
  , sampleMm_(settings.sampleMm())
  , radPerMm_(4.0 * pi * settings.centreFrequencyMHz / assumedSoundSpeedMmPerUs)
  , pulse_(settings)
  , speckle_(std::move(speckle))
{
  for (int s = 0; s < samples_ + pulse_.half(); ++s)
  {
    const double phase = radPerMm_ * s * sampleMm_;
    carrierRe_.push_back(float(std::cos(phase)));
    carrierIm_.push_back(float(-std::sin(phase)));
  }
  sumCount_ = carrierRe_.size();
  if (model == InterfaceModel::Acoustic)
  {
    sumCount_ = std::size_t(std::ceil(double(sumCount_) * deepestPerRange));
  }
  for (std::size_t s = 0; traced && s < sumCount_; ++s)
  {
    // Linear between the centres of the tracer's bins.
    const double position = std::clamp(double(s) * sampleMm_ / traced->binMm - 0.5, 0.0, double(traced->binCount - 1));
    const int bin = std::min(int(position), std::max(0, traced->binCount - 2));
    bin_.push_back(bin);
    binShare_.push_back(float(position - bin));
  }
  if (traced && traced->model == InterfaceModel::Acoustic && !traced->attenuationNpPerMHz.empty())
  {
    downshift_ = pulseDownshift(settings);
  }
  for (int e = 0; traced && level && e < traced->echoCount; ++e)
  {
    boundaryLevel_.push_back(float(level->at(e * traced->echoSampleMm)));
  }
}

LineSum LineFinisher::emptySum() const
{
  return { std::vector<float>(2 * sumCount_, 0.0f), float(sampleMm_), radPerMm_ };
}

float LineFinisher::reachMm(int line) const
{
  const double deepest = double(sumCount_) * sampleMm_;
  if (!traced_)
  {
    return float(deepest);
  }
  const float* bins = traced_->intensity.data() + std::size_t(line) * std::size_t(traced_->binCount);
  int b = traced_->binCount;
  while (b > 0 && !(bins[b - 1] > darkIntensity))
  {
    --b;
  }
  // The last bin's intensity holds below it, for the pulse's half.
  return b == 0 ? 0.0f : float(std::min(deepest, b == traced_->binCount ? deepest : (b + 0.5) * traced_->binMm));
}

void LineFinisher::applyIntensity(int line, LineSum& sum) const
{
  const float* bins = traced_->intensity.data() + std::size_t(line) * std::size_t(traced_->binCount);
  const int step = traced_->binCount > 1 ? 1 : 0;
  for (std::size_t s = 0; s < bin_.size(); ++s)
  {
    const float* bin = bins + bin_[s];
    const float intensity = bin[0] + (bin[step] - bin[0]) * binShare_[s];
    sum.iq[2 * s] *= intensity;
    sum.iq[2 * s + 1] *= intensity;
  }
}

/// As weak as a pulse is that has been attenuated like it; the little that its frequency differs from that of what is
/// heard directly does not show in the envelope.
void LineFinisher::sinkReverberation(int line, float* re, float* im) const
{
  if (!downshift_ || traced_->reverberationNpPerMHz.empty())
  {
    return;
  }
  const float* bins = traced_->reverberationNpPerMHz.data() + std::size_t(line) * std::size_t(traced_->binCount);
  const float binsPerSample = float(sampleMm_ / traced_->binMm);
  for (int s = 0; s < int(carrierRe_.size()); ++s)
  {
    const int bin = std::min(int(float(s) * binsPerSample), traced_->binCount - 1);
    const float gain = downshiftGain(*downshift_, shiftingExponent(*downshift_, bins[bin]));
    re[s] *= gain;
    im[s] *= gain;
  }
}

/// Whether paths have left boundary echoes or reverberation: where nothing reverberates, nothing is spent on it.
bool LineFinisher::hasPathEchoes(int line) const
{
  const auto first = traced_->boundaryEcho.begin() + std::ptrdiff_t(line) * traced_->echoCount;
  if (std::any_of(first, first + traced_->echoCount, [](std::complex<float> e) { return e != std::complex<float>{}; }))
  {
    return true;
  }
  if (traced_->reverberation.empty())
  {
    return false;
  }
  const auto bins = traced_->reverberation.begin() + std::ptrdiff_t(line) * traced_->binCount;
  return std::any_of(bins, bins + traced_->binCount, isWorthItsNoise);
}

bool LineFinisher::sinks(int line) const
{
  if (!downshift_)
  {
    return false;
  }
  const auto first = traced_->attenuationNpPerMHz.begin() + std::ptrdiff_t(line) * traced_->binCount;
  return std::any_of(first, first + traced_->binCount, [](float b) { return b > 0.0f; });
}

RangeMap LineFinisher::rangeMap(int line) const
{
  if (!traced_ || traced_->depthOffsetMm.empty())
  {
    return {};
  }
  return { traced_->depthOffsetMm.data() + std::size_t(line) * std::size_t(traced_->binCount), traced_->binCount,
           float(1.0 / traced_->binMm) };
}

/// B at each sample of range, as far as it lowers the frequency.
std::vector<float> LineFinisher::exponents(int line) const
{
  const float* bins = traced_->attenuationNpPerMHz.data() + std::size_t(line) * std::size_t(traced_->binCount);
  const int step = traced_->binCount > 1 ? 1 : 0;
  const RangeMap map = rangeMap(line);
  std::vector<float> result(carrierRe_.size());
  for (std::size_t s = 0; s < result.size(); ++s)
  {
    const std::size_t d = std::size_t(depthSample(map, float(sampleMm_), int(s), int(sumCount_)));
    const float* bin = bins + bin_[d];
    result[s] = shiftingExponent(*downshift_, bin[0] + (bin[step] - bin[0]) * binShare_[d]);
  }
  return result;
}

/// In baseband the phases no longer depend on the sample: the pulse is its envelope.
void LineFinisher::demodulate(const LineSum& sum, float* re, float* im) const
{
  for (std::size_t s = 0; s < carrierRe_.size(); ++s)
  {
    const float a = sum.iq[2 * s];
    const float b = sum.iq[2 * s + 1];
    re[s] += a * carrierRe_[s] - b * carrierIm_[s];
    im[s] += a * carrierIm_[s] + b * carrierRe_[s];
  }
}

/// Where range is time, what lies between the depths of two samples of range goes to both, with the phase of where it
/// is shown.
void LineFinisher::showDepths(const RangeMap& map, const LineSum& sum, float* re, float* im) const
{
  const float sampleMm = float(sampleMm_);
  const float radPerSample = float(radPerMm_ * sampleMm_);
  const int count = int(carrierRe_.size());
  float from = depthInSamples(map, sampleMm, 0);
  for (int s = 0; s < count; ++s)
  {
    const float to = depthInSamples(map, sampleMm, s + 1);
    const RangeStep step = stepBetween(from, to);
    from = to;
    const int last = std::min(step.end, int(sumCount_));
    for (int d = step.first; d < last; ++d)
    {
      const float share = step.shareOf(d);
      const ShownSample shown =
        shownSample(sum.iq[2 * std::size_t(d)], sum.iq[2 * std::size_t(d) + 1], share * radPerSample,
                    carrierRe_[std::size_t(s)], carrierIm_[std::size_t(s)]);
      re[s] += (1.0f - share) * shown.re;
      im[s] += (1.0f - share) * shown.im;
      if (s + 1 < count)
      {
        re[s + 1] += share * shown.re;
        im[s + 1] += share * shown.im;
      }
    }
  }
}

ReverberationNodes LineFinisher::reverberationNodes() const
{
  if (!traced_ || std::none_of(traced_->reverberation.begin(), traced_->reverberation.end(), isWorthItsNoise))
  {
    return {};
  }
  return ReverberationNodes(speckle_.noise, traced_->lineCount, rangeCount());
}

void LineFinisher::addReverberation(int line, const ReverberationNodes& nodes, float* re, float* im) const
{
  const float* bins = traced_->reverberation.data() + std::size_t(line) * std::size_t(traced_->binCount);
  const float binsPerSample = float(sampleMm_ / traced_->binMm);
  for (int s = 0; s < int(carrierRe_.size()); ++s)
  {
    const float level = levelAtRange(bins, traced_->binCount, binsPerSample, s);
    if (isWorthItsNoise(level))
    {
      const Vec2f noise = level * speckle_.rms[std::size_t(s)] * nodes.at(line, s);
      re[s] += noise.x;
      im[s] += noise.y;
    }
  }
}

/// Moves the boundary echoes from the tracer's grid to the RF samples, phases kept.
LineSum LineFinisher::boundaryEchoes(int line) const
{
  LineSum sum{ std::vector<float>(2 * carrierRe_.size(), 0.0f), float(sampleMm_), radPerMm_ };
  const std::complex<float>* echo = traced_->boundaryEcho.data() + std::size_t(line) * std::size_t(traced_->echoCount);
  for (int e = 0; e < traced_->echoCount; ++e)
  {
    if (echo[e] == std::complex<float>{})
    {
      continue;
    }
    const std::complex<float> seen = boundaryLevel_.empty() ? echo[e] : echo[e] * boundaryLevel_[std::size_t(e)];
    const double position = e * traced_->echoSampleMm / sampleMm_;
    const int s = int(std::floor(position + 1e-6)); // on a common grid, exactly the sample
    const double fraction = std::max(0.0, position - s);
    for (int i = 0; i < 2; ++i)
    {
      const double share = i == 0 ? 1.0 - fraction : fraction;
      if (share > 0.0 && s + i < sum.sampleCount())
      {
        const double phase = radPerMm_ * sampleMm_ * (fraction - i);
        const std::complex<float> v = seen * std::complex<float>(std::polar(share, -phase));
        sum.iq[2 * std::size_t(s + i)] += v.real();
        sum.iq[2 * std::size_t(s + i) + 1] += v.imag();
      }
    }
  }
  return sum;
}

SurfaceIntensity LineFinisher::intensity(int line) const
{
  if (!traced_)
  {
    return {};
  }
  return { traced_->intensity.data() + std::size_t(line) * std::size_t(traced_->binCount), traced_->binCount,
           float(1.0 / traced_->binMm) };
}

void LineFinisher::finish(int line, LineSum& sum, const LineSum* surfaces, const ReverberationNodes& nodes,
                          std::complex<float>* iq) const
{
  if (traced_)
  {
    applyIntensity(line, sum);
  }
  if (surfaces)
  {
    std::transform(sum.iq.begin(), sum.iq.end(), surfaces->iq.begin(), sum.iq.begin(), std::plus<float>());
  }
  const std::size_t half = std::size_t(pulse_.half()); // nothing lies above the first sample
  std::vector<float> re(half + carrierRe_.size(), 0.0f);
  std::vector<float> im(half + carrierRe_.size(), 0.0f);
  const RangeMap map = rangeMap(line);
  if (map.offsetMm)
  {
    showDepths(map, sum, re.data() + half, im.data() + half);
  }
  else
  {
    demodulate(sum, re.data() + half, im.data() + half);
  }
  // Of Acoustic these have been reflected, and attenuated by ways of their own.
  const bool isLate = traced_ && hasPathEchoes(line);
  std::vector<float> lateRe(isLate ? carrierRe_.size() : 0, 0.0f);
  std::vector<float> lateIm(lateRe.size(), 0.0f);
  if (isLate && traced_->echoCount > 0)
  {
    demodulate(boundaryEchoes(line), lateRe.data(), lateIm.data());
  }
  if (isLate && !traced_->reverberation.empty())
  {
    addReverberation(line, nodes, lateRe.data(), lateIm.data());
    sinkReverberation(line, lateRe.data(), lateIm.data());
  }
  if (!sinks(line))
  {
    std::transform(lateRe.begin(), lateRe.end(), re.begin() + std::ptrdiff_t(half), re.begin() + std::ptrdiff_t(half),
                   std::plus<float>());
    std::transform(lateIm.begin(), lateIm.end(), im.begin() + std::ptrdiff_t(half), im.begin() + std::ptrdiff_t(half),
                   std::plus<float>());
    pulse_.convolve(re.data(), im.data(), samples_, iq);
    return;
  }
  const std::vector<float> exponent = exponents(line);
  std::vector<DownshiftAt> turned(exponent.size());
  double turns = 0.0;
  for (std::size_t s = 0; s < exponent.size(); ++s)
  {
    turned[s] = downshiftRotation(float(turns - std::floor(turns + 0.5)));
    const float mean = s + 1 < exponent.size() ? 0.5f * (exponent[s] + exponent[s + 1]) : exponent[s];
    turns += double(downshiftTurns(*downshift_, mean));
  }
  for (std::size_t s = 0; s < exponent.size(); ++s)
  {
    const float gain = downshiftGain(*downshift_, exponent[s]);
    const float a = gain * re[half + s] + (isLate ? lateRe[s] : 0.0f);
    const float b = gain * im[half + s] + (isLate ? lateIm[s] : 0.0f);
    re[half + s] = a * turned[s].re - b * turned[s].im;
    im[half + s] = a * turned[s].im + b * turned[s].re;
  }
  pulse_.convolve(re.data(), im.data(), samples_, iq);
  for (std::size_t s = 0; s < std::size_t(samples_); ++s)
  {
    const float a = iq[s].real();
    const float b = iq[s].imag();
    iq[s] = { a * turned[s].re + b * turned[s].im, b * turned[s].re - a * turned[s].im };
  }
}

} // namespace sono
