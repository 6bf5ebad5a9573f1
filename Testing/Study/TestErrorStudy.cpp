#include "BenchImage.h"
#include "Core/Progress.h"
#include "EchoSkips.h"
#include "ErrorCurves.h"
#include "HardScenes.h"
#include "PhantomImaging.h"
#include "RegionSwitches.h"
#include "RelativeRms.h"
#include "SamplingName.h"
#include "StabilityStudy.h"
#include "Trace/RecordPaths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

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

TEST(ErrorStudy, TheStackLeavesNothingToChance)
{
  // All paths are transmitted: one is as good as many.
  const BenchScene stack = makeBenchScene("stack");
  EXPECT_LT(errorAgainstExact(stack, 1), 1e-5);
  EXPECT_LT(errorAgainstExact(stack, 4000), 1e-5);
  // The energy that enters is the energy of the first bins.
  EXPECT_NEAR(stackLine(stack.tracing).intensity.front(), 1.0, 0.05);
}

TEST(ErrorStudy, TheExactStackIsImagedAsTheTracedOne)
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
  EXPECT_NEAR(convergenceSlope(curve, 0.0).value, -0.5, 1e-9);
  EXPECT_NEAR(convergenceSlope(curve, 0.0).error, 0.0, 1e-6);
  // 0.5 / sqrt(n) = 0.01 at n = 2500.
  EXPECT_NEAR(secondsToReach(curve, 0.01), 2.5, 1e-9);
  EXPECT_NEAR(secondsToReach(curve, 0.9), 1e-3, 1e-12);
  EXPECT_TRUE(std::isinf(secondsToReach(curve, 1e-4)));
  // A floor of the reference bends the curve where it counts no more.
  curve.back().error = 1e-3;
  EXPECT_NEAR(convergenceSlope(curve, 5e-4).value, -0.5, 1e-9);
}

TEST(ErrorStudy, ASlopesErrorIsItsScatterOverManyCurves)
{
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 0.2);
  constexpr int curves = 2000;
  double variance = 0.0;
  double said = 0.0;
  for (int c = 0; c < curves; ++c)
  {
    std::vector<ErrorPoint> curve;
    for (double paths = 100.0; paths <= 1e6; paths *= 10.0)
    {
      curve.push_back({ paths, 1.0, std::exp(normal(random)) / std::sqrt(paths) });
    }
    const Slope slope = convergenceSlope(curve, 0.0);
    variance += std::pow(slope.value + 0.5, 2) / curves;
    said += slope.error * slope.error / curves;
  }
  EXPECT_NEAR(said / variance, 1.0, 0.1);
}

TEST(ErrorStudy, WithoutNoiseADifferenceIsWhatItIsOnAverage)
{
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 1.0);
  constexpr int count = 200000;
  std::vector<BenchImage> images(4);
  for (std::size_t which = 0; which < images.size(); ++which)
  {
    // Of amplitude 10 in phase, 11 in the two images that are judged; as much noise again as they differ.
    const double amplitude = which < 2 ? 11.0 : 10.0;
    BenchImage& image = images[which];
    image.lineCount = 1;
    image.binCount = count;
    image.binMm = 1.0;
    for (int i = 0; i < count; ++i)
    {
      image.intensity.push_back(amplitude + normal(random));
      image.iq.push_back(amplitude + 0.1 * normal(random));
    }
  }
  EXPECT_GT(imageError(images[0], images[2]).intensity, 0.15);
  const ImageError error = errorWithoutNoise({ images[0], images[1] }, { images[2], images[3] });
  EXPECT_NEAR(error.intensity, 0.1, 2e-3);
  EXPECT_NEAR(error.rf, 0.1, 2e-3);
  EXPECT_NEAR(error.decibels, 20.0 * std::log10(1.1), 2e-3);
}

TEST(ErrorStudy, AReferenceIsAsFarOffAsItSays)
{
  const BenchScene rib = makeBenchScene("rib", 2.0, 4);
  const BenchReference many = makeReference(rib, 240000);
  // The ratio of one reference, whose error a few rare paths decide, is off by 0.3 itself.
  double intensity = 0.0;
  double rf = 0.0;
  for (const int paths : { 3000, 4000, 6000, 8000 })
  {
    const BenchReference few = makeReference(rib, paths);
    intensity += 0.25 * intensityError(few.image, many.image) / few.floor.intensity;
    rf += 0.25 * imageError(few.image, many.image).rf / few.floor.rf;
    EXPECT_LT(many.floor.intensity, 0.5 * few.floor.intensity);
  }
  EXPECT_NEAR(intensity, 1.0, 0.5);
  EXPECT_NEAR(rf, 1.0, 0.5);
}

