#include "Echo/RodRing.h"

#include "Core/KeptByNumbers.h"
#include "Core/SoundSpeed.h"
#include "Echo/EchoSettings.h"
#include "Echo/Pulse.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
/// Behind the front, and how far it fades up to there (chosen): what rings runs along the rod out of the beam, and the
/// scanner's focus has moved on; the closed form is of a wave as wide as the rod is long.
constexpr double ringsMm = 12.0;
constexpr double fadesMm = 8.0;
constexpr double bandReach = 2.8;     // deviations of the pulse's spectrum, beyond which there is none
constexpr double bandWhole = 2.0;     // up to here nothing is taken off it
constexpr double lowestShare = 0.1;   // of the centre frequency
constexpr double mostRelative = 10.0; // of a wavelength as long as the rod is wide the front's own echo is no measure
constexpr int leadTaps = 8;           // a band's edge rings before as well
constexpr int frequencies = 1024;

/// J_n of orders [0, count], downwards from where it is nothing, which is stable (Miller).
std::vector<double> besselJ(int count, double x)
{
  constexpr double almostNothing = 1e-250;
  const int first = 2 * ((count + int(x) + 30) / 2);
  std::vector<double> j(std::size_t(first) + 2, 0.0);
  j[std::size_t(first)] = almostNothing;
  double sum = 0.0;
  for (int n = first; n > 0; --n)
  {
    const std::size_t at = std::size_t(n);
    sum += n % 2 == 0 ? 2.0 * j[at] : 0.0;
    j[at - 1] = 2.0 * n / x * j[at] - j[at + 1];
    if (std::abs(j[at - 1]) > 1.0 / almostNothing)
    {
      for (std::size_t k = at - 1; k < j.size(); ++k)
      {
        j[k] *= almostNothing; // the highest orders are nothing
      }
      sum *= almostNothing;
    }
  }
  sum += j[0]; // 1 of all even ones
  for (double& value : j)
  {
    value /= sum;
  }
  j.resize(std::size_t(count) + 1);
  return j;
}

/// The same of N_n, upwards.
std::vector<double> besselN(int count, double x)
{
  std::vector<double> y{ std::cyl_neumann(0.0, x), std::cyl_neumann(1.0, x) };
  for (int n = 1; n < count; ++n)
  {
    y.push_back(2.0 * n / x * y[std::size_t(n)] - y[std::size_t(n) - 1]);
  }
  return y;
}

/// Faran's tan alpha_n, -x J_n'(x) / J_n(x), and with the other function tan beta_n.
double tanOf(const std::vector<double>& of, int n, double x)
{
  const double value = of[std::size_t(n)];
  return std::isnormal(value) ? x * of[std::size_t(n) + 1] / value - n : -double(n); // where J_n is nothing
}

/// Faran's tan Phi_n, by the functions at k a of the two waves within, without the densities.
double innerTan(int n, const std::vector<double>& j1, double x1, const std::vector<double>& j2, double x2)
{
  const double n2 = double(n) * n;
  const double half = 0.5 * x2 * x2;
  const double a1 = tanOf(j1, n, x1);
  const double a2 = tanOf(j2, n, x2);
  const double above = a1 / (a1 + 1.0) - n2 / (a2 + n2 - half);
  const double below = (a1 + n2 - half) / (a1 + 1.0) - n2 * (a2 + 1.0) / (a2 + n2 - half);
  return half * above / below;
}

double reflectionOf(const Rod& rod)
{
  return (rod.impedanceMRayl - aroundRodsMRayl) / (rod.impedanceMRayl + aroundRodsMRayl);
}

