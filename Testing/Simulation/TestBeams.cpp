#include "BeamFigures.h"
#include "FieldScenes.h"

#include "Echo/BeamModel.h"
#include "Probe/BeamAperture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace sono;
using namespace sono::test;

/// Section 12.1 once more, in double precision and in its own words.
struct GaussianBeam
{
  double lambda, width, height, focus, lens;
  bool isMatrix = false;

  double receive(double size, double z) const { return 0.376 * std::sqrt(2.0) * lambda * z / std::min(size, z); }
  double transmit(double size, double depth, double z) const
  {
    const double waist = 0.4233 * size;
    return waist * std::sqrt((std::pow(1.0 - z / depth, 2) + std::pow(lambda * z / (M_PI * waist * waist), 2)) / 2.0);
  }
  double both(double a, double b) const { return 1.0 / std::sqrt(1.0 / (a * a) + 1.0 / (b * b)); }
  double lateral(double z) const { return both(receive(width, z), transmit(width, focus, z)); }
  double elevational(double z) const
  {
    return isMatrix ? both(receive(height, z), transmit(height, focus, z)) : transmit(height, lens, z) / std::sqrt(2.0);
  }
  double energy(double z) const // the product of the four widths, each to the root of the amplitude
  {
    const double e =
      isMatrix ? receive(height, z) * transmit(height, focus, z) : std::pow(transmit(height, lens, z), 2);
    return 1.0 / std::sqrt(receive(width, z) * transmit(width, focus, z) * e);
  }
  double weight(double l, double e, double z) const
  {
    return energy(z) / energy(focus) * std::exp(-0.5 * (std::pow(l / lateral(z), 2) + std::pow(e / elevational(z), 2)));
  }
};

GaussianBeam beamOf(const ProbePreset& p)
{
  return { 1.54 / p.centreFrequencyMHz, p.apertureMm,       p.elevationApertureMm,
           p.transmitFocusMm,           p.elevationFocusMm, p.geometry.isVolume() };
}

TEST(Beams, ThePresetNamesItsAperture)
{
  const ProbePreset preset = p42();
  EXPECT_NEAR(preset.apertureMm, 20.455, 1e-9);
  EXPECT_EQ(preset.elevationApertureMm, 14.0);
  EXPECT_EQ(preset.elementWidthMm, 0.295);
  EXPECT_TRUE(preset.aperture().isNamed());
  EXPECT_TRUE(ProbeSettings{}.aperture() == preset.aperture());
}

TEST(Beams, WidthsAreThoseOfTheTable)
{
  // Section 12.1's table, to its last digit.
  const EchoSettings s = echoOf(p42(), 160.0);
  const BeamModel model(s, InterfaceModel::Acoustic);
  const std::vector<std::pair<double, double>> table{ { 30, 0.78 }, { 60, 1.22 }, { 90, 2.19 }, { 120, 3.05 } };
  for (const auto& [depthMm, widthMm] : table)
  {
    EXPECT_NEAR(halfWidth * model.widthAt(depthMm).lateralSigmaMm, widthMm, 0.0051) << depthMm;
  }
  const double focus = halfWidth * model.widthAt(65.0).lateralSigmaMm;
  EXPECT_NEAR(focus / (0.886 * 1.54 / 3.6 * 65.0 / 20.455), 1.0, 0.03);
}

TEST(Beams, AMirrorsAreaIsThatOfTheFocus)
{
  const EchoSettings s = echoOf(p42(), 160.0);
  const GaussianBeam exact = beamOf(p42());
  const BeamModel model(s, InterfaceModel::Acoustic);
  EXPECT_NEAR(model.focusAreaMm2() / (2.0 * M_PI * exact.lateral(65.0) * exact.elevational(65.0)), 1.0, 1e-3);
  EXPECT_NEAR(model.widthAt(65.0).amplitude, 1.0, 1e-5);
  EchoSettings fixed;
  fixed.lateralSigmaMm = 1.5;
  fixed.elevationalSigmaMm = 2.0;
  EXPECT_NEAR(BeamModel(fixed, InterfaceModel::Acoustic).focusAreaMm2(), 2.0 * M_PI * 3.0, 1e-9);
}

