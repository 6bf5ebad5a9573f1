#include "Trace/ReverberationBins.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

// Echoes of tissue in all bins that they cover at once against those in one bin after the other.

namespace sono::test {
namespace {

constexpr float binMm = 0.5f;
constexpr int binCount = 330;

class ReverberationBins : public testing::Test
{
protected:
  float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
  Vec3f vector(float most) { return { uniform(-most, most), uniform(-most, most), uniform(-most, most) }; }

  /// Of a segment some millimetres long, towards deeper or shallower ranges, that decays little or much.
  TissueEcho echo()
  {
    const float mu = uniform(0.1f, 1.2f) * (uniform(0.0f, 1.0f) < 0.3f ? -1.0f : 1.0f);
    return { uniform(-5.0f, 165.0f),
             mu,
             uniform(0.0f, 2.0f),
             std::pow(10.0f, uniform(-5.0f, 0.5f)),
             uniform(0.0f, 3.0f),
             vector(60.0f),
             glm::normalize(vector(1.0f) + Vec3f(0.01f, 0.0f, 0.0f)) };
  }

  std::mt19937 random_{ 7 };
  std::vector<float> cellMm_ = std::vector<float>(binCount + binsTogether, 1.0f);
  std::vector<float> levels_ = std::vector<float>(binCount + binsTogether);
  std::vector<float> powers_ = std::vector<float>(binCount + binsTogether);
};

TEST_F(ReverberationBins, OwnWaysAreAsInOneBinAfterTheOther)
{
  for (int b = 0; b < binCount; ++b)
  {
    cellMm_[std::size_t(b)] = 0.3f + 0.02f * float(b);
  }
  int bins = 0;
  int otherSigns = 0; // where a place is within rounding of a cell's wall
  int minus = 0;
  for (int n = 0; n < 4000; ++n)
  {
    const TissueEcho own = echo();
    const DepthSpan span = depthSpan(own.r0, own.mu, uniform(0.001f, 60.0f), binMm * float(binCount));
    if (!(span.high > span.low))
    {
      continue;
    }
    const BinSpan covered = binSpan(span, binMm);
    const auto line = std::uint32_t(n % 128);
    ownWayLevels(own, span, binMm, covered, line, cellMm_.data(), levels_.data());
    for (int b = covered.first; b <= covered.last; ++b, ++bins)
    {
      const BinEcho alone = echoInBin(own, span, b, binMm);
      const float level = alone.level * alone.share;
      const float sign = signInBin(own, alone, line, b, cellMm_[std::size_t(b)]);
      const float found = levels_[std::size_t(b - covered.first)];
      ASSERT_NEAR(std::fabs(found), level, 1e-5f * own.level) << "echo " << n << ", bin " << b;
      otherSigns += found * sign < 0.0f ? 1 : 0;
      minus += found < 0.0f ? 1 : 0;
    }
    const int behind = (covered.last - covered.first + binsTogether) / binsTogether * binsTogether;
    for (int i = covered.last - covered.first + 1; i < behind; ++i)
    {
      ASSERT_EQ(levels_[std::size_t(i)], 0.0f);
    }
  }
  EXPECT_GT(bins, 50000);
  EXPECT_LT(otherSigns, bins / 1000);
  EXPECT_NEAR(double(minus) / bins, 0.5, 0.02);
}

TEST_F(ReverberationBins, WhatComesStraightBackIsAsInOneBinAfterTheOther)
{
  int bins = 0;
  for (int n = 0; n < 4000; ++n)
  {
    TissueEcho straight = echo();
    straight.start = vector(3.0f);
    straight.direction *= 0.2f;
    const DepthSpan span = heardSpan(straight, uniform(0.001f, 60.0f), binMm * float(binCount));
    if (!(span.high > span.low))
    {
      continue;
    }
    const BinSpan covered = binSpan(span, binMm);
    straightBackLevels(straight, span, binMm, covered, levels_.data(), powers_.data());
    for (int b = covered.first; b <= covered.last; ++b, ++bins)
    {
      const BinEcho alone = echoInBin(straight, span, b, binMm);
      const float heard = alone.level * heardInBin(alone);
      ASSERT_NEAR(levels_[std::size_t(b - covered.first)], heard * alone.share, 1e-5f * straight.level);
      ASSERT_NEAR(powers_[std::size_t(b - covered.first)], heard * heard * alone.share,
                  2e-5f * straight.level * straight.level);
    }
  }
  EXPECT_GT(bins, 20000);
}

} // namespace
} // namespace sono::test
