#include "BenchScenes.h"
#include "ImageError.h"
#include "RegionSwitches.h"
#include "StabilityStudy.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace sono;
using namespace sono::study;

double rmsDistance(const std::vector<float>& is, const std::vector<double>& should)
{
  double error = 0.0;
  double power = 0.0;
  for (std::size_t i = 0; i < is.size(); ++i)
  {
    error += std::pow(is[i] - should[i % should.size()], 2);
    power += std::pow(should[i % should.size()], 2);
  }
  return std::sqrt(error / power);
}

TEST(ErrorStudy, TheStackConvergesToItsFiniteSum)
{
  const BenchScene bench = makeBenchScene("stack");
  const std::vector<double> exact = stackIntensity(bench.tracing);
  TraceSettings tracing = bench.tracing;
  tracing.sampling = Sampling::Independent;
  tracing.pathsPerLine = 400;
  const double few = rmsDistance(trace(*bench.scene, bench.lines, tracing).intensity, exact);
  tracing.pathsPerLine = 40000;
  const double many = rmsDistance(trace(*bench.scene, bench.lines, tracing).intensity, exact);
  // A hundred times as many paths: a tenth of the error.
  EXPECT_NEAR(few / many, 10.0, 4.0);
  EXPECT_LT(many, 1e-3);
  // The energy that enters is the energy of the first bins.
  EXPECT_NEAR(exact.front(), 1.0, 0.05);
}

TEST(ErrorStudy, CoarseBinsAreComparedOnTheFineOnes)
{
  TracedLines fine;
  fine.lineCount = 1;
  fine.binMm = 0.5;
  fine.intensity = { 1.0f, 3.0f, 2.0f, 2.0f };
  fine.binCount = 4;
  TracedLines coarse = fine;
  coarse.binMm = 1.0;
  coarse.intensity = { 2.0f, 2.0f };
  coarse.binCount = 2;
  EXPECT_NEAR(intensityError(coarse, fine), std::sqrt(2.0 / 18.0), 1e-12);
  EXPECT_EQ(intensityError(fine, fine), 0.0);
}

TEST(StabilityStudy, SinglePrecisionIsFarBelowTheNoise)
{
  for (const std::string name : { "stack", "rib" })
  {
    const BenchScene bench = makeBenchScene(name, name == "rib" ? 2.0 : 1.0);
    TraceSettings tracing = bench.tracing;
    tracing.pathsPerLine = 100;
    const Difference d = singleAgainstDouble(bench, tracing);
    EXPECT_TRUE(d.finite) << name;
    EXPECT_GT(d.noise, 1e-3) << name;
    EXPECT_LT(d.rms, 0.02 * d.noise) << name;
    EXPECT_GT(d.rms, 0.0) << name; // two precisions indeed
  }
}

TEST(RegionSwitches, WithoutSkipsTheImageIsTheSame)
{
  const BenchScene bench = makeBenchScene("cyst", 2.0);
  const BenchScene slow = makeBenchScene("cyst", 2.0);
  removeSkips(slow);
  TraceSettings tracing = bench.tracing;
  tracing.pathsPerLine = 50;
  const TracedLines one = trace(*bench.scene, bench.lines, tracing);
  const TracedLines two = trace(*slow.scene, slow.lines, tracing);
  double worst = 0.0;
  for (std::size_t i = 0; i < one.intensity.size(); ++i)
  {
    worst = std::max(worst, std::fabs(double(one.intensity[i]) - two.intensity[i]));
  }
  EXPECT_LT(worst, 1e-4);
  removeSurfaces(slow);
  EXPECT_NE(trace(*slow.scene, slow.lines, tracing).intensity, two.intensity);
}

} // namespace
