#include "SurfaceFigures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <random>

// Echoes of surfaces against integrals over those surfaces in double precision, Data/docs/physics.md section 10.

namespace {

using namespace sono;
using namespace sono::test;

class TiltedPlane : public testing::TestWithParam<double>
{
};

TEST_P(TiltedPlane, ReferenceIsTheClosedForm)
{
  const EchoSettings s = surfaceSettings();
  EXPECT_NEAR(decibels(planePeak(s, GetParam(), 0.0, 20.0) / (r0 * closedForm(s, GetParam()))), 0.0, 0.05);
}

/// Beyond 10 degrees the diffuse echo of the rough one is the stronger.
std::vector<double> roughnessesAt(double degrees)
{
  return degrees > 10.0 ? std::vector<double>{ 0.0 } : std::vector<double>{ 0.0, 0.03 };
}

TEST_P(TiltedPlane, OfATarget)
{
  for (const double roughnessMm : roughnessesAt(GetParam()))
  {
    EXPECT_NEAR(planeOfTargetErrorDb(GetParam(), roughnessMm), 0.0, 1.0) << roughnessMm << " mm rough";
  }
}

TEST_P(TiltedPlane, OfLabels)
{
  for (const double offsetMm : { 0.03, 0.17, 0.28 })
  {
    for (const double roughnessMm : roughnessesAt(GetParam()))
    {
      EXPECT_NEAR(planeOfLabelsErrorDb(GetParam(), roughnessMm, offsetMm), 0.0, 1.0)
        << roughnessMm << " mm rough, moved by " << offsetMm;
    }
  }
}

TEST_P(TiltedPlane, OfLabelsWhileTheProbeMoves)
{
  for (const double offsetMm : { 0.03, 0.17, 0.28 })
  {
    EXPECT_NEAR(planeOfLabelsErrorDb(GetParam(), 0.0, offsetMm, true), 0.0, 1.0) << "moved by " << offsetMm;
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, TiltedPlane,
                         testing::Values(0.0, 1.0, 2.0, 5.0, 7.0, 8.0, 10.0, 15.0, 20.0, 25.0, 28.0, 30.0, 40.0));

class Ball : public testing::TestWithParam<double>
{
};

TEST_P(Ball, OfATarget)
{
  const BallErrors errors = ballOfTargetErrors(GetParam());
  EXPECT_NEAR(errors.frontDb, 0.0, 1.0);
  EXPECT_NEAR(errors.backDb, 0.0, 1.0);
}

TEST_P(Ball, OfLabels)
{
  for (const double offsetMm : { 0.0, 0.13, 0.38 })
  {
    const BallErrors errors = ballOfLabelsErrors(GetParam(), offsetMm);
    EXPECT_NEAR(errors.frontDb, 0.0, 1.0) << "moved by " << offsetMm;
    EXPECT_NEAR(errors.backDb, 0.0, 1.0) << "moved by " << offsetMm;
  }
}

TEST_P(Ball, OfLabelsWhileTheProbeMoves)
{
  for (const double offsetMm : { 0.0, 0.13, 0.38 })
  {
    const BallErrors errors = ballOfLabelsErrors(GetParam(), offsetMm, true);
    EXPECT_NEAR(errors.frontDb, 0.0, 1.0) << "moved by " << offsetMm;
    EXPECT_NEAR(errors.backDb, 0.0, 1.0) << "moved by " << offsetMm;
  }
}

INSTANTIATE_TEST_SUITE_P(RadiusMm, Ball, testing::Values(5.0, 10.0, 20.0, 50.0));

/// Eq. 10.12, a plane across the beam.
double diffusePower(const EchoSettings& s, double roughnessMm, double correlationMm)
{
  const double k = wavenumber(s);
  const double g = std::pow(2.0 * k * roughnessMm, 2);
  double sum = 0.0;
  double poisson = std::exp(-g);
  for (int n = 1; n < 200; ++n)
  {
    poisson *= g / n;
    const double alpha = n / std::pow(k * correlationMm, 2);
    sum += poisson / std::sqrt((1.0 + 4.0 * k * k * s.lateralSigmaMm * s.lateralSigmaMm * alpha) *
                               (1.0 + 4.0 * k * k * s.elevationalSigmaMm * s.elevationalSigmaMm * alpha));
  }
  return r0 * r0 * sum;
}

/// The mean over the pulse's band.
double diffuseBandPower(const EchoSettings& s, double roughnessMm, double correlationMm)
{
  const double band = 1.0 / (2.0 * wavenumber(s) * pulseSigmaMm(s.centreFrequencyMHz, s.fractionalBandwidth));
  double sum = 0.0;
  double weights = 0.0;
  for (double x = -3.5; x < 3.55; x += 0.1)
  {
    EchoSettings at = s;
    at.centreFrequencyMHz *= 1.0 + x * band;
    sum += std::exp(-x * x) * diffusePower(at, roughnessMm, correlationMm);
    weights += std::exp(-x * x);
  }
  return sum / weights;
}

/// Mean square of the echo of normal heights of the correlation exp(-d^2 / l^2), drawn on a net of 0.05 mm and summed
/// with their slopes, of a plane at this tilt (rad).
double drawnPower(const EchoSettings& s, double tilt, double roughnessMm, double correlationMm, int surfaces)
{
  constexpr double stepMm = 0.05;
  const double k = wavenumber(s);
  const double alongMm = s.lateralSigmaMm / std::cos(tilt);
  const int across = int(8.0 * s.elevationalSigmaMm / stepMm);
  const int along = int(8.0 * alongMm / stepMm);
  const int reach = int(1.8 * correlationMm / stepMm);
  std::vector<double> kernel;
  double squares = 0.0;
  for (int i = -reach; i <= reach; ++i)
  {
    kernel.push_back(std::exp(-2.0 * std::pow(i * stepMm / correlationMm, 2)));
    squares += kernel.back() * kernel.back();
  }
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, roughnessMm / squares);
  const int noisy = across + 2 * reach;
  double power = 0.0;
  for (int n = 0; n < surfaces; ++n)
  {
    std::vector<double> noise(std::size_t(noisy) * std::size_t(along + 2 + 2 * reach));
    std::generate(noise.begin(), noise.end(), [&] { return normal(random); });
    std::vector<double> half(std::size_t(across) * std::size_t(along + 2 + 2 * reach), 0.0);
    for (std::size_t i = 0; i < half.size(); ++i)
    {
      const auto from =
        noise.begin() + std::ptrdiff_t(i / std::size_t(across) * std::size_t(noisy) + i % std::size_t(across));
      half[i] = std::inner_product(kernel.begin(), kernel.end(), from, 0.0);
    }
    const auto height = [&](int u, int v) {
      double sum = 0.0;
      for (int i = 0; i <= 2 * reach; ++i)
      {
        sum += kernel[std::size_t(i)] * half[std::size_t(u + i) * std::size_t(across) + std::size_t(v)];
      }
      return sum;
    };
    std::complex<double> echo = 0.0;
    for (int v = 0; v < across; ++v)
    {
      double before = height(0, v);
      double here = height(1, v);
      for (int u = 1; u <= along; ++u)
      {
        const double next = height(u + 1, v);
        const double slope = (next - before) / (2.0 * stepMm);
        const double x = (u - 0.5 * along) * stepMm;
        const double y = (v - 0.5 * across) * stepMm;
        const double weight = std::exp(-0.5 * (std::pow(x / alongMm, 2) + std::pow(y / s.elevationalSigmaMm, 2)));
        echo += std::polar((std::cos(tilt) - slope * std::sin(tilt)) * weight * stepMm * stepMm,
                           -2.0 * k * (x * std::sin(tilt) + here * std::cos(tilt)));
        before = here;
        here = next;
      }
    }
    power += std::norm(r0 * echo / beamArea(s)) / surfaces;
  }
  return power;
}

TEST(RoughSurface, ReferenceIsTheSurfacesOwnIntegral)
{
  // 400 surfaces drawn on a net, 30 degrees aslant, at one frequency.
  EchoSettings s = surfaceSettings();
  s.lateralSigmaMm = s.elevationalSigmaMm = 0.5;
  s.fractionalBandwidth = 0.01;
  const double t = M_PI / 6.0;
  EXPECT_NEAR(10.0 * std::log10(drawnPower(s, t, 0.06, 0.5, 400) / planeEnergy(s, 30.0, 0.06, 0.5)), 0.0, 1.0);
  // Across the beam, (10.12); the coherent one beside.
  const double across = diffusePower(s, 0.1, 1.0) + std::pow(r0 * coherentShare(s, 0.1, 1.0), 2);
  EXPECT_NEAR(planeEnergy(s, 0.0, 0.1, 1.0) / across, 1.0, 0.01);
}

TEST(RoughSurface, HasTheMeanSquareOfKirchhoffsIntegral)
{
  struct Case
  {
    double roughnessMm, correlationMm, lateralMm;
  };
  for (const Case& c : { Case{ 0.1, 1.0, 1.0 }, Case{ 0.2, 1.0, 1.0 }, Case{ 0.2, 4.0, 1.0 }, Case{ 0.15, 1.0, 0.6 } })
  {
    EchoSettings s = surfaceSettings();
    s.depthMm = 14.0;
    s.lateralSigmaMm = c.lateralMm;
    const auto scene =
      makeScene({ 110, 110, 18 }, Vec3d(1.0),
                { surfaceTissue("a", inMedium, 0.0), surfaceTissue("b", behind, c.roughnessMm, c.correlationMm) },
                [](const Vec3d& p) { return p.z < 8.0 ? 0 : 1; });
    const RfLines rf = formRf({ scene.get(), nullptr, nullptr }, manyLines(40, 2.5, 5.0), s);
    const std::size_t at = std::size_t(std::lround(8.0 / rf.sampleMm));
    double squares = 0.0;
    std::complex<double> mean = 0.0;
    for (int l = 0; l < rf.lineCount; ++l)
    {
      const std::complex<double> v = rf.iq[std::size_t(l) * std::size_t(rf.sampleCount) + at];
      squares += std::norm(v) / rf.lineCount;
      mean += v / double(rf.lineCount);
    }
    // A sample sums the band's amplitudes.
    const double g = std::pow(2.0 * wavenumber(s) * c.roughnessMm, 2);
    const double band = 1.0 / (2.0 * wavenumber(s) * pulseSigmaMm(s.centreFrequencyMHz, s.fractionalBandwidth));
    const double spread = 1.0 + g * band * band;
    const double coherent = r0 * std::exp(-0.5 * g / spread) / std::sqrt(spread);
    const double expected = diffuseBandPower(s, c.roughnessMm, c.correlationMm) + coherent * coherent;
    EXPECT_NEAR(10.0 * std::log10(squares / expected), 0.0, 0.5) << c.roughnessMm << ", " << c.correlationMm;
    // 1600 independent ones of this mean square leave a mean of 1/40 of its root.
    EXPECT_NEAR(std::abs(mean), coherent, 4.0 * std::sqrt(expected) / 40.0);
  }
}

TEST(RoughSurface, StaysWhereItIsWhenTheProbeMoves)
{
  EchoSettings s = surfaceSettings();
  s.depthMm = 20.0;
  const auto scene =
    makeScene({ 60, 20, 24 }, Vec3d(1.0), { surfaceTissue("a", inMedium, 0.0), surfaceTissue("b", behind, 0.1) },
              [](const Vec3d& p) { return p.z < 10.0 + 0.1 * p.x ? 0 : 1; });
  std::vector<ScanLine> lines;
  for (int l = 0; l < 12; ++l)
  {
    lines.push_back(makeLine({ 10.0 + 0.5 * l, 10.0, 0.0 }, { 0, 0, 1 }));
  }
  const std::vector<ScanLine> moved(lines.begin() + 3, lines.end());
  const RfLines rf = formRf({ scene.get(), nullptr, nullptr }, lines, s);
  const RfLines shifted = formRf({ scene.get(), nullptr, nullptr }, moved, s);
  const std::size_t skipped = 3 * std::size_t(rf.sampleCount);
  ASSERT_GT(peak(rf), 0.0);
  for (std::size_t n = 0; n < shifted.iq.size(); ++n)
  {
    ASSERT_NEAR(std::abs(shifted.iq[n] - rf.iq[n + skipped]), 0.0, 1e-6 * peak(rf));
  }
}

TEST(MatchedBoundary, AddsNothing)
{
  EchoSettings s = surfaceSettings();
  const auto scene = makeScene({ 20, 20, 40 }, Vec3d(1.0),
                               { surfaceTissue("a", inMedium, 0.2), surfaceTissue("b", inMedium * (1 + 6e-7), 0.2) },
                               [](const Vec3d& p) { return p.z < 20.0 ? 0 : 1; });
  EXPECT_LT(peak(formRf({ scene.get(), nullptr, nullptr }, { makeLine({ 10, 10, 0 }, { 0, 0, 1 }) }, s)), 1e-6);
}

/// A thin leaf in a fluid: its two faces echo, wherever voxels are as thick as it.
TEST(ThinLeaf, OfOneVoxelEchoes)
{
  EchoSettings s = surfaceSettings();
  for (const double degrees : { 0.0, 8.0, 20.0 })
  {
    const double slope = std::tan(degrees * M_PI / 180.0);
    const auto scene = makeScene(
      { 40, 24, 40 }, Vec3d(1.0), { surfaceTissue("a", inMedium, 0.0), surfaceTissue("leaf", behind, 0.15) },
      [&](const Vec3d& p) { return std::fabs(p.z - 20.2 - slope * (p.x - 20.0)) < 0.5 / std::cos(slope) ? 1 : 0; });
    const RfLines rf = formRf({ scene.get(), nullptr, nullptr }, { makeLine({ 20, 12, 0 }, { 0, 0, 1 }) }, s);
    // Two faces, each of that mean square across the beam; a speckle lies within 20 dB of it.
    const double expected = std::sqrt(2.0 * diffusePower(s, 0.15, 1.0));
    EXPECT_GT(decibels(peak(rf) / expected), degrees > 10.0 ? -30.0 : -15.0) << degrees;
    EXPECT_LT(decibels(peak(rf) / expected), 10.0) << degrees;
  }
}

/// The paths give the intensity alone: more of them do not change a boundary's echo.
TEST(SurfaceEcho, DoesNotDependOnTheNumberOfPaths)
{
  EchoSettings s = surfaceSettings();
  s.depthMm = 45.0;
  const auto scene =
    makeScene({ 40, 40, 50 }, Vec3d(1.0),
              { surfaceTissue("a", 1.6, 0.1), surfaceTissue("b", 1.7, 0.1), surfaceTissue("c", 1.5, 0.1) },
              [](const Vec3d& p) { return p.z < 12.0 ? 0 : (p.z < 25.0 + 0.1 * p.x ? 1 : 2); });
  TraceSettings tracing;
  tracing.depthMm = s.depthMm;
  tracing.lobeSigmaDeg = 0.0;
  std::vector<ScanLine> lines;
  for (int l = 0; l < 16; ++l)
  {
    lines.push_back(makeLine({ 12.0 + l, 20.0, 0.0 }, { 0, 0, 1 }));
  }
  std::vector<double> shallow;
  std::vector<double> deep;
  for (const int paths : { 100, 1000, 10000 })
  {
    tracing.pathsPerLine = paths;
    const RfLines rf = formRf(*scene, lines, trace(*scene, lines, tracing), s);
    double near = 0.0;
    double far = 0.0;
    for (int l = 0; l < rf.lineCount; ++l)
    {
      for (int n = 0; n < rf.sampleCount; ++n)
      {
        const double z = n * rf.sampleMm;
        const double power = std::norm(rf.iq[std::size_t(l) * std::size_t(rf.sampleCount) + std::size_t(n)]);
        near += std::fabs(z - 12.0) < 2.0 ? power : 0.0;
        far += std::fabs(z - 28.0) < 5.0 ? power : 0.0;
      }
    }
    shallow.push_back(near);
    deep.push_back(far);
  }
  for (std::size_t i = 1; i < shallow.size(); ++i)
  {
    EXPECT_NEAR(10.0 * std::log10(shallow[i] / shallow[0]), 0.0, 0.5);
    EXPECT_NEAR(10.0 * std::log10(deep[i] / deep[0]), 0.0, 0.5);
  }
}

} // namespace
