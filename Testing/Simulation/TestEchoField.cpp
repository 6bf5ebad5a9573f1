#include "ErrorText.h"
#include "FieldScenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace sono;
using namespace sono::test;
using sono::testing::errorOf;
using sono::testing::expectContains;

/// A P4-2 class phased array of 2.5 MHz.
ArrayAperture phasedArray()
{
  ArrayAperture aperture;
  aperture.centreFrequencyMHz = 2.5;
  aperture.fractionalBandwidth = 0.6;
  return aperture;
}

std::shared_ptr<const PulseEchoField> phasedField(double depthMm)
{
  const ArrayAperture aperture = phasedArray();
  return std::make_shared<PulseEchoField>(pulseEchoField(aperture, suggestedFieldGrid(aperture, depthMm)));
}

FieldGrid halfGrid(double lateralStepMm, int lateralCount, double elevationalStepMm, int elevationalCount,
                   double depthStepMm, int depthCount)
{
  return { { 0.0, lateralStepMm, lateralCount },
           { 0.0, elevationalStepMm, elevationalCount },
           { 0.0, depthStepMm, depthCount } };
}

/// A Gaussian on a grid so fine that linear interpolation costs 0.05 % of it.
std::shared_ptr<const PulseEchoField> gaussianField(double lateralSigmaMm, double elevationalSigmaMm, double depthMm)
{
  return tabulate(halfGrid(lateralSigmaMm / 20.0, 101, elevationalSigmaMm / 20.0, 101, depthMm / 4.0, 5),
                  [&](double l, double e, double) {
                    return std::exp(-0.5 * (std::pow(l / lateralSigmaMm, 2) + std::pow(e / elevationalSigmaMm, 2)));
                  });
}

double energy(const std::vector<std::complex<float>>& iq)
{
  double sum = 0.0;
  for (const std::complex<float> v : iq)
  {
    sum += double(std::norm(v));
  }
  return sum;
}

TEST(EchoField, OfAPhasedArrayAgreesWithTheDirectSum)
{
  SceneS1 s1(60000, 7);
  s1.settings.centreFrequencyMHz = 2.5;
  s1.settings.field = phasedField(121.0);
  const PointScatterers sorted(s1.points);
  for (const double samplingMHz : { 50.0, 12.5 })
  {
    s1.settings.samplingMHz = samplingMHz;
    const RfLines rf = formRf({ nullptr, nullptr, &sorted }, s1.lines, s1.settings);
    for (const int line : { 0, 50, 127 })
    {
      const auto exact = directIq(
        s1.points, s1.lines[std::size_t(line)], s1.settings,
        [&](double l, double e, double r) { return trilinear(*s1.settings.field, l, e, r); },
        gaussianPulse(s1.settings));
      EXPECT_LT(nrmse(rf.iq.data() + std::size_t(line) * exact.size(), exact), samplingMHz == 50.0 ? 1e-3 : 1e-2)
        << "line " << line << " at " << samplingMHz << " MHz";
    }
  }
}

TEST(EchoField, OfATiltedLopsidedBeamAgreesWithTheDirectSum)
{
  // A table that is not symmetric, starts below the face, and whose beam bends and widens: nothing may be mirrored.
  const FieldGrid grid{ { -4.0, 0.2, 46 }, { -3.0, 0.3, 24 }, { 5.0, 2.0, 45 } };
  const auto field = tabulate(grid, [](double l, double e, double z) {
    const double width = 0.5 + std::abs(z - 40.0) / 60.0;
    return std::exp(-std::pow((l - 1.0 - 0.01 * z) / width, 2) - std::pow((e + 0.7) / 1.1, 2)) / width;
  });
  SceneS1 s1(100000, 3);
  s1.settings.depthMm = 93.0;
  s1.settings.field = field;
  const ScanLine tilted = makeLine({ -30.0, 4.0, 20.0 }, { 0.8, -0.1, 0.5 });
  const PointScatterers sorted(s1.points);
  const RfLines rf = formRf({ nullptr, nullptr, &sorted }, { tilted }, s1.settings);
  const auto exact = directIq(
    s1.points, tilted, s1.settings, [&](double l, double e, double r) { return trilinear(*field, l, e, r); },
    gaussianPulse(s1.settings));
  EXPECT_LT(nrmse(rf.iq.data(), exact), 1e-3);
}

