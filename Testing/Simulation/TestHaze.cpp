#include "Image/BMode.h"
#include "Image/Haze.h"
#include "ImageTestTools.h"
#include "Kernel/GreyLevel.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace sono;

namespace {

BModeSettings hazy(double variationDb)
{
  BModeSettings settings;
  settings.tgcDbPerCm = 0.0;
  settings.automaticReference = false;
  settings.dynamicRangeDb = 120.0;
  settings.addHaze = true;
  settings.hazeDb = -40.0;
  settings.hazeFallDbPerCmMHz = 1.2;
  settings.frequencyMHz = 2.5;
  settings.hazeVariationDb = variationDb;
  return settings;
}

double levelDb(float grey)
{
  return (double(grey) - 1.0) * 120.0;
}

TEST(Haze, FallsFromTheTransducer)
{
  const auto grey = makeBMode(std::vector<float>(2 * 1001, 0.0f), 2, 1001, 0.1, hazy(0.0)).grey;
  for (const int sample : { 0, 7, 500, 1000 })
  {
    EXPECT_NEAR(levelDb(grey[std::size_t(sample)]), -40.0 - 0.03 * sample, 0.02) << sample;
  }
}

TEST(Haze, AddsToEchoesAsPower)
{
  BModeSettings settings = hazy(0.0);
  settings.hazeFallDbPerCmMHz = 0.0;
  const auto grey = makeBMode({ 0.03f, 0.0f }, 1, 2, 0.1, settings).grey;
  EXPECT_NEAR(levelDb(grey[0]), 10.0 * std::log10(0.03 * 0.03 + 1e-4), 1e-3);
  EXPECT_NEAR(levelDb(grey[1]), -40.0, 1e-3);
}

TEST(Haze, VariesSmoothlyByItsDecibelsAndKeepsItsMean)
{
  BModeSettings settings = hazy(2.0);
  settings.hazeFallDbPerCmMHz = 0.0;
  const int lines = 128;
  const int samples = 10000;
  double power = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  double steepest = 0.0; // dB/mm
  const int seeds = 20;
  for (int seed = 1; seed <= seeds; ++seed)
  {
    settings.noiseSeed = std::uint64_t(seed);
    const HazePower haze = makeHaze(settings, lines, samples, 0.016);
    const auto count = double(haze.power.size()) * seeds;
    for (std::size_t n = 0; n < haze.power.size(); ++n)
    {
      const double decibels = 10.0 * std::log10(double(haze.power[n]));
      power += haze.power[n] / count;
      sum += decibels / count;
      squares += decibels * decibels / count;
      if (int(n) % haze.nodeCount > 0)
      {
        const double before = 10.0 * std::log10(double(haze.power[n - 1]));
        steepest = std::max(steepest, std::abs(decibels - before) * haze.nodesPerSample / 0.016);
      }
    }
  }
  // 20 fields of about 75 x 200 cells
  EXPECT_NEAR(10.0 * std::log10(power), -40.0, 0.1);
  EXPECT_NEAR(std::sqrt(squares - sum * sum), 2.0, 0.1);
  EXPECT_LT(steepest, 20.0);
}

TEST(Haze, DependsOnSeedAndPlaceOnly)
{
  const BModeSettings settings = hazy(3.0);
  const auto whole = makeHaze(settings, 64, 5000, 0.02);
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(whole.power, makeHaze(settings, 64, 5000, 0.02).power);
  }
  // Half of the depth, at twice the sampling: the same nodes.
  const auto shorter = makeHaze(settings, 64, 5000, 0.01);
  for (int line = 0; line < 64; ++line)
  {
    ASSERT_EQ(shorter.power[std::size_t(line * shorter.nodeCount + 80)],
              whole.power[std::size_t(line * whole.nodeCount + 80)]);
  }
  BModeSettings other = settings;
  other.noiseSeed = 2;
  EXPECT_NE(whole.power, makeHaze(other, 64, 5000, 0.02).power);
}

TEST(Haze, LeavesWhatIsNoAmplitude)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto grey = makeBMode({ nan, -1.0f, 0.0f, 1e30f }, 1, 4, 0.1, hazy(0.0)).grey;
  EXPECT_EQ(grey[0], 0.0f);
  EXPECT_EQ(grey[1], 0.0f);
  EXPECT_GT(grey[2], 0.0f);
  EXPECT_EQ(grey[3], 1.0f);
}

