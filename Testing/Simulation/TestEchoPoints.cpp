#include "EchoScenes.h"
#include "TestScenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

namespace {

using namespace sono;
using namespace sono::test;

EchoSettings calibrationSettings()
{
  EchoSettings s;
  s.centreFrequencyMHz = 3.6;
  s.fractionalBandwidth = 0.6;
  s.samplingMHz = 50.0;
  s.depthMm = 80.0;
  return s;
}

RfLines formPoints(const std::vector<PointScatterer>& points, const std::vector<ScanLine>& lines, const EchoSettings& s)
{
  const PointScatterers sorted(points);
  return formRf({ nullptr, nullptr, &sorted }, lines, s);
}

/// Width of a sampled bump at `level` of its largest value, edges found by linear interpolation.
double widthAt(const std::vector<float>& values, double step, double level)
{
  const std::size_t peak = std::size_t(std::max_element(values.begin(), values.end()) - values.begin());
  const double threshold = level * values[peak];
  std::size_t right = peak;
  while (values[right] > threshold)
  {
    ++right;
  }
  std::size_t left = peak;
  while (values[left] > threshold)
  {
    --left;
  }
  const double rightPart = (values[right - 1] - threshold) / (values[right - 1] - values[right]);
  const double leftPart = (values[left + 1] - threshold) / (values[left + 1] - values[left]);
  return (double(right - 1) + rightPart - double(left + 1) + leftPart) * step;
}

std::vector<ScanLine> parallelLines(int count, double pitchMm, const Vec3d& step)
{
  std::vector<ScanLine> lines;
  for (int i = 0; i < count; ++i)
  {
    lines.push_back({ step * (pitchMm * (i - 0.5 * (count - 1))), { 0, 0, 1 }, { 1, 0, 0 }, { 0, 1, 0 } });
  }
  return lines;
}

TEST(EchoPoints, AgreeWithTheDirectSum)
{
  SceneS1 s1(200000);
  const PointScatterers sorted(s1.points);
  for (const double samplingMHz : { 50.0, 12.5 })
  {
    s1.settings.samplingMHz = samplingMHz;
    const RfLines rf = formRf({ nullptr, nullptr, &sorted }, s1.lines, s1.settings);
    for (const int line : { 0, 50, 127 })
    {
      const auto exact = directIq(s1.points, s1.lines[std::size_t(line)], s1.settings);
      EXPECT_LT(nrmse(rf.iq.data() + std::size_t(line) * exact.size(), exact), samplingMHz == 50.0 ? 1e-3 : 1e-2)
        << "line " << line << " at " << samplingMHz << " MHz";
    }
  }
}

TEST(EchoPoints, StandInTheirBricksInTheOrderGiven)
{
  const SceneS1 s1(300000);
  const PointScatterers sorted(s1.points);
  const double edgeMm = sorted.grid().edgeMm;
  std::map<std::tuple<int, int, int>, std::vector<const PointScatterer*>> bricks;
  for (const PointScatterer& p : s1.points)
  {
    const Vec3d at = glm::floor((p.positionMm - sorted.originMm()) / edgeMm);
    bricks[{ int(at.x), int(at.y), int(at.z) }].push_back(&p);
  }
  for (const auto& [at, points] : bricks)
  {
    const ScattererView view = sorted.brick({ std::get<0>(at), std::get<1>(at), std::get<2>(at) });
    ASSERT_EQ(view.count, int(points.size()));
    for (int i = 0; i < view.count; ++i)
    {
      const Vec3f wanted(points[std::size_t(i)]->positionMm - sorted.originMm());
      ASSERT_EQ(Vec3f(view.x[i], view.y[i], view.z[i]), wanted);
      ASSERT_EQ(view.amplitude[i], points[std::size_t(i)]->amplitude);
    }
  }
  EXPECT_EQ(sorted.count(), int(s1.points.size()));
}

TEST(EchoPoints, TheirSortTellsHowFarItIsAndStops)
{
  const SceneS1 s1(1000000);
  std::vector<double> told;
  const PointScatterers sorted(s1.points, [&](double fraction) {
    told.push_back(fraction);
    return true;
  });
  EXPECT_GT(told.size(), 40u); // each some milliseconds
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GE(told.front(), 0.0);
  EXPECT_LE(told.back(), 1.0);
  for (const double last : { 0.0, 0.1, 0.3, 0.5, 0.7, 0.9 })
  {
    double at = 0.0;
    EXPECT_THROW(PointScatterers(s1.points,
                                 [&](double fraction) {
                                   EXPECT_LE(at, last); // not asked again
                                   at = fraction;
                                   return fraction <= last;
                                 }),
                 Aborted);
  }
}

TEST(EchoPoints, KeepTheirPhaseFarFromTheOrigin)
{
  SceneS1 s1(20000);
  const Vec3d far(1e5, -1e5, 1e5);
  for (PointScatterer& p : s1.points)
  {
    p.positionMm += far;
  }
  for (ScanLine& line : s1.lines)
  {
    line.originMm += far;
  }
  const RfLines rf = formPoints(s1.points, s1.lines, s1.settings);
  const auto exact = directIq(s1.points, s1.lines[64], s1.settings);
  EXPECT_LT(nrmse(rf.iq.data() + 64 * exact.size(), exact), 1e-3);
}

TEST(EchoPoints, AnElongatedTiltedBeamSeesAllItShould)
{
  SceneS1 s1(20000);
  s1.settings.lateralSigmaMm = 0.4;
  s1.settings.elevationalSigmaMm = 2.5;
  s1.settings.depthMm = 90.0;
  const ScanLine tilted = makeLine({ -30.0, 4.0, 20.0 }, { 0.8, -0.1, 0.5 });
  const RfLines rf = formPoints(s1.points, { tilted }, s1.settings);
  EXPECT_LT(nrmse(rf.iq.data(), directIq(s1.points, tilted, s1.settings)), 1e-3);
}

TEST(EchoPoints, OneOutlierDoesNotHideTheOthers)
{
  SceneS1 s1(20000);
  s1.points.push_back({ { 9e5, 0.0, 0.0 }, 1.0f });
  const RfLines rf = formPoints(s1.points, s1.lines, s1.settings);
  const auto exact = directIq(s1.points, s1.lines[64], s1.settings);
  EXPECT_LT(nrmse(rf.iq.data() + 64 * exact.size(), exact), 1e-3);
}

TEST(EchoPoints, ALineDoesNotDependOnItsNeighbours)
{
  const SceneS1 s1(20000);
  const RfLines all = formPoints(s1.points, s1.lines, s1.settings);
  const RfLines one = formPoints(s1.points, { s1.lines[37] }, s1.settings);
  double worst = 0.0;
  for (std::size_t s = 0; s < one.iq.size(); ++s)
  {
    worst = std::max<double>(worst, std::abs(one.iq[s] - all.iq[37 * one.iq.size() + s]));
  }
  EXPECT_LT(worst, 1e-5 * std::abs(*std::max_element(one.iq.begin(), one.iq.end(),
                                                     [](auto a, auto b) { return std::norm(a) < std::norm(b); })));
}

TEST(EchoOneScatterer, PeaksAtItsDepthWithItsAmplitude)
{
  const EchoSettings s = calibrationSettings();
  const ScanLine line = makeLine({ 3.0, -2.0, 7.0 }, { 0.3, 0.2, 1.0 });
  for (int i = 0; i < 200; ++i)
  {
    const double depth = 20.0 + 0.2331 * i; // any position between two samples
    const RfLines rf = formPoints({ { line.originMm + line.axis * depth, 2.5f } }, { line }, s);
    const std::vector<float> envelope = rf.envelope();
    const auto peak = std::max_element(envelope.begin(), envelope.end());
    EXPECT_NEAR(double(peak - envelope.begin()) * rf.sampleMm, depth, 0.01);
    EXPECT_NEAR(*peak, 2.5, 2.5e-2 * 0.5) << depth; // half a sample beside the peak the pulse has lost 0.2 %
    // The carrier is right at the peak: the RF there is the cosine of what is left of the way.
    const double rest =
      4.0 * M_PI * s.centreFrequencyMHz / 1.54 * (double(peak - envelope.begin()) * rf.sampleMm - depth);
    EXPECT_NEAR(rf.rf()[std::size_t(peak - envelope.begin())] / *peak, std::cos(rest), 2e-3) << depth;
  }
}

TEST(EchoOneScatterer, HasTheWidthsOfPulseAndBeam)
{
  EchoSettings s = calibrationSettings();
  s.lateralSigmaMm = 1.3;
  s.elevationalSigmaMm = 2.1;
  const double fullWidth = 2.0 * std::sqrt(2.0 * std::log(2.0)); // of a Gaussian at half its height, in sigma
  const std::vector<PointScatterer> point{ { { 0.0, 0.0, 40.003 }, 1.0f } };

  const RfLines axial = formPoints(point, parallelLines(1, 1.0, { 1, 0, 0 }), s);
  EXPECT_NEAR(widthAt(axial.envelope(), axial.sampleMm, std::pow(10.0, -0.3)), 0.3140, 0.001); // at -6 dB
  const double sigma = pulseSigmaMm(s.centreFrequencyMHz, s.fractionalBandwidth);
  EXPECT_NEAR(widthAt(axial.envelope(), axial.sampleMm, 0.5) / (fullWidth * sigma), 1.0, 0.01);

  for (const bool lateral : { true, false })
  {
    const double pitch = 0.1;
    const RfLines rf = formPoints(point, parallelLines(121, pitch, lateral ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)), s);
    const std::vector<float> envelope = rf.envelope();
    std::vector<float> profile;
    for (int line = 0; line < rf.lineCount; ++line)
    {
      const auto row = envelope.begin() + std::ptrdiff_t(line) * rf.sampleCount;
      profile.push_back(*std::max_element(row, row + rf.sampleCount));
    }
    const double expected = fullWidth * (lateral ? s.lateralSigmaMm : s.elevationalSigmaMm);
    EXPECT_NEAR(widthAt(profile, pitch, 0.5) / expected, 1.0, 0.01) << (lateral ? "lateral" : "elevational");
  }
}