TEST(EchoField, ThatTabulatesAGaussianGivesTheGaussianBeam)
{
  SceneS1 s1(200000);
  s1.settings.lateralSigmaMm = 0.8;
  s1.settings.elevationalSigmaMm = 1.7;
  const PointScatterers sorted(s1.points);
  const RfLines gaussian = formRf({ nullptr, nullptr, &sorted }, s1.lines, s1.settings);
  s1.settings.field = gaussianField(0.8, 1.7, s1.settings.depthMm);
  const RfLines field = formRf({ nullptr, nullptr, &sorted }, s1.lines, s1.settings);
  const std::vector<std::complex<double>> reference(gaussian.iq.begin(), gaussian.iq.end());
  EXPECT_LT(nrmse(field.iq.data(), reference), 1.5e-3); // h^2 / 8 of the second derivative, and both beams' cuts
}

TEST(EchoField, LeavesTheLevelOfTissueWhereItWas)
{
  // The level is normalised by the beam's and the pulse's own integrals: a tabulated Gaussian changes nothing.
  const auto scene = scatteringBox({ 30, 10, 30 });
  EchoSettings s;
  s.depthMm = 28.0;
  s.lateralSigmaMm = 0.9;
  s.elevationalSigmaMm = 0.7;
  const ScanLine line = makeLine({ 15.0, 5.0, 0.5 }, { 0, 0, 1 });
  const RfLines gaussian = formRf({ scene.get(), nullptr, nullptr }, { line }, s);
  s.field = gaussianField(0.9, 0.7, s.depthMm);
  const RfLines field = formRf({ scene.get(), nullptr, nullptr }, { line }, s);
  const std::vector<std::complex<double>> reference(gaussian.iq.begin(), gaussian.iq.end());
  EXPECT_LT(nrmse(field.iq.data(), reference), 2e-3);
}

TEST(EchoField, HoldsTheStatedLevelAtItsFocus)
{
  const auto scene = scatteringBox({ 160, 60, 100 });
  EchoSettings s;
  s.depthMm = 90.0;
  s.field = phasedField(s.depthMm);
  const auto lines = parallelLines(24, { 45.0, 30.0, 0.5 }, 3.0);
  const TracedLines traced = fullyLit(lines.size(), s, InterfaceModel::Amadou2024);
  const RfLines rf = formRf({ scene.get(), &traced, nullptr }, lines, s);
  // The focus: where the table's weight on the axis is largest.
  const FieldGrid& grid = s.field->grid();
  const std::size_t plane = std::size_t(grid.lateral.count) * std::size_t(grid.elevational.count);
  int focus = 0;
  for (int d = 0; d < grid.depth.count; ++d)
  {
    focus = s.field->values()[std::size_t(d) * plane] > s.field->values()[std::size_t(focus) * plane] ? d : focus;
  }
  double squares = 0.0;
  int count = 0;
  for (int line = 0; line < rf.lineCount; ++line)
  {
    for (int n = int((grid.depth.at(focus) - 4.0) / rf.sampleMm); n < int((grid.depth.at(focus) + 4.0) / rf.sampleMm);
         ++n)
    {
      squares += std::norm(rf.iq[std::size_t(line) * std::size_t(rf.sampleCount) + std::size_t(n)]);
      ++count;
    }
  }
  EXPECT_NEAR(10.0 * std::log10(squares / count), s.scattererLevelDb, 0.7); // some 500 independent samples
}

