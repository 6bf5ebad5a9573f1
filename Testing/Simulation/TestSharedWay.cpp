// The way that a line's paths share is followed once (Trace/SharedWay.h): sums are those of each path by itself.
#include "BusyScene.h"

#include "Trace/Deposit.h"
#include "Trace/SharedWay.h"
#include "Trace/TraceSetup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace {

using namespace sono;
using namespace sono::test;

/// Counts paths that arrive at the line's boundaries without having been reflected, one after the other.
struct ArrivalCounter : PathSink
{
  std::vector<int> arrived;

  explicit ArrivalCounter(std::size_t boundaries)
    : arrived(boundaries, 0)
  {
  }
  void meets(const PathState& path, const PathBoundary&)
  {
    if (path.reflections == 0)
    {
      ++arrived.at(std::size_t(path.collisions));
    }
  }
};

/// The intensity of a line, mean of its batches, of paths that are followed one by one.
std::vector<double> intensityPathByPath(const TraceSetup& setup, int index, const TracedLines& layout,
                                        std::uint64_t& segments)
{
  const TraceView& view = setup.view;
  const TraceLine& line = setup.lines[std::size_t(index)];
  const auto space = setup.space();
  // Where reverberation comes back to matters to its own sums alone.
  const int steps = int(view.depthMm) + 1;
  std::vector<float> range(std::size_t(steps) + 1);
  std::iota(range.begin(), range.end(), 0.0f);
  const std::vector<float> full(range.size(), 1.0f);
  const std::vector<float> none(range.size(), 0.0f);
  LineTally tally(layout.binCount, layout.binMm, binSumsOf(layout.model), layout.echoCount, layout.echoSampleMm, 1.0);
  tally.begin(view, line, std::uint32_t(index), { range.data(), full.data(), none.data(), steps, 1.0f });
  const LineStart start = startLine(view, space, line, tally);
  std::vector<double> sums;
  for (const BinSums<double>& bin : tally.takeBins(1))
  {
    sums.push_back(bin.of[intensitySum]);
  }
  const int batches = std::min(batchCount, setup.paths);
  for (int batch = 0; start.meets && batch < batches; ++batch)
  {
    const int paths = batchRange(setup.paths, batches, batch).count();
    for (int path = 0; path < paths; ++path)
    {
      const PathKey key{ std::uint32_t(index), std::uint32_t(batch), std::uint32_t(path), setup.seed, nullptr };
      tracePath(view, space, line, start, key, tally);
    }
    const std::vector<BinSums<double>> means = tally.takeBins(paths);
    for (std::size_t b = 0; b < sums.size(); ++b)
    {
      sums[b] += means[b].of[intensitySum] / batches;
    }
  }
  segments += tally.segments();
  return sums;
}

void expectAlike(const Scene& scene, const TraceSettings& settings)
{
  const std::vector<ScanLine> lines = fan(5);
  const TracedLines traced = trace(scene, lines, settings);
  const TraceSetup setup(scene, lines, settings, {}, {}, Records::OnDemand);
  std::uint64_t segments = 0;
  for (int line = 0; line < traced.lineCount; ++line)
  {
    const std::vector<double> expected = intensityPathByPath(setup, line, traced, segments);
    for (int b = 0; b < traced.binCount; ++b)
    {
      // Boundaries are at the same place to 2e-5 mm or so, of bins of 0.5 mm; one path of 300 that went elsewhere would
      // be 3e-3. Behind 57 mm, where 3e-6 are left, a few paths are heard that curved walls have
      // turned often enough to magnify the last digit to 1e-3 of one.
      const double value = expected[std::size_t(b)];
      EXPECT_NEAR(double(traced.intensity[std::size_t(line * traced.binCount + b)]), value, 1e-4 * value + 3e-9)
        << "line " << line << ", bin " << b;
    }
  }
  EXPECT_EQ(traced.segments, segments);
}

TEST(SharedWay, LeavesWhatEachPathByItselfDoes)
{
  const auto scene = makeBusyScene();
  for (const Sampling sampling : { Sampling::LowDiscrepancy, Sampling::Independent })
  {
    for (const bool reverberates : { false, true })
    {
      TraceSettings settings = busySettings();
      settings.pathsPerLine = 300;
      settings.sampling = sampling;
      settings.reverberation = reverberates;
      expectAlike(*scene, settings);
    }
  }
}

