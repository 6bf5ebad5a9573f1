#include "Channels/ChannelPlan.h"
#include "Channels/EvenSpectrum.h"
#include "Core/SoundSpeed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

namespace {

using namespace sono;

using Complex = std::complex<double>;

constexpr double pi = 3.14159265358979323846;

/// The P4-2's face with fewer elements.
ProbeSettings phased(double depthMm = 80.0)
{
  ProbeSettings probe;
  probe.geometry.kind = ScanKind::PhasedSector;
  probe.geometry.sectorDeg = 75.0;
  probe.geometry.depthMm = depthMm;
  probe.centreFrequencyMHz = 2.5;
  return probe;
}

ProbeSettings linear(double depthMm = 50.0)
{
  ProbeSettings probe;
  probe.geometry.kind = ScanKind::Linear;
  probe.geometry.widthMm = 38.0;
  probe.geometry.depthMm = depthMm;
  probe.centreFrequencyMHz = 7.5;
  probe.elementWidthMm = 0.27;
  probe.elevationApertureMm = 4.0;
  probe.elevationFocusMm = 20.0;
  return probe;
}

ChannelPoints at(const std::vector<Vec3d>& places)
{
  ChannelPoints points;
  for (const Vec3d& place : places)
  {
    points.push(Vec3f(place), 1.0f, 0.0f, 0.0f, 0.0f);
  }
  return points;
}

/// When a signal's envelope is largest near an expected time, in samples: of the analytic signal of 256 samples there,
/// by its Fourier sum.
double peakNear(const float* signal, int count, double expected)
{
  constexpr int window = 256;
  const int first = std::clamp(int(expected) - window / 2, 0, count - window);
  std::vector<Complex> spectrum(window / 2);
  for (int k = 1; k < window / 2; ++k)
  {
    for (int n = 0; n < window; ++n)
    {
      spectrum[std::size_t(k)] += double(signal[first + n]) * std::polar(1.0, -2.0 * pi * k * n / window);
    }
  }
  double best = 0.0;
  double where = 0.0;
  for (double place = expected - 3.0; place <= expected + 3.0; place += 0.01)
  {
    Complex sum = 0.0;
    for (int k = 1; k < window / 2; ++k)
    {
      sum += spectrum[std::size_t(k)] * std::polar(1.0, 2.0 * pi * k * (place - first) / window);
    }
    if (std::abs(sum) > best)
    {
      best = std::abs(sum);
      where = place;
    }
  }
  return where;
}

double largest(const ChannelData& data, int transmit, int element)
{
  const float* signal = data.signal(transmit, element);
  double most = 0.0;
  for (int s = 0; s < data.sampleCount; ++s)
  {
    most = std::max(most, double(std::abs(signal[s])));
  }
  return most;
}

/// When the wave of a transmit is at a place, from (15.3) the other way round.
double arrivalUs(const Transmits& transmits, std::size_t t, const Vec3d& place)
{
  const Transmit& sent = transmits.each[t];
  const Vec3d direction(std::sin(sent.angleRad), 0.0, std::cos(sent.angleRad));
  const double way = sent.kind == TransmitKind::PlaneWaves ? glm::dot(place, direction)
                     : sent.kind == TransmitKind::DivergingWaves
                       ? glm::length(place + sent.distanceMm * direction) - sent.distanceMm
                       : sent.distanceMm - glm::length(sent.distanceMm * direction - place);
  return transmits.passUs + way / assumedSoundSpeedMmPerUs;
}

// Of fewer and of more samples than a period, against the sum itself.
TEST(EvenSpectrum, IsTheSumAtEachFrequency)
{
  for (const std::size_t count : { 1, 63, 1201, 4096, 5000 })
  {
    std::vector<double> samples(count);
    for (std::size_t n = 0; n < count; ++n)
    {
      samples[n] = std::sin(0.37 * double(n)) + double(n * 2654435761u % 1000) / 1000.0;
    }
    const std::vector<double> moduli = evenSpectrum(samples);
    ASSERT_EQ(moduli.size(), 2049u);
    for (std::size_t k = 0; k < moduli.size(); k += 37)
    {
      Complex sum = 0.0;
      for (std::size_t n = 0; n < count; ++n)
      {
        sum += std::polar(samples[n], pi * double(n * k % 4096) / 2048.0);
      }
      EXPECT_NEAR(moduli[k], std::abs(sum), 1e-9 * double(count)) << count << " samples, frequency " << k;
    }
  }
}

TEST(Channels, APointIsHeardWhenItsWaveHasBeenThere)
{
  for (const TransmitKind kind : { TransmitKind::PlaneWaves, TransmitKind::DivergingWaves, TransmitKind::FocusedWaves })
  {
    ChannelSettings settings;
    settings.transmitKind = kind;
    settings.transmitCount = 3;
    settings.transmitSpanDeg = 20.0;
    settings.transmitDistanceMm = kind == TransmitKind::FocusedWaves ? 45.0 : 30.0;
    settings.apodization = Apodization::Hann; // the aperture's ends send waves of their own
    settings.flat = true;
    settings.channelSamplingMHz = 20.0;
    const ChannelPlan plan(settings, phased());
    // In each transmit's own direction: at the focus, or so near that the aperture does not yet diffract.
    const double mm = kind == TransmitKind::FocusedWaves ? 45.0 : 20.0;
    for (std::size_t t = 0; t < 3; ++t)
    {
      const double angle = plan.transmits.each[t].angleRad;
      const Vec3d place(mm * std::sin(angle), 0.0, mm * std::cos(angle));
      const ChannelData data = formChannels(plan, at({ place }));
      for (int n = 0; n < data.elementCount; n += 9)
      {
        const double us = arrivalUs(plan.transmits, t, place) +
                          glm::length(place - plan.elements.centresMm[std::size_t(n)]) / assumedSoundSpeedMmPerUs;
        const double expected = us * plan.samplingMHz;
        EXPECT_NEAR(peakNear(data.signal(int(t), n), data.sampleCount, expected), expected, 0.1)
          << "kind " << int(kind) << ", transmit " << t << ", element " << n;
      }
    }
  }
}

TEST(Channels, DelaysBeginAtZeroAndAllWavesPassTheMiddleTogether)
{
  for (const TransmitKind kind : { TransmitKind::PlaneWaves, TransmitKind::DivergingWaves, TransmitKind::FocusedWaves })
  {
    ChannelSettings settings;
    settings.transmitKind = kind;
    settings.elementCount = 65; // one in the middle
    settings.transmitCount = 5;
    ProbeSettings probe = phased();
    probe.elementWidthMm = 0.25;
    const ChannelPlan plan(settings, probe);
    EXPECT_NEAR(*std::min_element(plan.transmits.delaysUs.begin(), plan.transmits.delaysUs.end()), 0.0, 1e-12);
    for (std::size_t t = 0; t < 5; ++t)
    {
      EXPECT_NEAR(plan.transmits.delayUs(t, 32), plan.transmits.passUs, 1e-12);
    }
  }
}

TEST(Channels, AnEchoFallsOffWithDistanceAndAttenuation)
{
  ChannelSettings settings;
  settings.transmitCount = 1;
  settings.elementCount = 1;
  ProbeSettings probe = phased();
  probe.apertureMm = 0.3;
  probe.elevationFocusMm = 0.0;
  probe.elevationApertureMm = 1.0; // far from everything
  const auto ratio = [&](double attenuation) {
    settings.attenuationDbPerCmMHz = attenuation;
    const ChannelPlan plan(settings, probe);
    return largest(formChannels(plan, at({ { 0.0, 0.0, 70.0 } })), 0, 0) /
           largest(formChannels(plan, at({ { 0.0, 0.0, 35.0 } })), 0, 0);
  };
  settings.channelSamplingMHz = 80.0; // a sample lies near each peak
  settings.flat = true;
  EXPECT_NEAR(ratio(0.0), 1.0 / 2.0, 0.002);
  // A Gaussian spectrum times exp(-B f): section 12.4.
  const double spread = 2.5 * 0.6 / (2.0 * std::sqrt(0.6 * std::log(10.0))); // s_f of a -6 dB bandwidth
  const auto left = [&](double mm) {
    const double b = 2.0 * 0.5 / 8.685889638 * mm / 10.0;
    return std::exp(-b * 2.5 + 0.5 * b * b * spread * spread);
  };
  EXPECT_NEAR(ratio(0.5) / (0.5 * left(70.0) / left(35.0)), 1.0, 0.01);
  settings.flat = false;
  EXPECT_NEAR(ratio(0.0), 1.0 / 4.0, 0.01);
}

TEST(Channels, AnElementIsWeakerToTheSide)
{
  ChannelSettings settings;
  settings.transmitCount = 1;
  settings.elementCount = 1;
  settings.flat = true;
  settings.channelSamplingMHz = 80.0;
  ProbeSettings probe = phased();
  probe.apertureMm = 0.3;
  probe.elementWidthMm = 0.3;
  probe.fractionalBandwidth = 0.05; // nearly one tone
  for (const Baffle baffle : { Baffle::Soft, Baffle::Rigid })
  {
    settings.baffle = baffle;
    const ChannelPlan plan(settings, probe);
    const double ahead = largest(formChannels(plan, at({ { 0.0, 0.0, 50.0 } })), 0, 0);
    const double angle = 0.7;
    const double aside =
      largest(formChannels(plan, at({ { 50.0 * std::sin(angle), 0.0, 50.0 * std::cos(angle) } })), 0, 0);
    const double x = pi * 0.3 * std::sin(angle) * 2.5 / assumedSoundSpeedMmPerUs;
    const double one = std::sin(x) / x * (baffle == Baffle::Soft ? std::cos(angle) : 1.0);
    EXPECT_NEAR(aside / ahead, one * one, 0.002);
  }
}

/// The sum over everything at once, in double precision, over a whole record; the mean over the height by strips.
std::vector<double> bruteForce(const ChannelPlan& plan, const ProbeSettings& probe, const ChannelPoints& points)
{
  const std::size_t elements = plan.elements.centresMm.size();
  const std::size_t transmits = plan.transmits.each.size();
  const double recordUs = plan.sampleCount / plan.samplingMHz + 40.0;
  std::vector<double> rf(transmits * elements * std::size_t(plan.sampleCount));
  constexpr int strips = 300;
  for (int j = int(plan.spectrum.lowMHz() * recordUs) + 1; j <= int(plan.highMHz * recordUs); ++j)
  {
    const double f = j / recordUs;
    const double k = 2.0 * pi * f / assumedSoundSpeedMmPerUs;
    std::vector<Complex> heard(transmits * elements);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      std::vector<Complex> g(elements);
      for (std::size_t n = 0; n < elements; ++n)
      {
        const double dx = double(points.x[i]) - plan.elements.centresMm[n].x;
        const double dz = double(points.z[i]) - plan.elements.centresMm[n].z;
        const double angle = std::atan2(dx, dz) - plan.elements.azimuthsRad[n];
        const double plane = std::hypot(dx, dz);
        const double x = 0.5 * k * plan.elements.widthMm * std::sin(angle);
        const double size = std::cos(angle) * (std::abs(x) < 1e-9 ? 1.0 : std::sin(x) / x);
        Complex mean = 0.0;
        if (plan.settings.flat)
        {
          mean = std::polar(1.0 / std::sqrt(plane), k * plane);
        }
        for (int m = 0; m < strips && !plan.settings.flat; ++m)
        {
          const double from = ((m + 0.5) / strips - 0.5) * probe.elevationApertureMm;
          const double r = std::hypot(plane, double(points.y[i]) - from);
          const double lens =
            std::hypot(probe.elevationFocusMm, from) - probe.elevationFocusMm; // the way that it makes up for
          mean += std::polar(1.0 / r / strips, k * (r - lens));
        }
        g[n] = size * mean;
      }
      const Complex amplitude = Complex(points.re[i], points.im[i]) *
                                std::polar(1.0, 2.0 * k * double(points.lagMm[i])) *
                                std::exp(-double(points.sinkNp[i]) * (f - plan.centreMHz));
      for (std::size_t t = 0; t < transmits; ++t)
      {
        Complex arriving = 0.0;
        for (std::size_t n = 0; n < elements; ++n)
        {
          arriving += double(plan.transmits.weights[t * elements + n]) *
                      std::polar(1.0, 2.0 * pi * f * plan.transmits.delayUs(t, n)) * g[n];
        }
        for (std::size_t n = 0; n < elements; ++n)
        {
          heard[t * elements + n] += amplitude * arriving * g[n];
        }
      }
    }
    for (std::size_t s = 0; s < heard.size(); ++s)
    {
      const Complex tone = 2.0 / recordUs * plan.spectrum.at(f) * heard[s];
      const Complex turn = std::polar(1.0, -2.0 * pi * f / plan.samplingMHz);
      Complex phase = tone;
      for (int n = 0; n < plan.sampleCount; ++n)
      {
        rf[s * std::size_t(plan.sampleCount) + std::size_t(n)] += phase.real();
        phase *= turn;
      }
    }
  }
  return rf;
}