TEST(EchoField, GivesAPointItsOwnWidthAtTheFocus)
{
  EchoSettings s;
  s.depthMm = 80.0;
  s.field = phasedField(s.depthMm);
  const double depthMm = 60.0;
  const double pitchMm = 0.05;
  const auto lines = parallelLines(161, { -80.0 * pitchMm, 0.0, 0.0 }, pitchMm);
  const PointScatterers point({ { { 0.0, 0.0, depthMm }, 1.0f } });
  const std::vector<float> envelope = formRf({ nullptr, nullptr, &point }, lines, s).envelope();
  const std::size_t samples = envelope.size() / lines.size();
  const auto peakOf = [&](std::size_t line) {
    const auto row = envelope.begin() + std::ptrdiff_t(line * samples);
    return double(*std::max_element(row, row + std::ptrdiff_t(samples)));
  };
  // Half a width: where a profile falls to half its value on the axis, between two positions.
  const auto halfWidth = [&](const std::function<double(double)>& profile) {
    const double threshold = std::pow(10.0, -0.3) * profile(0.0);
    double x = 0.0;
    while (profile(x + pitchMm) > threshold)
    {
      x += pitchMm;
    }
    return x + pitchMm * (profile(x) - threshold) / (profile(x) - profile(x + pitchMm));
  };
  const double imaged = halfWidth([&](double x) { return peakOf(std::size_t(80 + std::lround(x / pitchMm))); });
  const double own = halfWidth([&](double x) { return trilinear(*s.field, x, 0.0, depthMm); });
  EXPECT_NEAR(imaged / own, 1.0, 1e-3);
  // Two-way, rectangular aperture: 0.886 lambda F#, at the transmit focus and nearly so 5 mm before it.
  const ArrayAperture aperture = phasedArray();
  EXPECT_NEAR(2.0 * imaged / (0.886 * aperture.wavelengthMm() * depthMm / aperture.widthMm()), 1.0, 0.1);
}

TEST(EchoField, WeighsBoundariesByItsIntegralAcrossTheirDepth)
{
  // w = a(z) in a strip whose width grows with depth: A(z) = a^2 times the strip's area, by hand.
  FieldGrid grid = halfGrid(1.0, 9, 1.0, 2, 20.0, 3);
  const auto field = tabulate(grid, [](double l, double, double z) {
    const double a = z == 20.0 ? 1.0 : (z == 0.0 ? 0.5 : 0.25);
    return l <= (z == 40.0 ? 4.0 : 1.0) ? a : 0.0;
  });
  // Flat over the half width n, then linear to 0 within a step: the square's integral is n + 1/3.
  const double wide = std::sqrt(0.25 * 0.25 * (4.0 + 1.0 / 3.0) / (1.0 + 1.0 / 3.0));
  TracedLines traced;
  traced.lineCount = 1;
  traced.binMm = 0.25;
  traced.binCount = 160;
  traced.model = InterfaceModel::Amadou2024;
  traced.intensity.assign(160, 1.0f);
  traced.standardError.assign(160, 0.0f);
  EchoSettings s;
  s.depthMm = 40.0;
  s.field = field;
  traced.echoSampleMm = s.sampleMm();
  traced.echoCount = s.sampleCount();
  traced.boundaryEcho.resize(std::size_t(traced.echoCount));
  const std::vector<std::pair<double, double>> expected{
    { 20.0, 1.0 }, { 10.0, 0.75 }, { 30.0, 0.5 * (1.0 + wide) }, { 39.0, 0.05 + 0.95 * wide }
  };
  for (const auto& [depthMm, level] : expected)
  {
    traced.boundaryEcho[std::size_t(std::lround(depthMm / s.sampleMm()))] = 0.8f;
  }
  const RfLines rf = formRf({ nullptr, &traced, nullptr }, { makeLine({ 0, 0, 0 }, { 0, 0, 1 }) }, s);
  for (const auto& [depthMm, level] : expected)
  {
    EXPECT_NEAR(std::abs(rf.iq[std::size_t(std::lround(depthMm / s.sampleMm()))]) / 0.8, level, 4e-3) << depthMm;
  }
}

