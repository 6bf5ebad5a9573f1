#include "BenchImage.h"
#include "EchoSkips.h"
#include "ErrorCurves.h"
#include "HardScenes.h"
#include "PhantomImaging.h"
#include "Progress.h"
#include "RegionSwitches.h"
#include "RelativeRms.h"
#include "SamplingName.h"
#include "StabilityStudy.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace sono;
using namespace sono::study;

double errorAgainstExact(const BenchScene& stack, int paths)
{
  TraceSettings tracing = stack.tracing;
  tracing.sampling = Sampling::Independent;
  tracing.pathsPerLine = paths;
  return intensityError(makeBenchImage(stack, tracing, Precision::Single), exactStackImage(stack));
}

TEST(ErrorStudy, TheStackConvergesToItsFiniteSum)
{
  const BenchScene stack = makeBenchScene("stack");
  const double many = errorAgainstExact(stack, 40000);
  // A hundred times as many paths: a tenth of the error.
  EXPECT_NEAR(errorAgainstExact(stack, 400) / many, 10.0, 4.0);
  EXPECT_LT(many, 1e-3);
  // The energy that enters is the energy of the first bins.
  EXPECT_NEAR(stackLine(stack.tracing).intensity.front(), 1.0, 0.05);
}

TEST(ErrorStudy, TheExactStackHasTheEchoesOfTheTracedOne)
{
  const BenchScene stack = makeBenchScene("stack", 0.0, 2);
  TraceSettings tracing = stack.tracing;
  tracing.pathsPerLine = 20000;
  for (const Precision precision : { Precision::Single, Precision::Double })
  {
    const ImageError error = imageError(makeBenchImage(stack, tracing, precision), exactStackImage(stack));
    EXPECT_LT(error.rf, 2e-3);
    EXPECT_LT(error.decibels, 0.05);
  }
}

TEST(ErrorStudy, CoarseBinsAreComparedOnTheFineOnes)
{
  BenchImage fine;
  fine.lineCount = 1;
  fine.binMm = 0.5;
  fine.intensity = { 1.0, 3.0, 2.0, 2.0 };
  fine.binCount = 4;
  BenchImage coarse = fine;
  coarse.binMm = 1.0;
  coarse.intensity = { 2.0, 2.0 };
  coarse.binCount = 2;
  EXPECT_NEAR(intensityError(coarse, fine), std::sqrt(2.0 / 18.0), 1e-12);
  EXPECT_EQ(intensityError(fine, fine), 0.0);
}

TEST(ErrorStudy, ASlopeAndTheTimeToAnErrorFollowAPowerLaw)
{
  std::vector<ErrorPoint> curve;
  for (double paths = 1.0; paths <= 1e6; paths *= 10.0)
  {
    curve.push_back({ paths, 1e-3 * paths, 0.5 / std::sqrt(paths) });
  }
  EXPECT_NEAR(convergenceSlope(curve, 0.0), -0.5, 1e-9);
  // 0.5 / sqrt(n) = 0.01 at n = 2500.
  EXPECT_NEAR(secondsToReach(curve, 0.01), 2.5, 1e-9);
  EXPECT_NEAR(secondsToReach(curve, 0.9), 1e-3, 1e-12);
  EXPECT_TRUE(std::isinf(secondsToReach(curve, 1e-4)));
  // A floor of the reference bends the curve where it counts no more.
  curve.back().error = 1e-3;
  EXPECT_NEAR(convergenceSlope(curve, 5e-4), -0.5, 1e-9);
}

TEST(ErrorStudy, AReferenceIsAsFarOffAsItSays)
{
  const BenchScene rib = makeBenchScene("rib", 2.0, 4);
  const BenchReference few = makeReference(rib, 4000);
  const BenchReference many = makeReference(rib, 60000);
  EXPECT_NEAR(intensityError(few.image, many.image) / few.floor.intensity, 1.0, 0.5);
  EXPECT_NEAR(imageError(few.image, many.image).rf / few.floor.rf, 1.0, 0.5);
  EXPECT_LT(many.floor.intensity, 0.5 * few.floor.intensity);
}

TEST(StabilityStudy, SinglePrecisionIsFarBelowTheNoise)
{
  for (const std::string name : { "stack", "rib", "phantom" })
  {
    const BenchScene bench = makeBenchScene(name, name == "stack" ? 1.0 : 2.0, 4);
    for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy, Sampling::SharedPaths })
    {
      TraceSettings tracing = bench.tracing;
      tracing.sampling = sampling;
      tracing.pathsPerLine = 100;
      const Difference d = singleAgainstDouble(bench, tracing);
      EXPECT_TRUE(d.finite) << name;
      EXPECT_GT(d.noise, 1e-4) << name;
      EXPECT_LT(d.of.intensity, 0.02 * d.noise) << name << " " << test::nameOf(sampling);
      EXPECT_LT(d.of.rf, 1e-3) << name << " " << test::nameOf(sampling);
      EXPECT_LT(d.of.decibels, 0.01) << name << " " << test::nameOf(sampling);
      EXPECT_GT(d.of.intensity, 0.0) << name; // two precisions indeed
      EXPECT_GT(d.of.rf, 0.0) << name;
    }
  }
}

TEST(StabilityStudy, EveryHazardEndsInAnImageOrASentence)
{
  int refused = 0;
  for (const HardScene& hard : hardScenes())
  {
    if (hard.hazard == "none")
    {
      continue;
    }
    try
    {
      const BenchScene bench = hard.make();
      TraceSettings tracing = bench.tracing;
      tracing.pathsPerLine = std::min(tracing.pathsPerLine, 20);
      const Difference d = singleAgainstDouble(bench, tracing);
      EXPECT_TRUE(d.finite) << hard.name;
      // What a rounded number decides otherwise at a hit takes that path elsewhere, one of twenty.
      EXPECT_LT(d.of.intensity, 0.05) << hard.hazard << ", " << hard.name;
    }
    catch (const Error& error)
    {
      ++refused;
      EXPECT_GT(std::string(error.what()).size(), 20u) << hard.name;
    }
  }
  EXPECT_EQ(refused, 5); // no impedance, no speed, NaN, no voxels, no depth
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

TEST(EchoSkips, WithoutSkipsTheImageIsTheSame)
{
  BenchScene bench = makeBenchScene("cyst", 2.0, 10);
  TraceSettings tracing = bench.tracing;
  tracing.pathsPerLine = 20;
  tracing.device = Device::Cpu;
  const TracedLines traced = trace(*bench.scene, bench.lines, tracing);
  bench.echo.device = Device::Cpu;
  for (const bool computed : { false, true })
  {
    if (computed)
    {
      bench.echo.field = phantomImaging(128).echo.field;
    }
    const RfLines usual = formRf(*bench.scene, bench.lines, traced, bench.echo);
    EXPECT_EQ(test::relativeRms(formRfBySkipping(bench, traced, {}).iq, usual.iq), 0.0);
    for (const auto skip :
         { &EchoSkips::unseenBricks, &EchoSkips::madeTwice, &EchoSkips::absent, &EchoSkips::dark, &EchoSkips::faint })
    {
      EchoSkips without;
      without.*skip = false;
      if (computed && skip == &EchoSkips::unseenBricks)
      {
        continue; // sees the faint parts, too
      }
      // The order of the sums changes, and the faintest parts of a field are let go.
      EXPECT_LT(test::relativeRms(formRfBySkipping(bench, traced, without).iq, usual.iq),
                computed && skip == &EchoSkips::faint ? 1e-3 : 2e-5);
    }
  }
}

} // namespace
