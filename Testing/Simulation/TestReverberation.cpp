#include "LayeredScene.h"

#include "Echo/FormRf.h"
#include "Echo/Pulse.h"
#include "Echo/ReverberationSpeckle.h"
#include "Trace/Deposit.h"
#include "Trace/Trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

// Paths that have been reflected: Data/docs/physics.md 13.2.

using namespace sono;
using namespace sono::test;

namespace {

/// Smooth layers.
std::unique_ptr<Scene> smoothLayers(const std::vector<Layer>& layers, double backscatterPerCmSr = 0.0,
                                    double voxelMm = 0.5)
{
  const auto change = [=](Tissue& tissue) {
    tissue.roughnessMm = 0.0;
    tissue.backscatterPerCmSr = backscatterPerCmSr;
    tissue.backscatterExponent = 0.0;
    tissue.scattererProbability = 1.0;
    tissue.scattererMean = 1.0;
  };
  return layeredScene(layers, change, voxelMm);
}

const std::vector<ScanLine>& line()
{
  static const std::vector<ScanLine> one{ makeLine({ 10.1, 9.9, 0.0 }, { 0.0, 0.0, 1.0 }) };
  return one;
}

TraceSettings settings(int paths)
{
  TraceSettings s;
  s.device = Device::Cpu;
  s.depthMm = 90.0;
  s.frequencyMHz = 2.5;
  s.pathsPerLine = paths;
  s.maxCollisions = 30;
  s.faceReflection = 0.0;
  s.reverberation = true;
  return s;
}

/// Of the boundary echoes within a tenth of a millimetre of a range: the amplitude with its sign.
double arrivalAt(const TracedLines& traced, double rangeMm, double frequencyMHz)
{
  const double k2 = 4.0 * M_PI * frequencyMHz / 1.54;
  std::complex<double> sum = 0.0;
  for (int s = 0; s < traced.echoCount; ++s)
  {
    const double r = s * traced.echoSampleMm;
    if (std::abs(r - rangeMm) < 0.1)
    {
      sum += std::complex<double>(traced.boundaryEcho[std::size_t(s)]) * std::polar(1.0, k2 * (rangeMm - r));
    }
  }
  EXPECT_LT(std::abs(sum.imag()), 0.1 * std::abs(sum.real()) + 1e-6) << rangeMm;
  return sum.real();
}

double decibels(double amplitude)
{
  return 20.0 * std::log10(std::abs(amplitude));
}

} // namespace

TEST(Reverberation, FourLayersEchoAsTheExactSumOverAllWays)
{
  const auto scene = smoothLayers({ { 20.0, 1.50, 1480.0, 0.0 },
                                    { 32.0, 1.90, 1650.0, 0.0 },
                                    { 50.0, 1.30, 1450.0, 0.0 },
                                    { 90.0, 2.40, 1800.0, 0.0 } });
  const TracedLines traced = trace(*scene, line(), settings(400000));
  // The table of physics.md 13.3, lossless.
  const double expected[][2] = { { 43.211, -47.79 }, { 62.328, -38.08 }, { 70.245, -36.04 }, { 81.445, -41.06 } };
  const double signs[] = { -1.0, 1.0, 1.0, -1.0 };
  for (int i = 0; i < 4; ++i)
  {
    const double amplitude = arrivalAt(traced, expected[i][0], 2.5);
    EXPECT_NEAR(decibels(amplitude), expected[i][1], 0.4) << expected[i][0];
    EXPECT_GT(amplitude * signs[i], 0.0) << expected[i][0];
  }
  // First echoes are the surfaces'.
  for (const double first : { 20.811, 32.011, 51.128 })
  {
    EXPECT_EQ(arrivalAt(traced, first, 2.5), 0.0);
  }
}

TEST(Reverberation, ALinesOfAPlateAndTheFace)
{
  // Gas behind 20 mm of tissue: at n d, r^n r_t^(n - 1) with n times the attenuation.
  const auto scene = smoothLayers({ { 20.0, 1.6, 1540.0, 0.5 }, { 60.0, 0.0004, 340.0, 0.0 } });
  TraceSettings s = settings(1000);
  s.faceReflection = 0.5;
  const TracedLines traced = trace(*scene, line(), s);
  const double r = (0.0004 - 1.6) / (0.0004 + 1.6);
  for (int n = 2; n <= 4; ++n)
  {
    const double expected =
      decibels(std::pow(r, n) * std::pow(0.5, n - 1)) - 2.0 * n * 2.0 * 0.5 * 2.5; // 2 cm there and back
    EXPECT_NEAR(decibels(arrivalAt(traced, 20.0 * n, 2.5)), expected, 0.05) << n;
  }
}

