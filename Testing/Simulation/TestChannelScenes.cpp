#include "Channels/ChannelPlan.h"
#include "Channels/ScenePoints.h"
#include "Core/SoundSpeed.h"
#include "TestScenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <map>
#include <tuple>

namespace {

using namespace sono;
using namespace sono::test;

using Complex = std::complex<double>;

constexpr double pi = 3.14159265358979323846;

ProbeSettings probeOf(double depthMm)
{
  ProbeSettings probe;
  probe.geometry.kind = ScanKind::PhasedSector;
  probe.geometry.sectorDeg = 75.0;
  probe.geometry.depthMm = depthMm;
  probe.geometry.lineCount = 64;
  probe.centreFrequencyMHz = 2.5;
  return probe;
}

EchoSettings echoOf(const ProbeSettings& probe)
{
  EchoSettings echo;
  echo.centreFrequencyMHz = probe.centreFrequencyMHz;
  echo.fractionalBandwidth = probe.fractionalBandwidth;
  echo.aperture = probe.aperture();
  echo.depthMm = probe.geometry.rangeMm();
  return echo;
}

/// At the top of a block of 100 x 40 x 80 mm.
ProbePose poseAt(double xMm)
{
  ProbePose pose;
  pose.positionMm = { xMm, 20.0, 0.0 };
  return pose;
}

Tissue scattering()
{
  Tissue tissue = makeTissue("soft", 1.6, 1540.0, 0.0);
  tissue.scattererMean = 1.0;
  tissue.scattererProbability = 0.7;
  tissue.backscatterPerCmSr = 5e-4;
  return tissue;
}

std::unique_ptr<Scene> block()
{
  return makeScene(Vec3i(100, 40, 80), Vec3d(1.0), { scattering() }, [](const Vec3d&) { return 0; });
}

EchoSources ofScene(const Scene& scene, const TracedLines* traced = nullptr)
{
  EchoSources sources;
  sources.scene = &scene;
  sources.traced = traced;
  return sources;
}

TEST(ChannelScenes, CrossSectionsAreThoseOfTheVolume)
{
  const auto scene = block();
  const ProbeSettings probe = probeOf(60.0);
  for (const int perCell : { 15, 4 })
  {
    const ChannelPoints points = scenePoints(ofScene(*scene), probe, poseAt(50.0), echoOf(probe), perCell);
    // In a box within fan and slab.
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      if (std::abs(points.x[i]) < 15.0f && std::abs(points.y[i]) < 1.5f && points.z[i] > 30.0f && points.z[i] < 50.0f)
      {
        sum += double(points.re[i]) * double(points.re[i]);
        ++count;
      }
    }
    const double perMm = 0.1 * 5e-4 * std::pow(2.5, scattering().backscatterExponent); // eq. 11.1
    const double volume = 30.0 * 3.0 * 20.0;
    EXPECT_NEAR(sum / (perMm * volume), 1.0, 4.0 / std::sqrt(double(count))) << perCell;
  }
}

TEST(ChannelScenes, ScatterersStayInTheBodyWhenTheProbeMoves)
{
  const auto scene = block();
  const ProbeSettings probe = probeOf(60.0);
  std::map<std::tuple<long, long, long>, int> seen;
  const auto key = [](const ChannelPoints& points, std::size_t i, double xMm) {
    return std::make_tuple(std::lround(1e3 * (double(points.x[i]) + xMm)), std::lround(1e3 * double(points.y[i])),
                           std::lround(1e3 * double(points.z[i])));
  };
  const ChannelPoints first = scenePoints(ofScene(*scene), probe, poseAt(50.0), echoOf(probe), 15);
  for (std::size_t i = 0; i < first.size(); ++i)
  {
    ++seen[key(first, i, 50.0)];
  }
  EXPECT_EQ(seen.size(), first.size()); // none twice
  const ChannelPoints second = scenePoints(ofScene(*scene), probe, poseAt(50.0625), echoOf(probe), 15);
  std::size_t same = 0;
  for (std::size_t i = 0; i < second.size(); ++i)
  {
    same += seen.count(key(second, i, 50.0625));
  }
  EXPECT_GT(double(same), 0.97 * double(second.size())); // the rest came in at rims, and where the density steps
}

