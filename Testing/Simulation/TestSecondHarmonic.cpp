#include "Cuda/MakeImageJob.h"
#include "ErrorText.h"
#include "ImageSettings.h"
#include "Probe/BeamAperture.h"
#include "Simulator.h"
#include "TestScenes.h"
#include "Trace/SecondHarmonic.h"
#include "Trace/TraceSetup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <vector>

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int bins = 400;
constexpr double binMm = 0.25;

double middle(int bin)
{
  return (bin + 0.5) * binMm;
}

double decibels(double ratio)
{
  return 20.0 * std::log10(ratio);
}

/// One line whose one-way pressure is given; intensity is its square.
TracedLines lineOf(const std::function<double(double)>& pressure)
{
  TracedLines lines;
  lines.lineCount = 1;
  lines.binCount = bins;
  lines.binMm = binMm;
  for (int bin = 0; bin < bins; ++bin)
  {
    const double p = pressure(middle(bin));
    lines.intensity.push_back(float(p * p));
    lines.standardError.push_back(float(0.1 * p * p));
    lines.attenuationNpPerMHz.push_back(0.01f * float(bin));
  }
  return lines;
}

const std::vector<std::complex<double>> planeWave(bins, 1.0);

/// (14.1) without what p1 loses: pressures as shares of the one that is sent.
double planeHarmonic(double sourcePerMm, double a1, double a2, double z)
{
  const double difference = a2 - 2.0 * a1;
  return std::abs(difference * z) < 1e-9 ? sourcePerMm * z * std::exp(-a2 * z)
                                         : sourcePerMm * (std::exp(-2.0 * a1 * z) - std::exp(-a2 * z)) / difference;
}

TEST(SecondHarmonic, OfAPlaneWaveFollowsItsClosedForm)
{
  const double source = 1e-5; // p1 loses nothing
  for (const auto& [a1, a2] :
       { std::pair(0.0, 0.0), std::pair(0.005, 0.01), std::pair(0.005, 0.007), std::pair(0.01, 0.012) }) // Np/mm
  {
    const auto fading = [](double a) { return [a](double z) { return std::exp(-a * z); }; };
    const TracedLines made =
      secondHarmonic(lineOf(fading(a1)), lineOf(fading(a2)), std::vector<float>(bins, float(source)), planeWave);
    for (int bin = 0; bin < bins; bin += 13)
    {
      const double z = middle(bin);
      const double expected = planeHarmonic(source, a1, a2, z) * std::exp(-a2 * z); // and back
      EXPECT_NEAR(made.intensity[std::size_t(bin)] / expected, 1.0, 1e-3) << a1 << " " << a2 << " at " << z;
      EXPECT_NEAR(made.standardError[std::size_t(bin)] / made.intensity[std::size_t(bin)], 0.1, 1e-5);
      EXPECT_EQ(made.attenuationNpPerMHz[std::size_t(bin)], 0.01f * float(bin));
    }
  }
}

TEST(SecondHarmonic, OfLayersFollowsTheIntegratedEquation)
{
  struct Layer
  {
    double fromMm, source, a1, a2, boundary; // pressure that is let through in front
  };
  const std::vector<Layer> layers{ { 0.0, 3e-4, 0.004, 0.008, 1.0 },
                                   { 20.0, 1e-4, 0.010, 0.018, 0.9 },
                                   { 45.0, 0.0, 0.001, 0.002, 0.5 },
                                   { 70.0, 4e-4, 0.006, 0.011, 0.8 } };
  const auto layerAt = [&](double z) {
    return *std::find_if(layers.rbegin(), layers.rend(), [&](const Layer& layer) { return z >= layer.fromMm; });
  };
  // dp1/dz = -a1 p1, dp2/dz = S p1^2 - a2 p2, in steps that end at each boundary.
  const double stepMm = 0.0005;
  std::vector<double> p1{ 1.0 };
  std::vector<double> p2{ 0.0 };
  std::vector<double> way2{ 1.0 };
  for (int n = 0; n < int(bins * binMm / stepMm); ++n)
  {
    const double z = n * stepMm;
    const Layer layer = layerAt(z + 0.5 * stepMm);
    const bool isBoundary = layer.fromMm > 0.0 && std::abs(z - layer.fromMm) < 0.5 * stepMm;
    const double through = isBoundary ? layer.boundary : 1.0;
    const double before = through * p1.back();
    const double half = before * std::exp(-0.5 * layer.a1 * stepMm);
    p1.push_back(before * std::exp(-layer.a1 * stepMm));
    p2.push_back(through * p2.back() * std::exp(-layer.a2 * stepMm) +
                 layer.source * half * half * std::exp(-0.5 * layer.a2 * stepMm) * stepMm);
    way2.push_back(through * way2.back() * std::exp(-layer.a2 * stepMm));
  }
  const auto lookUp = [&](const std::vector<double>& values) {
    return [&values, stepMm](double z) { return values[std::size_t(std::lround(z / stepMm))]; };
  };
  std::vector<float> sources;
  for (int bin = 0; bin < bins; ++bin)
  {
    sources.push_back(float(layerAt(middle(bin)).source));
  }
  const TracedLines made = secondHarmonic(lineOf(lookUp(p1)), lineOf(lookUp(way2)), sources, planeWave);
  for (int bin = 3; bin < bins; bin += 7)
  {
    const double expected = lookUp(p2)(middle(bin)) * lookUp(way2)(middle(bin));
    EXPECT_NEAR(decibels(made.intensity[std::size_t(bin)] / expected), 0.0, 0.03) << middle(bin);
  }
}

