#include "ChiSquared.h"

#include "Kernel/Rng.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace {

using namespace sono;
using namespace sono::test;

TEST(Philox, GivesThePublishedWords)
{
  // Random123, kat_vectors, philox4x32-10.
  const RandomWords zero = philox(0, 0, 0, 0, 0);
  EXPECT_EQ(zero.v[0], 0x6627e8d5u);
  EXPECT_EQ(zero.v[1], 0xe169c58du);
  EXPECT_EQ(zero.v[2], 0xbc57ac4cu);
  EXPECT_EQ(zero.v[3], 0x9b00dbd8u);
  const std::uint32_t f = 0xffffffffu;
  const RandomWords full = philox(0xffffffffffffffffull, f, f, f, f);
  EXPECT_EQ(full.v[0], 0x408f276du);
  EXPECT_EQ(full.v[1], 0x41c83b0eu);
  EXPECT_EQ(full.v[2], 0xa20bc7c6u);
  EXPECT_EQ(full.v[3], 0x6d5451fdu);
  // Digits of pi; the key's words are a4093822 (low) and 299f31d0.
  const RandomWords pi = philox(0x299f31d0a4093822ull, 0x243f6a88u, 0x85a308d3u, 0x13198a2eu, 0x03707344u);
  EXPECT_EQ(pi.v[0], 0xd16cfe09u);
  EXPECT_EQ(pi.v[1], 0x94fdccebu);
  EXPECT_EQ(pi.v[2], 0x5001e420u);
  EXPECT_EQ(pi.v[3], 0x24126ea1u);
}

TEST(UniformFrom, StaysInsideTheOpenIntervalAndIsSymmetric)
{
  EXPECT_GT(uniformFrom(0u), 0.0f);
  EXPECT_LT(uniformFrom(0xffffffffu), 1.0f);
  for (std::uint32_t word = 0; word < 0xfff00000u; word += 0x000fedcbu)
  {
    EXPECT_EQ(uniformFrom(word), 1.0f - uniformFrom(~word));
  }
}

TEST(UniformFrom, AllStepsAreEqual)
{
  for (const std::uint32_t base : { 0u, 0x7ffff000u, 0x80000000u, 0xfffff000u })
  {
    std::set<float> values;
    for (std::uint32_t i = 0; i < 0x1000u; ++i)
    {
      values.insert(uniformFrom(base + i));
    }
    const float step = *std::next(values.begin()) - *values.begin();
    float previous = *values.begin() - step;
    for (const float v : values)
    {
      EXPECT_EQ(v - previous, step) << base;
      previous = v;
    }
    EXPECT_LE(step, std::ldexp(1.0f, -23));
  }
}

/// Whether the points have exactly one in each of the 2^k elementary intervals of every shape.
template<class Point>
bool stratifies(int k, std::uint32_t first, const Point& point)
{
  for (int a = 0; a <= k; ++a)
  {
    std::set<std::uint64_t> cells;
    for (std::uint32_t i = 0; i < (1u << k); ++i)
    {
      const auto [x, y] = point(first + i);
      const auto cx = std::uint64_t(std::ldexp(double(x), a));
      const auto cy = std::uint64_t(std::ldexp(double(y), k - a));
      cells.insert((cx << 32) | cy);
    }
    if (cells.size() != (std::size_t(1) << k))
    {
      return false;
    }
  }
  return true;
}

TEST(Sobol, FirstTwoDimensionsAreAZeroTwoSequence)
{
  const auto plain = [](std::uint32_t i) {
    return std::make_pair(std::ldexp(double(reverseBits(i)), -32),
                          std::ldexp(double(reverseBits(sobolSecondReversed(i))), -32));
  };
  for (int k = 0; k <= 10; ++k)
  {
    for (std::uint32_t block = 0; block < 3; ++block)
    {
      EXPECT_TRUE(stratifies(k, block << k, plain)) << "k " << k << " block " << block;
    }
  }
  // The diagonal is no (0,2)-sequence, and the check must say so.
  EXPECT_FALSE(stratifies(
    4, 0, [](std::uint32_t i) { return std::make_pair(std::ldexp(double(i), -4), std::ldexp(double(i), -4)); }));
}

