#include "BeamFigures.h"
#include "ErrorText.h"

#include "Probe/ArrayField.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace {

using namespace sono;
using namespace sono::test;
using sono::testing::errorOf;
using sono::testing::expectContains;

ArrayAperture p42Array()
{
  return apertureOf(p42());
}

double decibels(double ratio)
{
  return 20.0 * std::log10(ratio);
}

TEST(ArrayField, BetweenItsNodesIsTheExactSum)
{
  const ArrayField field(p42Array(), 130.0);
  const ArrayBeamView view = field.view();
  std::mt19937_64 random(5);
  for (const double rangeMm : { 20.3, 30.1, 47.7, 65.2, 90.4, 119.9 })
  {
    const double widthMm = 1.54 / field.frequencyMHz() * rangeMm / 20.455;
    std::uniform_real_distribution<double> across(-2.0 * widthMm, 2.0 * widthMm);
    for (int n = 0; n < 200; ++n)
    {
      const double mm = across(random);
      for (const bool isLateral : { true, false })
      {
        const auto exact = isLateral ? field.lateralAt(mm, rangeMm) : field.elevationalAt(mm, rangeMm);
        const auto other = isLateral ? field.elevationalAt(0.0, rangeMm) : field.lateralAt(0.0, rangeMm);
        const auto axis = isLateral ? field.lateralAt(0.0, rangeMm) : field.elevationalAt(0.0, rangeMm);
        const ComplexWeight w = isLateral ? arrayBeamWeight(view, float(mm), 0.0f, float(rangeMm))
                                          : arrayBeamWeight(view, 0.0f, float(mm), float(rangeMm));
        if (std::abs(exact) > 0.1 * std::abs(axis))
        {
          const double error = decibels(std::hypot(w.re, w.im) / std::abs(exact * other));
          EXPECT_LT(std::abs(error), 0.3) << rangeMm << " " << mm << " " << isLateral;
          EXPECT_LT(std::abs(std::arg(std::complex<double>(w.re, w.im) / (exact * other))), 0.05) << rangeMm;
        }
      }
    }
  }
}

TEST(ArrayField, TheTableIsFineEnough)
{
  EXPECT_LT(fieldTableErrorDb(), 0.3);
}

TEST(ArrayField, FactorsAgreeWithTheWholeAperture)
{
  // The sum over the aperture's surface, without Fresnel's approximation (the real field, one frequency), in its focus.
  ArrayAperture aperture = p42Array();
  const ArrayField field(aperture, 130.0);
  aperture.centreFrequencyMHz = field.frequencyMHz();
  aperture.fractionalBandwidth = 0.0;
  for (const double depthMm : { 40.0, 65.0, 110.0 })
  {
    const FieldGrid grid{ { 0.0, 0.25, 12 }, { 0.0, 0.5, 6 }, { depthMm, 1.0, 1 } };
    const PulseEchoField whole = pulseEchoField(aperture, grid);
    const double onAxis = std::abs(field.lateralAt(0.0, depthMm) * field.elevationalAt(0.0, depthMm));
    std::size_t n = 0;
    for (int e = 0; e < 6; ++e)
    {
      for (int l = 0; l < 12; ++l)
      {
        const double mm = grid.lateral.at(l), across = grid.elevational.at(e);
        const double rangeMm = std::sqrt(depthMm * depthMm + mm * mm + across * across);
        const double product = std::abs(field.lateralAt(mm, rangeMm) * field.elevationalAt(across, rangeMm)) / onAxis;
        const double expected = whole.values()[n++] / whole.values()[0];
        EXPECT_NEAR(product, expected, 0.03) << depthMm << " " << mm << " " << across;
      }
    }
  }
}

TEST(ArrayField, OfAMatrixIsTheSameBothWays)
{
  ArrayAperture aperture = p42Array();
  aperture.elementCount = 48;
  aperture.elevationCount = 48;
  aperture.elementHeightMm = aperture.elementWidthMm;
  const ArrayField field(aperture, 100.0);
  for (const double rangeMm : { 10.0, 40.0, 90.0 })
  {
    for (const double mm : { 0.0, 0.4, 1.7 })
    {
      EXPECT_NEAR(std::abs(field.lateralAt(mm, rangeMm) - field.elevationalAt(mm, rangeMm)), 0.0, 1e-12);
    }
  }
}

TEST(ArrayField, LinesAgreeWithTheDirectSum)
{
  EchoSettings s;
  s.centreFrequencyMHz = 3.6;
  s.fractionalBandwidth = 0.74;
  s.depthMm = 100.0;
  const auto field = std::make_shared<ArrayField>(p42Array(), s.depthMm);
  s.arrayField = field;
  const ArrayBeamView view = field->view();
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<PointScatterer> points;
  for (int n = 0; n < 20000; ++n)
  {
    points.push_back({ { 12.0 * uniform(random), 6.0 * uniform(random), 50.0 + 50.0 * uniform(random) }, 1.0f });
  }
  const PointScatterers sorted(points);
  const ScanLine line = makeLine({ 0, 0, 0 }, { 0, 0, 1 });
  const RfLines rf = formRf({ nullptr, nullptr, &sorted }, { line }, s);
  std::vector<std::complex<double>> expected(std::size_t(s.sampleCount()));
  const ExactPulse pulse = gaussianPulse(s);
  const double twoK = 4.0 * M_PI * 3.6 / 1.54;
  for (const PointScatterer& p : points)
  {
    const double range = glm::length(p.positionMm);
    const ComplexWeight w = arrayBeamWeight(view, float(p.positionMm.x), float(p.positionMm.y), float(range));
    const auto a = std::complex<double>(w.re, w.im) * std::polar(1.0, -twoK * range);
    for (int n = std::max(0, int((range - pulse.reachMm) / s.sampleMm()));
         n < std::min(s.sampleCount(), int((range + pulse.reachMm) / s.sampleMm())); ++n)
    {
      expected[std::size_t(n)] += a * pulse.envelope(n * s.sampleMm() - range);
    }
  }
  EXPECT_LT(nrmse(rf.iq.data(), expected), 0.02); // what is 46 dB below the beam's strongest is left out
}

TEST(ArrayField, RefusesWhatMakesNoSense)
{
  expectContains(errorOf([] { ArrayField(p42Array(), 0.0); }), "depth");
  EchoSettings s;
  s.depthMm = 120.0;
  s.arrayField = std::make_shared<ArrayField>(p42Array(), 60.0);
  expectContains(errorOf([&] { s.validate(); }), "120");
}

} // namespace