TEST(SecondHarmonic, TakesFromTheFundamentalAsFubiniSays)
{
  const auto lossless = [](double) { return 1.0; };
  const double source = 0.005; // per mm: sigma = 2 S z is 1 at 100 mm
  const TracedLines made =
    secondHarmonic(lineOf(lossless), lineOf(lossless), std::vector<float>(bins, float(source)), planeWave);
  for (int bin = 0; bin < bins; bin += 11)
  {
    const double sigma = 2.0 * source * middle(bin);
    const double fubini = std::cyl_bessel_j(2.0, 2.0 * sigma) / sigma;
    EXPECT_NEAR(decibels(made.intensity[std::size_t(bin)] / fubini), 0.0, 0.9) << sigma;
  }
  const TracedLines strong =
    secondHarmonic(lineOf(lossless), lineOf(lossless), std::vector<float>(bins, 10.0f), planeWave);
  EXPECT_LT(*std::max_element(strong.intensity.begin(), strong.intensity.end()), 0.613f);
}

TEST(SecondHarmonic, StaysFiniteInAShadow)
{
  const auto shadow = [](double z) { return z < 40.0 || z > 60.0 ? 1.0 : 0.0; };
  const TracedLines made = secondHarmonic(lineOf(shadow), lineOf(shadow), std::vector<float>(bins, 1e-3f), planeWave);
  for (int bin = 0; bin < bins; ++bin)
  {
    const double z = middle(bin);
    const double way = z < 40.0 ? z : z > 60.0 ? z - 20.0 : 0.0;
    EXPECT_NEAR(made.intensity[std::size_t(bin)], 1e-3 * way, 1e-3 * (0.02 * way + 1e-9)) << z;
    EXPECT_EQ(made.attenuationNpPerMHz[std::size_t(bin)], shadow(z) > 0.0 ? 0.01f * float(bin) : 0.0f) << z;
  }
}

TEST(SecondHarmonic, SourceIsThatOfPressuresInPascal)
{
  Tissue tissue;
  tissue.impedanceMRayl = 1.65;
  tissue.soundSpeedMPerS = 1550.0;
  tissue.nonlinearity = 4.4;
  const double omega = 2.0 * pi * 2e6;
  const double density = 1.65e6 / 1550.0;
  const double perM = 4.4 * omega * 300e3 / (2.0 * density * std::pow(1550.0, 3.0)); // dp2/dz / p1^2, times p0
  EXPECT_NEAR(harmonicSourcePerMm(tissue, 1.65, { 2.0, 300.0 }), perM / 1000.0, 1e-9);
}