BModeSettings plain()
{
  BModeSettings settings;
  settings.tgcDbPerCm = 0.0;
  settings.automaticReference = false;
  return settings;
}

TEST(AxialSmoothing, TurnsAStepIntoTheNormalDistribution)
{
  BModeSettings settings = plain();
  settings.axialSmoothingMm = 0.4;
  const double sampleMm = 0.01;
  std::vector<float> envelope(1000, 0.2f);
  std::fill(envelope.begin() + 500, envelope.end(), 0.8f);
  const auto grey = makeBMode(envelope, 1, 1000, sampleMm, settings).grey;
  const double sigmaMm = 0.4 / 2.3548200450;
  for (const int sample : { 0, 460, 490, 500, 505, 530, 999 })
  {
    const double x = (sample - 499.5) * sampleMm / sigmaMm;
    const double expected = 0.2 + 0.6 * 0.5 * std::erfc(-x / std::sqrt(2.0));
    EXPECT_NEAR(std::pow(10.0, 3.0 * (grey[std::size_t(sample)] - 1.0)), expected, 1e-4) << sample;
  }
}

TEST(LateralSmoothing, TurnsAStepIntoTheNormalDistributionWithinItsPlane)
{
  constexpr int across = 200;
  BModeSettings settings = plain();
  settings.lateralSmoothingLines = 20.0;
  settings.linesAcross = across;
  const int samples = 3;
  std::vector<float> envelope(2 * across * samples, 0.2f);
  std::fill(envelope.begin() + 100 * samples, envelope.begin() + across * samples, 0.8f); // the second plane is even
  const auto grey = makeBMode(envelope, 2 * across, samples, 0.1, settings).grey;
  const double sigma = 20.0 / 2.3548200450;
  for (const int line : { 0, 80, 95, 100, 110, 199, 200, 210, 399 })
  {
    const double step = line < across ? 0.5 * std::erfc(-(line - 99.5) / (sigma * std::sqrt(2.0))) : 0.0;
    for (int s = 0; s < samples; ++s)
    {
      const float level = grey[std::size_t(line * samples + s)];
      EXPECT_NEAR(std::pow(10.0, 3.0 * (level - 1.0)), 0.2 + 0.6 * step, 1e-4) << line;
    }
  }
}

TEST(Smoothing, OfLevelsLeavesABellsWidthAndComesBeforeTheMap)
{
  // A bell's level is a parabola, which a Gaussian of variance v lowers by v dB'' / 2 everywhere: 8.6859 v / (2 s^2).
  constexpr int side = 201;
  constexpr double sigma = 12.0; // lines and samples
  std::vector<float> bell;
  for (int l = 0; l < side; ++l)
  {
    for (int s = 0; s < side; ++s)
    {
      bell.push_back(float(std::exp(-0.5 * (std::pow(l - 100, 2) + std::pow(s - 100, 2)) / (sigma * sigma))));
    }
  }
  BModeSettings settings = plain();
  settings.dynamicRangeDb = 100.0;
  settings.axialSmoothingMm = 0.6; // at 0.1 mm a sample
  settings.lateralSmoothingLines = 8.0;
  settings.smoothCompressed = true;
  const auto level = makeBMode(bell, side, side, 0.1, settings).grey;
  const double lowerDb = (36.0 + 64.0) / std::pow(2.3548200450, 2) * 8.6858896 / (2.0 * sigma * sigma);
  for (const int away : { 0, 5, 10, 15 })
  {
    const double db = -8.6858896 * 0.5 * away * away / (sigma * sigma) - lowerDb;
    EXPECT_NEAR(100.0 * (level[std::size_t(100 * side + 100 + away)] - 1.0), db, 2e-3) << away << " samples";
    EXPECT_NEAR(100.0 * (level[std::size_t((100 + away) * side + 100)] - 1.0), db, 2e-3) << away << " lines";
  }
  settings.greyMap = { 0.0f, 0.1f, 1.0f };
  const auto grey = makeBMode(bell, side, side, 0.1, settings).grey;
  for (std::size_t i = 0; i < grey.size(); i += 97)
  {
    EXPECT_EQ(grey[i], mapGrey(settings.greyMap.data(), 3, level[i]));
  }
}

} // namespace
