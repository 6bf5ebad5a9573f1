#include "LayerStack.h"

#include <gtest/gtest.h>

// The reference that reverberation is judged by, held against itself computed another way.

namespace {

using namespace sono;
using namespace sono::test;

std::complex<double> sumOfArrivals(const std::vector<Arrival>& arrivals, double frequencyMHz)
{
  std::complex<double> sum = 0.0;
  for (const Arrival& a : arrivals)
  {
    sum += std::polar(a.at(frequencyMHz), -4.0 * M_PI * frequencyMHz * a.rangeMm / assumedSoundSpeedMmPerUs);
  }
  return sum;
}

LayerStack withFace(LayerStack stack, double faceReflection)
{
  stack.faceReflection = faceReflection;
  return stack;
}

TEST(LayerStack, ArrivalsAddUpToTheRecursion)
{
  const LayerStack thin{
    { { 1.6, 1540.0, 0.2, 3.0 }, { 6.0, 3000.0, 2.0, 4.0 }, { 1.4, 1450.0, 0.5, 5.0 }, { 0.2, 600.0, 0.0, 0.0 } }
  };
  for (const LayerStack& stack : { namedStack(), withFace(namedStack(), 0.5), thin, withFace(thin, -0.4) })
  {
    const auto arrivals = everyArrival(stack, 1.0, 1e-10, 1e9);
    for (double f = 1.0; f < 3.0; f += 0.0137)
    {
      EXPECT_NEAR(std::abs(sumOfArrivals(arrivals, f) - stackResponse(stack, f).heard), 0.0, 1e-6) << f;
    }
  }
}

TEST(LayerStack, ALayerRingsAsItsGeometricSeries)
{
  const LayerStack stack{ { { 1.5, 1500.0, 0.4, 20.0 }, { 3.0, 1600.0, 0.7, 5.0 }, { 1.2, 1500.0, 0.0, 0.0 } } };
  const double first = stack.reflection(0);
  const double second = stack.reflection(1);
  const auto arrivals = stackArrivals(stack, 1.0, 1e-5, 100.0);
  ASSERT_GE(arrivals.size(), 5u);
  EXPECT_DOUBLE_EQ(arrivals[0].amplitude, first);
  for (std::size_t n = 1; n < arrivals.size(); ++n)
  {
    EXPECT_NEAR(arrivals[n].rangeMm, 20.0 * 1540.0 / 1500.0 + double(n) * 5.0 * 1540.0 / 1600.0, 1e-12);
    EXPECT_NEAR(arrivals[n].amplitude, (1.0 - first * first) * second * std::pow(-first * second, n - 1.0), 1e-15);
    EXPECT_NEAR(arrivals[n].exponentNpPerMHz, 2.0 * (0.4 * 2.0 + 0.7 * 0.5 * double(n)) / 8.685889638, 1e-9);
    EXPECT_EQ(arrivals[n].primary, n == 1);
  }
}

TEST(LayerStack, FaceAndPlateMakeEquidistantLines)
{
  const LayerStack stack{ { { 1.6, 1450.0, 0.0, 30.0 }, { 0.2, 600.0, 0.0, 0.0 } }, 0.5 };
  const double r = stack.reflection(0);
  const auto arrivals = stackArrivals(stack, 1.0, 1e-3, 1e9);
  ASSERT_GE(arrivals.size(), 4u);
  for (std::size_t n = 0; n < arrivals.size(); ++n)
  {
    EXPECT_NEAR(arrivals[n].rangeMm, double(n + 1) * 30.0 * 1540.0 / 1450.0, 1e-9);
    EXPECT_NEAR(arrivals[n].amplitude, std::pow(r, n + 1.0) * std::pow(0.5, double(n)), 1e-15);
  }
}

/// Of a layer half and a quarter of a wavelength thick, textbooks say what is left.
TEST(LayerStack, HidesHalfAWavelengthAndMatchesAQuarter)
{
  const auto heard = [](double impedance, double wavelengths) {
    const LayerStack stack{
      { { 1.5, 1500.0, 0.0, 0.0 }, { impedance, 2000.0, 0.0, wavelengths * 2.0 }, { 6.0, 3000.0, 0.0, 0.0 } }
    };
    return std::abs(stackResponse(stack, 1.0).heard);
  };
  EXPECT_NEAR(heard(2.7, 0.5), (6.0 - 1.5) / (6.0 + 1.5), 1e-12);
  EXPECT_NEAR(heard(3.0, 0.25), 0.0, 1e-12);
  EXPECT_NEAR(heard(2.0, 0.25), (6.0 * 1.5 - 4.0) / (6.0 * 1.5 + 4.0), 1e-12);
}

TEST(LayerStack, KeepsTheEnergyWhereNothingIsAbsorbed)
{
  LayerStack stack = namedStack();
  for (StackLayer& layer : stack.layers)
  {
    layer.attenuationDbPerCmMHz = 0.0;
  }
  const double admittance = stack.layers.front().impedanceMRayl / stack.layers.back().impedanceMRayl;
  for (double f = 0.5; f < 5.0; f += 0.0137)
  {
    const StackResponse response = stackResponse(stack, f);
    EXPECT_NEAR(std::norm(response.heard) + admittance * std::norm(response.behind), 1.0, 1e-12) << f;
  }
}

TEST(LayerStack, HasTheTableOfThePhysicsPage)
{
  const auto arrivals = stackArrivals(namedStack(), 2.5, 1e-3, 1e9);
  const double expected[][2] = {
    { 20.811, -21.59 }, { 32.011, -22.46 }, { 51.128, -24.17 }, { 62.328, -56.08 }, { 70.245, -54.64 }
  };
  ASSERT_EQ(arrivals.size(), std::size(expected));
  for (std::size_t n = 0; n < arrivals.size(); ++n)
  {
    EXPECT_NEAR(arrivals[n].rangeMm, expected[n][0], 0.0006);
    EXPECT_NEAR(20.0 * std::log10(std::abs(arrivals[n].at(2.5))), expected[n][1], 0.006);
  }
  EXPECT_EQ(arrivals[3].routes, 2);
}

} // namespace
