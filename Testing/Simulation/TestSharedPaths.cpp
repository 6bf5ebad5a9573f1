#include "BusyScene.h"

#include "Labels/AssignTissues.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Trace/Deposit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace {

using namespace sono;
using namespace sono::test;

/// Means over seeds, and how far those scatter.
struct Averages
{
  std::vector<double> mean;
  double variance = 0.0; ///< of the means, summed
};

/// Intensities and the echoes' sums over windows of 2 mm, as seen by many seeds.
Averages average(const Scene& scene, const std::vector<ScanLine>& lines, TraceSettings s, int seeds, bool echoes,
                 const std::vector<TargetSurface>& targets = {})
{
  std::vector<double> sum;
  std::vector<double> squares;
  for (int seed = 0; seed < seeds; ++seed)
  {
    s.seed = std::uint64_t(300 + seed);
    const TracedLines traced = trace(scene, lines, s, {}, targets);
    std::vector<double> values;
    if (echoes)
    {
      const int window = int(2.0 / traced.echoSampleMm);
      for (int line = 0; line < traced.lineCount; ++line)
      {
        const auto row = traced.boundaryEcho.begin() + std::ptrdiff_t(line) * traced.echoCount;
        for (int w = 0; w + window <= traced.echoCount; w += window)
        {
          // Magnitudes: phases would hide a bias of the amplitude.
          double total = 0.0;
          for (int i = w; i < w + window; ++i)
          {
            total += std::abs(row[i]);
          }
          values.push_back(total);
        }
      }
    }
    else
    {
      values.assign(traced.intensity.begin(), traced.intensity.end());
    }
    sum.resize(values.size());
    squares.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      sum[i] += values[i];
      squares[i] += values[i] * values[i];
    }
  }
  Averages averages;
  for (std::size_t i = 0; i < sum.size(); ++i)
  {
    averages.mean.push_back(sum[i] / seeds);
    averages.variance += (squares[i] - sum[i] * sum[i] / seeds) / (double(seeds) * (seeds - 1));
  }
  return averages;
}

double squaredDistance(const Averages& a, const Averages& b)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < a.mean.size(); ++i)
  {
    sum += (a.mean[i] - b.mean[i]) * (a.mean[i] - b.mean[i]);
  }
  return sum;
}

/// A closed box of bone beside the fan's middle.
TargetSurface boneBox()
{
  TargetSurface box{ "box", makeTissue("bone", 6.0, 3500, 4.0), {}, {} };
  for (int i = 0; i < 8; ++i)
  {
    box.pointsMm.push_back({ i & 1 ? 40.0 : 31.0, i & 2 ? 30.0 : 20.0, i & 4 ? 38.0 : 33.0 });
  }
  box.triangles = { { 0, 2, 3 }, { 0, 3, 1 }, { 4, 5, 7 }, { 4, 7, 6 }, { 0, 1, 5 }, { 0, 5, 4 },
                    { 2, 6, 7 }, { 2, 7, 3 }, { 0, 4, 6 }, { 0, 6, 2 }, { 1, 3, 7 }, { 1, 7, 5 } };
  return box;
}

TEST(SharedPaths, KeepTheMeanOfIndependentOnes)
{
  const auto scene = makeBusyScene();
  const auto lines = fan(20);
  for (const double sigma : { 0.785, 0.1 })
  {
    for (const bool target : { false, true })
    {
      TraceSettings s = busySettings();
      s.lobeSigmaDeg = sigma * 180.0 / M_PI;
      const std::vector<TargetSurface> targets =
        target ? std::vector<TargetSurface>{ boneBox() } : std::vector<TargetSurface>{};
      s.sampling = Sampling::Independent;
      s.pathsPerLine = 4000;
      const Averages independent = average(*scene, lines, s, 12, false, targets);
      s.sampling = Sampling::SharedPaths;
      s.pathsPerLine = 512;
      const Averages shared = average(*scene, lines, s, 12, false, targets);
      // Errors of neighbouring bins and lines are alike, so the sum scatters about its mean by tens of percents.
      EXPECT_LT(squaredDistance(independent, shared), 2.0 * (independent.variance + shared.variance))
        << "sigma " << sigma << " target " << target;
    }
  }
}

TEST(SharedPaths, KeepTheEchoesOfIndependentOnes)
{
  // A lobe so narrow that the echoes of one boundary keep their phase.
  const auto scene = makeBusyScene();
  const auto lines = fan(20);
  TraceSettings s = busySettings();
  s.lobeSigmaDeg = 0.03 * 180.0 / M_PI;
  s.frequencyMHz = 0.05;
  s.sampling = Sampling::Independent;
  s.pathsPerLine = 2000;
  const Averages independent = average(*scene, lines, s, 10, true);
  s.sampling = Sampling::SharedPaths;
  const Averages shared = average(*scene, lines, s, 10, true);
  double power = 0.0;
  for (const double v : independent.mean)
  {
    power += v * v;
  }
  EXPECT_LT(squaredDistance(independent, shared), 1e-4 * power);
}

