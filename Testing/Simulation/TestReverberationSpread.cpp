#include "TestScenes.h"

#include "Kernel/ReverberationSpread.h"
#include "Kernel/TracePath.h"
#include "Trace/Trace.h"
#include "Trace/TraceSetup.h"
#include "Trace/TracedReverberation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

// Sound that rough walls have spread: Data/docs/physics.md 13.4.

using namespace sono;
using namespace sono::test;

namespace {

/// Mean product of the signs at two places, over many bins.
double signProduct(const Vec3f& place, const Vec3f& direction, const Vec3f& otherPlace, const Vec3f& otherDirection,
                   float sideMm)
{
  constexpr int bins = 40000;
  double sum = 0.0;
  for (int bin = 0; bin < bins; ++bin)
  {
    sum += double(cellSign(place, direction, sideMm, signDraw(0, bin))) *
           double(cellSign(otherPlace, otherDirection, sideMm, signDraw(0, bin)));
  }
  return sum / bins;
}

/// A wall of gas, rough, 30 mm below a probe, and tissue in front of it.
std::unique_ptr<Scene> roughWall(double roughnessMm)
{
  Tissue tissue = makeTissue("tissue", 1.6, 1540.0, 0.0);
  tissue.roughnessMm = 0.0;
  tissue.backscatterPerCmSr = 5e-4;
  tissue.backscatterExponent = 0.0;
  tissue.scattererProbability = tissue.scattererMean = 1.0;
  Tissue gas = makeTissue("gas", 0.0004, 340.0, 0.0);
  gas.roughnessMm = roughnessMm;
  gas.correlationMm = 1.0;
  return makeScene({ 120, 120, 40 }, Vec3d(1.0), { tissue, gas }, [](const Vec3d& p) { return p.z > 30.0 ? 1 : 0; });
}

std::vector<ScanLine> linesDown(int count)
{
  std::vector<ScanLine> lines;
  for (int l = 0; l < count; ++l)
  {
    lines.push_back(makeLine({ 60.2 + 0.5 * (l - count / 2), 60.4, 0.0 }, { 0.0, 0.0, 1.0 }));
  }
  return lines;
}

TraceSettings settings(int paths)
{
  TraceSettings s;
  s.device = Device::Cpu;
  s.depthMm = 60.0;
  s.frequencyMHz = 2.5;
  s.pathsPerLine = paths;
  s.faceReflection = 0.0;
  s.reverberation = true;
  return s;
}

constexpr double firstRangeMm = 42.0;
constexpr int rangeCount = 12; // a millimetre apart

struct Passage
{
  Vec3d place;
  Vec3d direction;
  double level;
};

/// Where reflected paths pass the ranges.
struct PassageSink : PathSink
{
  std::array<std::vector<Passage>, rangeCount> at;