double relativeError(const ChannelData& data, const std::vector<double>& exact)
{
  double off = 0.0;
  double all = 0.0;
  for (std::size_t s = 0; s < exact.size(); ++s)
  {
    off += std::pow(double(data.rf[s]) - exact[s], 2);
    all += exact[s] * exact[s];
  }
  return std::sqrt(off / all);
}

TEST(Channels, ShellsAndRecurrencesGiveTheDirectSum)
{
  ChannelSettings settings;
  settings.transmitCount = 2;
  settings.elementCount = 9;
  settings.flat = true;
  ProbeSettings probe = phased(60.0);
  probe.apertureMm = 9.0;
  ChannelPoints points = at({ { 3.0, 0.0, 12.0 }, { -10.0, 0.0, 30.0 }, { 0.5, 0.0, 55.0 }, { 20.0, 0.0, 41.0 } });
  points.re = { 1.0f, -3.0f, 8.0f, 2.0f };
  points.im = { 0.5f, 1.0f, -4.0f, 5.0f };
  points.lagMm = { 0.0f, 0.3f, -0.5f, 0.1f };
  points.sinkNp = { 0.0f, 0.2f, 0.5f, 0.3f };
  const ChannelPlan plan(settings, probe);
  EXPECT_GT(makeShells(plan, points).shells.size(), 2u);
  EXPECT_LT(relativeError(formChannels(plan, points), bruteForce(plan, probe, points)), 1e-3);
}