TEST(SharedWay, PathsThatRoulettePlaysWithAreByThemselves)
{
  const auto scene = makeBusyScene();
  TraceSettings settings = busySettings();
  settings.pathsPerLine = 300;
  settings.rouletteDb = -10.0;
  expectAlike(*scene, settings);
}

TEST(SharedWay, GoesOnToTheLastBoundaryThatPassesAnythingCoherently)
{
  const auto scene = makeBusyScene();
  TraceSettings settings = busySettings();
  const std::vector<ScanLine> lines = fan(5);
  const TraceSetup setup(*scene, lines, settings, {}, {}, Records::OnDemand);
  PathSink sink;
  std::size_t followed = 0;
  for (const TraceLine& line : setup.lines)
  {
    const LineStart start = startLine(setup.view, setup.space(), line, sink);
    if (!start.meets)
    {
      continue;
    }
    const std::vector<SharedStretch> way = sharedWay(setup.view, setup.space(), line, start);
    for (const SharedStretch& stretch : way)
    {
      // One that is followed leads somewhere, to a deeper boundary unless it is the last.
      EXPECT_EQ(stretch.isFollowed, !stretch.segments.empty());
      EXPECT_TRUE(stretch.isFollowed || &stretch == &way.back());
      EXPECT_EQ(stretch.start.path.reflections, 0);
      EXPECT_EQ(stretch.start.path.collisions, int(&stretch - way.data()));
      followed += stretch.isFollowed ? 1 : 0;
    }
  }
  EXPECT_GE(followed, 2 * lines.size());
}

// Of paths of a scrambled van der Corput sequence, 2^m of them, less than one more or less than their share lies above
// any number. With a number for each boundary a few more or less would.
TEST(CoherentWay, AsManyPathsPassEachBoundaryAsTheirShare)
{
  const double impedance[5] = { 1.5, 2.4, 1.3, 2.9, 1.4 };
  std::vector<Tissue> tissues;
  for (int layer = 0; layer < 5; ++layer)
  {
    tissues.push_back(makeTissue(std::string(1, char('a' + layer)), impedance[layer], 1540, 0.0));
    tissues.back().roughnessMm = 0.0;
  }
  const auto scene = makeScene(Vec3i(20, 20, 60), Vec3d(1.0), tissues, [](const Vec3d& p) { return int(p.z / 12.0); });
  constexpr int paths = 256;
  double independentSquares = 0.0;
  for (const Sampling sampling : { Sampling::LowDiscrepancy, Sampling::Independent })
  {
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
    {
      TraceSettings settings = busySettings();
      settings.sampling = sampling;
      settings.seed = seed;
      const TraceSetup setup(*scene, { makeLine({ 10.2, 10.3, 0.0 }, { 0.0, 0.0, 1.0 }) }, settings, {}, {},
                             Records::OnDemand);
      PathSink none;
      const LineStart start = startLine(setup.view, setup.space(), setup.lines[0], none);
      for (std::uint32_t batch = 0; batch < 8; ++batch)
      {
        ArrivalCounter count(std::size_t(setup.view.maxCollisions) + 1);
        for (std::uint32_t path = 0; path < paths; ++path)
        {
          const PathKey key{ 0, batch, path, setup.seed, nullptr };
          tracePath(setup.view, setup.space(), setup.lines[0], start, key, count);
        }
        double share = 1.0;
        for (std::size_t b = 1; b < 4; ++b)
        {
          // A boundary reflects as many paths as it does of the power, but no fewer than a quarter of the amplitude.
          const double r = std::fabs(impedance[b] - impedance[b - 1]) / (impedance[b] + impedance[b - 1]);
          share *= 1.0 - std::max(r * r, 0.25 * r);
          const double off = count.arrived[b] - paths * share;
          if (sampling == Sampling::LowDiscrepancy)
          {
            EXPECT_LT(std::fabs(off), 1.001) << "boundary " << b << ", seed " << seed << ", batch " << batch;
          }
          else if (b == 3)
          {
            independentSquares += off * off / (paths * share * (1.0 - share));
          }
        }
      }
    }
  }
  EXPECT_NEAR(independentSquares / 40.0, 1.0, 0.6); // chi square of 40: 0.22 is a deviation
}

} // namespace