/// Behind lung and bone the exponent is so large that the pulse would sink to nothing, and be endlessly strong there.
TEST(ChannelScenes, ThePulseDoesNotSinkBelowItsBand)
{
  const auto scene = block();
  const ProbeSettings probe = probeOf(60.0);
  TracedLines traced;
  traced.lineCount = 64;
  traced.binCount = 60;
  traced.binMm = 1.0;
  traced.intensity.assign(64 * 60, 1e-9f);
  traced.standardError.assign(64 * 60, 0.0f);
  traced.attenuationNpPerMHz.assign(64 * 60, 300.0f);
  const ChannelPoints points = scenePoints(ofScene(*scene, &traced), probe, poseAt(50.0), echoOf(probe), 1);
  const double spread = 2.5 * 0.6 / (2.0 * std::sqrt(0.6 * std::log(10.0))); // s_f of a -6 dB bandwidth
  const double most = (2.5 - spread) / (spread * spread);                    // section 12.4
  ASSERT_GT(points.size(), 1000u);
  for (const float sink : points.sinkNp)
  {
    ASSERT_NEAR(double(sink), most, 1e-3);
  }
  ChannelSettings settings;
  settings.transmitCount = 1;
  settings.elementCount = 4;
  const ChannelData data = formChannels(ChannelPlan(settings, probe), points);
  for (const float value : data.rf)
  {
    ASSERT_TRUE(std::isfinite(value));
  }
}

TEST(ChannelScenes, WhatIsTracedWeighs)
{
  const auto scene = block();
  const ProbeSettings probe = probeOf(60.0);
  TracedLines traced;
  traced.lineCount = 64;
  traced.binCount = 60;
  traced.binMm = 1.0;
  for (int line = 0; line < 64; ++line)
  {
    for (int bin = 0; bin < 60; ++bin)
    {
      const bool isShadowed = line < 32 && bin >= 30;
      traced.intensity.push_back(isShadowed ? 0.0f : 0.5f);
      traced.attenuationNpPerMHz.push_back(0.01f * (float(bin) + 0.5f));
      traced.depthOffsetMm.push_back(0.05f * float(bin)); // 5 % slower than range says
    }
  }
  traced.standardError.assign(traced.intensity.size(), 0.0f);
  const ChannelPoints all = scenePoints(ofScene(*scene), probe, poseAt(50.0), echoOf(probe), 4);
  const ChannelPoints lit = scenePoints(ofScene(*scene, &traced), probe, poseAt(50.0), echoOf(probe), 4);
  std::map<std::tuple<float, float, float>, std::size_t> found;
  for (std::size_t i = 0; i < lit.size(); ++i)
  {
    found[{ lit.x[i], lit.y[i], lit.z[i] }] = i;
  }
  int shadowed = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    const double depth = std::hypot(double(all.x[i]), double(all.z[i]));
    const double angle = std::atan2(double(all.x[i]), double(all.z[i])) * 180.0 / pi;
    const auto at = found.find({ all.x[i], all.y[i], all.z[i] });
    if (depth > 31.0 && angle < -1.2)
    {
      EXPECT_TRUE(at == found.end());
      ++shadowed;
    }
    if (depth > 5.0 && depth < 59.0 && (depth < 29.0 || angle > 1.2))
    {
      ASSERT_TRUE(at != found.end());
      const std::size_t n = at->second;
      EXPECT_NEAR(double(lit.re[n]), 0.5 * double(all.re[i]), 1e-6 + 1e-5 * std::abs(double(all.re[i])));
      EXPECT_NEAR(double(lit.sinkNp[n]), 0.01 * depth, 1e-4);
      EXPECT_NEAR(double(lit.lagMm[n]), depth / 1.05 - depth, 1e-3); // range (1 + 0.05) = depth
    }
  }
  EXPECT_GT(shadowed, 1000);
}

