#include "ErrorText.h"
#include "Probe/PulseFile.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

constexpr double pi = 3.141592653589793;
constexpr double speedMmPerUs = 1.54;

/// exp(-t^2 / (2 s^2)) cos(2 pi f t + phase) at uneven fractions of its period.
SampledPulse gaussian(double frequencyMHz, double sigmaUs, double phase, double scale, double shiftUs)
{
  SampledPulse pulse;
  pulse.stepUs = 0.0371;
  pulse.startUs = shiftUs - 40 * pulse.stepUs + 0.009;
  for (int n = 0; n < 81; ++n)
  {
    const double t = pulse.startUs + n * pulse.stepUs - shiftUs;
    pulse.amplitude.push_back(scale * std::exp(-0.5 * t * t / (sigmaUs * sigmaUs)) *
                              std::cos(2.0 * pi * frequencyMHz * t + phase));
  }
  return pulse;
}

std::complex<double> expected(double r, double sigmaUs, double phase, double shiftUs, double offsetMHz)
{
  const double t = 2.0 * r / speedMmPerUs - shiftUs;
  // p(t) = Re(envelope exp(i 2 pi f (t + shift))), so the shift turns the carrier, too.
  return std::exp(-0.5 * t * t / (sigmaUs * sigmaUs)) * std::polar(1.0, phase + 2.0 * pi * offsetMHz * t);
}

class PulseFile : public ::testing::Test
{
protected:
  std::string refusal(const std::string& text) const
  {
    std::ofstream(path) << text;
    const std::string message = errorOf([&] { readPulse(path); });
    expectContains(message, "pulse.csv");
    return message;
  }

  const sono::testing::TemporaryFolder folder;
  const std::string path = folder.file("pulse.csv");
};

} // namespace

TEST_F(PulseFile, GaussianFromAFileAgreesWithItsClosedForm)
{
  const double sigmaUs = 0.17; // about 60 % bandwidth at 3.6 MHz
  for (const double phase : { 0.0, 1.1 })
  {
    const SampledPulse made = gaussian(3.6, sigmaUs, phase, 250.0, 0.0);
    {
      std::ofstream stream(path);
      stream.precision(15);
      stream << "# hydrophone\ntime_us, amplitude\n";
      for (std::size_t n = 0; n < made.amplitude.size(); ++n)
      {
        stream << made.startUs + double(n) * made.stepUs << ", " << made.amplitude[n] << "\n";
      }
    }
    const SampledPulse pulse = readPulse(path);
    for (const double sampleMm : { 0.0154, 0.0616 })
    {
      const auto envelope = pulseBaseband(pulse, 3.6, sampleMm);
      ASSERT_EQ(envelope.size() % 2, 1u);
      const int half = int(envelope.size() / 2);
      EXPECT_GT(half * sampleMm, 4.0 * sigmaUs * speedMmPerUs / 2.0);
      for (int n = -half; n <= half; ++n)
      {
        const std::complex<double> got = envelope[std::size_t(half + n)];
        EXPECT_LT(std::abs(got - expected(n * sampleMm, sigmaUs, phase, 0.0, 0.0)), 1e-3) << n;
      }
    }
  }
}

TEST_F(PulseFile, TimeZeroIsTheScatterersPlaceAndTheCarrierIsTheGivenOne)
{
  const double sigmaUs = 0.17;
  const double shiftUs = 0.25;
  const SampledPulse pulse = gaussian(3.2, sigmaUs, 0.4, 0.01, shiftUs); // demodulated with 3.6 MHz
  const double sampleMm = 0.02;
  const auto envelope = pulseBaseband(pulse, 3.6, sampleMm);
  const int half = int(envelope.size() / 2);
  for (int n = -half; n <= half; ++n)
  {
    const double r = n * sampleMm;
    const auto turned = expected(r, sigmaUs, 0.4, shiftUs, -0.4) * std::polar(1.0, -2.0 * pi * 3.6 * shiftUs);
    EXPECT_LT(std::abs(std::complex<double>(envelope[std::size_t(half + n)]) - turned), 1e-3) << n;
  }
  // Behind the scatterer is later.
  EXPECT_NEAR(std::abs(envelope[std::size_t(half + std::lround(shiftUs * speedMmPerUs / 2.0 / sampleMm))]), 1.0, 2e-3);
}

