#include "Image/BMode.h"
#include "ImageTestTools.h"
#include "Kernel/PixelMath.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

namespace {

using namespace sono;

constexpr double pi = 3.141592653589793;

/// No gain, reference 1, 60 dB: the settings whose grey levels a person can work out in the head.
BModeSettings plainSettings()
{
  BModeSettings settings;
  settings.tgcDbPerCm = 0.0;
  settings.automaticReference = false;
  settings.referenceAmplitude = 1.0;
  settings.dynamicRangeDb = 60.0;
  return settings;
}

std::vector<float> greyOf(const std::vector<float>& line, const BModeSettings& settings, double sampleMm = 1.0)
{
  return makeBMode(line, 1, static_cast<int>(line.size()), sampleMm, settings).grey;
}

double worstDecibelError(int firstExponent, int lastExponent)
{
  double worst = 0.0;
  for (int exponent = firstExponent; exponent <= lastExponent; ++exponent)
  {
    for (int k = 0; k < 1000; ++k)
    {
      const float x = std::ldexp(1.0f + k / 1000.0f, exponent);
      worst = std::max(worst, std::abs(fastDecibels(x) - 20.0 * std::log10(double(x))));
    }
  }
  return worst;
}

TEST(PixelMath, DecibelsAgreeWithLog10)
{
  EXPECT_LT(worstDecibelError(-20, 19), 3e-5);
  EXPECT_LT(worstDecibelError(-126, 127), 1e-4); // one float step at 760 dB is 6e-5
}

TEST(PixelMath, AngleAgreesWithAtan2)
{
  double worst = 0.0;
  for (int k = -20000; k <= 20000; ++k)
  {
    const double angle = k * (pi / 2.0 / 20000.0);
    const auto y = static_cast<float>(150.0 * std::sin(angle));
    const auto x = static_cast<float>(150.0 * std::max(0.0, std::cos(angle)));
    worst = std::max(worst, std::abs(fastAtan2RightHalf(y, x) - std::atan2(double(y), double(x))));
  }
  EXPECT_LT(worst, 2e-7);
}

TEST(BMode, GreyLevelsByHand)
{
  // 0, -20, -30, -60, -80 and +20 dB of a 60 dB range
  const auto grey = greyOf({ 1.0f, 0.1f, 0.0316227766f, 0.001f, 0.0001f, 10.0f }, plainSettings());
  const std::vector<float> expected{ 1.0f, 2.0f / 3.0f, 0.5f, 0.0f, 0.0f, 1.0f };
  for (std::size_t s = 0; s < grey.size(); ++s)
  {
    EXPECT_NEAR(grey[s], expected[s], 2e-6) << s;
  }
}

TEST(BMode, GainAndReferenceShiftTheScale)
{
  BModeSettings settings = plainSettings();
  settings.gainDb = 15.0;
  settings.referenceAmplitude = 100.0; // 40 dB
  EXPECT_NEAR(greyOf({ 10.0f }, settings)[0], 1.0 + (20.0 + 15.0 - 40.0) / 60.0, 2e-6);
}

TEST(BMode, SlopeCompensatesExponentialDecay)
{
  BModeSettings settings = plainSettings();
  settings.tgcDbPerCm = 1.5;
  const double sampleMm = 0.0154;
  std::vector<float> envelope(10390);
  for (std::size_t s = 0; s < envelope.size(); ++s)
  {
    envelope[s] = static_cast<float>(0.1 * std::pow(10.0, -1.5 * (s * sampleMm / 10.0) / 20.0));
  }
  for (const float grey : greyOf(envelope, settings, sampleMm))
  {
    ASSERT_NEAR(grey, 2.0 / 3.0, 2e-6);
  }
}

TEST(BMode, SlidersStandInTheMiddleOfTheirEighths)
{
  BModeSettings settings = plainSettings();
  settings.tgcDb = { 0.0, 6.0, -6.0, 0.0, 0.0, 0.0, 4.0, 10.0 };
  // 160 mm: sliders at 10, 30, ..., 150 mm
  const std::vector<std::pair<std::size_t, double>> expectedDb{ { 0, 0.0 },   { 10, 0.0 },  { 20, 3.0 },  { 30, 6.0 },
                                                                { 40, 0.0 },  { 45, -3.0 }, { 50, -6.0 }, { 70, 0.0 },
                                                                { 90, 0.0 },  { 120, 2.0 }, { 135, 5.5 }, { 150, 10.0 },
                                                                { 160, 10.0 } };
  const auto grey = greyOf(std::vector<float>(161, 0.1f), settings);
  for (const auto& [sample, decibels] : expectedDb)
  {
    EXPECT_NEAR(grey[sample], 1.0 + (decibels - 20.0) / 60.0, 2e-6) << sample;
  }
}

TEST(BMode, SlidersAddToTheSlope)
{
  BModeSettings settings = plainSettings();
  settings.tgcDbPerCm = 2.0;
  settings.tgcDb.fill(3.0);
  EXPECT_NEAR(greyOf(std::vector<float>(21, 0.01f), settings)[20], 1.0 + (4.0 + 3.0 - 40.0) / 60.0, 2e-6);
}

TEST(BMode, LateralGainFollowsTheLines)
{
  BModeSettings settings = plainSettings();
  settings.lateralGainDb = { -8.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 16.0 };
  // One line an eighth: each slider is a line's.
  const auto grey = makeBMode(std::vector<float>(16, 0.1f), 8, 2, 1.0, settings).grey;
  EXPECT_NEAR(grey[0], 1.0 - 28.0 / 60.0, 2e-6);
  EXPECT_NEAR(grey[7], 1.0 - 20.0 / 60.0, 2e-6);
  EXPECT_NEAR(grey[14], 1.0 - 4.0 / 60.0, 2e-6);
  EXPECT_EQ(grey[14], grey[15]);
  // Two lines an eighth, in two planes: the second line stands a quarter of a step behind its slider.
  settings.linesAcross = 16;
  const auto planes = makeBMode(std::vector<float>(32, 0.1f), 32, 1, 1.0, settings).grey;
  EXPECT_NEAR(planes[1], 1.0 - (20.0 + 8.0 * 0.75) / 60.0, 2e-6);
  EXPECT_NEAR(planes[14], 1.0 - (20.0 - 16.0 * 0.75) / 60.0, 2e-6);
  EXPECT_TRUE(std::equal(planes.begin(), planes.begin() + 16, planes.begin() + 16));
}

TEST(BMode, LateralGainLeavesTheReferenceAlone)
{
  BModeSettings settings;
  const auto envelope = rayleighEnvelope(16 * 500, 3);
  const double reference = makeBMode(envelope, 16, 500, 0.1, settings).referenceAmplitude;
  settings.lateralGainDb.fill(12.0);
  EXPECT_EQ(makeBMode(envelope, 16, 500, 0.1, settings).referenceAmplitude, reference);
}

TEST(BMode, RejectBlackensTheBottom)
{
  BModeSettings settings = plainSettings();
  settings.rejectDb = 20.0; // levels below -40 dB
  const auto grey = greyOf({ 0.0101f, 0.0099f, 0.1f, 1.0f }, settings);
  EXPECT_NEAR(grey[0], (60.0 + 20.0 * std::log10(0.0101)) / 60.0, 2e-6);
  EXPECT_EQ(grey[1], 0.0f);
  EXPECT_NEAR(grey[2], 2.0 / 3.0, 2e-6);
  EXPECT_EQ(grey[3], 1.0f);
}

TEST(BMode, AmplitudesThatAreNoneAreBlack)
{
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> envelope{ nan, -nan, -1.0f, 0.0f, -0.0f, 1e-40f, -infinity, infinity, 1.0f };
  for (const bool automatic : { false, true })
  {
    BModeSettings settings = plainSettings();
    settings.automaticReference = automatic;
    settings.tgcDb.fill(40.0); // the strongest gain must not lift nothing to something
    settings.gainDb = 300.0;
    settings.dynamicRangeDb = 300.0;
    const auto grey = greyOf(envelope, settings);
    for (std::size_t s = 0; s < 7; ++s)
    {
      EXPECT_EQ(grey[s], 0.0f) << s;
    }
    EXPECT_EQ(grey[7], 1.0f);
    EXPECT_EQ(grey[8], 1.0f);
  }
}

TEST(BMode, AutomaticReferenceIsThePercentile)
{
  BModeSettings settings;
  settings.tgcDbPerCm = 1.5;
  settings.tgcDb = { -3.0, -3.0, -3.0, -3.0, 4.0, 4.0, 4.0, 4.0 };
  settings.gainDb = 12.0; // leaves the reference alone
  const double sampleMm = 0.05;
  for (const int sampleCount : { 1, 7, 125, 1000, 1237 })
  {
    const int lineCount = 16;
    const auto envelope = rayleighEnvelope(std::size_t(lineCount) * sampleCount, 7u + sampleCount);
    std::vector<double> gained;
    for (std::size_t k = 0; k < envelope.size(); ++k)
    {
      const int sample = int(k % std::size_t(sampleCount));
      if (sampleCount > 120 && sample < 120) // the first 6 mm do not count, where there is more
      {
        continue;
      }
      const double depth = sample * sampleMm;
      const double eighth = 8.0 * sample / std::max(1, sampleCount - 1);
      const double curve = eighth < 3.5 ? -3.0 : eighth > 4.5 ? 4.0 : -3.0 + 7.0 * (eighth - 3.5);
      gained.push_back(envelope[k] * std::pow(10.0, (0.15 * depth + curve) / 20.0));
    }
    std::sort(gained.begin(), gained.end());
    const auto rank = static_cast<std::size_t>(std::ceil(0.9 * gained.size() - 1e-9));
    const auto lines = makeBMode(envelope, lineCount, sampleCount, sampleMm, settings);
    EXPECT_NEAR(20.0 * std::log10(lines.referenceAmplitude / gained[rank - 1]), 25.0, 1e-5) << sampleCount;
  }
}

TEST(BMode, AutomaticReferenceIsNotTheSkin)
{
  BModeSettings settings = plainSettings();
  settings.automaticReference = true;
  std::vector<float> envelope(4 * 400, 0.01f);
  for (std::size_t line = 0; line < 4; ++line)
  {
    std::fill_n(envelope.begin() + std::ptrdiff_t(400 * line), 59, 1.0f); // 0.1 mm a sample: up to 5.8 mm
  }
  EXPECT_NEAR(makeBMode(envelope, 4, 400, 0.1, settings).referenceAmplitude, 0.01 * std::pow(10.0, 1.25), 1e-6);
}

TEST(BMode, AutomaticReferenceOfNearlyNothing)
{
  BModeSettings settings = plainSettings();
  settings.automaticReference = true;
  std::vector<float> envelope(5000, 0.0f);
  EXPECT_EQ(makeBMode(envelope, 5, 1000, 1.0, settings).referenceAmplitude, 1.0);
  envelope[4321] = 0.25f; // one bright point, fewer than one in ten
  const auto lines = makeBMode(envelope, 5, 1000, 1.0, settings);
  EXPECT_EQ(lines.referenceAmplitude, 0.25);
  EXPECT_NEAR(lines.grey[4321], 1.0f, 2e-6);
}

TEST(BMode, GainStillActsWithAutomaticReference)
{
  BModeSettings settings = plainSettings();
  settings.automaticReference = true;
  const std::vector<float> envelope{ 1.0f, 0.1f };
  const float before = greyOf(envelope, settings)[1];
  settings.gainDb = 6.0;
  EXPECT_NEAR(greyOf(envelope, settings)[1] - before, 0.1, 2e-6);
}

TEST(BMode, RefusesWhatMakesNoSense)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto with = [](const std::function<void(BModeSettings&)>& change) {
    return [change] {
      BModeSettings settings = plainSettings();
      change(settings);
      makeBMode({ 1.0f }, 1, 1, 1.0, settings);
    };
  };
  expectError(with([&](auto& s) { s.tgcDbPerCm = nan; }), "tgcDbPerCm");
  expectError(with([&](auto& s) { s.gainDb = 1e9; }), "gainDb");
  expectError(with([&](auto& s) { s.referenceAmplitude = 0.0; }), "referenceAmplitude");
  expectError(with([&](auto& s) { s.dynamicRangeDb = 0.0; }), "dynamicRangeDb");
  expectError(with([&](auto& s) { s.dynamicRangeDb = nan; }), "dynamicRangeDb");
  expectError(with([&](auto& s) { s.rejectDb = 60.0; }), "rejectDb");
  expectError(with([&](auto& s) { s.rejectDb = -1.0; }), "rejectDb");
  expectError(with([&](auto& s) { s.tgcDb[2] = nan; }), "tgc3Db");
  expectError(with([&](auto& s) { s.tgcDb[7] = 41.0; }), "tgc8Db");
  expectError(with([&](auto& s) { s.lateralGainDb[0] = -41.0; }), "lateralGain1Db");
  expectError(with([&](auto& s) { s.axialSmoothingMm = -1.0; }), "axialSmoothingMm");
  expectError(with([&](auto& s) { s.hazeDb = nan; }), "hazeDb");
  expectError(with([&](auto& s) { s.greyMap = { 0.5f }; }), "greyMap");
  expectError(with([&](auto& s) { s.greyMap = { 0.0f, 1.5f }; }), "greyMap");
  expectError([] { makeBMode({}, 0, 1, 1.0, plainSettings()); }, "lineCount");
  expectError([] { makeBMode({}, 1, 0, 1.0, plainSettings()); }, "sampleCount");
  expectError([] { makeBMode({ 1.0f }, 1, 1, 0.0, plainSettings()); }, "sampleMm");
  expectError([] { makeBMode({ 1.0f }, 1, 2, 1.0, plainSettings()); }, "envelope");
}

} // namespace
