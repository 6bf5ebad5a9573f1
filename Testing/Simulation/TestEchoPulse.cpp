#include "Core/SoundSpeed.h"
#include "EchoScenes.h"
#include "ErrorText.h"
#include "FieldScenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace sono;
using namespace sono::test;
using sono::testing::errorOf;
using sono::testing::expectContains;

/// A pulse with a closed form: a carrier that is not the centre frequency, a chirp, and a place and phase of its own.
///   p(t) = exp(-(t - t0)^2 / (2 s^2)) cos(2 pi f (t - t0) + q (t - t0)^2 + phase)
struct ChirpedPulse
{
  double frequencyMHz = 3.3;
  double sigmaUs = 0.22;
  double chirpPerUs2 = 4.0;
  double phase = 0.7;
  double delayUs = 0.15;

  std::complex<double> analytic(double timeUs) const
  {
    const double t = timeUs - delayUs;
    return std::polar(std::exp(-0.5 * t * t / (sigmaUs * sigmaUs)),
                      2.0 * M_PI * frequencyMHz * t + chirpPerUs2 * t * t + phase);
  }
  std::shared_ptr<const SampledPulse> sampled(double scale) const
  {
    SampledPulse pulse;
    pulse.stepUs = 0.02;
    pulse.startUs = delayUs - 1.4;
    for (int n = 0; n <= 140; ++n)
    {
      pulse.amplitude.push_back(scale * analytic(pulse.startUs + n * pulse.stepUs).real());
    }
    return std::make_shared<SampledPulse>(pulse);
  }
  ExactPulse exact(const EchoSettings& s) const
  {
    const double f = s.centreFrequencyMHz;
    return { [*this, f](double r) {
              const double t = 2.0 * r / assumedSoundSpeedMmPerUs;
              return analytic(t) * std::polar(1.0, -2.0 * M_PI * f * t);
            },
             2.0 };
  }
};

double gaussianWeight(const EchoSettings& s, double l, double e)
{
  return std::exp(-0.5 * (std::pow(l / s.lateralSigmaMm, 2) + std::pow(e / s.elevationalSigmaMm, 2)));
}

TEST(EchoPulse, FromAFileAgreesWithTheDirectSum)
{
  SceneS1 s1(100000);
  const ChirpedPulse pulse;
  s1.settings.pulse = pulse.sampled(250.0);
  const PointScatterers sorted(s1.points);
  for (const double samplingMHz : { 50.0, 12.5 })
  {
    s1.settings.samplingMHz = samplingMHz;
    const RfLines rf = formRf({ nullptr, nullptr, &sorted }, s1.lines, s1.settings);
    for (const int line : { 3, 64, 120 })
    {
      const auto exact = directIq(
        s1.points, s1.lines[std::size_t(line)], s1.settings,
        [&](double l, double e, double) { return gaussianWeight(s1.settings, l, e); }, pulse.exact(s1.settings));
      EXPECT_LT(nrmse(rf.iq.data() + std::size_t(line) * exact.size(), exact), samplingMHz == 50.0 ? 1e-3 : 1e-2)
        << "line " << line << " at " << samplingMHz << " MHz";
    }
  }
}

TEST(EchoPulse, AndFieldTogetherAgreeWithTheDirectSum)
{
  SceneS1 s1(60000, 5);
  const ChirpedPulse pulse;
  s1.settings.pulse = pulse.sampled(1.0);
  ArrayAperture aperture;
  s1.settings.field =
    std::make_shared<PulseEchoField>(pulseEchoField(aperture, suggestedFieldGrid(aperture, s1.settings.depthMm)));
  const PointScatterers sorted(s1.points);
  const RfLines rf = formRf({ nullptr, nullptr, &sorted }, { s1.lines[40] }, s1.settings);
  const auto exact = directIq(
    s1.points, s1.lines[40], s1.settings,
    [&](double l, double e, double r) { return trilinear(*s1.settings.field, l, e, r); }, pulse.exact(s1.settings));
  EXPECT_LT(nrmse(rf.iq.data(), exact), 1e-3);
}