TEST_F(PulseFile, UndoesTheLossOfALinearSplit)
{
  // Amplitudes at many places between two samples, split linearly, then convolved: on average, the pulse itself.
  const double sigmaUs = 0.17;
  const SampledPulse pulse = gaussian(3.6, sigmaUs, 0.0, 1.0, 0.0);
  const double sampleMm = 0.05; // 2.6 samples a sigma
  const auto envelope = pulseBaseband(pulse, 3.6, sampleMm, sampleMm);
  const auto plain = pulseBaseband(pulse, 3.6, sampleMm);
  const auto at = [&](const std::vector<std::complex<float>>& e, int n) {
    const int index = int(e.size() / 2) + n;
    return index >= 0 && index < int(e.size()) ? std::complex<double>(e[std::size_t(index)]) : std::complex<double>();
  };
  const auto averageError = [&](const std::vector<std::complex<float>>& e) {
    // Correlated with the true pulse of each place, in baseband at that place
    std::complex<double> sum = 0.0;
    double energy = 0.0;
    for (int place = 0; place < 100; ++place)
    {
      const double f = (place + 0.5) / 100.0;
      for (int n = -20; n <= 20; ++n)
      {
        const auto exact = expected((n - f) * sampleMm, sigmaUs, 0.0, 0.0, 0.0);
        sum += std::conj(exact) * ((1.0 - f) * at(e, n) + f * at(e, n - 1));
        energy += std::norm(exact);
      }
    }
    return std::abs(sum / energy - 1.0);
  };
  EXPECT_LT(averageError(envelope), 5e-4);
  EXPECT_GT(averageError(plain), 5e-3);
}

TEST_F(PulseFile, ErrorsNameFileAndLine)
{
  const std::string head = "time_us,amplitude\n";
  expectContains(refusal("time,amplitude\n0,1\n"), "time_us");
  expectContains(refusal(head + "0,0\n0.1,1\n0.2,0\n"), "3 samples");
  expectContains(refusal(head + "0,0\n0.1,1\n0.1,2\n0.2,1\n0.3,0\n"), "line 4: the time");
  expectContains(refusal(head + "0,0\n0.1,1\n0.25,1\n0.3,0\n"), "line 4: the times are not evenly spaced");
  expectContains(refusal(head + "0.3,0\n0.2,1\n0.1,1\n0,0\n"), "does not ascend");
  expectContains(refusal(head + "0,0\n0.1,nan\n0.2,1\n0.3,0\n"), "line 3: 'nan' is no finite number");
  expectContains(refusal(head + "0,0\n0.1,x\n0.2,1\n0.3,0\n"), "line 3: 'x'");
  expectContains(refusal(head + "0,0\n0.1,0\n0.2,0\n0.3,0\n"), "all amplitudes are zero");
}

TEST_F(PulseFile, RefusesSamplingThatCannotCarryIt)
{
  const SampledPulse pulse = gaussian(3.6, 0.17, 0.0, 1.0, 0.0);
  expectContains(errorOf([&] { pulseBaseband(pulse, 0.0, 0.02); }), "centre frequency (MHz) is 0");
  expectContains(errorOf([&] { pulseBaseband(pulse, 3.6, 0.0); }), "sampleMm is 0");
  expectContains(errorOf([&] { pulseBaseband(pulse, 3.6, 0.02, 1.0); }), "splitMm is 1");
  expectContains(errorOf([&] { pulseBaseband(pulse, 3.6, 0.5); }), "beyond 0.77 MHz");
  expectContains(errorOf([&] { pulseBaseband(pulse, 360.0, 0.02); }), "centre frequency");
  SampledPulse late = pulse;
  late.startUs = 1e6;
  expectContains(errorOf([&] { pulseBaseband(late, 3.6, 0.02); }), "nearer to time 0");
}
