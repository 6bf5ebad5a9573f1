#include "Detectability.h"
#include "EchoScenes.h"
#include "PhantomBeam.h"
#include "PhantomLesions.h"
#include "PhantomWires.h"
#include "WireEcho.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace sono;
using namespace sono::study;

/// Rayleigh envelopes whose power has the mean `power` over `looks` independent pictures.
std::vector<float> speckleOf(double power, int looks, unsigned seed, int count = 200000)
{
  std::mt19937 random(seed);
  std::gamma_distribution<double> gamma(looks, power / looks);
  std::vector<float> values;
  for (int i = 0; i < count; ++i)
  {
    values.push_back(float(std::sqrt(gamma(random))));
  }
  return values;
}

TEST(Detectability, GcnrOfSpeckleIsTheClosedFormAndWhatSamplesShow)
{
  for (const double db : { 3.0, 6.0, 9.0, 15.0 })
  {
    const double r = std::pow(10.0, db / 10.0);
    EXPECT_NEAR(gcnrOfSpeckle(db), std::pow(r, -1.0 / (r - 1.0)) - std::pow(r, -r / (r - 1.0)), 1e-12);
    EXPECT_EQ(gcnrOfSpeckle(db), gcnrOfSpeckle(-db));
    for (const int looks : { 1, 3 })
    {
      const auto inside = speckleOf(r, looks, 1);
      const auto outside = speckleOf(1.0, looks, 2);
      EXPECT_NEAR(gcnrByThreshold(inside, outside), gcnrOfSpeckle(db, looks), 0.005) << db << " dB, " << looks;
      EXPECT_NEAR(gcnrByHistogram(inside, outside, 100), gcnrOfSpeckle(db, looks), 0.01) << db << " dB, " << looks;
    }
  }
  EXPECT_EQ(gcnrOfSpeckle(0.0), 0.0);
  EXPECT_NEAR(gcnrOfSpeckle(6.0), 0.471, 0.0005); // Data/docs/physics.md section 9
}

TEST(Detectability, OfFewPixelsTheHistogramIsBiasedAndTheThresholdHardly)
{
  const auto a = speckleOf(1.0, 1, 3, 300);
  const auto b = speckleOf(1.0, 1, 4, 300);
  EXPECT_LT(gcnrByThreshold(a, b), 0.12);
  EXPECT_GT(gcnrByHistogram(a, b, 256), 0.3);
}

TEST(Detectability, ContrastAndCnrAreThoseOfRayleigh)
{
  const auto inside = speckleOf(4.0, 1, 5);
  const auto outside = speckleOf(1.0, 1, 6);
  const Detectability d = detectability(inside, outside, inside, outside);
  EXPECT_NEAR(d.contrastDb, 6.02, 0.05);
  EXPECT_NEAR(d.cnr, 1.9131 / std::sqrt(5.0), 0.01); // mean over deviation of one is 1.9131
  EXPECT_EQ(d.gcnr, d.gcnrShown);
}

TEST(Detectability, LeastErrorIsWhatASearchFinds)
{
  EXPECT_NEAR(leastGcnrError({ { gcnrOfSpeckle(8.0), -8.0 } }, 1.5), 0.0, 1e-3);
  const std::vector<MeasuredLesion> lesions{ { 0.19, 4.72 }, { 0.71, -19.41 } };
  double found = 1.0;
  for (double a = 0.0; a < 25.0; a += 0.05)
  {
    for (double b = 0.0; b < 25.0; b += 0.05)
    {
      if (0.5 * (std::fabs(a - 4.72) + std::fabs(b - 19.41)) <= 1.5)
      {
        found = std::min(found, 0.5 * (std::fabs(gcnrOfSpeckle(a) - 0.19) + std::fabs(gcnrOfSpeckle(b) - 0.71)));
      }
    }
  }
  EXPECT_NEAR(leastGcnrError(lesions, 1.5), found, 2e-3); // the search's step
}

TEST(WireEcho, OfAThinCylinderIsTheLongWaveFormula)
{
  const double rho = 1.14 / 1.04;
  const double speed = 2600.0 / 1540.0;
  const double kappa = 1.0 / (rho * speed * speed);
  for (const double ka : { 0.01, 0.05 })
  {
    const double longWave = 0.25 * M_PI * ka * ka * std::fabs(1.0 - kappa + 2.0 * (rho - 1.0) / (rho + 1.0));
    EXPECT_NEAR(cylinderBackscatter(ka, rho * speed, speed) / longWave, 1.0, 20.0 * ka * ka);
  }
  EXPECT_NEAR(cylinderBackscatter(0.5, 1.0, 1.0), 0.0, 1e-12); // the same medium
}