TEST(Beams, AgreeWithTheDirectSum)
{
  // Brick culling and single precision against the sum over all points, for lines across the whole sector.
  ProbePreset preset = p42();
  preset.geometry.lineCount = 7;
  EchoSettings s = echoOf(preset, 140.0);
  s.samplingMHz = 50.0;
  const GaussianBeam exact = beamOf(preset);
  const auto lines = makeScanLines(preset.geometry, ProbePose{});
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<PointScatterer> points;
  for (int n = 0; n < 60000; ++n)
  {
    points.push_back(
      { { 90.0 * uniform(random), 12.0 * uniform(random), 70.0 + 70.0 * uniform(random) }, float(uniform(random)) });
  }
  const PointScatterers sorted(points);
  const RfLines rf = formRf({ nullptr, nullptr, &sorted }, lines, s);
  for (std::size_t l = 0; l < lines.size(); ++l)
  {
    const double angle = std::asin(std::abs(lines[l].axis.x));
    const double cosine = std::cos(angle);
    const double x = 0.295 * std::sin(angle) / (1.54 / 3.6);
    const double loss = std::pow((x == 0.0 ? 1.0 : std::sin(M_PI * x) / (M_PI * x)) * cosine, 2);
    const auto expected = directIq(
      points, lines[l], s,
      [&](double dl, double de, double r) { return loss * exact.weight(dl * cosine, de, std::max(r, 1e-6)); },
      gaussianPulse(s));
    EXPECT_LT(nrmse(rf.iq.data() + l * std::size_t(rf.sampleCount), expected), 1.5e-3) << l;
  }
}

TEST(Beams, SteeredLinesLoseWhatAnElementLoses)
{
  ProbePreset preset = p42();
  preset.geometry.lineCount = 3;
  const auto lossDb = [&](double angleDeg) {
    preset.geometry.sectorDeg = 2.0 * angleDeg;
    const auto lines = makeScanLines(preset.geometry, ProbePose{});
    return 20.0 * std::log10(directivity(preset.aperture(), 3.6, lines[2]));
  };
  EXPECT_NEAR(lossDb(37.5), -5.4 - 4.0, 0.06); // section 12.3's, to their last digit
  EXPECT_NEAR(lossDb(42.0), -6.6 - 5.2, 0.11);
  EXPECT_NEAR(lossDb(42.5), -6.7 - 5.3, 0.11);
}

TEST(Beams, OfAMatrixFocusesBothWaysAlike)
{
  ProbePreset preset = p42();
  preset.geometry.kind = ScanKind::Matrix;
  preset.geometry.elevationLineCount = 3;
  preset.geometry.elevationSectorDeg = 60.0;
  preset.geometry.lineCount = 3;
  preset.elevationApertureMm = preset.apertureMm;
  const EchoSettings s = echoOf(preset, 160.0);
  const BeamModel model(s, InterfaceModel::Acoustic);
  for (const double z : { 5.0, 30.0, 65.0, 120.0 })
  {
    EXPECT_NEAR(model.widthAt(z).elevationalSigmaMm / model.widthAt(z).lateralSigmaMm, 1.0, 1e-6) << z;
  }
  preset.geometry.elevationLineCount = 1; // a plane is scanned with the same array
  EXPECT_TRUE(preset.aperture() == s.aperture);
  preset.geometry.elevationLineCount = 3;
  // Lines that lean to the side, across the plane and in it, are as weak.
  preset.geometry.sectorDeg = 60.0;
  const auto lines = makeScanLines(preset.geometry, ProbePose{});
  EXPECT_NEAR(directivity(s.aperture, 3.6, lines[1]), directivity(s.aperture, 3.6, lines[3]), 1e-12);
  const Beam across = model.beamOf(lines[1], Vec3d(0.0), Mat3d(1.0));
  EXPECT_NEAR(across.profile.elevational.cosine2, 0.75, 1e-6);
  EXPECT_EQ(across.profile.lateral.cosine2, 1.0f);
}

TEST(Beams, Amadou2024HasOneWidth)
{
  EchoSettings s = echoOf(p42(), 60.0);
  TracedLines traced;
  traced.model = InterfaceModel::Amadou2024;
  traced.lineCount = 1;
  traced.binCount = 240;
  traced.binMm = 0.25;
  traced.intensity.assign(240, 0.7f);
  traced.attenuationNpPerMHz.assign(240, 0.5f);
  const auto box = scatteringBox({ 20, 20, 60 });
  const std::vector<ScanLine> lines{ makeLine({ 10, 10, 0 }, { 0, 0, 1 }) };
  const auto with = formRf(*box, lines, traced, s);
  s.aperture = {};
  traced.attenuationNpPerMHz.clear();
  EXPECT_EQ(with.iq, formRf(*box, lines, traced, s).iq);
}

TEST(Beams, SpeckleWidensInDepth)
{
  const WidthErrors errors = widthErrors();
  EXPECT_LT(errors.gaussian, 0.01);
  EXPECT_LT(errors.field, 0.1);
}

} // namespace