TEST(Sobol, StaysAZeroTwoSequenceWhenShuffledAndScrambled)
{
  for (std::uint32_t set = 0; set < 20; ++set)
  {
    const BounceScramble scramble = makeBounceScramble(3, set, set * 7, set % 5);
    for (int k = 0; k <= 9; ++k)
    {
      const auto pair = [&](std::uint32_t i) {
        const BounceSample s = lowDiscrepancySample(scramble, i);
        return std::make_pair(s.polar, s.azimuth);
      };
      EXPECT_TRUE(stratifies(k, 0, pair)) << "set " << set << " k " << k;
      EXPECT_TRUE(stratifies(k, 5u << k, pair)) << "set " << set << " k " << k;
      std::set<int> strata;
      for (std::uint32_t i = 0; i < (1u << k); ++i)
      {
        strata.insert(int(std::ldexp(lowDiscrepancySample(scramble, i).choice, k)));
      }
      EXPECT_EQ(strata.size(), std::size_t(1) << k) << "choice, set " << set;
    }
  }
}

TEST(Sobol, WhatIsPaddedTogetherIsUncorrelated)
{
  constexpr int cells = 8;
  constexpr int sets = 64;
  const auto cell = [](float v) { return int(v * cells); };
  for (const int points : { 125, 128, 1000 })
  {
    std::vector<double> choicePolar(cells * cells, 0.0);
    std::vector<double> choiceAzimuth(cells * cells, 0.0);
    std::vector<double> nextBounce(cells * cells, 0.0);
    std::vector<double> nextBatch(cells * cells, 0.0);
    int worst = 0;
    for (std::uint32_t set = 0; set < sets; ++set)
    {
      const BounceScramble one = makeBounceScramble(9, set, 0, 0);
      const BounceScramble bounce = makeBounceScramble(9, set, 0, 1);
      const BounceScramble batch = makeBounceScramble(9, set, 1, 0);
      std::vector<int> quadrants(4, 0);
      for (std::uint32_t i = 0; i < std::uint32_t(points); ++i)
      {
        const BounceSample s = lowDiscrepancySample(one, i);
        const BounceSample n = lowDiscrepancySample(bounce, i);
        const BounceSample o = lowDiscrepancySample(batch, i);
        choicePolar[std::size_t(cell(s.choice) * cells + cell(s.polar))] += 1.0;
        choiceAzimuth[std::size_t(cell(s.choice) * cells + cell(s.azimuth))] += 1.0;
        nextBounce[std::size_t(cell(s.polar) * cells + cell(n.polar))] += 1.0;
        nextBatch[std::size_t(cell(s.polar) * cells + cell(o.polar))] += 1.0;
        ++quadrants[std::size_t(2 * int(s.choice * 2.0f) + int(s.polar * 2.0f))];
      }
      // Within one set, too: a reflected path must not always get the small angles.
      worst = std::max(worst, std::abs(quadrants[0] + quadrants[3] - quadrants[1] - quadrants[2]));
    }
    const double level = significanceOfEach(12);
    EXPECT_GT(independencePValue(choicePolar, cells), level) << points;
    EXPECT_GT(independencePValue(choiceAzimuth, cells), level) << points;
    EXPECT_GT(independencePValue(nextBounce, cells), level) << points;
    EXPECT_GT(independencePValue(nextBatch, cells), level) << points;
    // Four and a half standard deviations of a coin's balance, with stratified paths falling in pairs.
    EXPECT_LT(worst, 4.5 * std::sqrt(2.0 * points)) << points;
  }
}

} // namespace