TEST(WireEcho, StandsSomeThirtyDecibelsAboveTheGel)
{
  const PhantomImaging imaging = phantomImaging(64);
  // A wire is a line: its echo is the integral of the beam's weight along it, which is some millimetres wide.
  const double wireDb = 20.0 * std::log10(wireEchoPerMm(imaging.echo, 0.1) * 3.0);
  const double gelDb = imaging.echo.scattererLevelDb + 20.0 * std::log10(0.15);
  EXPECT_GT(wireDb - gelDb, 20.0);
  EXPECT_LT(wireDb - gelDb, 40.0);
  EXPECT_LT(gelDb, -50.0);                                    // soft tissue against a mirror
  EXPECT_NEAR(wireEchoPerMm(imaging.echo, 0.1), 0.013, 5e-4); // the default of ParaView's source
}

TEST(PhantomStudy, AttenuationFallsAsTheMediumSays)
{
  EXPECT_NEAR(intensitySlopeDbPerCm(), 3.6, 1e-3);
  EXPECT_NEAR(speckleSlopeDbPerCm(32, 1), 3.6, 0.1); // as far as 32 lines of speckle tell
}

TEST(PhantomStudy, EchoWidthIsThatOfPulseAndAperture)
{
  EXPECT_NEAR(pulseWidthMm(3.6, 0.6), 0.3140, 1e-4); // Data/docs/physics.md section 4, to its last digit
  const PhantomImaging imaging = phantomImaging(64);
  const EchoWidth width = wireEchoWidth(imaging, 50.0);
  EXPECT_NEAR(width.axialMm, pulseWidthMm(3.6, imaging.echo.fractionalBandwidth), 0.003);
  // 0.886 lambda F# for one frequency in the image plane; the band and the wire's length widen it by a tenth.
  EXPECT_NEAR(width.lateralMm, 0.886 * 1.54 / 3.6 * 50.0 / 20.455, 0.15);
}

TEST(PhantomStudy, AWireIsLocatedBetweenPixels)
{
  PlaneImage image;
  image.width = 201;
  image.height = 401;
  image.pixelMm = 0.23;
  image.lateralMinMm = -23.0;
  for (int j = 0; j < image.height; ++j)
  {
    for (int i = 0; i < image.width; ++i)
    {
      const double x = (image.lateralMinMm + i * image.pixelMm - 10.07) / 0.8;
      const double z = (j * image.pixelMm - 45.0) / 0.13;
      image.value.push_back(float(-4.34 * (x * x + z * z)));
    }
  }
  const WirePlace place = locateWire(image, { PhantomTargetKind::Wire, 1, "near", 10.0, 45.0, 0.1, "phantom_nylon" });
  EXPECT_TRUE(place.found);
  EXPECT_NEAR(place.fittedMm, 10.07, 0.01);
  EXPECT_NEAR(place.pixelMm, 10.07, 0.12);
}

TEST(PhantomStudy, WiresAreWhereTheTableHasThem)
{
  const PhantomBench bench(WireModel::Surface, 2.0);
  // As the study does. At 14 cm wires stand 10 to 12 dB above the gel, near the 10 dB that count as found.
  const PhantomImaging imaging = imagingOf(WireModel::Surface, 256);
  const WireErrors errors = measureWires(bench, imaging, 1);
  const Spread all = errors.spread(0, "", true);
  EXPECT_EQ(all.count, int(errors.wires.size()));
  EXPECT_LE(all.mean, 0.05);
  EXPECT_LE(all.deviation, 0.05);
}

TEST(PhantomStudy, ALesionHasItsContrast)
{
  const std::vector<PhantomTarget> lesion{ { PhantomTargetKind::Cylinder, 2, "p6", -14.0, 45.0, 10.0, "phantom_p6" } };
  const PhantomBench bench(lesion, WireModel::Scatterers, 0.5);
  PhantomImaging imaging = phantomImaging(128);
  imaging.geometry.depthMm = imaging.tracing.depthMm = imaging.echo.depthMm = 60.0;
  double contrast = 0.0;
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    contrast +=
      0.25 * lesionDetectability(imaging, bench.image(imaging, 2, seed).envelope(), lesion.front()).contrastDb;
  }
  EXPECT_NEAR(contrast, 6.0, 1.0);
}

} // namespace
