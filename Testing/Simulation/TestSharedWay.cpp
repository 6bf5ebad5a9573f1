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
      // be 3e-3.
      const double value = expected[std::size_t(b)];
      EXPECT_NEAR(double(traced.intensity[std::size_t(line * traced.binCount + b)]), value, 1e-4 * value + 1e-9)
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

} // namespace