TEST(Channels, WideElementsAreCutUp)
{
  ChannelSettings settings;
  settings.transmitCount = 1;
  settings.elementCount = 4;
  settings.flat = true;
  ProbeSettings probe = linear(110.0);
  probe.geometry.widthMm = 3.0;
  probe.elementWidthMm = 0.6; // three wavelengths
  probe.geometry.sectorDeg = 60.0;
  const ChannelPlan plan(settings, probe);
  EXPECT_EQ(plan.pieces.perElement, 4);
  // So far away, an element is as good as its pieces.
  const ChannelPoints points = at({ { 24.0, 0.0, 100.0 }, { -8.0, 0.0, 90.0 } });
  EXPECT_LT(relativeError(formChannels(plan, points), bruteForce(plan, probe, points)), 0.01);
}

TEST(Channels, TheLensIsThatOfTheIntegralOverTheHeight)
{
  ChannelSettings settings;
  settings.transmitCount = 1;
  settings.elementCount = 16;
  ProbeSettings probe = phased(80.0);
  probe.apertureMm = 5.0;
  const ChannelPlan plan(settings, probe);
  // Four Gaussians stand for the height: against the echo from the image plane. The beam's deviation is 1.1 mm there.
  const auto exactAt = [&](double y) { return bruteForce(plan, probe, at({ { 4.0, y, 60.0 } })); };
  const std::vector<double> ahead = exactAt(0.0);
  const double all = std::sqrt(std::inner_product(ahead.begin(), ahead.end(), ahead.begin(), 0.0));
  for (const double y : { 0.0, 1.0, 2.0, 3.0 })
  {
    const std::vector<double> exact = exactAt(y);
    const ChannelData data = formChannels(plan, at({ { 4.0, y, 60.0 } }));
    double off = 0.0;
    for (std::size_t s = 0; s < exact.size(); ++s)
    {
      off += std::pow(double(data.rf[s]) - exact[s], 2);
    }
    EXPECT_LT(std::sqrt(off) / all, 0.04) << y;
  }
}

