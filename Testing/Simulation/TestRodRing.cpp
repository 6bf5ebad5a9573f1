#include "Echo/EchoSettings.h"
#include "Echo/Pulse.h"
#include "Echo/RodRing.h"
#include "TestScenes.h"
#include "Trace/Targets.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <vector>

// What rings within a rod, against the boundary conditions at its surface, solved order by order.

namespace sono::test {
namespace {

using Complex = std::complex<double>;
using Row = std::array<Complex, 4>;

constexpr double outsideSpeed = 1.54; // mm / us
constexpr double outsideImpedance = 1.63;

struct Wave
{
  double value, slope, bend; // of J_n, by its argument

  Wave(int n, double x)
    : value(std::cyl_bessel_j(double(n), x))
    , slope(n == 0 ? -std::cyl_bessel_j(1.0, x) : std::cyl_bessel_j(n - 1.0, x) - n / x * value)
    , bend(-slope / x - (1.0 - double(n) * n / (x * x)) * value) // Bessel's equation
  {
  }
};

/// Of three equations for three unknowns, by elimination; the first.
Complex solve(std::array<Row, 3> m)
{
  for (std::size_t c = 0; c < 3; ++c)
  {
    std::size_t best = c;
    for (std::size_t r = c + 1; r < 3; ++r)
    {
      best = std::abs(m[r][c]) > std::abs(m[best][c]) ? r : best;
    }
    std::swap(m[c], m[best]);
    for (std::size_t r = 0; r < 3; ++r)
    {
      const Complex factor = r == c ? 0.0 : m[r][c] / m[c][c];
      for (std::size_t k = 0; k < 4; ++k)
      {
        m[r][k] -= factor * m[c][k];
      }
    }
  }
  return m[0][3] / m[0][0];
}

/// A plane wave of pressure 1 meets the rod: A_n of the outgoing wave, exp(-i w t). Pressure and radial displacement
/// pass on, and nothing shears the surface.
Complex scattered(int n, const Rod& rod, double frequencyMHz)
{
  const double w = 2.0 * M_PI * frequencyMHz;
  const double a = rod.radiusMm;
  const double k = w / outsideSpeed;
  const double cL = 1e-3 * rod.soundSpeedMPerS;
  const double cS = 1e-3 * rod.shearSpeedMPerS;
  const double kL = w / cL;
  const double kS = w / cS;
  const double density = rod.impedanceMRayl / cL;
  const double outside = outsideImpedance / outsideSpeed;
  const double mu = density * cS * cS;
  const double lambda = density * cL * cL - 2.0 * mu;
  const Wave in(n, k * a);
  const Wave l(n, kL * a);
  const Wave s(n, kS * a);
  const double y = std::cyl_neumann(double(n), k * a);
  const double ySlope = n == 0 ? -std::cyl_neumann(1.0, k * a) : std::cyl_neumann(n - 1.0, k * a) - n / (k * a) * y;
  const Complex out(in.value, y);
  const Complex outSlope(in.slope, ySlope);
  const double move = k / (outside * w * w); // of a pressure's slope
  const double m = n;
  return solve({ { { -move * outSlope, kL * l.slope, m / a * s.value, move * in.slope },
                   { out, -lambda * kL * kL * l.value + 2.0 * mu * kL * kL * l.bend,
                     2.0 * mu * m * (kS * s.slope / a - s.value / (a * a)), -in.value },
                   { 0.0, 2.0 * m / a * (l.value / a - kL * l.slope),
                     kS * s.slope / a - m * m / (a * a) * s.value - kS * kS * s.bend, 0.0 } } });
}

/// Far behind, against r sqrt(a / 2), the front's by rays, as seen from the front; exp(i w t).
Complex backscattered(const Rod& rod, double frequencyMHz)
{
  const double x = 2.0 * M_PI * frequencyMHz * rod.radiusMm / outsideSpeed;
  Complex sum = 0.0;
  for (int n = 0; n < int(x + 4.0 * std::cbrt(x) + 8.0); ++n)
  {
    sum += (n == 0 ? 1.0 : 2.0) * (n % 2 == 0 ? 1.0 : -1.0) * scattered(n, rod, frequencyMHz);
  }
  const double r = (rod.impedanceMRayl - outsideImpedance) / (rod.impedanceMRayl + outsideImpedance);
  return std::conj(sum * std::polar(2.0 / (std::sqrt(M_PI * x) * r), 2.0 * x - 0.25 * M_PI));
}

Rod titanium(double diameterMm)
{
  return { 0.5 * diameterMm, 27.3, 6070.0, 3035.0 };
}

TEST(RodRing, IsWhatTheBoundaryConditionsSay)
{
  const Rod steel{ 0.6, 46.0, 5900.0, 3200.0 };
  for (const Rod& rod : { titanium(0.82), titanium(1.27), steel })
  {
    for (double frequency = 0.6; frequency < 12.0; frequency += 0.37)
    {
      const Complex exact = backscattered(rod, frequency);
      EXPECT_LT(std::abs(rodEcho(rod, frequency) - exact), 1e-6 * std::abs(exact)) << frequency << " MHz";
    }
  }
}

/// The mean over many frequencies is what comes first: the front, and nothing else.
TEST(RodRing, TheFrontIsASurfacesOwn)
{
  Complex mean = 0.0;
  int count = 0;
  for (double frequency = 10.0; frequency < 40.0; frequency += 0.013)
  {
    mean += rodEcho(titanium(1.2), frequency);
    ++count;
  }
  mean /= count;
  EXPECT_NEAR(mean.real(), 1.0, 0.03);
  EXPECT_NEAR(mean.imag(), 0.0, 0.03);
}

TEST(RodRing, ThinAndThickRodsHaveNumbersToo)
{
  for (const double diameterMm : { 0.1, 1.0, 10.0 })
  {
    for (const double frequency : { 0.1, 1.0, 10.0, 40.0, 100.0 })
    {
      const double level = std::abs(rodEcho(titanium(diameterMm), frequency));
      EXPECT_TRUE(std::isfinite(level) && level < 100.0) << diameterMm << " mm, " << frequency << " MHz: " << level;
    }
  }
  for (const double frequency : { 20.0, 60.0 })
  {
    const Complex exact = backscattered(titanium(1.27), frequency);
    EXPECT_LT(std::abs(rodEcho(titanium(1.27), frequency) - exact), 1e-6 * std::abs(exact)) << frequency << " MHz";
  }
}

TEST(RodRing, OnlyHardRodsRing)
{
  const auto target = [](double impedance, double speed, double diameterMm) {
    return TargetSurface{ "rod", makeTissue("rod", impedance, speed, 0.1), {}, {}, diameterMm };
  };
  EXPECT_TRUE(ringingRod(target(27.3, 6070.0, 0.82)));
  EXPECT_FALSE(ringingRod(target(27.3, 6070.0, 0.0)));
  EXPECT_FALSE(ringingRod(target(1.7, 1600.0, 1.0)));
}

/// One point of a surface, its ring by the taps, and the pulse: its envelope is that of the exact spectrum.
TEST(RodRing, ALineHearsItAsOneOfTheExactSpectrumWould)
{
  for (const double centre : { 2.5, 7.2 })
  {
    EchoSettings settings;
    settings.centreFrequencyMHz = centre;
    settings.fractionalBandwidth = 0.6;
    settings.samplingMHz = 60.0;
    const Rod rod = titanium(1.2);
    const RodRing ring = rodRing(rod, settings);
    constexpr int at = 400;
    constexpr int samples = 1600;
    std::vector<float> surface(2 * samples, 0.0f);
    surface[2 * at] = 1.0f;
    std::vector<float> line(2 * samples, 0.0f);
    addRung(ring, surface, line);

    const double sigmaMHz = 1.54 / (4.0 * M_PI * pulseSigmaMm(centre, settings.fractionalBandwidth));
    const double sampleUs = 2.0 * settings.sampleMm() / 1.54;
    constexpr int frequencies = 2000; // 70 us and more until it repeats itself
    std::vector<Complex> made(frequencies), exact(frequencies);
    for (int i = 0; i < frequencies; ++i)
    {
      const double frequency = centre + sigmaMHz * 8.0 * ((i + 0.5) / frequencies - 0.5);
      const double pulse = std::exp(-0.5 * std::pow((frequency - centre) / sigmaMHz, 2));
      exact[std::size_t(i)] = frequency > 0.05 ? pulse * backscattered(rod, frequency) : 0.0;
      for (int s = 0; s < samples; ++s)
      {
        const Complex value(line[2 * std::size_t(s)], line[2 * std::size_t(s) + 1]);
        if (value != 0.0)
        {
          made[std::size_t(i)] += pulse * value * std::polar(1.0, -2.0 * M_PI * frequency * (s - at) * sampleUs);
        }
      }
    }
    const auto envelope = [&](const std::vector<Complex>& spectrum, double lateMm) {
      Complex sum = 0.0;
      for (int i = 0; i < frequencies; ++i)
      {
        const double frequency = centre + sigmaMHz * 8.0 * ((i + 0.5) / frequencies - 0.5);
        sum += spectrum[std::size_t(i)] * std::polar(1.0 / frequencies, 4.0 * M_PI * frequency * lateMm / 1.54);
      }
      return std::abs(sum);
    };
    const double front = envelope(exact, 0.0);
    double loudest = 0.0;
    for (double lateMm = 0.0; lateMm < 9.0; lateMm += 0.05)
    {
      const double here = envelope(made, lateMm) / front;
      const double wanted = envelope(exact, lateMm) / front;
      if (lateMm < 3.5) // then it fades
      {
        EXPECT_NEAR(here, wanted, 0.01) << lateMm << " mm at " << centre;
      }
      EXPECT_LT(here, wanted + 0.01) << lateMm << " mm at " << centre;
      loudest = lateMm > 4.0 ? std::max(loudest, here) : loudest;
    }
    EXPECT_GT(20.0 * std::log10(loudest), -40.0); // a comet's tail
  }
}

} // namespace
} // namespace sono::test