TEST(EchoOneScatterer, NearTheEndsOfTheLineEchoesAsElsewhere)
{
  const EchoSettings s = calibrationSettings();
  const ScanLine line = makeLine({ 0, 0, 0 }, { 0, 0, 1 });
  // In front of the face, at it, above the line's end and below, where only the pulse's flank is seen.
  for (const double depth : { 0.0, 0.05, 79.9, 80.0, 80.2 })
  {
    const std::vector<PointScatterer> point{ { { 0.0, 0.0, depth }, 1.0f } };
    EXPECT_LT(nrmse(formPoints(point, { line }, s).iq.data(), directIq(point, line, s)), 2e-3) << depth;
  }
  // Behind the face nothing echoes.
  for (const std::complex<float> iq : formPoints({ { { 0.0, 0.0, -0.05 }, 1.0f } }, { line }, s).iq)
  {
    ASSERT_EQ(iq, std::complex<float>{});
  }
}

TEST(EchoIntensity, MultipliesTheScatterersLinearlyBetweenItsBins)
{
  const SceneS1 s1(200000);
  const ScanLine& line = s1.lines[64];
  TracedLines traced;
  traced.lineCount = 1;
  traced.binMm = 0.25;
  traced.binCount = 480;
  for (int b = 0; b < traced.binCount; ++b)
  {
    traced.intensity.push_back(float(std::exp(-0.02 * b) * (b > 200 ? 0.3 : 1.0))); // a fall and a step
  }
  traced.standardError.assign(traced.intensity.size(), 0.0f);
  const auto intensity = [&](double r) {
    const double at = std::clamp(r / 0.25 - 0.5, 0.0, 479.0);
    const int b = std::min(int(at), 478);
    return traced.intensity[std::size_t(b)] * (b + 1 - at) + traced.intensity[std::size_t(b) + 1] * (at - b);
  };
  const PointScatterers sorted(s1.points);
  const RfLines rf = formRf({ nullptr, &traced, &sorted }, { line }, s1.settings);
  EXPECT_LT(nrmse(rf.iq.data(), directIq(s1.points, line, s1.settings, intensity)), 1e-3);
}

TEST(EchoIntensity, DarknessHidesWhatLiesBelow)
{
  TracedLines traced;
  traced.lineCount = 1;
  traced.binMm = 1.0;
  traced.binCount = 80;
  traced.intensity.assign(80, 1.0f);
  std::fill(traced.intensity.begin() + 40, traced.intensity.end(), 0.0f);
  traced.standardError.assign(80, 0.0f);
  const PointScatterers points({ { { 0, 0, 30 }, 1.0f }, { { 0, 0, 50 }, 1.0f } });
  const RfLines rf =
    formRf({ nullptr, &traced, &points }, { makeLine({ 0, 0, 0 }, { 0, 0, 1 }) }, calibrationSettings());
  EXPECT_NEAR(std::abs(rf.iq[std::size_t(std::lround(30.0 / rf.sampleMm))]), 1.0, 2e-3);
  EXPECT_EQ(std::abs(rf.iq[std::size_t(std::lround(50.0 / rf.sampleMm))]), 0.0f);
}

} // namespace
