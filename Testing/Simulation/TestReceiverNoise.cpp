#include "Image/BMode.h"
#include "Image/ReceiverNoise.h"
#include "ImageTestTools.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace sono;

namespace {

/// 0 dB is 1, black is -60 dB.
BModeSettings plainSettings()
{
  BModeSettings settings;
  settings.tgcDbPerCm = 0.0;
  settings.automaticReference = false;
  return settings;
}

/// The default pulse is so short that all samples are independent.
std::vector<float> noiseOf(double levelDb, std::uint64_t seed, int lines, int samples, float echo,
                           double pulseSigmaSamples = 0.1)
{
  std::vector<float> envelope(std::size_t(lines) * std::size_t(samples), echo);
  addReceiverNoise(envelope, samples, levelDb, pulseSigmaSamples, seed);
  return envelope;
}

double mean(const std::vector<float>& values, int power)
{
  double sum = 0.0;
  for (const float v : values)
  {
    sum += std::pow(double(v), power);
  }
  return sum / double(values.size());
}

} // namespace

TEST(ReceiverNoise, AloneItIsRayleigh)
{
  const auto noise = noiseOf(-40.0, 7, 100, 10000, 0.0f);
  const double count = double(noise.size());
  // Mean square 1e-4; its square is exponential with a standard deviation of the mean itself.
  EXPECT_NEAR(mean(noise, 2) / 1e-4, 1.0, 4.0 / std::sqrt(count));
  const double m = mean(noise, 1);
  const double snr = m / std::sqrt(mean(noise, 2) - m * m);
  EXPECT_NEAR(snr, 1.9131, 0.01);
  // Kolmogorov and Smirnov against 1 - exp(-a^2 / 1e-4); 1.95 / sqrt(n) at p = 0.001
  auto sorted = noise;
  std::sort(sorted.begin(), sorted.end());
  double worst = 0.0;
  for (std::size_t n = 0; n < sorted.size(); ++n)
  {
    const double expected = 1.0 - std::exp(-double(sorted[n]) * double(sorted[n]) / 1e-4);
    worst = std::max(worst, std::abs((double(n) + 0.5) / count - expected));
  }
  EXPECT_LT(worst, 1.95 / std::sqrt(count));
}

TEST(ReceiverNoise, AddsToEchoesAsPower)
{
  // Rice: the mean square is the sum of both; the variance of the amplitude of a strong echo is half the noise's power.
  const auto noisy = noiseOf(-20.0, 3, 50, 10000, 0.5f);
  EXPECT_NEAR(mean(noisy, 2), 0.25 + 0.01, 4.0 * std::sqrt(2.0 * 0.25 * 0.01) / std::sqrt(double(noisy.size())) + 1e-5);
  const double m = mean(noisy, 1);
  EXPECT_NEAR((mean(noisy, 2) - m * m) / 0.005, 1.0, 0.02);
  EXPECT_NEAR(m, 0.5 + 0.01 / (4.0 * 0.5), 5e-4);
}

TEST(ReceiverNoise, IsAsLongAsThePulse)
{
  // The intensity of a complex normal process has the squared correlation of its amplitude; that of noise through a
  // Gaussian filter of sigma is exp(-lag^2 / (4 sigma^2)).
  const double sigma = 13.0;
  const auto noise = noiseOf(0.0, 11, 400, 4000, 0.0f, sigma);
  EXPECT_NEAR(mean(noise, 2), 1.0, 0.01);
  for (const int lag : { 6, 13, 20, 26, 39 })
  {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t n = 0; n + std::size_t(lag) < noise.size(); ++n)
    {
      if (n % 4000 + std::size_t(lag) < 4000)
      {
        sum += std::pow(double(noise[n]) * double(noise[n + std::size_t(lag)]), 2) - 1.0;
        count += 1.0;
      }
    }
    EXPECT_NEAR(sum / count, std::exp(-2.0 * lag * lag / (4.0 * sigma * sigma)), 0.05) << lag;
  }
}