TEST(Channels, ACurvedFaceHearsByItsNormals)
{
  ChannelSettings settings;
  settings.transmitCount = 2;
  settings.elementCount = 12;
  settings.flat = true;
  ProbeSettings probe;
  probe.geometry.kind = ScanKind::Curvilinear;
  probe.geometry.radiusMm = 40.0;
  probe.geometry.sectorDeg = 20.0;
  probe.geometry.depthMm = 50.0;
  probe.elementWidthMm = 0.4;
  const ChannelPlan plan(settings, probe);
  const ChannelPoints points = at({ { 6.0, 0.0, 20.0 }, { -2.0, 0.0, 45.0 } });
  EXPECT_LT(relativeError(formChannels(plan, points), bruteForce(plan, probe, points)), 2e-3);
}

TEST(Channels, ThreadsAndTheOrderOfPointsDoNotMatter)
{
  ChannelSettings settings;
  settings.transmitCount = 3;
  settings.elementCount = 17;
  const ChannelPlan plan(settings, phased());
  std::vector<Vec3d> places;
  for (int n = 0; n < 200; ++n)
  {
    places.push_back({ 30.0 * std::sin(3.0 * n), std::cos(5.0 * n), 20.0 + 0.25 * n });
  }
  const ChannelData data = formChannels(plan, at(places));
  EXPECT_EQ(data.rf, formChannels(plan, at(places)).rf);
  std::reverse(places.begin(), places.end());
  const ChannelData reversed = formChannels(plan, at(places));
  EXPECT_LT(relativeError(reversed, { data.rf.begin(), data.rf.end() }), 1e-5);
  const ChannelData nothing = formChannels(plan, {});
  EXPECT_EQ(*std::max_element(nothing.rf.begin(), nothing.rf.end()), 0.0f);
}