TEST(Reverberation, AWallIsNotInItsOwnWayBack)
{
  // Wherever in a bin it lies. A lung lets a third of the intensity through, which would be missing.
  for (int n = 0; n < 8; ++n)
  {
    const double voxelMm = 0.5 + 0.0009 * n; // the wall in steps of 0.04 mm
    const double wallMm = 40.0 * voxelMm;
    const auto scene =
      smoothLayers({ { wallMm, 1.6, 1500.0, 0.0 }, { 120.0 * voxelMm, 0.4, 650.0, 0.0 } }, 0.0, voxelMm);
    TraceSettings s = settings(20000);
    s.faceReflection = 0.5;
    const TracedLines traced = trace(*scene, line(), s);
    EXPECT_NEAR(decibels(arrivalAt(traced, 2.0 * wallMm * 1540.0 / 1500.0, 2.5)), decibels(0.6 * 0.6 * 0.5), 0.02)
      << wallMm;
  }
}

TEST(Reverberation, TissueIsRepeatedBehindTheMirror)
{
  // Lossless tissue of 5e-4 /(cm sr) in front of gas: its own way d + (d - z), and with a face straight back, 2 r r_t.
  const auto scene = smoothLayers({ { 20.0, 1.6, 1540.0, 0.0 }, { 60.0, 0.0004, 340.0, 0.0 } }, 5e-4);
  TraceSettings s = settings(2000);
  s.faceReflection = 0.4;
  const TracedLines traced = trace(*scene, line(), s);
  const auto level = [&](double rangeMm) { return double(traced.reverberation[std::size_t(rangeMm / traced.binMm)]); };
  EXPECT_NEAR(level(10.0), 0.0, 1e-6);
  // 20 to 40 mm: own way up from the gas, 1, and straight back on the way down after the face, 2 r_t.
  EXPECT_NEAR(level(30.1), 1.0 + 2.0 * 0.4, 0.02);
  // 40 to 60: own way down after the face, r_t^2; straight back after the second bounce at the face, 2 r_t^2.
  EXPECT_NEAR(level(50.1), 0.16 + 2.0 * 0.16, 0.02);
}

TEST(Reverberation, SilentLinesCountInTheMeanPowerOfWhatComesStraightBack)
{
  // The same at 30 mm between two lines that look out of the body: weights over lines fall from 9 by one a line.
  const auto scene = smoothLayers({ { 20.0, 1.6, 1540.0, 0.0 }, { 60.0, 0.0004, 340.0, 0.0 } }, 5e-4);
  TraceSettings s = settings(2000);
  s.faceReflection = 0.4;
  const ScanLine silent = makeLine({ 10.1, 9.9, 0.0 }, { 0.0, 0.0, -1.0 });
  const TracedLines traced = trace(*scene, { silent, line().front(), silent }, s);
  const double level = traced.reverberation[std::size_t(traced.binCount) + std::size_t(30.1 / traced.binMm)];
  EXPECT_NEAR(level, 1.0 + 2.0 * 0.4 * std::sqrt(9.0 / (8.0 + 9.0 + 8.0)), 0.02);
}

TEST(Reverberation, SpeckleHasTheLevelOfItsTissue)
{
  // What the gas mirrors is as strong as the tissue itself.
  const auto scene = smoothLayers({ { 40.0, 1.6, 1540.0, 0.0 }, { 60.0, 0.0004, 340.0, 0.0 } }, 5e-4);
  TraceSettings s = settings(500);
  s.depthMm = 80.0;
  EchoSettings e;
  e.device = Device::Cpu;
  e.depthMm = s.depthMm;
  std::vector<ScanLine> lines;
  for (int l = 0; l < 32; ++l)
  {
    lines.push_back(makeLine({ 3.0 + 0.44 * l, 9.9, 0.0 }, { 0.0, 0.0, 1.0 }));
  }
  e.lateralSigmaMm = e.elevationalSigmaMm = 0.5;
  const RfLines rf = formRf(*scene, lines, trace(*scene, lines, s), e);
  const auto power = [&](double fromMm, double toMm) {
    double sum = 0.0;
    int count = 0;
    for (int l = 0; l < rf.lineCount; ++l)
    {
      for (int i = int(fromMm / rf.sampleMm); i < int(toMm / rf.sampleMm); ++i, ++count)
      {
        sum += std::norm(rf.iq[std::size_t(l) * std::size_t(rf.sampleCount) + std::size_t(i)]);
      }
    }
    return 10.0 * std::log10(sum / count);
  };
  EXPECT_NEAR(power(45.0, 75.0), power(8.0, 36.0), 0.4);
}