/// On the axis of a focused Gaussian beam, by brute force: the field of each slab's source, S p1^2, of the whole disk,
/// summed by Fresnel's integral at twice the wave number.
double summedHarmonic(double waistMm, double focusMm, double wavelengthMm, double zMm)
{
  using Complex = std::complex<double>;
  const double k2 = 4.0 * pi / wavelengthMm;
  const int slabs = 300;
  const int rings = 6000;
  const double gapMm = 0.5; // to the nearest slab, where the rings would be too wide
  const double slabMm = (zMm - gapMm) / slabs;
  Complex sum;
  const auto q = [&](double z) { return Complex(1.0 - z / focusMm, wavelengthMm * z / (pi * waistMm * waistMm)); };
  for (int n = 0; n < slabs; ++n)
  {
    const double at = (n + 0.5) * slabMm;
    const double toGoMm = zMm - at;
    // exp(-rho^2 / (waist^2 q0)) with 1/q0 of the focused face, propagated: 1/(waist^2) + i k/(2 F) at the face.
    const Complex bend = (Complex(1.0 / (waistMm * waistMm), pi / (wavelengthMm * focusMm))) / q(at);
    const double reachMm = 5.0 / std::sqrt(2.0 * bend.real());
    const double ringMm = reachMm / rings;
    Complex slab;
    for (int r = 0; r < rings; ++r)
    {
      const double rho = (r + 0.5) * ringMm;
      slab +=
        2.0 * pi * rho * ringMm * std::exp(-2.0 * bend * rho * rho + Complex(0.0, k2 * rho * rho / (2.0 * toGoMm)));
    }
    sum += slabMm * slab / (q(at) * q(at)) * Complex(0.0, -k2 / (2.0 * pi * toGoMm));
  }
  return std::abs(sum + gapMm / (q(zMm) * q(zMm)));
}

TEST(SecondHarmonic, OfAFocusedBeamIsTheSumOfItsSources)
{
  BeamAperture aperture;
  aperture.apertureMm = aperture.elevationApertureMm = 14.0;
  aperture.transmitFocusMm = aperture.elevationFocusMm = 60.0;
  const double sentMHz = 1.8;
  const double wavelengthMm = assumedSoundSpeedMmPerUs / sentMHz;
  const double waistMm = 14.0 / (0.376 * 2.0 * pi);
  std::vector<std::complex<double>> gains;
  for (int bin = 0; bin < bins; ++bin)
  {
    gains.push_back(sentGain(aperture, sentMHz, middle(bin)));
  }
  const auto lossless = [](double) { return 1.0; };
  const TracedLines made = secondHarmonic(lineOf(lossless), lineOf(lossless), std::vector<float>(bins, 1e-6f), gains);
  for (const int bin : { 40, 120, 200, 240, 320 })
  {
    const double onAxis = 1e6 * made.intensity[std::size_t(bin)] * std::abs(gains[std::size_t(bin)]);
    EXPECT_NEAR(decibels(onAxis / summedHarmonic(waistMm, 60.0, wavelengthMm, middle(bin))), 0.0, 0.2) << middle(bin);
  }
}

TEST(SecondHarmonic, GrowsInTissueAndNotInCoupling)
{
  Tissue air = test::makeTissue("air", 0.0004, 343.0, 7.5);
  Tissue fat = test::makeTissue("fat", 1.38, 1450.0, 0.6);
  fat.nonlinearity = 6.2;
  Tissue liver = test::makeTissue("liver", 1.65, 1550.0, 0.5);
  liver.nonlinearity = 4.4;
  const auto scene = test::makeScene(
    { 4, 4, 60 }, { 5.0, 5.0, 1.0 }, { air, fat, liver },
    [](const Vec3d& p) { return p.z < 10.0   ? 0
                                : p.z < 30.0 ? 1
                                             : 2; }, "air");
  TraceSettings settings;
  settings.depthMm = 80.0;
  settings.frequencyMHz = 2.0;
  settings.facePressureKPa = 400.0;
  const auto sources = harmonicSources(*scene, { test::makeLine({ 10.0, 10.0, 0.0 }, { 0.0, 0.0, 1.0 }) }, settings);
  const auto at = [&](double mm) { return double(sources[std::size_t(mm / settings.radialBinMm)]); };
  EXPECT_EQ(at(5.1), 0.0);
  EXPECT_NEAR(at(20.1), 6.2 * pi * 2.0 * 400.0 / (1450.0 * 1450.0 * 1.38), 1e-8);
  EXPECT_NEAR(at(40.1), 4.4 * pi * 2.0 * 400.0 / (1550.0 * 1550.0 * std::sqrt(1.65 * 1.38)), 1e-8);
  EXPECT_EQ(at(70.1), 0.0); // beyond the map
}

