// A line from its sum to IQ against the same in double precision, each depth added to each sample of range and each
// sample convolved directly.
#include "EchoScenes.h"

#include "Core/SoundSpeed.h"
#include "Echo/LineFinisher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <random>
#include <vector>

namespace sono::test {
namespace {

using Complex = std::complex<double>;

constexpr double bendMm = 20.07; // behind it, sound is faster

/// Depth less range; of no slope with which depths lie halfway between two samples.
double offsetMm(double rangeMm)
{
  return -0.0613 * std::min(rangeMm, bendMm) + 0.0397 * std::max(0.0, rangeMm - bendMm);
}

EchoSettings settingsOf(double samplingMHz)
{
  EchoSettings s;
  s.depthMm = 60.0;
  s.samplingMHz = samplingMHz;
  return s;
}

/// A line of everything that the tracer leaves.
TracedLines busyLine(const EchoSettings& settings)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  TracedLines traced;
  traced.model = InterfaceModel::Acoustic;
  traced.lineCount = 1;
  traced.binMm = 0.25;
  traced.binCount = int(settings.depthMm * deepestPerRange / traced.binMm) + 1;
  traced.echoCount = settings.sampleCount();
  traced.echoSampleMm = settings.sampleMm();
  for (int b = 0; b < traced.binCount; ++b)
  {
    traced.intensity.push_back(unit(random));
    traced.attenuationNpPerMHz.push_back(0.01f * float(b) + 0.002f * unit(random));
    traced.reverberation.push_back(b % 7 < 4 ? unit(random) : 0.0f);
    traced.reverberationNpPerMHz.push_back(0.012f * float(b));
    traced.depthOffsetMm.push_back(float(offsetMm(b * traced.binMm)));
  }
  for (int e = 0; e < traced.echoCount; ++e)
  {
    traced.boundaryEcho.emplace_back(e % 97 == 0 ? unit(random) : 0.0f, e % 97 == 0 ? unit(random) : 0.0f);
  }
  return traced;
}

double betweenMiddles(const std::vector<float>& bins, double position)
{
  const double held = std::clamp(position - 0.5, 0.0, double(bins.size() - 1));
  const std::size_t bin = std::min(std::size_t(held), bins.size() - 2);
  return bins[bin] + (double(bins[bin + 1]) - bins[bin]) * (held - double(bin));
}

std::vector<Complex> directly(const EchoSettings& settings, const TracedLines& traced, const LineSum& sum,
                              const ReverberationSpeckle& speckle, const PulseKernel& pulse)
{
  const double sampleMm = settings.sampleMm();
  const double radPerSample = 4.0 * M_PI * settings.centreFrequencyMHz / assumedSoundSpeedMmPerUs * sampleMm;
  const double binsPerSample = sampleMm / traced.binMm;
  const int ranges = settings.sampleCount() + pulse.half();
  const Downshift down = *pulseDownshift(settings);
  const auto depthAt = [&](int s) { return s + offsetMm(s * sampleMm) / sampleMm; };
  const auto sinks = [&](double np) { return std::clamp(np, 0.0, double(down.maxNpPerMHz)); };
  const auto gain = [&](double np) { return std::exp(0.5 * down.spectrumMHz2 * np * np); };

  std::vector<Complex> heard(std::size_t(ranges) + 1);
  int s = 0;
  for (int d = 0; d < sum.sampleCount(); ++d)
  {
    while (s < ranges && depthAt(s + 1) <= d)
    {
      ++s;
    }
    if (s < ranges)
    {
      const double share = (d - depthAt(s)) / (depthAt(s + 1) - depthAt(s));
      const Complex v = Complex(sum.iq[2 * std::size_t(d)], sum.iq[2 * std::size_t(d) + 1]) *
                        betweenMiddles(traced.intensity, d * binsPerSample) *
                        std::polar(1.0, -radPerSample * (s + share));
      heard[std::size_t(s)] += (1.0 - share) * v;
      heard[std::size_t(s) + 1] += share * v;
    }
  }
  std::vector<double> exponent;
  for (s = 0; s < ranges; ++s)
  {
    exponent.push_back(sinks(betweenMiddles(traced.attenuationNpPerMHz, std::floor(depthAt(s) + 0.5) * binsPerSample)));
  }
  std::vector<double> turns(std::size_t(ranges), 0.0);
  for (std::size_t n = 1; n < turns.size(); ++n)
  {
    turns[n] = turns[n - 1] + double(down.turnsPerMHz) * down.spectrumMHz2 * 0.5 * (exponent[n - 1] + exponent[n]);
  }
  std::vector<double> lateGain;
  std::vector<float> lateLevel;
  for (std::size_t bin = 0; bin < traced.reverberation.size(); ++bin)
  {
    lateGain.push_back(gain(sinks(traced.reverberationNpPerMHz[bin])));
    lateLevel.push_back(float(lateGain.back() * double(traced.reverberation[bin])));
  }
  std::vector<Complex> noise;
  for (s = 0; s < ranges; ++s)
  {
    const std::size_t n = std::size_t(s);
    const Vec2f drawn = speckle.noise.at(0, s);
    noise.push_back(double(speckle.rms[n]) * Complex(drawn.x, drawn.y));
    const Complex echo =
      s < traced.echoCount ? Complex(traced.boundaryEcho[n]) * std::polar(1.0, -radPerSample * s) : 0.0;
    const double late = lateGain[std::min(std::size_t(s * binsPerSample), lateGain.size() - 1)];
    heard[n] = (gain(exponent[n]) * heard[n] + late * echo) * std::polar(1.0, 2.0 * M_PI * turns[n]);
  }
  std::vector<Complex> iq(std::size_t(settings.sampleCount()));
  for (int out = 0; out < settings.sampleCount(); ++out)
  {
    Complex reverberating = 0.0;
    for (int k = -pulse.half(); k <= pulse.half(); ++k)
    {
      if (out - k >= 0 && out - k < ranges)
      {
        const double amplitude = double(pulse.re()[std::size_t(pulse.half() - k)]);
        iq[std::size_t(out)] += amplitude * heard[std::size_t(out - k)];
        reverberating += amplitude * noise[std::size_t(out - k)];
      }
    }
    const double level = betweenMiddles(lateLevel, out * binsPerSample);
    iq[std::size_t(out)] *= std::polar(1.0, -2.0 * M_PI * turns[std::size_t(out)]);
    iq[std::size_t(out)] += level > double(faintestReverberation) ? level * reverberating : 0.0;
  }
  return iq;
}

/// To 1e-5 of the largest sample, which is louder than `least`.
void expectAgreement(const std::vector<Complex>& exact, const std::vector<std::complex<float>>& iq, double least)
{
  double largest = 0.0;
  double worst = 0.0;
  for (std::size_t s = 0; s < exact.size(); ++s)
  {
    largest = std::max(largest, std::abs(exact[s]));
    worst = std::max(worst, std::abs(exact[s] - Complex(iq[s])));
  }
  EXPECT_GT(largest, least);
  EXPECT_LT(worst, 1e-5 * largest);
}

TEST(LineFinisher, AgreesWithTheDirectSum)
{
  for (const double samplingMHz : { 50.0, 17.3 })
  {
    SCOPED_TRACE(samplingMHz);
    const EchoSettings settings = settingsOf(samplingMHz);
    const TracedLines traced = busyLine(settings);
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    const ReverberationSpeckle speckle{ { 9, 0.4f },
                                        std::vector<float>(std::size_t(settings.sampleCount()) + 500, 0.3f) };
    const LineFinisher finisher(settings, InterfaceModel::Acoustic, &traced, nullptr, speckle);
    LineSum sum = finisher.emptySum();
    for (float& v : sum.iq)
    {
      v = normal(random);
    }
    std::vector<std::complex<float>> iq(std::size_t(settings.sampleCount()));
    LineFinisher::Room room = finisher.room();
    finisher.finish(0, sum, nullptr, finisher.reverberationNodes(), room, iq.data());
    const std::vector<Complex> exact = directly(settings, traced, sum, speckle, finisher.pulse());
    expectAgreement(exact, iq, 1.0);
  }
}

/// Sound that ends halfway, of which nothing is heard behind but what a path has reflected.
TEST(LineFinisher, EndsWhereNothingIsHeard)
{
  const EchoSettings settings = settingsOf(50.0);
  for (const bool isReflected : { false, true })
  {
    SCOPED_TRACE(isReflected);
    TracedLines traced = busyLine(settings);
    const std::size_t lit = traced.intensity.size() / 2;
    std::fill(traced.intensity.begin() + std::ptrdiff_t(lit), traced.intensity.end(), 0.0f);
    std::fill(traced.reverberation.begin(), traced.reverberation.end(), 0.0f);
    if (!isReflected)
    {
      std::fill(traced.boundaryEcho.begin(), traced.boundaryEcho.end(), 0.0f);
    }
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    const LineFinisher finisher(settings, InterfaceModel::Acoustic, &traced, nullptr, {});
    LineFinisher::Room room = finisher.room();
    std::vector<std::complex<float>> iq(std::size_t(settings.sampleCount()), 7.0f);
    LineSum sum = finisher.emptySum();
    std::fill(sum.iq.begin(), sum.iq.end(), 1e6f);
    TracedLines whole = busyLine(settings);
    whole.reverberation.clear();
    const LineFinisher before(settings, InterfaceModel::Acoustic, &whole, nullptr, {});
    before.finish(0, sum, nullptr, {}, room, iq.data()); // leaves the room full
    for (float& v : sum.iq)
    {
      v = normal(random);
    }
    finisher.finish(0, sum, nullptr, {}, room, iq.data());
    const std::vector<Complex> exact =
      directly(settings, traced, sum, { { 9, 0.4f }, std::vector<float>(iq.size() + 500, 0.0f) }, finisher.pulse());
    expectAgreement(exact, iq, 1.0);
    const bool isSilent = std::all_of(iq.begin() + std::ptrdiff_t(iq.size() * 3 / 4), iq.end(),
                                      [](std::complex<float> v) { return v == std::complex<float>{}; });
    EXPECT_EQ(isSilent, !isReflected);
  }
}

/// The same with surfaces, which are heard deeper.
TEST(LineFinisher, HearsSurfacesWhereNothingElseIs)
{
  const EchoSettings settings = settingsOf(50.0);
  TracedLines traced = busyLine(settings);
  std::fill(traced.intensity.begin(), traced.intensity.end(), 0.0f);
  std::fill(traced.reverberation.begin(), traced.reverberation.end(), 0.0f);
  std::fill(traced.boundaryEcho.begin(), traced.boundaryEcho.end(), 0.0f);
  const LineFinisher finisher(settings, InterfaceModel::Acoustic, &traced, nullptr, {});
  LineSum surfaces = finisher.emptySum();
  const std::size_t at = std::size_t(settings.sampleCount()) * 3 / 4;
  surfaces.iq[2 * at + 1] = 1.0f;
  LineFinisher::Room room = finisher.room();
  std::vector<std::complex<float>> iq(std::size_t(settings.sampleCount()));
  finisher.finish(0, finisher.emptySum(), &surfaces, {}, room, iq.data());
  TracedLines lit = traced; // the same echo as a scatterer's where all is lit
  std::fill(lit.intensity.begin(), lit.intensity.end(), 1.0f);
  const std::vector<Complex> exact =
    directly(settings, lit, surfaces, { { 9, 0.4f }, std::vector<float>(iq.size() + 500, 0.0f) }, finisher.pulse());
  expectAgreement(exact, iq, 0.5);
}

/// What is known of B is noisy, and its phase sums it up over the whole line: added to the direct sound in that phase,
/// speckle that reverberates would make another picture of each number of paths.
TEST(LineFinisher, WhatReverberatesDoesNotDependOnTheAttenuation)
{
  const EchoSettings settings = settingsOf(50.0);
  TracedLines traced = busyLine(settings);
  std::fill(traced.boundaryEcho.begin(), traced.boundaryEcho.end(), 0.0f);
  const ReverberationSpeckle speckle{ { 9, 0.4f },
                                      std::vector<float>(std::size_t(settings.sampleCount()) + 500, 0.3f) };
  std::vector<std::complex<float>> iq[2];
  for (const int i : { 0, 1 })
  {
    const LineFinisher finisher(settings, InterfaceModel::Acoustic, &traced, nullptr, speckle);
    LineFinisher::Room room = finisher.room();
    iq[i].resize(std::size_t(settings.sampleCount()));
    finisher.finish(0, finisher.emptySum(), nullptr, finisher.reverberationNodes(), room, iq[i].data());
    for (float& b : traced.attenuationNpPerMHz)
    {
      b *= 1.1f;
    }
  }
  EXPECT_EQ(iq[0], iq[1]);
  EXPECT_TRUE(std::any_of(iq[0].begin(), iq[0].end(), [](std::complex<float> v) { return std::abs(v) > 0.1f; }));
}

/// Depths and ranges that are the same but for rounding, and such that part: each depth is shown once.
TEST(SampleLoops, EachDepthIsShownOnce)
{
  constexpr int count = 400;
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  for (const float slope : { 0.0f, -0.04f, 0.03f, 2.8f })
  {
    for (const float noise : { 1e-9f, 1e-7f, 1e-3f })
    {
      std::vector<float> offset = sampleRoom(count + 1);
      for (int s = 0; s < count + 1; ++s)
      {
        offset[std::size_t(s)] = slope * float(s) + noise * uniform(random);
      }
      std::vector<float> re(2000, 1.0f);
      std::vector<float> im(2000, 0.0f);
      std::vector<float> outRe = sampleRoom(count);
      std::vector<float> outIm = sampleRoom(count);
      std::vector<float> room;
      showDepths({ re.data(), im.data() }, int(re.size()), offset.data(), Carrier(0.0, count), count,
                 { outRe.data(), outIm.data() }, room);
      // Depth 0 may lie in front of the first range, and the last one's far share behind the last.
      const double shown = std::accumulate(outRe.begin(), outRe.begin() + count, 0.0);
      const int steps = count - 2;
      EXPECT_NEAR(shown, (1.0 + double(slope)) * steps, 4.0 + 2.0 * double(std::max(slope, 0.0f)));
      for (int s = 1; s < steps; ++s)
      {
        const float most = std::abs(slope) < 1e-6f ? 2e-3f : 1.0f + std::abs(slope);
        EXPECT_NEAR(outRe[std::size_t(s)], 1.0f + slope, most) << s << " slope " << slope << " noise " << noise;
      }
    }
  }
}

} // namespace
} // namespace sono::test
