#include "BeamScenes.h"
#include "Echo/ComputedBeam.h"
#include "Image/Haze.h"
#include "Probe/BeamAperture.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace sono;

namespace {

constexpr double pi = 3.14159265358979323846;

double sinc(double x)
{
  return x == 0.0 ? 1.0 : std::sin(pi * x) / (pi * x);
}

/// W^2 of (12.2).
double radius2(double apertureMm, double focusMm, double wavelengthMm, double z)
{
  const double waist = apertureMm / (0.376 * 2.0 * pi);
  const double spread = wavelengthMm * z / (pi * waist);
  return waist * waist * (1.0 - z / focusMm) * (1.0 - z / focusMm) + spread * spread;
}

TEST(HarmonicBeam, IsTheSquareOfWhatIsSentAndHeardAtTwiceTheFrequency)
{
  const BeamAperture aperture = test::p42().aperture();
  const double sentMHz = 1.8;
  const double longMm = 1.54 / sentMHz;
  const double shortMm = 0.5 * longMm;
  const ApertureProfile profile = apertureProfile(aperture, 2.0 * sentMHz, ImagingMode::Harmonic);
  for (const double z : { 15.0, 30.0, 50.0, 65.0, 90.0, 140.0 })
  {
    const ProfileAt at = profileAt(profile, float(z));
    // Of the square of a Gaussian W, W / sqrt(2); as deviations, 1 / s^2 = 2 / W^2.
    const double sent = 4.0 / radius2(aperture.apertureMm, aperture.transmitFocusMm, longMm, z);
    const double heardMm = 0.376 * std::sqrt(2.0) * shortMm * std::max(1.0, z / aperture.apertureMm);
    EXPECT_NEAR(at.perLateral2 / (sent + 1.0 / (heardMm * heardMm)), 1.0, 1e-4) << z;
    const double lens = 4.0 / radius2(aperture.elevationApertureMm, aperture.elevationFocusMm, longMm, z) +
                        2.0 / radius2(aperture.elevationApertureMm, aperture.elevationFocusMm, shortMm, z);
    const double width = std::sqrt(lens / at.perElevational2); // against what is right
    EXPECT_GT(width, 0.94) << z;
    EXPECT_LT(width, 1.001) << z;
  }
  EXPECT_NEAR(profileAt(profile, 65.0f).amplitude, 1.0f, 1e-5f);
}

TEST(HarmonicBeam, OfElementsHasTheirProfileAtTheFocus)
{
  EchoSettings s = test::echoOf(test::p42(), 100.0);
  s.imagingMode = ImagingMode::Harmonic;
  s.centreFrequencyMHz = 3.6;
  s.fractionalBandwidth = 0.3;
  const ArrayField field(elementsOf(s), 100.0);
  const double perMm = s.aperture.apertureMm * field.frequencyMHz() / (1.54 * 65.0); // of D x / (lambda z)
  const double atAxis = std::abs(field.lateralAt(0.0, 65.0));
  for (const double x : { 0.3, 0.6, 0.9, 1.2, 1.8, 2.4 })
  {
    const double expected = std::abs(std::pow(sinc(0.5 * perMm * x), 2.0) * sinc(perMm * x));
    EXPECT_NEAR(std::abs(field.lateralAt(x, 65.0)) / atAxis, expected, 0.01) << x;
  }
}

TEST(HarmonicBeam, ThroughALensIsMadeOfTheFundamentalsOfBothFrequencies)
{
  EchoSettings s = test::echoOf(test::p42(), 120.0);
  const auto fieldOf = [&](ImagingMode mode, double mhz) {
    s.imagingMode = mode;
    s.centreFrequencyMHz = mhz;
    ArrayAperture elements = elementsOf(s);
    elements.fractionalBandwidth = 0.0;
    return ArrayField(elements, 120.0);
  };
  const ArrayField sent = fieldOf(ImagingMode::Fundamental, 1.8); // a lens' two ways are alike
  const ArrayField heard = fieldOf(ImagingMode::Fundamental, 3.6);
  const ArrayField harmonic = fieldOf(ImagingMode::Harmonic, 3.6);
  for (const double z : { 30.0, 60.0, 110.0 })
  {
    for (const double x : { 0.0, 0.7, 1.5, 3.0 })
    {
      const double there = std::abs(sent.elevationalAt(x, z)) / std::sqrt(std::abs(sent.elevationalAt(0.0, z)));
      const double back = std::sqrt(std::abs(heard.elevationalAt(x, z)));
      EXPECT_NEAR(std::abs(harmonic.elevationalAt(x, z)), there * back, 0.01) << x << " at " << z;
    }
  }
}

TEST(HarmonicBeam, IsWeakerToTheSide)
{
  const BeamAperture aperture = test::p42().aperture();
  ScanLine line;
  line.steeringLateral = std::sin(0.6);
  const auto oneWay = [&](double mhz) {
    return sinc(aperture.elementWidthMm * mhz / 1.54 * std::sin(0.6)) * std::cos(0.6);
  };
  EXPECT_NEAR(directivity(aperture, 3.6, line, ImagingMode::Harmonic), oneWay(1.8) * oneWay(1.8) * oneWay(3.6), 1e-9);
}

TEST(HarmonicBeam, HazeHasGrownInTheBodyWall)
{
  BModeSettings settings;
  settings.addHaze = true;
  settings.hazeVariationDb = 0.0;
  settings.hazeDb = -40.0;
  settings.hazeFallDbPerCmMHz = 0.0;
  const HazePower fundamental = makeHaze(settings, 1, 400, 0.1);
  settings.hazeGrowthPerMm = 0.004;
  const HazePower harmonic = makeHaze(settings, 1, 400, 0.1);
  for (const int node : { 0, 8, 20, 40, 100 })
  {
    // The mean over echoes that lie anywhere above the depth, or in the wall of 10 mm.
    const double mm = std::min(0.25 * node, 10.0);
    double mean = 0.0;
    for (int n = 0; n < 1000; ++n)
    {
      mean += std::pow(0.004 * (n + 0.5) / 1000.0 * mm, 2.0) / 1000.0;
    }
    EXPECT_NEAR(harmonic.power[std::size_t(node)] / fundamental.power[std::size_t(node)], mean, 1e-5 * mean + 1e-12);
  }
}

} // namespace