/// What has been reflected is not followed, and nothing else is changed by that.
TEST(SecondHarmonic, TheToneThatIsSentHasTheSameIntensity)
{
  Tissue fat = test::makeTissue("fat", 1.38, 1450.0, 0.6);
  Tissue bone = test::makeTissue("bone", 6.0, 3200.0, 4.0);
  fat.roughnessMm = 0.1;
  bone.roughnessMm = 0.2;
  for (Tissue* tissue : { &fat, &bone })
  {
    tissue->scattererProbability = 1.0;
    tissue->scattererSigma = 1.0;
  }
  const auto scene = test::makeScene({ 40, 40, 60 }, Vec3d(1.0), { fat, bone }, [](const Vec3d& p) {
    return p.z > 20.0 && p.z < 24.0 && p.x + 0.5 * p.z < 35.0 ? 1 : 0;
  });
  const std::vector<ScanLine> lines{ test::makeLine({ 20.0, 20.0, 0.0 }, { 0.0, 0.0, 1.0 }),
                                     test::makeLine({ 22.0, 20.0, 0.0 }, glm::normalize(Vec3d(0.2, 0.0, 1.0))) };
  for (const double apertureMm : { 0.0, 18.0 })
  {
    TraceSettings tone;
    tone.depthMm = 50.0;
    tone.aperture.apertureMm = apertureMm;
    tone.aperture.elevationApertureMm = apertureMm;
    const TracedLines whole = trace(*scene, lines, tone);
    const TracedLines sent = trace(*scene, lines, sentTone(tone));
    EXPECT_EQ(sent.intensity, whole.intensity) << apertureMm;
    EXPECT_LT(sent.segments, whole.segments * 4 / 5) << apertureMm;
    EXPECT_TRUE(sent.reverberation.empty());
    EXPECT_GT(*std::max_element(whole.reverberation.begin(), whole.reverberation.end()), 0.0f);
  }
}

/// What a GPU gets of a setup that went over to the doubled tone is what it gets of one that was made for it.
TEST(SecondHarmonic, ATunedSetupIsThatOfTheTone)
{
  Tissue fat = test::makeTissue("fat", 1.38, 1450.0, 0.6);
  Tissue liver = test::makeTissue("liver", 1.65, 1550.0, 0.5);
  liver.scattererProbability = 1.0;
  liver.scattererSigma = 1.0;
  liver.backscatterExponent = 1.3;
  liver.roughnessMm = 0.2;
  const auto scene =
    test::makeScene({ 40, 40, 60 }, Vec3d(1.0), { fat, liver }, [](const Vec3d& p) { return p.z < 20.0 ? 0 : 1; });
  const std::vector<ScanLine> lines{ test::makeLine({ 20.0, 20.0, 0.0 }, { 0.0, 0.0, 1.0 }),
                                     test::makeLine({ 21.0, 20.0, 0.0 }, glm::normalize(Vec3d(0.1, 0.0, 1.0))) };
  TraceSettings tone;
  tone.frequencyMHz = 1.7;
  tone.depthMm = 50.0;
  tone.aperture.apertureMm = 18.0;
  tone.aperture.elevationApertureMm = 12.0;
  tone.aperture.transmitFocusMm = 60.0;
  const TraceSettings sent = sentTone(tone);
  const TraceSettings twice = doubledTone(tone);

  TraceSetup setup(*scene, lines, sent, {}, {});
  TraceJob tuned = makeTraceJob(setup, sent, 1);
  setup.tune(*scene, twice, {});
  tuneTraceJob(setup, twice, tuned);
  const TraceSetup fresh(*scene, lines, twice, {}, {});
  const TraceJob made = makeTraceJob(fresh, twice, 1);

  EXPECT_EQ(tuned.frequencyMHz, 3.4);
  EXPECT_EQ(tuned.frequencyMHz, made.frequencyMHz);
  EXPECT_EQ(tuned.radPerMm, made.radPerMm);
  EXPECT_EQ(tuned.view.waveNumberAtOne, made.view.waveNumberAtOne);
  EXPECT_EQ(tuned.view.cellLateralPerMm, made.view.cellLateralPerMm);
  EXPECT_EQ(tuned.view.cellElevationPerMm, made.view.cellElevationPerMm);
  EXPECT_EQ(tuned.view.cornerMm, made.view.cornerMm);
  EXPECT_EQ(tuned.view.depthMm, made.view.depthMm);
  EXPECT_EQ(tuned.seeds, made.seeds);
  EXPECT_EQ(tuned.paths, made.paths);
  EXPECT_EQ(tuned.binCount, made.binCount);
  EXPECT_EQ(tuned.echoCount, made.echoCount);
  EXPECT_EQ(tuned.rangeIsTime, made.rangeIsTime);
  EXPECT_EQ(tuned.view.reverberates, made.view.reverberates);
  EXPECT_EQ(tuned.region, made.region);
  ASSERT_EQ(tuned.media.size(), made.media.size());
  for (std::size_t m = 0; m < made.media.size(); ++m)
  {
    EXPECT_EQ(tuned.media[m].decayPerMm, made.media[m].decayPerMm);
    EXPECT_EQ(tuned.media[m].scatter, made.media[m].scatter);
    EXPECT_EQ(tuned.media[m].roughnessMm, made.media[m].roughnessMm);
  }
  ASSERT_EQ(tuned.lines.size(), made.lines.size());
  for (std::size_t l = 0; l < made.lines.size(); ++l)
  {
    EXPECT_EQ(tuned.lines[l].origin, made.lines[l].origin);
    EXPECT_EQ(tuned.lines[l].axis, made.lines[l].axis);
    EXPECT_EQ(tuned.lines[l].lateral, made.lines[l].lateral);
    EXPECT_EQ(tuned.lines[l].elevation, made.lines[l].elevation);
  }
}