  void segment(const PathSegment& s)
  {
    for (int r = 0; s.reflections > 0 && r < rangeCount; ++r)
    {
      const double along = (firstRangeMm + r - double(s.rangeMm)) / double(s.rangePerMm);
      if (along >= 0.0 && along < double(s.length))
      {
        const double level = double(s.intensity) * double(s.scatter) * std::exp(-double(s.decayPerMm) * along);
        at[std::size_t(r)].push_back({ Vec3d(s.start) + Vec3d(s.direction) * along, Vec3d(s.direction), level });
      }
    }
  }
};

/// Sum over cells of the squared sum in each, over pairs of different paths, by sorting them into grids that begin at
/// random.
double cellPower(const std::vector<Passage>& passages, double sideMm)
{
  constexpr int grids = 30;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  double own = 0.0;
  for (const Passage& p : passages)
  {
    own += p.level * p.level;
  }
  double power = 0.0;
  for (int grid = 0; grid < grids; ++grid)
  {
    std::array<double, 7> begin{};
    for (double& b : begin)
    {
      b = uniform(random);
    }
    std::map<std::array<int, 7>, double> cells;
    for (const Passage& p : passages)
    {
      std::array<int, 7> cell{};
      Vec3d fromMiddle(0.0);
      for (int a = 0; a < 3; ++a)
      {
        const double position = p.place[a] / sideMm + begin[std::size_t(a)];
        cell[std::size_t(a)] = int(std::floor(position));
        fromMiddle[a] = (position - std::floor(position) - 0.5) * sideMm;
        cell[std::size_t(3 + a)] = int(std::floor(p.direction[a] / double(cellAngle) + begin[std::size_t(3 + a)]));
      }
      cell[6] = int(std::floor(glm::dot(p.direction, fromMiddle) / double(cellLengthMm) + begin[6]));
      cells[cell] += p.level;
    }
    for (const auto& [cell, level] : cells)
    {
      power += level * level;
    }
  }
  return power / grids - own;
}

/// Mean power of the level over lines and the ranges.
double tracedPower(const Scene& scene, int paths)
{
  const TracedLines traced = trace(scene, linesDown(9), settings(paths));
  double sum = 0.0;
  for (int l = 0; l < traced.lineCount; ++l)
  {
    for (int r = 0; r < rangeCount; ++r)
    {
      const auto bin = std::size_t((firstRangeMm + r) / traced.binMm);
      sum += std::pow(double(traced.reverberation[std::size_t(l) * std::size_t(traced.binCount) + bin]), 2.0);
    }
  }
  return sum / (rangeCount * traced.lineCount);
}

double decibels(double power)
{
  return 10.0 * std::log10(power);
}

TEST(ReverberationWindows, BinsWiderThanAWindowAreEachTakenOnce)
{
  const double radialBinMm = 15.0;
  std::map<std::array<int, 2>, int> taken;
  const ReverberationAround sum = sumFurther(20, 0, 128, 2, 11, float(radialBinMm), [&](int line, int bin) {
    ++taken[{ line, bin }];
    return ReverberationAround{ 1.0f, 1.0f, 1.0f, 1.0f, 1.0f };
  });
  EXPECT_EQ(taken.size(), 25u);
  EXPECT_FLOAT_EQ(sum.power, 25.0f);
  TraceSettings settings;
  settings.depthMm = 39.0;
  settings.radialBinMm = radialBinMm;
  const TracedLines lines = trace(*roughWall(0.3), linesDown(3), settings);
  ASSERT_FALSE(lines.reverberation.empty());
  float most = 0.0f;
  for (const float level : lines.reverberation)
  {
    most = std::max(most, level);
  }
  EXPECT_GT(most, 0.0f);
}

} // namespace

TEST(ReverberationSpread, SignsAgreeAsFarAsCellsOverlap)
{
  const Vec3f at(31.7f, -4.4f, 12.3f);
  const Vec3f down(0.0f, 0.0f, 1.0f);
  constexpr float sideMm = 4.0f;
  constexpr double noise = 0.025; // five standard errors of 40000 products
  EXPECT_EQ(signProduct(at, down, at, down, sideMm), 1.0);
  for (const float aside : { 0.4f, 1.6f, 3.2f, 5.0f, 40.0f })
  {
    const double overlap = std::max(0.0, 1.0 - double(aside / sideMm));
    EXPECT_NEAR(signProduct(at, down, at + Vec3f(aside, 0.0f, 0.0f), down, sideMm), overlap, noise) << aside;
    EXPECT_NEAR(signProduct(at, down, at + Vec3f(0.0f, aside, 0.0f), down, sideMm), overlap, noise) << aside;
  }
  // Along the way a cell is shorter.
  for (const float ahead : { 0.3f, 0.9f, 2.0f })
  {
    const double overlap = (1.0 - double(ahead / sideMm)) * std::max(0.0, 1.0 - double(ahead / cellLengthMm));
    EXPECT_NEAR(signProduct(at, down, at + Vec3f(0.0f, 0.0f, ahead), down, sideMm), overlap, noise) << ahead;
  }
  EXPECT_NEAR(signProduct(at, down, at, { 1.0f, 0.0f, 0.0f }, sideMm), 0.0, noise);
}

TEST(ReverberationSpread, TwoOfARowLieInOneCellAsOftenAsDrawn)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (const float lengthMm : { 0.5f, 2.0f, 3.0f, 12.0f })
  {
    constexpr int draws = 200000;
    int same = 0;
    for (int i = 0; i < draws; ++i)
    {
      const float begin = uniform(random);
      const auto cell = [&] { return int(std::floor(uniform(random) * lengthMm / 2.0f + begin)); };
      same += cell() == cell() ? 1 : 0;
    }
    EXPECT_NEAR(double(same) / draws, double(sameCell(lengthMm, 2.0f)), 0.006) << lengthMm;
  }
}

