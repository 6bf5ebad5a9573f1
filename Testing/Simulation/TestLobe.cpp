#include "ChiSquared.h"

#include "Kernel/Lobe.h"
#include "Kernel/Rng.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace sono;
using namespace sono::test;

/// The truncated normal in double precision, the reference of every test here.
struct Truncated
{
  double mu;
  double sigma;
  double a;
  double b;

  /// Mass of the untruncated normal between two angles, from whichever tail keeps its digits.
  double between(double from, double to) const
  {
    const double x = (from - mu) / (sigma * std::sqrt(2.0));
    const double y = (to - mu) / (sigma * std::sqrt(2.0));
    return y < 0.0 ? 0.5 * (std::erfc(-y) - std::erfc(-x)) : 0.5 * (std::erfc(x) - std::erfc(y));
  }
  double cdf(double phi) const { return between(a, phi) / between(a, b); }

  double quantile(double p) const
  {
    double low = a;
    double high = b;
    for (int i = 0; i < 100; ++i)
    {
      const double middle = 0.5 * (low + high);
      (cdf(middle) < p ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
};

std::vector<Truncated> truncatedCases()
{
  const double right = 1.570796;
  std::vector<Truncated> cases;
  for (const double sigma : { 1e-3, 1e-2, 0.1, M_PI / 4.0, 1.0, 3.0, 10.0 })
  {
    cases.push_back({ 0.0, sigma, 0.0, right });
    cases.push_back({ 0.6, sigma, 0.0, right });
    cases.push_back({ 0.6, sigma, 0.6 - 0.5 * std::min(sigma, 1.0), 0.6 + 0.9 * std::min(sigma, 1.0) });
    cases.push_back({ right, sigma, 0.0, right });
  }
  // Far tails: the interval begins 4.9, 5.1, 10 and 30 sigma above mu, or mu lies beyond its upper end.
  for (const double distance : { 4.9, 5.1, 10.0, 30.0 })
  {
    cases.push_back({ 0.2, 0.01, 0.2 + 0.01 * distance, right });
    cases.push_back({ 1.2, 0.01, 0.1, 1.2 - 0.01 * distance });
    cases.push_back({ -0.5 * distance, 0.5, 0.0, right });
  }
  // Just on either side of the centre, where sampling turns from one tail to the other.
  cases.push_back({ 0.5, 0.1, 0.3, 0.701 });
  cases.push_back({ 0.5, 0.1, 0.3, 0.699 });
  // As good as uniform.
  cases.push_back({ 0.0, 1e3, 0.0, right });
  cases.push_back({ 0.7, 1e6, 0.2, right });
  return cases;
}

std::string nameOf(const Truncated& t)
{
  return "mu " + std::to_string(t.mu) + " sigma " + std::to_string(t.sigma) + " a " + std::to_string(t.a) + " b " +
         std::to_string(t.b);
}

Lobe lobeOf(const Truncated& t)
{
  return makeLobe(t.mu, t.sigma, t.a, t.b);
}

/// p-value of samples in 64 cells of equal probability.
template<class Polar>
double polarPValue(const Truncated& reference, int samples, const Polar& polar)
{
  constexpr int cells = 64;
  const Lobe lobe = lobeOf(reference);
  std::vector<double> edges;
  for (int i = 1; i < cells; ++i)
  {
    edges.push_back(reference.quantile(double(i) / cells));
  }
  std::vector<double> observed(cells, 0.0);
  for (int i = 0; i < samples; ++i)
  {
    const double phi = samplePolar(lobe, polar(i));
    observed[std::size_t(std::upper_bound(edges.begin(), edges.end(), phi) - edges.begin())] += 1.0;
  }
  return chiSquaredPValue(observed, std::vector<double>(cells, 1.0 / cells));
}

TEST(ChiSquared, TailAgreesWithTables)
{
  // Critical values of the chi-squared distribution (Abramowitz and Stegun, table 26.8).
  EXPECT_NEAR(chiSquaredTail(3.841459, 1.0), 0.05, 1e-7);
  EXPECT_NEAR(chiSquaredTail(18.30704, 10.0), 0.05, 1e-7);
  EXPECT_NEAR(chiSquaredTail(29.58830, 10.0), 0.001, 1e-8);
  EXPECT_NEAR(chiSquaredTail(15.37916, 30.0), 0.9875, 0.0026);
  EXPECT_NEAR(chiSquaredTail(2.0, 2.0), std::exp(-1.0), 1e-14);
  EXPECT_NEAR(chiSquaredTail(6.0, 4.0), 4.0 * std::exp(-3.0), 1e-14);
}

TEST(ChiSquared, AcceptsTheRightLawAndRejectsAWrongOne)
{
  const Truncated right{ 0.3, 0.5, 0.0, 1.5 };
  const auto draw = [](int i) { return independentSample(11, 0, 0, std::uint32_t(i), 0).polar; };
  EXPECT_GT(polarPValue(right, 200000, draw), 0.001);
  // The same samples against a mean that is off by six per cent of sigma.
  const Lobe lobe = lobeOf(right);
  const Truncated wrong{ 0.33, 0.5, 0.0, 1.5 };
  std::vector<double> observed(50, 0.0);
  std::vector<double> probability;
  for (int i = 0; i < 200000; ++i)
  {
    observed[std::size_t(samplePolar(lobe, draw(i)) / 0.03)] += 1.0;
  }
  for (int cell = 0; cell < 50; ++cell)
  {
    probability.push_back(wrong.between(0.03 * cell, 0.03 * (cell + 1)) / wrong.between(0.0, 1.5));
  }
  EXPECT_LT(chiSquaredPValue(observed, probability), 1e-6);
  // A count where none can be.
  EXPECT_EQ(chiSquaredPValue({ 50.0, 50.0, 1.0 }, { 0.5, 0.5, 0.0 }), 0.0);
}

TEST(LobePolar, IndependentSamplesFollowPsi)
{
  const auto cases = truncatedCases();
  for (std::size_t c = 0; c < cases.size(); ++c)
  {
    const auto draw = [&](int i) { return independentSample(7, std::uint32_t(c), 0, std::uint32_t(i), 3).polar; };
    EXPECT_GT(polarPValue(cases[c], 100000, draw), significanceOfEach(int(cases.size()))) << nameOf(cases[c]);
  }
}

TEST(LobePolar, LowDiscrepancySamplesFollowPsi)
{
  const auto cases = truncatedCases();
  for (std::size_t c = 0; c < cases.size(); ++c)
  {
    // Batches of an odd size, as a path count gives them.
    const auto draw = [&](int i) {
      return lowDiscrepancySample(makeBounceScramble(7, std::uint32_t(c), std::uint32_t(i / 125), 3),
                                  std::uint32_t(i % 125))
        .polar;
    };
    EXPECT_GT(polarPValue(cases[c], 50000, draw), significanceOfEach(int(cases.size()))) << nameOf(cases[c]);
  }
}

TEST(LobePolar, InvertsAtTheEndsOfTheUnitInterval)
{
  for (const Truncated& t : truncatedCases())
  {
    const Lobe lobe = lobeOf(t);
    // 1 - 2^-25 is 1 in single precision: both ends themselves must hold.
    for (const float u : { 0.0f, std::ldexp(1.0f, -25), std::ldexp(1.0f, -24), 1e-4f })
    {
      const float low = samplePolar(lobe, u);
      const float high = samplePolar(lobe, 1.0f - u);
      ASSERT_TRUE(std::isfinite(low) && std::isfinite(high)) << nameOf(t);
      ASSERT_GE(low, lobe.a) << nameOf(t);
      ASSERT_LE(high, lobe.b) << nameOf(t);
      // The rounding of the angle, at most 1.2e-7, times the density; and of the tail around one half, which the
      // interval's own share resolves.
      const double share = std::min(1.0, t.between(t.a, t.b) * std::max(1.0, t.sigma / 100.0));
      const double rounding = 1.2e-7 * std::max(polarDensity(lobe, low), polarDensity(lobe, high)) +
                              (lobe.alpha < farTail ? 6e-8 / share : 0.0);
      EXPECT_NEAR(t.cdf(low), u, 3e-6 + rounding) << nameOf(t) << " u " << u;
      EXPECT_NEAR(t.cdf(high), 1.0 - u, 3e-6 + rounding) << nameOf(t) << " 1 - u " << u;
    }
  }
}

TEST(LobePolar, NeverFallsAsTheRandomNumberRises)
{
  for (const Truncated& t : truncatedCases())
  {
    const Lobe lobe = lobeOf(t);
    float previous = lobe.a;
    for (int i = 0; i <= 4096; ++i)
    {
      const float phi = samplePolar(lobe, float(i) / 4096.0f);
      // Rounding in the rational fit may cost a unit in the last place or two.
      ASSERT_GE(phi, previous - 4e-7f * std::max(1.0f, std::abs(lobe.mu))) << nameOf(t) << " at " << i;
      previous = phi;
    }
  }
}

TEST(LobePolar, TailsBeyondDoublePrecisionDecayExponentially)
{
  // alpha = 60 and 500: erfc itself underflows. Beyond alpha the density is exp(-alpha s - s^2 / 2), s = x - alpha.
  for (const double alpha : { 60.0, 500.0 })
  {
    const double sigma = 1e-3;
    const Lobe lobe = makeLobe(0.5 - alpha * sigma, sigma, 0.5, 1.5);
    for (const double u : { 0.01, 0.25, 0.5, 0.9, 0.999 })
    {
      // Survival exp(-alpha s - s^2/2) M(alpha + s) / M(alpha), M the Mills ratio 1/x (1 - 1/x^2 + 3/x^4).
      const auto mills = [](double x) { return (1.0 - 1.0 / (x * x) + 3.0 / (x * x * x * x)) / x; };
      double s = 0.0;
      for (int i = 0; i < 50; ++i)
      {
        s = (-std::log(1.0 - u) + std::log(mills(alpha + s) / mills(alpha)) - 0.5 * s * s) / alpha;
      }
      // The angle itself has steps of 6e-8 here.
      EXPECT_NEAR(samplePolar(lobe, float(u)), 0.5 + s * sigma, 1.5e-7) << alpha << " " << u;
    }
    const double slope = polarDensity(lobe, 0.5f) * sigma / alpha;
    EXPECT_NEAR(slope, 1.0 + 1.0 / (alpha * alpha), 1e-4);
  }
}

TEST(LobePolar, WithoutSpreadIsTheMean)
{
  EXPECT_EQ(samplePolar(makeLobe(0.0, 0.0, 0.0, 1.5), 0.3f), 0.0f);
  EXPECT_EQ(samplePolar(makeLobe(0.4, 0.0, 0.0, 1.5), 0.9f), 0.4f);
  EXPECT_EQ(samplePolar(makeLobe(2.0, 0.0, 0.0, 1.5), 0.9f), 1.5f);
  EXPECT_EQ(polarDensity(makeLobe(0.0, 0.0, 0.0, 1.5), 0.0f), 0.0f);
  for (const double sigma : { 1e-7, 1e-6, 1e-5 })
  {
    EXPECT_NEAR(samplePolar(makeLobe(0.4, sigma, 0.0, 1.5), 0.9f), 0.4f, 6.0 * sigma + 1e-7);
  }
}

TEST(LobePolar, DensityIsPsiAndIntegratesToOne)
{
  for (const Truncated& t : truncatedCases())
  {
    const Lobe lobe = lobeOf(t);
    const double low = t.quantile(1e-7);
    const double high = t.quantile(1.0 - 1e-7);
    constexpr int steps = 4000;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i)
    {
      sum += polarDensity(lobe, float(low + (high - low) * (i + 0.5) / steps));
    }
    // sigma 1e-3 spans few thousand single-precision angles: their rounding is what remains.
    EXPECT_NEAR(sum * (high - low) / steps, 1.0, 1e-4) << nameOf(t);
    for (const double p : { 0.1, 0.5, 0.8 })
    {
      const double phi = float(t.quantile(p));
      const double h = 1e-4 * std::min(t.sigma, t.b - t.a);
      const double expected = t.between(phi - h, phi + h) / (2.0 * h * t.between(t.a, t.b));
      EXPECT_NEAR(polarDensity(lobe, float(phi)) / expected, 1.0, 1e-3) << nameOf(t);
    }
  }
}

TEST(LobeDirection, StandsAtItsAngleWithUniformAzimuth)
{
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  constexpr int cells = 32;
  constexpr int axes = 200;
  for (int n = 0; n < axes; ++n)
  {
    Vec3d axis = glm::normalize(Vec3d(normal(random), normal(random), normal(random)));
    if (n < 6)
    {
      axis = Vec3d(0.0);
      axis[n / 2] = n % 2 ? 1.0 : -1.0;
    }
    const Vec3d helper = std::abs(axis.x) < 0.7 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    const Vec3d s = glm::normalize(glm::cross(axis, helper));
    const Vec3d t = glm::cross(axis, s);
    const float phi = 0.001f + 1.5f * float(n) / axes;
    std::vector<double> azimuths;
    for (int i = 0; i < 20 * cells; ++i)
    {
      const Vec3d w(directionAround(Vec3f(axis), phi, (float(i) + 0.5f) / (20.0f * cells)));
      ASSERT_NEAR(glm::length(w), 1.0, 2e-7);
      ASSERT_NEAR(std::atan2(glm::length(glm::cross(axis, w)), glm::dot(axis, w)), phi, 5e-7);
      azimuths.push_back(std::atan2(glm::dot(w, t), glm::dot(w, s)));
    }
    // Equal steps of u are equal steps of azimuth around any reference.
    std::sort(azimuths.begin(), azimuths.end());
    const double step = 2.0 * M_PI / double(azimuths.size());
    for (std::size_t i = 1; i < azimuths.size(); ++i)
    {
      ASSERT_NEAR(azimuths[i] - azimuths[i - 1], step, 2e-6 / phi);
    }
  }
}

} // namespace