TEST(Channels, AStopIsHeard)
{
  const ChannelPlan plan({}, phased());
  EXPECT_THROW(formChannels(plan, at({ { 0.0, 0.0, 30.0 } }), [](double) { return false; }), Aborted);
}

TEST(Channels, BadInputGetsOneSentence)
{
  const auto sentence = [](ChannelSettings settings, ProbeSettings probe) {
    try
    {
      ChannelPlan(settings, probe);
    }
    catch (const Error& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  ChannelSettings settings;
  settings.transmitCount = 0;
  EXPECT_NE(sentence(settings, phased()).find("transmitCount is 0"), std::string::npos);
  settings = {};
  settings.elementCount = 500;
  EXPECT_NE(sentence(settings, phased()).find("500 elements"), std::string::npos);
  settings = {};
  settings.channelSamplingMHz = 4.0;
  EXPECT_NE(sentence(settings, phased()).find("channelSamplingMHz is 4"), std::string::npos);
  settings = {};
  ProbeSettings probe = phased();
  probe.imagingMode = ImagingMode::Harmonic;
  EXPECT_NE(sentence(settings, probe).find("Harmonic"), std::string::npos);
  probe = phased();
  probe.geometry.kind = ScanKind::Matrix;
  EXPECT_NE(sentence(settings, probe).find("one row"), std::string::npos);
  probe = phased();
  probe.apertureMm = 0.0;
  EXPECT_NE(sentence(settings, probe).find("apertureMm"), std::string::npos);
  probe = phased();
  probe.elevationApertureMm = 0.0;
  EXPECT_NE(sentence(settings, probe).find("elevationApertureMm"), std::string::npos);
  settings.transmitKind = TransmitKind::FocusedWaves;
  probe = phased();
  probe.transmitFocusMm = 0.0;
  EXPECT_NE(sentence(settings, probe).find("transmitDistanceMm"), std::string::npos);
  settings.transmitDistanceMm = 40.0;
  settings.transmitCount = 1024;
  settings.elementCount = 0;
  settings.channelSamplingMHz = 1000.0;
  EXPECT_NE(sentence(settings, probe).find("transmitCount is 1024"), std::string::npos);
}

} // namespace