TEST(ReverberationSpread, ARoughWallEchoesAsCellsOfItsSoundDo)
{
  const auto scene = roughWall(0.1);
  constexpr int paths = 20000;
  const TraceSettings s = settings(paths);
  const TraceSetup setup(*scene, linesDown(1), s, {}, {}, Records::OnDemand);
  PassageSink sink;
  const LineStart start = startLine(setup.view, setup.space(), setup.lines[0], sink);
  ASSERT_TRUE(start.meets);
  for (std::uint32_t p = 0; p < paths; ++p)
  {
    tracePath(setup.view, setup.space(), setup.lines[0], start, PathKey{ 0, 0, p }, sink);
  }
  double power = 0.0;
  double together = 0.0;
  for (int r = 0; r < rangeCount; ++r)
  {
    const auto& passages = sink.at[std::size_t(r)];
    const float rangeMm = float(firstRangeMm + r);
    const double sideMm = double(resolutionCell(setup.view, setup.lines[0], rangeMm).sideMm);
    power += cellPower(passages, sideMm) / (double(paths) * paths * rangeCount);
    double all = 0.0;
    for (const Passage& p : passages)
    {
      all += p.level / paths;
    }
    together += all * all / rangeCount;
  }
  std::printf("a rough wall's sound echoes %.2f dB weaker than if it stayed together\n",
              decibels(together) - decibels(power));
  EXPECT_LT(decibels(power), decibels(together) - 6.0);
  EXPECT_NEAR(decibels(tracedPower(*scene, 8000)), decibels(power), 0.5);
  // Whatever the number of paths.
  EXPECT_NEAR(decibels(tracedPower(*scene, 1000)), decibels(power), 1.0);
  EXPECT_NEAR(decibels(tracedPower(*scene, 250)), decibels(power), 2.0);
}

TEST(ReverberationSpread, ASmoothWallKeepsItTogether)
{
  const auto scene = roughWall(0.0);
  for (const int paths : { 64, 1000 })
  {
    EXPECT_NEAR(decibels(tracedPower(*scene, paths)), 0.0, 0.02) << paths;
  }
}

// A region reaches as far as its lines do; one of another probe's pose begins elsewhere.
TEST(ReverberationSpread, DoesNotDependOnWhereTheRegionBegins)
{
  const auto scene = roughWall(0.1);
  TraceSettings s = settings(200);
  s.depthMm = 45.0;
  constexpr std::size_t untouched = 9; // of 18 lines those that the last is too far from to be averaged with
  std::vector<ScanLine> lines = linesDown(18);
  const TracedLines here = trace(*scene, lines, s);
  lines.back().originMm.x -= 17.3;
  const TracedLines there = trace(*scene, lines, s);
  const std::size_t bins = untouched * std::size_t(here.binCount);
  const float most = *std::max_element(here.reverberation.begin(), here.reverberation.begin() + std::ptrdiff_t(bins));
  ASSERT_GT(most, 0.0f);
  for (std::size_t i = 0; i < bins; ++i)
  {
    ASSERT_NEAR(here.reverberation[i], there.reverberation[i], 1e-3f * most) << "bin " << i;
  }
}

TEST(ReverberationSpread, TheErrorIsNoLessThanTheSpreadOverSeeds)
{
  const auto scene = roughWall(0.1);
  constexpr int seeds = 40;
  double sums[3] = {}; // of the level, its square and its error's
  TraceSettings s = settings(400);
  for (int seed = 1; seed <= seeds; ++seed)
  {
    s.seed = std::uint64_t(seed);
    const TracedLines traced = trace(*scene, linesDown(9), s);
    const std::size_t bin = 4 * std::size_t(traced.binCount) + std::size_t(45.0 / traced.binMm);
    const double level = double(traced.reverberation[bin]);
    sums[0] += level / seeds;
    sums[1] += level * level / seeds;
    sums[2] += std::pow(double(traced.reverberationError[bin]), 2.0) / seeds;
  }
  const double spread = std::sqrt((sums[1] - sums[0] * sums[0]) * seeds / (seeds - 1));
  EXPECT_GT(spread, 0.01 * sums[0]);
  EXPECT_GT(std::sqrt(sums[2]), 0.8 * spread); // 0.8: three deviations of 40 draws
}