TEST(EchoField, InFrontOfItsFirstDepthNothingEchoes)
{
  EchoSettings s;
  s.samplingMHz = 50.0;
  s.depthMm = 40.0;
  FieldGrid grid = halfGrid(0.5, 9, 0.5, 9, 5.0, 7);
  grid.depth.minMm = 10.0;
  s.field = tabulate(grid, [](double, double, double) { return 1.0; });
  const ScanLine line = makeLine({ 0, 0, 0 }, { 0, 0, 1 });
  const auto formed = [&](double depthMm) {
    const PointScatterers point({ { { 0.0, 0.0, depthMm }, 1.0f } });
    return energy(formRf({ nullptr, nullptr, &point }, { line }, s).iq);
  };
  EXPECT_EQ(formed(9.99), 0.0);
  EXPECT_GT(formed(10.01), 1.0);
  EXPECT_NEAR(formed(39.0) / formed(20.0), 1.0, 1e-3);
}

TEST(EchoField, BelowTheImageStillEchoesIntoIt)
{
  // The table ends where the image does; half a pulse deeper its last weights hold.
  EchoSettings s;
  s.depthMm = 40.0;
  s.field = gaussianField(1.0, 1.0, s.depthMm);
  const ScanLine line = makeLine({ 0, 0, 0 }, { 0, 0, 1 });
  const std::vector<PointScatterer> below{ { { 0.3, 0.2, 40.1 }, 1.0f } };
  const PointScatterers sorted(below);
  const auto exact = directIq(
    below, line, s, [&](double l, double e, double r) { return trilinear(*s.field, l, e, r); }, gaussianPulse(s));
  EXPECT_LT(nrmse(formRf({ nullptr, nullptr, &sorted }, { line }, s).iq.data(), exact), 2e-3);
}

TEST(EchoField, OfOneValueAnAxisIsASlab)
{
  EchoSettings s;
  s.depthMm = 40.0;
  s.field =
    tabulate({ { 0.0, 2.0, 1 }, { 0.0, 4.0, 1 }, { 20.0, 40.0, 1 } }, [](double, double, double) { return 1.0; });
  const auto formed = [&](const Vec3d& at) {
    const PointScatterers point({ { at, 1.0f } });
    return energy(formRf({ nullptr, nullptr, &point }, { makeLine({ 0, 0, 0 }, { 0, 0, 1 }) }, s).iq);
  };
  const double axial = formed({ 0, 0, 20 });
  EXPECT_GT(axial, 1.0);
  EXPECT_EQ(formed({ 0.99, -1.99, 20 }), axial);
  EXPECT_EQ(formed({ 1.01, 0, 20 }), 0.0);
  EXPECT_EQ(formed({ 0, 2.01, 20 }), 0.0);
}

TEST(EchoField, ThatDoesNotReachTheImagesDepthIsRefused)
{
  EchoSettings s;
  s.depthMm = 120.0;
  s.field = gaussianField(1.0, 1.0, 100.0);
  const std::vector<ScanLine> lines{ makeLine({ 0, 0, 0 }, { 0, 0, 1 }) };
  const std::string message = errorOf([&] { formRf({}, lines, s); });
  expectContains(message, "pulse-echo field");
  expectContains(message, "100");
  expectContains(message, "120");
  expectContains(message, "lower the depth");
  s.depthMm = 100.0;
  EXPECT_EQ(errorOf([&] { formRf({}, lines, s); }), "no error");

  FieldGrid deep = halfGrid(0.5, 9, 0.5, 9, 5.0, 7);
  deep.depth.minMm = 110.0;
  s.field = tabulate(deep, [](double, double, double) { return 1.0; });
  expectContains(errorOf([&] { formRf({}, lines, s); }), "pulse-echo field");
}

TEST(EchoField, ThatIsZeroOnItsAxisIsRefused)
{
  EchoSettings s;
  s.depthMm = 30.0;
  s.field = tabulate(halfGrid(0.5, 9, 0.5, 9, 5.0, 7), [](double l, double, double) { return l > 1.0 ? 1.0 : 0.0; });
  expectContains(errorOf([&] { formRf({}, { makeLine({ 0, 0, 0 }, { 0, 0, 1 }) }, s); }), "axis");
}

} // namespace