TEST(Reverberation, ItsSpeckleDoesNotDependOnWhatIsKnownOfTheAttenuation)
{
  // Which paths of the direct sound arrive behind a wall is chance, and so is how far its frequency is said to sink.
  const auto scene = smoothLayers({ { 20.0, 1.6, 1540.0, 0.5 }, { 60.0, 0.0004, 340.0, 0.0 } }, 5e-4);
  TracedLines traced = trace(*scene, line(), settings(500));
  std::fill(traced.intensity.begin(), traced.intensity.end(), 0.0f);
  std::fill(traced.boundaryEcho.begin(), traced.boundaryEcho.end(), 0.0f);
  EchoSettings e;
  e.device = Device::Cpu;
  e.depthMm = 90.0;
  const RfLines one = formRf(*scene, line(), traced, e);
  for (std::size_t b = 0; b < traced.attenuationNpPerMHz.size(); ++b)
  {
    traced.attenuationNpPerMHz[b] = b / 7 % 3 == 0 ? 0.0f : 0.4f;
  }
  const RfLines two = formRf(*scene, line(), traced, e);
  float peak = 0.0f;
  float worst = 0.0f;
  for (std::size_t i = 0; i < one.iq.size(); ++i)
  {
    peak = std::max(peak, std::abs(one.iq[i]));
    worst = std::max(worst, std::fabs(std::abs(one.iq[i]) - std::abs(two.iq[i])));
  }
  EXPECT_GT(peak, 0.0f);
  EXPECT_LT(worst, 1e-5f * peak);
}

TEST(Reverberation, WhatComesStraightBackIsHeardAsFarAsItIsOnTheAxis)
{
  // A path across the axis at 40 degrees, which it meets 20 mm below the face: its power is the Gaussian of (13.6), of
  // 1.5 mm beside the axis, at each depth, however the way is cut into pieces.
  const TraceLine axis{ Vec3f(0.0f), Vec3f(0.0f, 0.0f, 1.0f) };
  const float angle = 0.7f;
  const Vec3f direction(std::sin(angle), 0.0f, std::cos(angle));
  const std::vector<float> range{ 0.0f, 50.0f };
  const std::vector<float> arrives{ 1.0f, 1.0f };
  const std::vector<float> absorbed{ 0.0f, 0.0f };
  const StraightWay way{ range.data(), arrives.data(), absorbed.data(), 1, 50.0f };
  const float lengthMm = 20.0f / direction.z;
  for (const int pieces : { 1, 7 })
  {
    LineTally tally(100, 0.5, binSumCount, 0, 0.0154, 1.6);
    const TraceView view;
    tally.begin(view, axis, 0, way);
    for (int i = 0; i < pieces; ++i)
    {
      PathSegment s{};
      const float from = 2.0f * lengthMm * float(i) / float(pieces);
      s.start = direction * (from - lengthMm) + Vec3f(0.0f, 0.0f, 20.0f);
      s.direction = direction;
      s.length = 2.0f * lengthMm / float(pieces);
      s.intensity = 0.01f;
      s.lengthMm = from;
      s.rangeMm = from;
      s.scatter = 1.0f;
      s.reflections = 2;
      tally.segment(s);
    }
    const std::vector<ReverberationSums> sums = tally.takeReverberation(1);
    // r = (L_out + L_back) / 2 grows by (1 + cos) / 2 a mm of the way; a bin is 0.5 mm.
    for (int b = 2; b < 78; ++b)
    {
      const double along = (b + 0.5) / (1.0 + double(direction.z)) - lengthMm;
      const double asideMm = along * direction.x;
      EXPECT_NEAR(sums[std::size_t(b)].of[straightPowerSum], 0.04 * std::exp(-asideMm * asideMm / (2.0 * 1.5 * 1.5)),
                  0.02 * 0.04)
        << b << " of " << pieces;
    }
  }
}