TEST(EchoPulse, LiesBehindItsScattererAndNearTheEndsOfTheLine)
{
  // Cut by the face, in the middle, and from below the image, into which only a pulse that starts early reaches.
  EchoSettings s;
  s.centreFrequencyMHz = 3.6;
  s.depthMm = 30.0;
  ChirpedPulse pulse;
  const ScanLine line = makeLine({ 0, 0, 0 }, { 0, 0, 1 });
  for (const double delayUs : { 0.3, -0.3 })
  {
    pulse.delayUs = delayUs;
    s.pulse = pulse.sampled(3.0);
    for (const double depthMm : { 0.02, 15.0037, 30.1 })
    {
      const std::vector<PointScatterer> point{ { { 0.0, 0.0, depthMm }, 1.0f } };
      const PointScatterers sorted(point);
      const RfLines rf = formRf({ nullptr, nullptr, &sorted }, { line }, s);
      const auto exact = directIq(
        point, line, s, [](double, double, double) { return 1.0; }, pulse.exact(s));
      EXPECT_LT(nrmse(rf.iq.data(), exact), 3e-3) << depthMm << " mm, " << delayUs << " us";
    }
  }
}

TEST(EchoPulse, ThatIsTheGaussianChangesNothing)
{
  SceneS1 s1(20000);
  const PointScatterers sorted(s1.points);
  const RfLines own = formRf({ nullptr, nullptr, &sorted }, s1.lines, s1.settings);
  ChirpedPulse gaussian{ 3.6, 0.0, 0.0, 0.0, 0.0 };
  gaussian.sigmaUs = 2.0 * pulseSigmaMm(3.6, 0.6) / assumedSoundSpeedMmPerUs;
  s1.settings.pulse = gaussian.sampled(0.01);
  const RfLines fromFile = formRf({ nullptr, nullptr, &sorted }, s1.lines, s1.settings);
  const std::vector<std::complex<double>> reference(own.iq.begin(), own.iq.end());
  EXPECT_LT(nrmse(fromFile.iq.data(), reference), 1e-3);
}

TEST(EchoPulse, LeavesTheLevelOfTissueWhereItWas)
{
  const auto scene = scatteringBox({ 30, 20, 80 });
  EchoSettings s;
  s.centreFrequencyMHz = 3.6;
  s.depthMm = 75.0;
  const auto lines = parallelLines(8, { 6.0, 10.0, 0.5 }, 2.5);
  s.pulse = ChirpedPulse{}.sampled(17.0);
  const TracedLines traced = fullyLit(lines.size(), s, InterfaceModel::Amadou2024);
  const RfLines rf = formRf({ scene.get(), &traced, nullptr }, lines, s);
  double squares = 0.0;
  for (const std::complex<float> v : rf.iq)
  {
    squares += std::norm(v);
  }
  EXPECT_NEAR(10.0 * std::log10(squares / double(rf.iq.size())), s.scattererLevelDb,
              0.4); // some 1500 independent samples
}

TEST(EchoPulse, ThatMakesNoSenseIsRefused)
{
  const auto refusal = [](const SampledPulse& pulse) {
    EchoSettings s;
    s.pulse = std::make_shared<SampledPulse>(pulse);
    return errorOf([&] { formRf({}, { makeLine({ 0, 0, 0 }, { 0, 0, 1 }) }, s); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expectContains(refusal({}), "sampled pulse");
  expectContains(refusal({ 0.0, 0.0, { 1.0, 2.0, 1.0, 0.0 } }), "sampled pulse");
  expectContains(refusal({ 0.0, 0.02, { 1.0, nan, 1.0, 0.0 } }), "sampled pulse");
  expectContains(refusal({ nan, 0.02, { 1.0, 2.0, 1.0, 0.0 } }), "sampled pulse");
  expectContains(refusal({ 0.0, 0.02, { 0.0, 0.0, 0.0, 0.0 } }), "only zeros");
  // Nanoseconds instead of microseconds: far outside of what the samples carry.
  SampledPulse slow = *ChirpedPulse{}.sampled(1.0);
  slow.stepUs *= 1e-3;
  expectContains(refusal(slow), "raise Sampling (MHz)");
}

} // namespace
