#include "Core/SoundSpeed.h"
#include "EchoScenes.h"
#include "TestScenes.h"

#include "Kernel/Scatterer.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>

namespace {

using namespace sono;
using namespace sono::test;

Tissue scatteringTissue(const std::string& name, double mean, double sigma, double probability)
{
  Tissue t = makeTissue(name, 1.6, 1540.0, 0.0);
  t.scattererMean = mean;
  t.scattererSigma = sigma;
  t.scattererProbability = probability;
  return t;
}

/// A cube of side 40 mm: tissue 0 above z = 20, tissue 1 below.
std::unique_ptr<Scene> twoLayers()
{
  return makeScene({ 40, 20, 80 }, { 1.0, 2.0, 0.5 },
                   { scatteringTissue("upper", 0.3, 0.2, 0.7), scatteringTissue("lower", 0.0, 0.4, 0.25) },
                   [](const Vec3d& p) { return p.z < 20.0 ? 0 : 1; });
}

std::unique_ptr<Scene> uniformCube(int sizeMm, double mean, double sigma, double probability)
{
  return makeScene(Vec3i(sizeMm), Vec3d(1.0), { scatteringTissue("tissue", mean, sigma, probability) },
                   [](const Vec3d&) { return 0; });
}

EchoSettings tissueSettings()
{
  EchoSettings s;
  s.centreFrequencyMHz = 3.6;
  s.depthMm = 38.0;
  s.scattererCellMm = 0.6;
  s.seed = 77;
  return s;
}

/// x of the upper tail probability u, by bisection.
double quantile(double u)
{
  double low = -10.0;
  double high = 10.0;
  for (int i = 0; i < 60; ++i)
  {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(middle / std::sqrt(2.0)) > u ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// All scatterers of `twoLayers` by looking into every cell, with the amplitude that the level gives them: the rms of a
/// medium with one unit scatterer a cell is sqrt(density * integral of w^2 * integral of the squared pulse).
std::vector<PointScatterer> enumerateTwoLayers(const EchoSettings& s)
{
  const double h = s.scattererCellMm;
  const double sigmaMm = 0.3140 * 3.6 / s.centreFrequencyMHz * 0.6 / s.fractionalBandwidth / 2.0 /
                         std::sqrt(2.0 * std::log(std::pow(10.0, 0.3)));
  const double power = std::pow(h, -3) * (M_PI * s.lateralSigmaMm * s.elevationalSigmaMm) * (std::sqrt(M_PI) * sigmaMm);
  const double scale = std::pow(10.0, s.scattererLevelDb / 20.0) / std::sqrt(power);
  std::vector<PointScatterer> points;
  const int cells = int(40.0 / h) + 1;
  for (int k = 0; k < cells; ++k)
  {
    for (int j = 0; j < cells; ++j)
    {
      for (int i = 0; i < cells; ++i)
      {
        const ScattererSeed seed = scattererSeed(s.seed, { i, j, k });
        const Vec3d p = (Vec3d(i, j, k) + Vec3d(seed.fraction)) * h;
        const bool upper = p.z < 20.0;
        if (glm::any(glm::greaterThanEqual(p, Vec3d(40.0))) || seed.presence >= (upper ? 0.7 : 0.25))
        {
          continue;
        }
        const double deviate = quantile(double(seed.deviate));
        points.push_back({ p, float(scale * (upper ? 0.3 + 0.2 * deviate : 0.4 * deviate)) });
      }
    }
  }
  return points;
}

double largest(const RfLines& rf)
{
  double out = 0.0;
  for (const std::complex<float> iq : rf.iq)
  {
    out = std::max<double>(out, std::abs(iq));
  }
  return out;
}

/// Amadou2024's scatterers: one density, and the level of the settings.
RfLines formTissue(const Scene& scene, const std::vector<ScanLine>& lines, const EchoSettings& s)
{
  const TracedLines traced = fullyLit(lines.size(), s, InterfaceModel::Amadou2024);
  return formRf({ &scene, &traced, nullptr }, lines, s);
}

TEST(EchoTissue, AgreesWithTheDirectSumOverItsCells)
{
  const auto scene = twoLayers();
  const std::vector<ScanLine> lines{ makeLine({ 20.0, 20.0, 0.0 }, { 0, 0, 1 }),
                                     makeLine({ 8.0, 33.0, 2.0 }, { 0.5, -0.6, 0.8 }),
                                     makeLine({ 20.0, -3.0, 30.0 }, { 0.1, 1.0, -0.3 }) }; // from outside
  EchoSettings s = tissueSettings();
  const std::vector<PointScatterer> points = enumerateTwoLayers(s);
  for (const double samplingMHz : { 50.0, 12.5 })
  {
    s.samplingMHz = samplingMHz;
    const RfLines rf = formTissue(*scene, lines, s);
    for (std::size_t line = 0; line < lines.size(); ++line)
    {
      const auto exact = directIq(points, lines[line], s);
      EXPECT_LT(nrmse(rf.iq.data() + line * exact.size(), exact), samplingMHz == 50.0 ? 1e-3 : 1e-2)
        << "line " << line << " at " << samplingMHz << " MHz";
    }
  }
}

TEST(EchoTissue, ExplicitScatterersAddToIt)
{
  const auto scene = twoLayers();
  const std::vector<ScanLine> lines{ makeLine({ 20.0, 20.0, 0.0 }, { 0, 0, 1 }) };
  const EchoSettings s = tissueSettings();
  const PointScatterers points({ { { 20.3, 19.9, 25.0 }, 0.7f }, { { 19.0, 20.0, 5.0 }, -0.2f } });
  const TracedLines traced = fullyLit(lines.size(), s, InterfaceModel::Amadou2024);
  const RfLines both = formRf({ scene.get(), &traced, &points }, lines, s);
  const RfLines tissue = formTissue(*scene, lines, s);
  const RfLines alone = formRf({ nullptr, nullptr, &points }, lines, s);
  for (std::size_t i = 0; i < both.iq.size(); ++i)
  {
    ASSERT_NEAR(std::abs(both.iq[i] - tissue.iq[i] - alone.iq[i]), 0.0, 1e-6);
  }
}

TEST(EchoTissue, ShiftsByALineWhenTheProbeMovesByOne)
{
  const auto scene = uniformCube(50, 0.3, 0.2, 0.7);
  ScanGeometry geometry;
  geometry.kind = ScanKind::Linear;
  geometry.lineCount = 21;
  geometry.widthMm = 20.0 * 0.83;
  ProbePose pose;
  pose.positionMm = { 25.0, 25.0, 0.0 };
  const RfLines before = formTissue(*scene, makeScanLines(geometry, pose), tissueSettings());
  pose.positionMm += pose.lateral * 0.83;
  const RfLines after = formTissue(*scene, makeScanLines(geometry, pose), tissueSettings());
  const std::size_t samples = std::size_t(before.sampleCount);
  double worst = 0.0;
  for (std::size_t i = samples; i < before.iq.size(); ++i)
  {
    worst = std::max<double>(worst, std::abs(before.iq[i] - after.iq[i - samples]));
  }
  EXPECT_LT(worst, 1e-5 * largest(before));
}

TEST(EchoTissue, StaysInTheAnatomyWhenTheProbeMoves)
{
  const auto scene = uniformCube(50, 0.3, 0.2, 0.7);
  const EchoSettings s = tissueSettings();
  const Vec3d axis = glm::normalize(Vec3d(0.3, 0.1, 1.0));
  const ScanLine line = makeLine({ 18.0, 22.0, 0.0 }, axis);
  const std::vector<float> before = formTissue(*scene, { line }, s).envelope();
  const double peak = *std::max_element(before.begin(), before.end());

  // Forward by 500 samples along the line: the same echoes 500 samples earlier.
  const std::size_t moved = 500;
  const std::vector<float> after =
    formTissue(*scene, { makeLine(line.originMm + axis * (double(moved) * s.sampleMm()), axis) }, s).envelope();
  const std::size_t pulse = 60; // what lies behind the face echoes no more
  for (std::size_t i = pulse; i + moved < before.size(); ++i)
  {
    ASSERT_NEAR(after[i], before[i + moved], 2e-3 * peak) << i;
  }

  // From the other end: the same echoes in reverse order.
  const std::size_t last = before.size() - 1;
  const ScanLine facing = makeLine(line.originMm + axis * (double(last) * s.sampleMm()), -axis);
  const std::vector<float> reversed = formTissue(*scene, { facing }, s).envelope();
  for (std::size_t i = pulse; i + pulse < before.size(); ++i)
  {
    ASSERT_NEAR(reversed[last - i], before[i], 2e-3 * peak) << i;
  }
}

TEST(EchoTissue, IsTheSameToTheBitOnAnyNumberOfThreads)
{
  const auto scene = twoLayers();
  ScanGeometry geometry;
  geometry.lineCount = 61;
  ProbePose pose;
  pose.positionMm = { 20.0, 20.0, 0.0 };
  const auto lines = makeScanLines(geometry, pose);
  std::vector<RfLines> images;
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  for (const int threads : { 1, 2, 8 })
  {
    tbb::task_arena arena(threads);
    arena.execute([&] { images.push_back(formTissue(*scene, lines, tissueSettings())); });
  }
  EXPECT_EQ(images[0].iq, images[1].iq);
  EXPECT_EQ(images[0].iq, images[2].iq);
  EXPECT_GT(largest(images[0]), 0.0);
}

/// Rms of the envelope, dB, over 100 separate lines in a uniform cube.
double rmsLevelDb(const Scene& scene, EchoSettings s)
{
  s.depthMm = 50.0;
  std::vector<ScanLine> lines;
  for (int i = 0; i < 100; ++i)
  {
    // Away from the cube's sides by more than 4 sigma, and not along the axes of the cells.
    lines.push_back(makeLine({ 17.0 + 2.9 * (i % 10), 17.0 + 2.9 * (i / 10), 5.0 }, { 0.05, -0.07, 1.0 }));
  }
  const RfLines rf = formTissue(scene, lines, s);
  double power = 0.0;
  double count = 0.0;
  for (int line = 0; line < rf.lineCount; ++line)
  {
    for (int i = int(3.0 / rf.sampleMm); i < rf.sampleCount; ++i) // past the face's own onset
    {
      power += std::norm(rf.iq[std::size_t(line) * std::size_t(rf.sampleCount) + std::size_t(i)]);
      count += 1.0;
    }
  }
  return 10.0 * std::log10(power / count);
}

TEST(EchoLevel, IsTheStatedRmsWhateverCellBeamAndPulse)
{
  const auto scene = uniformCube(60, 1.0, 0.0, 1.0);
  EchoSettings s;
  s.scattererLevelDb = -24.0;
  EXPECT_NEAR(rmsLevelDb(*scene, s), -24.0, 0.5);
  for (const double cell : { 0.4, 0.7 })
  {
    EchoSettings other = s;
    other.scattererCellMm = cell;
    EXPECT_NEAR(rmsLevelDb(*scene, other), -24.0, 0.5) << "cell of " << cell;
  }
  for (const double sigma : { 0.7, 2.0 })
  {
    EchoSettings other = s;
    other.lateralSigmaMm = sigma;
    other.elevationalSigmaMm = 0.5 + sigma;
    EXPECT_NEAR(rmsLevelDb(*scene, other), -24.0, 0.5) << "beam of " << sigma;
  }
  EchoSettings other = s;
  other.centreFrequencyMHz = 4.0;
  other.fractionalBandwidth = 0.9;
  EXPECT_NEAR(rmsLevelDb(*scene, other), -24.0, 0.5) << "another pulse";
}

TEST(EchoLevel, FollowsProbabilityMeanAndSigma)
{
  // 10 log10(mu1 (mu0^2 + sigma0^2)) relative to the level.
  const auto scene = uniformCube(60, 0.3, 0.4, 0.5);
  const EchoSettings s;
  EXPECT_NEAR(rmsLevelDb(*scene, s) - s.scattererLevelDb, 10.0 * std::log10(0.5 * 0.25), 0.5);
}

TEST(EchoLevel, FallsInFineCellsAsAJitteredLatticeDoes)
{
  // One equal scatterer in every cell is too regular where cells are finer than the half wavelength: its power lacks
  // the squared transform of a cell, here for a line near the z axis.
  const auto scene = uniformCube(60, 1.0, 0.0, 1.0);
  EchoSettings s;
  s.scattererCellMm = 0.2;
  const double x = M_PI * s.scattererCellMm * 2.0 * s.centreFrequencyMHz / assumedSoundSpeedMmPerUs;
  const double missing = std::pow(std::sin(x) / x, 2);
  EXPECT_NEAR(rmsLevelDb(*scene, s) - s.scattererLevelDb, 10.0 * std::log10(1.0 - missing), 0.5);
}

} // namespace