TEST(SecondHarmonic, BadInputGetsASentence)
{
  EchoSettings echo;
  echo.imagingMode = ImagingMode::Harmonic;
  echo.centreFrequencyMHz = 10.0;
  echo.samplingMHz = 18.0;
  expectContains(errorOf([&] { echo.validate(); }),
                 "second harmonic lies at 10 MHz, not below half the sampling frequency of 18 MHz");
  TraceSettings tracing;
  tracing.imagingMode = ImagingMode::Harmonic;
  tracing.model = InterfaceModel::Amadou2024;
  expectContains(errorOf([&] { tracing.validate(); }), "no second harmonic");
  tracing.model = InterfaceModel::Acoustic;
  tracing.facePressureKPa = 0.0;
  expectContains(errorOf([&] { tracing.validate(); }), "face pressure");
  ImageSettings image;
  image.matchStages();
  image.echo.imagingMode = ImagingMode::Harmonic;
  expectContains(errorOf([&] { image.requireMatch(); }), "the imaging mode");
}

TEST(SecondHarmonic, StagesMatch)
{
  ImageSettings image;
  image.echo.imagingMode = ImagingMode::Harmonic;
  image.echo.centreFrequencyMHz = 3.6;
  image.tracing.facePressureKPa = 700.0;
  image.matchStages();
  image.requireMatch();
  EXPECT_EQ(image.tracing.frequencyMHz, 1.8);
  EXPECT_EQ(image.bmode.frequencyMHz, 3.6);
  EXPECT_NEAR(image.bmode.hazeGrowthPerMm, 5.4 * pi * 1.8 * 700.0 / (1515.0 * 1515.0 * 1.53), 1e-9);
  image.echo.imagingMode = ImagingMode::Fundamental;
  image.matchStages();
  EXPECT_EQ(image.tracing.frequencyMHz, 3.6);
  EXPECT_EQ(image.bmode.hazeGrowthPerMm, 0.0);
}

TEST(SecondHarmonic, TheFundamentalKnowsNothingOfIt)
{
  Tissue liver = test::makeTissue("liver", 1.65, 1550.0, 0.5);
  liver.scattererProbability = 1.0;
  liver.scattererSigma = 1.0;
  Tissue softer = liver;
  softer.nonlinearity = 1.0;
  const auto rfOf = [&](const Tissue& tissue, double kPa) {
    Simulator simulator(test::makeScene({ 40, 40, 40 }, Vec3d(1.0), { tissue }, [](const Vec3d&) { return 0; }));
    ImageInput input;
    input.pose.positionMm = { 20.0, 20.0, 0.0 };
    input.settings.geometry.depthMm = 35.0;
    input.settings.geometry.lineCount = 4;
    input.settings.tracing.facePressureKPa = kPa;
    input.settings.setDevice(Device::Cpu);
    input.settings.matchStages();
    return simulator.rf(input).host().iq;
  };
  EXPECT_EQ(rfOf(liver, 500.0), rfOf(softer, 50.0));
}

} // namespace
