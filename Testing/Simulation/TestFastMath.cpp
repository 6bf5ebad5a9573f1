#include "Kernel/FastMath.h"
#include "Kernel/NormalDeviate.h"
#include "Kernel/Rng.h"
#include "Kernel/Scatterer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

using namespace sono;

/// Upper tail probability of a standard normal.
double upperTail(double x)
{
  return 0.5 * std::erfc(x / std::sqrt(2.0));
}

/// x with upperTail(x) = q by bisection of the logarithm, in double precision.
double quantile(double q)
{
  double low = -40.0;
  double high = 40.0;
  for (int i = 0; i < 200; ++i)
  {
    const double middle = 0.5 * (low + high);
    (upperTail(middle) > q ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

TEST(FastMath, ExponentialFollowsDouble)
{
  for (double x = 0.0; x >= -87.0; x -= 0.00137)
  {
    const float argument = float(x);
    const double exact = std::exp(double(argument));
    ASSERT_LT(std::abs(expNegative(argument) / exact - 1.0), 3e-7 + 1e-7 * std::abs(x)) << x;
  }
  for (const float x : { -88.0f, -1e3f, -3e38f, -std::numeric_limits<float>::infinity() })
  {
    EXPECT_NEAR(expNegative(x), std::exp(-87.0), 1e-43) << x;
  }
}

TEST(FastMath, CosineAndSineFollowDouble)
{
  for (double x = -1.6; x <= 1.6; x += 1.1e-5)
  {
    const float argument = float(x);
    ASSERT_NEAR(cosSmall(argument), std::cos(double(argument)), 2e-7) << x;
    ASSERT_NEAR(sinSmall(argument), std::sin(double(argument)), 2e-7) << x;
  }
}

TEST(FastMath, LogarithmFollowsDouble)
{
  EXPECT_EQ(logPositive(1.0f), 0.0f);
  for (double x = 1.2e-38; x < 3e38; x *= 1.00071)
  {
    const float argument = float(x);
    const double exact = std::log(double(argument));
    ASSERT_NEAR(logPositive(argument), exact, 2e-7 * (1.0 + std::abs(exact))) << x;
  }
}

TEST(NormalDeviate, FollowsTheQuantileOverAllItsUniforms)
{
  // Around the ends each of the 24-bit uniforms, elsewhere every 4999th.
  for (std::uint64_t word = 0; word < (1u << 24); word += (word < 500 || word > (1u << 24) - 500) ? 1 : 4999)
  {
    const float u = uniformFrom(std::uint32_t(word) << 8);
    const double exact = quantile(double(u));
    ASSERT_NEAR(normalDeviate(u), exact, 2e-6) << u;
  }
}

TEST(NormalQuantile, KeepsItsPrecisionInBothTails)
{
  for (double q = 1e-36; q < 0.5; q *= 1.37)
  {
    const float upper = float(q);
    const double x = quantile(double(upper));
    // Beyond 5 Mills' ratio is cut at 15 / 5^6 = 1e-3 of the probability, which is 1e-3 / x of x.
    ASSERT_NEAR(normalFromUpperTail(upper), x, x > 5.0 ? 1e-3 / x : 5e-6 * std::max(1.0, x)) << q;
    const float lower = 1.0f - upper;
    if (lower < 1.0f)
    {
      ASSERT_NEAR(normalFromUpperTail(lower), quantile(double(lower)), 5e-6 * std::max(1.0, x)) << q;
    }
  }
}

TEST(Philox, GivesThePublishedWords)
{
  // Known answers of philox4x32-10 in Random123's kat_vectors (Salmon et al. 2011).
  const RandomWords zeros = philox(0, 0, 0, 0, 0);
  EXPECT_EQ(zeros.v[0], 0x6627e8d5u);
  EXPECT_EQ(zeros.v[1], 0xe169c58du);
  EXPECT_EQ(zeros.v[2], 0xbc57ac4cu);
  EXPECT_EQ(zeros.v[3], 0x9b00dbd8u);
  const std::uint32_t full = 0xffffffffu;
  const RandomWords ones = philox(~std::uint64_t(0), full, full, full, full);
  EXPECT_EQ(ones.v[0], 0x408f276du);
  EXPECT_EQ(ones.v[1], 0x41c83b0eu);
  EXPECT_EQ(ones.v[2], 0xa20bc7c6u);
  EXPECT_EQ(ones.v[3], 0x6d5451fdu);
}

} // namespace