/// A flat boundary echoes as the mirror image of what sends: exp(ikR)/R from each element's strips to the images of the
/// others', times directivities.
TEST(ChannelScenes, AMirrorShowsTheArray)
{
  Tissue front = makeTissue("front", 1.5, 1540.0, 0.0);
  Tissue back = makeTissue("back", 1.8, 1540.0, 0.0);
  front.roughnessMm = back.roughnessMm = 0.0;
  const double planeMm = 40.0;
  const auto scene = makeScene(Vec3i(200, 80, 120), Vec3d(0.5), { front, back },
                               [&](const Vec3d& place) { return place.z < planeMm ? 0 : 1; });
  const ProbeSettings probe = probeOf(55.0);
  ChannelSettings settings;
  settings.transmitCount = 1;
  settings.elementCount = 24;
  const ChannelPlan plan(settings, probe);
  const ChannelData data = formChannels(plan, scenePoints(ofScene(*scene), probe, poseAt(50.0), echoOf(probe), 15));
  const std::size_t elements = plan.elements.centresMm.size();
  constexpr int strips = 24;
  const double r = (1.8 - 1.5) / (1.8 + 1.5);
  const double recordUs = 90.0;
  std::vector<double> exact(data.rf.size(), 0.0);
  for (int j = int(plan.spectrum.lowMHz() * recordUs) + 1; j <= int(plan.highMHz * recordUs); ++j)
  {
    const double f = j / recordUs;
    const double k = 2.0 * pi * f / assumedSoundSpeedMmPerUs;
    std::vector<Complex> heard(elements);
    for (std::size_t e = 0; e < elements; ++e)
    {
      for (std::size_t n = 0; n < elements; ++n)
      {
        const double across = plan.elements.centresMm[n].x - plan.elements.centresMm[e].x;
        const double cosine = 2.0 * planeMm / std::hypot(across, 2.0 * planeMm);
        const double x = 0.5 * k * plan.elements.widthMm * std::sqrt(1.0 - cosine * cosine);
        const double one = cosine * (x < 1e-9 ? 1.0 : std::sin(x) / x);
        Complex mean = 0.0;
        for (int a = 0; a < strips; ++a)
        {
          for (int b = 0; b < strips; ++b)
          {
            const double ya = ((a + 0.5) / strips - 0.5) * probe.elevationApertureMm;
            const double yb = ((b + 0.5) / strips - 0.5) * probe.elevationApertureMm;
            const double way = std::sqrt(across * across + 4.0 * planeMm * planeMm + (ya - yb) * (ya - yb));
            const double lens = (ya * ya + yb * yb) / (2.0 * probe.elevationFocusMm);
            mean += std::polar(1.0 / way, k * (way - lens));
          }
        }
        heard[n] +=
          std::polar(1.0, 2.0 * pi * f * plan.transmits.delayUs(0, e)) * one * one * r * mean / double(strips * strips);
      }
    }
    for (std::size_t n = 0; n < elements; ++n)
    {
      const Complex tone = 2.0 / recordUs * plan.spectrum.at(f) * heard[n];
      for (int s = 0; s < data.sampleCount; ++s)
      {
        exact[n * std::size_t(data.sampleCount) + std::size_t(s)] +=
          (tone * std::polar(1.0, -2.0 * pi * f * s / plan.samplingMHz)).real();
      }
    }
  }
  double off = 0.0;
  double all = 0.0;
  double product = 0.0;
  for (std::size_t s = 0; s < exact.size(); ++s)
  {
    off += std::pow(double(data.rf[s]) - exact[s], 2);
    all += exact[s] * exact[s];
    product += double(data.rf[s]) * exact[s];
  }
  EXPECT_NEAR(product / all, 1.0, 0.06);
  EXPECT_LT(std::sqrt(off / all), 0.2);
}

TEST(ChannelScenes, AnotherModelIsRefused)
{
  const auto scene = block();
  const ProbeSettings probe = probeOf(60.0);
  EchoSources sources = ofScene(*scene);
  sources.model = InterfaceModel::Amadou2024;
  EXPECT_THROW(scenePoints(sources, probe, poseAt(50.0), echoOf(probe), 15), Error);
  ProbeSettings compound = probe;
  compound.geometry.kind = ScanKind::Linear;
  compound.geometry.compoundFans = 3;
  EXPECT_THROW(scenePoints(ofScene(*scene), compound, poseAt(50.0), echoOf(compound), 15), Error);
}

} // namespace