TEST(ErrorStudy, AReferencesOwnErrorIsTakenOut)
{
  BenchReference reference;
  reference.image.lineCount = 1;
  reference.image.binMm = 1.0;
  reference.image.intensity = { 1.0, 2.0 };
  reference.image.binCount = 2;
  reference.image.iq = { 1.0, { 0.0, 1.0 } };
  reference.floor = { 0.03, 0.06, 0.0 };
  BenchImage image = reference.image;
  for (double& v : image.intensity)
  {
    v *= 1.05;
  }
  for (std::complex<double>& v : image.iq)
  {
    v *= 1.05;
  }
  const ImageError error = errorAgainst(reference, image);
  EXPECT_NEAR(error.intensity, 0.04, 1e-12); // 3, 4, 5
  EXPECT_EQ(error.rf, 0.0);
  EXPECT_NEAR(error.decibels, 20.0 * std::log10(1.05), 1e-12);
}

TEST(StabilityStudy, SinglePrecisionIsFarBelowTheNoise)
{
  for (const std::string name : { "stack", "rib", "phantom" })
  {
    const BenchScene bench = makeBenchScene(name, name == "stack" ? 1.0 : 2.0, 4);
    for (const InterfaceModel model : { InterfaceModel::Acoustic, InterfaceModel::Amadou2024 })
    {
      for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy })
      {
        const std::string with = name + " " + test::nameOf(sampling) + " " + std::to_string(int(model));
        TraceSettings tracing = bench.tracing;
        tracing.model = model;
        tracing.sampling = sampling;
        tracing.pathsPerLine = 100;
        const Difference d = singleAgainstDouble(bench, tracing);
        EXPECT_TRUE(d.finite) << with;
        // Boundaries leave little to chance in Acoustic, but for the rib's rough edge, of which paths of low
        // discrepancy leave little, too: there its own digits are what counts.
        const bool noisy = (name == "rib" && sampling == Sampling::Independent) || model == InterfaceModel::Amadou2024;
        EXPECT_EQ(d.noise > 1e-4, noisy) << with;
        EXPECT_LT(d.of.intensity, noisy ? 0.02 * d.noise : 1e-6) << with;
        EXPECT_LT(d.of.rf, 1e-3) << with;
        EXPECT_LT(d.of.decibels, 0.01) << with;
        EXPECT_GT(d.of.intensity, 0.0) << with; // two precisions indeed
        EXPECT_GT(d.of.rf, 0.0) << with;
      }
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

TEST(StabilityStudy, GrazingLinesMeetTheVoxelFaceItself)
{
  const auto grazing = std::find_if(hardScenes().begin(), hardScenes().end(),
                                    [](const HardScene& hard) { return hard.hazard == "grazing incidence"; });
  ASSERT_NE(grazing, hardScenes().end());
  const BenchScene bench = grazing->make();
  int faster = 0;
  int slower = 0;
  for (const RecordedPath& path : recordPaths(*bench.scene, bench.lines, bench.tracing, int(bench.lines.size())))
  {
    ASSERT_FALSE(path.hits.empty());
    const BoundaryHit& hit = path.hits.front();
    EXPECT_GT(hit.incidenceCosine, 0.0f);
    // A smoothed surface would have given 0.01 or more, as it does where it turns: where the wall's two parts meet.
    if (std::fabs(hit.depthMm - 28.0f) > 7.0f)
    {
      EXPECT_LT(hit.incidenceCosine, 0.0025f);
      const std::vector<Tissue>& tissues = bench.scene->tissues();
      const bool slow = tissues[std::size_t(hit.to)].soundSpeedMPerS < tissues[std::size_t(hit.from)].soundSpeedMPerS;
      (slow ? slower : faster) += 1;
    }
  }
  EXPECT_GE(slower, 3);
  EXPECT_GE(faster, 3);
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
  tracing.model = InterfaceModel::Amadou2024; // whose cells formRfBySkipping() walks
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