TEST(Reverberation, WhatTheMediaTookIsThatInTheMiddleOfFourBins)
{
  // Of one path whose exponent grows straight with its range, past the end of the line, whose last group has two bins.
  constexpr int bins = 102;
  const TraceLine axis{ Vec3f(0.0f), Vec3f(0.0f, 0.0f, 1.0f) };
  const TraceView view;
  LineTally tally(bins, 0.5, binSumCount, 0, 0.0154, 1.6);
  tally.begin(view, axis, 0, {});
  PathSegment s{};
  s.direction = Vec3f(0.0f, 0.0f, 1.0f);
  s.length = 100.0f;
  s.intensity = 1.0f;
  s.decayPerMm = 0.02f;
  s.absorbed = 0.3f;
  s.rangeMm = 10.0f;
  s.scatter = 1.0f;
  s.reflections = 1;
  tally.segment(s);
  const std::vector<float> np = tally.takeReverberatedNp(nullptr);
  ASSERT_EQ(np.size(), std::size_t(bins));
  for (int b = 0; b < bins; ++b)
  {
    const int middle = std::min(b / 4 * 4 + 2, bins - 1);
    const double rangeMm = 0.5 * (middle + 0.5);
    EXPECT_NEAR(np[std::size_t(b)], rangeMm > 10.0 ? 0.3 + 0.02 * (rangeMm - 10.0) : 0.0, 1e-5) << b;
  }
  EXPECT_EQ(tally.takeReverberatedNp(nullptr), std::vector<float>(bins, 0.0f));
}

TEST(Reverberation, NodesThatLinesShareGiveTheNoiseOfEachBehindThePulse)
{
  constexpr int lines = 33;
  constexpr int samples = 4000;
  const PulseKernel pulse{ EchoSettings() };
  const int half = pulse.half();
  for (const float nodesPerLine : { 1e-3f, 0.3f, 1.0f })
  {
    const ReverberationSpeckle speckle{ { 7, nodesPerLine }, std::vector<float>(std::size_t(samples + half), 2.0f) };
    const ReverberationNodes nodes(speckle, pulse, lines, samples);
    const std::vector<float> level(samples, 0.5f);
    double power = 0.0;
    for (int l = 0; l < lines; ++l)
    {
      std::vector<std::complex<float>> iq(samples, { 3.0f, -1.0f });
      nodes.add(l, level.data(), samples, iq.data());
      for (int s = 0; s < samples; s += s < 2 * half ? 1 : 37)
      {
        std::complex<double> exact(3.0, -1.0);
        for (int from = std::max(0, s - half); from <= s + half; ++from)
        {
          const Vec2f own = speckle.noise.at(l, from);
          exact += double(pulse.re()[std::size_t(half - (s - from))]) * std::complex<double>(own.x, own.y);
        }
        ASSERT_NEAR(std::abs(std::complex<double>(iq[std::size_t(s)]) - exact), 0.0, 2e-5)
          << "line " << l << ", sample " << s;
      }
      for (int s = 0; s < samples; ++s)
      {
        const Vec2f own = speckle.noise.at(l, s);
        power += double(glm::dot(own, own));
      }
    }
    EXPECT_NEAR(power / (lines * samples), 1.0, 5.0 / std::sqrt(samples)) << nodesPerLine;
  }
}

TEST(Reverberation, OffPathsEndWhereTheyAreReflected)
{
  const auto scene = smoothLayers({ { 20.0, 1.6, 1540.0, 0.0 }, { 60.0, 3.0, 1540.0, 0.0 } });
  TraceSettings s = settings(200);
  s.reverberation = false;
  const TracedLines traced = trace(*scene, line(), s);
  EXPECT_EQ(traced.echoCount, 0);
  EXPECT_TRUE(traced.reverberation.empty());
  // Nothing is left to chance: each path is transmitted.
  const double t = 1.0 - std::pow(1.4 / 4.6, 2.0);
  for (const double depth : { 10.0, 30.0, 50.0 })
  {
    const auto bin = std::size_t(depth / traced.binMm);
    EXPECT_NEAR(traced.intensity[bin], depth < 20.0 ? 1.0 : t, 1e-5);
    EXPECT_LT(traced.standardError[bin], 1e-6);
  }
}

TEST(Reverberation, PerfectMirrorsEndByTheDepth)
{
  const auto scene = smoothLayers({ { 2.0, 1.6, 1540.0, 0.0 }, { 60.0, 0.0004, 340.0, 0.0 } });
  TraceSettings s = settings(100);
  s.faceReflection = 1.0;
  s.maxCollisions = 1000;
  const TracedLines traced = trace(*scene, line(), s);
  EXPECT_LT(traced.segments, 100u * 120u); // twice 45 ways of 2 mm in 90, and a few
  EXPECT_NEAR(std::abs(arrivalAt(traced, 80.0, 2.5)), 1.0, 0.05);
}