RodRing makeRing(const Rod& rod, const EchoSettings& settings)
{
  const double sampleUs = 2.0 * settings.sampleMm() / assumedSoundSpeedMmPerUs;
  const double centre = settings.centreFrequencyMHz;
  // 2 k s of a pulse with s mm of deviation: of its spectrum the deviation is a share of 1 / that.
  const double sigmaMHz = assumedSoundSpeedMmPerUs / (4.0 * pi * pulseSigmaMm(centre, settings.fractionalBandwidth));
  RodRing ring;
  ring.stride = std::max(1, int(1.0 / (2.0 * bandReach * sigmaMHz * sampleUs)));
  ring.lead = leadTaps;
  const double tapUs = ring.stride * sampleUs;
  const double bandMHz = 1.0 / tapUs;
  const auto frequencyMHz = [&](int i) { return centre + bandMHz * ((i + 0.5) / frequencies - 0.5); };
  std::vector<std::complex<double>> spectrum(frequencies);
  for (int i = 0; i < frequencies; ++i)
  {
    const double frequency = frequencyMHz(i);
    const double beyond = (std::abs(frequency - centre) / sigmaMHz - bandWhole) / (bandReach - bandWhole);
    if (beyond < 1.0 && frequency > lowestShare * centre)
    {
      const double left = beyond > 0.0 ? 0.5 + 0.5 * std::cos(pi * beyond) : 1.0;
      std::complex<double> rung = rodEcho(rod, frequency) - 1.0;
      rung *= std::min(1.0, mostRelative / std::max(std::abs(rung), 1e-30));
      spectrum[std::size_t(i)] = left * rung;
    }
  }
  const double tapMm = ring.stride * settings.sampleMm();
  const int count = leadTaps + int(ringsMm / tapMm) + 1;
  for (int j = 0; j < count; ++j)
  {
    const double lateUs = (j - leadTaps) * tapUs;
    const double lateMm = (j - leadTaps) * tapMm;
    std::complex<double> tap = 0.0;
    for (int i = 0; i < frequencies; ++i)
    {
      tap += spectrum[std::size_t(i)] * std::polar(1.0 / frequencies, 2.0 * pi * frequencyMHz(i) * lateUs);
    }
    const double fades = std::clamp((lateMm - ringsMm + fadesMm) / fadesMm, 0.0, 1.0);
    tap *= 0.5 + 0.5 * std::cos(pi * fades);
    ring.taps.push_back({ float(tap.real()), float(tap.imag()) });
  }
  return ring;
}

} // namespace

std::complex<double> rodEcho(const Rod& rod, double frequencyMHz)
{
  const double perSpeed = 2.0 * pi * frequencyMHz * rod.radiusMm;
  const double x = perSpeed / assumedSoundSpeedMmPerUs;
  const double x1 = perSpeed / (1e-3 * rod.soundSpeedMPerS);
  const double x2 = perSpeed / (1e-3 * rod.shearSpeedMPerS);
  const double densities =
    aroundRodsMRayl / assumedSoundSpeedMmPerUs / (rod.impedanceMRayl / (1e-3 * rod.soundSpeedMPerS));
  std::complex<double> sum = 0.0;
  const int orders = int(x + 4.0 * std::cbrt(x) + 6.0);
  const std::vector<double> j = besselJ(orders, x);
  const std::vector<double> y = besselN(orders, x);
  const std::vector<double> j1 = besselJ(orders, x1);
  const std::vector<double> j2 = besselJ(orders, x2);
  for (int n = 0; n < orders; ++n)
  {
    const double inner = densities * innerTan(n, j1, x1, j2, x2);
    const double free = -j[std::size_t(n)] / y[std::size_t(n)];
    const double eta = std::atan(free * (inner + tanOf(j, n, x)) / (inner + tanOf(y, n, x)));
    // Backwards, cos(n pi).
    sum += std::polar((n == 0 ? 1.0 : 2.0) * (n % 2 == 0 ? 1.0 : -1.0) * std::sin(eta), eta);
  }
  // The front's, by rays: r sqrt(a / 2), 2 k a earlier than from the axis.
  return -sum * std::polar(2.0 / (std::sqrt(pi * x) * reflectionOf(rod)), -2.0 * x - 0.25 * pi);
}

RodRing rodRing(const Rod& rod, const EchoSettings& settings)
{
  const std::vector<double> key{ rod.radiusMm,        rod.impedanceMRayl,          rod.soundSpeedMPerS,
                                 rod.shearSpeedMPerS, settings.centreFrequencyMHz, settings.fractionalBandwidth,
                                 settings.sampleMm() };
  static KeptByNumbers<RodRing> kept(16);
  return *kept.of(key, [&] { return makeRing(rod, settings); });
}

void addRung(const RodRing& ring, const std::vector<float>& surface, std::vector<float>& line)
{
  const int samples = int(surface.size() / 2);
  for (int s = 0; s < samples; ++s)
  {
    const float re = surface[2 * std::size_t(s)];
    const float im = surface[2 * std::size_t(s) + 1];
    if (re == 0.0f && im == 0.0f)
    {
      continue;
    }
    line[2 * std::size_t(s)] += re;
    line[2 * std::size_t(s) + 1] += im;
    int to = s - ring.lead * ring.stride;
    for (const ComplexWeight& tap : ring.taps)
    {
      if (to >= samples)
      {
        break;
      }
      if (to >= 0)
      {
        line[2 * std::size_t(to)] += tap.re * re - tap.im * im;
        line[2 * std::size_t(to) + 1] += tap.re * im + tap.im * re;
      }
      to += ring.stride;
    }
  }
}

} // namespace sono