TEST(ReceiverNoise, IsAsStrongBetweenItsNodesAsOnThem)
{
  const int lines = 20000;
  const int samples = 24;
  const auto noise = noiseOf(0.0, 2, lines, samples, 0.0f, 6.0);
  for (int s = 0; s < samples; ++s)
  {
    double sum = 0.0;
    for (int l = 0; l < lines; ++l)
    {
      sum += std::pow(double(noise[std::size_t(l * samples + s)]), 2);
    }
    EXPECT_NEAR(sum / lines, 1.0, 4.5 / std::sqrt(double(lines))) << s;
  }
}

TEST(ReceiverNoise, IsWhiteWhereThePulseIsShort)
{
  const auto noise = noiseOf(0.0, 5, 200, 2000, 0.0f);
  const double m = mean(noise, 1);
  const double variance = mean(noise, 2) - m * m;
  for (const std::size_t lag : { std::size_t(1), std::size_t(2), std::size_t(2000), std::size_t(2001) })
  {
    double sum = 0.0;
    for (std::size_t n = 0; n + lag < noise.size(); ++n)
    {
      sum += (noise[n] - m) * (noise[n + lag] - m);
    }
    const double count = double(noise.size() - lag);
    EXPECT_LT(std::abs(sum / count / variance), 4.0 / std::sqrt(count)) << lag;
  }
}

TEST(ReceiverNoise, DependsOnSeedLineAndSampleOnly)
{
  const auto whole = noiseOf(0.0, 5, 20, 1000, 0.0f);
  EXPECT_NE(whole, noiseOf(0.0, 6, 20, 1000, 0.0f));
  const auto shorter = noiseOf(0.0, 5, 10, 700, 0.0f);
  for (std::size_t n = 0; n < shorter.size(); ++n)
  {
    ASSERT_EQ(shorter[n], whole[n / 700 * 1000 + n % 700]);
  }
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(whole, noiseOf(0.0, 5, 20, 1000, 0.0f));
}

TEST(ReceiverNoise, LeavesWhatIsNoAmplitude)
{
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<float> envelope{ -1.0f, std::numeric_limits<float>::quiet_NaN(), infinity, 1e30f };
  addReceiverNoise(envelope, 4, 0.0, 13.0, 1);
  EXPECT_EQ(envelope[0], -1.0f);
  EXPECT_TRUE(std::isnan(envelope[1]));
  EXPECT_EQ(envelope[2], infinity);
  EXPECT_GE(envelope[3], 1e30f);
}

TEST(BModeNoise, IsOffUntilAskedFor)
{
  const auto envelope = rayleighEnvelope(5000, 1);
  BModeSettings settings;
  const auto without = makeBMode(envelope, 5, 1000, 0.1, settings).grey;
  settings.noiseSeed = 99;
  EXPECT_EQ(makeBMode(envelope, 5, 1000, 0.1, settings).grey, without);
  settings.addNoise = true;
  settings.noiseDb = -30.0;
  EXPECT_NE(makeBMode(envelope, 5, 1000, 0.1, settings).grey, without);
}

TEST(BModeNoise, GainLiftsTheFloorWithDepth)
{
  BModeSettings settings = plainSettings();
  settings.tgcDbPerCm = 2.0;
  settings.dynamicRangeDb = 120.0; // nothing is clipped
  settings.addNoise = true;
  settings.noiseDb = -50.0;
  const auto grey = makeBMode(std::vector<float>(400 * 1000, 0.0f), 400, 1000, 0.1, settings).grey;
  // E[20 log10 |n|] of Rayleigh noise: its power's level less 10 log10(e) times Euler's constant, 2.507 dB
  for (const int sample : { 0, 500, 999 })
  {
    double sum = 0.0;
    for (int line = 0; line < 400; ++line)
    {
      sum += (grey[std::size_t(line * 1000 + sample)] - 1.0) * 120.0;
    }
    EXPECT_NEAR(sum / 400.0, -50.0 - 2.507 + 2.0 * sample * 0.01, 4.0 * 5.57 / 20.0) << sample;
  }
}

TEST(BModeNoise, RefusesLevelsThatAreNone)
{
  BModeSettings settings = plainSettings();
  settings.noiseDb = std::numeric_limits<double>::quiet_NaN();
  expectError([&] { makeBMode({ 1.0f }, 1, 1, 1.0, settings); }, "noiseDb");
  settings.noiseDb = 201.0;
  expectError([&] { makeBMode({ 1.0f }, 1, 1, 1.0, settings); }, "noiseDb");
}
