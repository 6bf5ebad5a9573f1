#include "BeamFigures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace sono;
using namespace sono::test;

EchoSettings p42Pulse(double depthMm)
{
  EchoSettings s;
  s.centreFrequencyMHz = 3.6;
  s.fractionalBandwidth = 0.74;
  s.samplingMHz = 50.0; // frequencies are told by neighbouring samples
  s.depthMm = depthMm;
  return s;
}

/// IQ of a point at a depth by the integral over its spectrum, exp(-(f - f0)^2 / (2 s_f^2)) exp(-B f), in double.
std::vector<std::complex<double>> exactIq(const EchoSettings& s, double depthMm)
{
  const double spectrum = 1.54 / (4.0 * M_PI * pulseSigmaMm(s.centreFrequencyMHz, s.fractionalBandwidth)); // MHz
  const double f0 = s.centreFrequencyMHz;
  const double exponent = uniformExponentAt(depthMm);
  std::vector<std::complex<double>> iq(std::size_t(s.sampleCount()));
  const double step = spectrum / 40.0;
  for (double f = f0 - 9.0 * spectrum; f < f0 + 6.0 * spectrum; f += step)
  {
    const double size =
      std::exp(-0.5 * std::pow((f - f0) / spectrum, 2) - exponent * f) * step / (std::sqrt(2.0 * M_PI) * spectrum);
    for (std::size_t n = 0; n < iq.size(); ++n)
    {
      const double r = double(n) * s.sampleMm();
      if (std::abs(r - depthMm) < 3.0)
      {
        iq[n] += std::polar(size, 4.0 * M_PI / 1.54 * (f * (r - depthMm) - f0 * r));
      }
    }
  }
  return iq;
}

TEST(Downshift, APointsEchoIsThatOfItsSpectrum)
{
  const EchoSettings s = p42Pulse(130.0);
  const TracedLines traced = uniformPhantom(s.depthMm, s.centreFrequencyMHz);
  for (const double depthMm : { 20.0, 60.0, 120.0 })
  {
    const RfLines rf = pointEcho(traced, s, depthMm);
    EXPECT_LT(nrmse(rf.iq.data(), exactIq(s, depthMm)), 0.05) << depthMm; // B changes a little within the pulse
  }
}

TEST(Downshift, FrequencyAndLevelAt12Cm)
{
  // Section 12.4: 1.83 MHz and 10.6 dB.
  const EchoSettings s = p42Pulse(130.0);
  TracedLines traced = uniformPhantom(s.depthMm, s.centreFrequencyMHz);
  const RfLines rf = pointEcho(traced, s, 120.0);
  EXPECT_NEAR(frequencyAtMHz(rf, 120.0), 1.83, 0.02 * 1.83);
  EXPECT_LT(downshiftError(), 0.02);
  const auto at = std::size_t(std::lround(120.0 / rf.sampleMm));
  traced.attenuationNpPerMHz.clear();
  const double without = std::abs(pointEcho(traced, s, 120.0).iq[at]);
  EXPECT_NEAR(20.0 * std::log10(std::abs(rf.iq[at]) / without), 10.6, 0.1);
}

TEST(Downshift, OffChangesNothing)
{
  const EchoSettings s = p42Pulse(60.0);
  TracedLines traced = uniformPhantom(s.depthMm, s.centreFrequencyMHz);
  std::fill(traced.attenuationNpPerMHz.begin(), traced.attenuationNpPerMHz.end(), 0.0f);
  const auto box = scatteringBox({ 10, 10, 60 });
  const std::vector<ScanLine> lines{ makeLine({ 5, 5, 0 }, { 0, 0, 1 }) };
  const auto with = formRf(*box, lines, traced, s);
  traced.attenuationNpPerMHz.clear();
  EXPECT_EQ(with.iq, formRf(*box, lines, traced, s).iq);
}

TEST(Downshift, TheCentreDoesNotFallBelowTheSpectrumsWidth)
{
  EchoSettings s = p42Pulse(130.0);
  TracedLines traced = uniformPhantom(s.depthMm, s.centreFrequencyMHz);
  for (float& b : traced.attenuationNpPerMHz)
  {
    b = 1000.0f; // bone all the way
  }
  EXPECT_NEAR(frequencyAtMHz(pointEcho(traced, s, 60.0), 60.0), 1.133, 0.02);
}

} // namespace