TEST(SharedPaths, TheReferenceMarchGivesTheSameImage)
{
  const auto scene = makeBusyScene();
  TraceSettings s = busySettings();
  s.sampling = Sampling::SharedPaths;
  s.pathsPerLine = 64;
  const TracedLines cells = trace(*scene, fan(20), s);
  s.march = March::NanoVDB;
  const TracedLines nano = trace(*scene, fan(20), s);
  double worst = 0.0;
  for (std::size_t i = 0; i < cells.intensity.size(); ++i)
  {
    worst = std::max(worst, std::fabs(double(cells.intensity[i]) - nano.intensity[i]));
  }
  EXPECT_LT(worst, 1e-4);
}

TEST(SharedPaths, WhatCannotBeSharedIsLowDiscrepancy)
{
  const auto scene = makeBusyScene();
  TraceSettings mirror = busySettings();
  mirror.lobeSigmaDeg = 0.0;
  TraceSettings amadou = busySettings();
  amadou.model = InterfaceModel::Amadou2024;
  TraceSettings deterministic = busySettings();
  deterministic.deterministic = true;
  for (TraceSettings s : { mirror, amadou, deterministic })
  {
    s.sampling = Sampling::LowDiscrepancy;
    const TracedLines own = trace(*scene, fan(9), s);
    s.sampling = Sampling::SharedPaths;
    const TracedLines shared = trace(*scene, fan(9), s);
    EXPECT_EQ(own.intensity, shared.intensity);
    EXPECT_EQ(own.boundaryEcho, shared.boundaryEcho);
  }
}

TEST(SharedPaths, FewPathsAndLinesStillGiveAnImage)
{
  const auto scene = makeBusyScene();
  for (const int lineCount : { 1, 2, 7, 13 })
  {
    for (const int paths : { 1, 2, 9 })
    {
      TraceSettings s = busySettings();
      s.sampling = Sampling::SharedPaths;
      s.pathsPerLine = paths;
      for (const float v : trace(*scene, fan(lineCount), s).intensity)
      {
        ASSERT_TRUE(std::isfinite(v));
      }
    }
  }
}

/// Three tissues meet at x = 10, z = 20, where the lines leave their first boundary: half of the paths are in the third
/// one at once.
TEST(SharedPaths, AThirdTissueInTheFirstBoundaryItselfIsJustAnother)
{
  const auto scene =
    makeScene(Vec3i(20, 20, 40), Vec3d(1.0),
              { makeTissue("a", 1.5, 1540, 0.4), makeTissue("b", 2.4, 1700, 0.6), makeTissue("c", 4.0, 2500, 1.0) },
              [](const Vec3d& p) { return p.z < 20.0 ? 0 : (p.x < 10.0 ? 1 : 2); });
  std::vector<ScanLine> lines;
  for (int i = 0; i < 8; ++i)
  {
    lines.push_back(makeLine({ 10.0, 6.0 + i, 0.0 }, { 0.0, 0.0, 1.0 }));
  }
  TraceSettings s = busySettings();
  s.depthMm = 36.0;
  s.coherenceMm = 50.0;
  s.sampling = Sampling::Independent;
  s.pathsPerLine = 20000;
  const Averages independent = average(*scene, lines, s, 6, false);
  s.sampling = Sampling::SharedPaths;
  s.pathsPerLine = 2000;
  const Averages shared = average(*scene, lines, s, 6, false);
  for (const double v : shared.mean)
  {
    ASSERT_TRUE(std::isfinite(v));
  }
  EXPECT_LT(squaredDistance(independent, shared), 3.0 * (independent.variance + shared.variance));
}

TEST(SharedPaths, CanBeStoppedWithinAGroup)
{
  const auto scene = makeBusyScene();
  TraceSettings s = busySettings();
  s.sampling = Sampling::SharedPaths;
  s.pathsPerLine = 8192;
  const auto lines = fan(4); // one group a batch
  const int pauses = 4 * s.pathsPerLine / pathsPerFold;
  trace(*scene, lines, s); // so that the region is there
  int told = 0;
  trace(*scene, lines, s, [&](double) {
    ++told;
    return true;
  });
  EXPECT_GE(told, pauses);
  int asked = 0;
  EXPECT_THROW(trace(*scene, lines, s, [&](double) { return ++asked < pauses / 3; }), Aborted);
  EXPECT_EQ(asked, pauses / 3);
}

TEST(SharedPaths, ATenthOfTheIndependentPathsIsEnoughForTheApicalView)
{
  LabelVolume volume = makeThoraxPhantom(2.0);
  const std::string data = SONOVDB_DATA_DIR;
  const TissueTable table = TissueTable::read(data + "/tissues.csv");
  assignTissues(volume, LabelTissueMap::read(data + "/label_tissues.csv"), table, "air");
  const Scene scene(std::move(volume), table, "air");
  const auto all = makeScanLines(ScanGeometry(), thoraxPhantomA4C().orthonormalized());
  const std::vector<ScanLine> lines(all.begin() + 44, all.begin() + 84);
  TraceSettings s;
  s.pathsPerLine = 256;
  std::array<double, 2> squared{};
  for (const Sampling sampling : { Sampling::Independent, Sampling::SharedPaths })
  {
    s.sampling = sampling;
    for (int seed = 1; seed <= 4; ++seed)
    {
      s.seed = std::uint64_t(seed);
      const TracedLines traced = trace(scene, lines, s);
      for (const float e : traced.standardError)
      {
        squared[sampling == Sampling::SharedPaths ? 1 : 0] += double(e) * e;
      }
    }
  }
  EXPECT_GT(squared[0], 10.0 * squared[1]);
}

} // namespace
