#include "FieldScenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace sono;
using namespace sono::test;

constexpr double attenuationDb = 0.5; // /(cm MHz)

EchoSettings p42Pulse(double depthMm)
{
  EchoSettings s;
  s.centreFrequencyMHz = 3.6;
  s.fractionalBandwidth = 0.74;
  s.depthMm = depthMm;
  return s;
}

double exponentAt(double depthMm)
{
  return 2.0 * attenuationDb * depthMm / 10.0 / 8.685889638065037;
}

/// A uniform phantom's line.
TracedLines uniformPhantom(double depthMm, double frequencyMHz)
{
  TracedLines traced;
  traced.lineCount = 1;
  traced.binMm = 0.25;
  traced.binCount = int(std::ceil(depthMm / traced.binMm));
  for (int b = 0; b < traced.binCount; ++b)
  {
    const double exponent = exponentAt((b + 0.5) * traced.binMm);
    traced.intensity.push_back(float(std::exp(-exponent * frequencyMHz)));
    traced.attenuationNpPerMHz.push_back(float(exponent));
  }
  return traced;
}

const std::vector<ScanLine> oneLine{ { { 0, 0, 0 }, { 0, 0, 1 }, { 1, 0, 0 }, { 0, 1, 0 } } };

/// IQ of a point at a depth by the integral over its spectrum, exp(-(f - f0)^2 / (2 s_f^2)) exp(-B f), in double.
std::vector<std::complex<double>> exactIq(const EchoSettings& s, double depthMm)
{
  const double spectrum = 1.54 / (4.0 * M_PI * pulseSigmaMm(s.centreFrequencyMHz, s.fractionalBandwidth)); // MHz
  const double f0 = s.centreFrequencyMHz;
  const double exponent = exponentAt(depthMm);
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
    const PointScatterers point({ { { 0.0, 0.0, depthMm }, 1.0f } });
    const RfLines rf = formRf({ nullptr, &traced, &point }, oneLine, s);
    EXPECT_LT(nrmse(rf.iq.data(), exactIq(s, depthMm)), 0.05) << depthMm; // B changes a little within the pulse
  }
}

TEST(Downshift, FrequencyAndLevelAt12Cm)
{
  // Section 12.4: 1.83 MHz and 10.6 dB.
  const EchoSettings s = p42Pulse(130.0);
  TracedLines traced = uniformPhantom(s.depthMm, s.centreFrequencyMHz);
  const PointScatterers point({ { { 0.0, 0.0, 120.0 }, 1.0f } });
  const RfLines rf = formRf({ nullptr, &traced, &point }, oneLine, s);
  const auto at = std::size_t(std::lround(120.0 / rf.sampleMm));
  const double turn = std::arg(std::complex<double>(rf.iq[at + 3]) * std::conj(std::complex<double>(rf.iq[at - 3])));
  const double frequencyMHz = s.centreFrequencyMHz + turn / (6.0 * rf.sampleMm) * 1.54 / (4.0 * M_PI);
  EXPECT_NEAR(frequencyMHz, 1.83, 0.02 * 1.83);
  const double with = std::abs(rf.iq[at]);
  traced.attenuationNpPerMHz.clear();
  const double without = std::abs(formRf({ nullptr, &traced, &point }, oneLine, s).iq[at]);
  EXPECT_NEAR(20.0 * std::log10(with / without), 10.6, 0.1);
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
  const PointScatterers point({ { { 0.0, 0.0, 60.0 }, 1.0f } });
  const RfLines rf = formRf({ nullptr, &traced, &point }, oneLine, s);
  const auto at = std::size_t(std::lround(60.0 / rf.sampleMm));
  const double turn = std::arg(std::complex<double>(rf.iq[at + 3]) * std::conj(std::complex<double>(rf.iq[at - 3])));
  EXPECT_NEAR(s.centreFrequencyMHz + turn / (6.0 * rf.sampleMm) * 1.54 / (4.0 * M_PI), 1.133, 0.02);
}

} // namespace
