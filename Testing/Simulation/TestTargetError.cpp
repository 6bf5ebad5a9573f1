#include "BeamScenes.h"
#include "BusyScene.h"

#include "Kernel/Reverberation.h"
#include "Trace/RefinedTrace.h"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

// Lines that get paths until their picture is as exact as is wanted: Data/docs/physics.md 9.2.

namespace {

using namespace sono;
using namespace sono::test;

/// So that some lines are harder than others: what lies behind the ball is seen past its edges alone.
TraceSettings refined(double targetDb, int mostPaths)
{
  TraceSettings s = busySettings();
  s.targetErrorDb = targetDb;
  s.pathsPerLine = mostPaths;
  return s;
}

/// A line's part of an array of `each` values a line.
template<class T>
std::vector<T> rowOf(const std::vector<T>& values, std::size_t line, int each)
{
  const auto first = values.begin() + std::ptrdiff_t(line) * each;
  return values.empty() ? values : std::vector<T>(first, first + each);
}

/// Every line against those of fixed numbers of paths.
void expectFixedLines(const Scene& scene, const std::vector<ScanLine>& lines, TraceSettings s)
{
  const TracedLines some = trace(scene, lines, s);
  const std::set<int> numbers(some.paths.begin(), some.paths.end());
  EXPECT_GT(numbers.size(), 1u) << "all lines have " << some.paths[0] << " paths, error " << some.errorDb;
  s.targetErrorDb = 0.0;
  for (const int paths : numbers)
  {
    s.pathsPerLine = paths;
    const TracedLines fixed = trace(scene, lines, s);
    EXPECT_EQ(fixed.paths, std::vector<int>(lines.size(), paths));
    for (std::size_t l = 0; l < lines.size(); ++l)
    {
      if (some.paths[l] != paths)
      {
        continue;
      }
      const auto expectSame = [&](const std::vector<float>& one, const std::vector<float>& other, const char* what) {
        EXPECT_EQ(rowOf(one, l, some.binCount), rowOf(other, l, some.binCount)) << what << " of line " << l;
      };
      expectSame(some.intensity, fixed.intensity, "intensity");
      expectSame(some.standardError, fixed.standardError, "standard error");
      expectSame(some.attenuationNpPerMHz, fixed.attenuationNpPerMHz, "attenuation");
      expectSame(some.depthOffsetMm, fixed.depthOffsetMm, "depth offset");
      expectSame(some.reverberationError, fixed.reverberationError, "error of the reverberation");
      const auto echo = rowOf(some.boundaryEcho, l, some.echoCount);
      const auto wanted = rowOf(fixed.boundaryEcho, l, some.echoCount);
      for (std::size_t e = 0; e < echo.size(); ++e)
      {
        // Summed in another order, in double precision.
        EXPECT_LE(std::abs(echo[e] - wanted[e]), 2e-7f * std::abs(wanted[e]) + 1e-12f) << l << " sample " << e;
      }
    }
  }
}

TEST(TargetError, LinesHaveWhatAFixedNumberOfPathsLeaves)
{
  const auto scene = makeBusyScene();
  for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy })
  {
    TraceSettings s = refined(0.06, 8192);
    s.sampling = sampling;
    expectFixedLines(*scene, fan(16), s);
  }
  TraceSettings amadou = refined(2.5, 4096);
  amadou.model = InterfaceModel::Amadou2024;
  expectFixedLines(*scene, fan(16), amadou);
}

TEST(TargetError, SoItIsWithPathsThatStartApartAndReverberate)
{
  const auto scene = makeBusyScene();
  TraceSettings s = refined(0.1, 4096);
  s.aperture = p42().aperture();
  expectFixedLines(*scene, fan(16), s);
  s.reverberation = true;
  s.targetErrorDb = 0.5;
  expectFixedLines(*scene, fan(16), s);
}

TEST(TargetError, NumbersOfPathsAreFirstOnesDoubledWithinTheMost)
{
  const auto scene = makeBusyScene();
  for (const int most : { 1, 31, 63, 64, 100, 300, 4096 })
  {
    const TracedLines traced = trace(*scene, fan(8), refined(0.001, most));
    // 0.001 dB asks for all that may be had.
    int expected = most < 2 * firstPaths ? most : firstPaths;
    while (most >= 2 * firstPaths && 2 * expected <= most)
    {
      expected *= 2;
    }
    EXPECT_EQ(traced.paths, std::vector<int>(8, expected)) << most;
  }
}

TEST(TargetError, OneTwoAndEightThreadsGiveTheSameBits)
{
  std::vector<TracedLines> results;
  TraceSettings s = refined(0.5, 2048);
  s.reverberation = true;
  for (const std::size_t threads : { 1, 2, 8 })
  {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(trace(*makeBusyScene(), fan(24), s));
  }
  for (const std::size_t other : { 1, 2 })
  {
    EXPECT_EQ(results[0].paths, results[other].paths);
    EXPECT_EQ(results[0].intensity, results[other].intensity);
    EXPECT_EQ(results[0].reverberation, results[other].reverberation);
    EXPECT_EQ(results[0].boundaryEcho, results[other].boundaryEcho);
    EXPECT_EQ(results[0].errorDb, results[other].errorDb);
    EXPECT_EQ(results[0].segments, results[other].segments);
  }
}

/// Rms of the errors in dB of the cells that a picture shows, against a reference; brute force, with no regard to
/// reverberation.
double trueErrorDb(const TracedLines& traced, const TracedLines& reference)
{
  constexpr int each = 2; // bins of 0.5 mm
  const int cells = int(traced.binCount * traced.binMm / 1.04);
  const auto levelOf = [&](const TracedLines& of, int line, int cell) {
    double sum = 0.0;
    for (int b = cell * each; b < (cell + 1) * each; ++b)
    {
      sum += double(of.intensity[std::size_t(line) * std::size_t(of.binCount) + std::size_t(b)]) / each;
    }
    return std::max(sum, 1e-12);
  };
  std::vector<double> gainedDb;
  for (int line = 0; line < traced.lineCount; ++line)
  {
    for (int cell = 6; cell < cells; ++cell)
    {
      gainedDb.push_back(20.0 * std::log10(levelOf(reference, line, cell)) + 5.0 * (cell + 0.5) / 10.0);
    }
  }
  std::vector<double> sorted = gainedDb;
  std::sort(sorted.begin(), sorted.end());
  const double darkDb = sorted[std::size_t(0.9 * double(sorted.size()))] + 25.0 - 60.0;
  double squares = 0.0;
  int count = 0;
  for (int line = 0; line < traced.lineCount; ++line)
  {
    for (int cell = 6; cell < cells; ++cell)
    {
      if (gainedDb[std::size_t(line) * std::size_t(cells - 6) + std::size_t(cell - 6)] > darkDb)
      {
        squares += std::pow(20.0 * std::log10(levelOf(traced, line, cell) / levelOf(reference, line, cell)), 2.0);
        ++count;
      }
    }
  }
  return std::sqrt(squares / count);
}

TEST(TargetError, IsReachedAgainstAReference)
{
  const auto scene = makeBusyScene();
  const auto lines = fan(24);
  TraceSettings many = refined(0.0, 1 << 17);
  many.seed = 99;
  const TracedLines reference = trace(*scene, lines, many);
  for (const double targetDb : { 0.2, 0.1, 0.05 })
  {
    double squares = 0.0;
    constexpr int seeds = 8;
    for (int seed = 1; seed <= seeds; ++seed)
    {
      TraceSettings s = refined(targetDb, 1 << 16);
      s.seed = std::uint64_t(seed);
      const TracedLines traced = trace(*scene, lines, s);
      EXPECT_LE(traced.errorDb, targetDb);
      EXPECT_GT(traced.errorDb, 0.25 * targetDb) << "more than was asked for";
      squares += std::pow(trueErrorDb(traced, reference), 2.0) / seeds;
    }
    // The standard error of eight batches is itself uncertain, by a quarter for one line.
    EXPECT_LT(std::sqrt(squares), 1.25 * targetDb);
  }
}

TEST(TargetError, EveryRoundIsAPictureAndTheLastIsTheTrace)
{
  const auto scene = makeBusyScene();
  const auto lines = fan(12);
  const TraceSettings s = refined(0.05, 4096);
  RefinedTrace rounds(*scene, lines, s, {}, {});
  const TracedLines first = rounds.lines();
  TraceSettings fixed = s;
  fixed.targetErrorDb = 0.0;
  fixed.pathsPerLine = firstPaths;
  EXPECT_EQ(first.intensity, trace(*scene, lines, fixed).intensity);
  EXPECT_EQ(first.paths, std::vector<int>(lines.size(), firstPaths));
  int count = 1;
  while (rounds.refine({}))
  {
    ++count;
  }
  EXPECT_GT(count, 3);
  EXPECT_LT(rounds.lines().errorDb, 0.5 * first.errorDb);
  const TracedLines atOnce = trace(*scene, lines, s);
  EXPECT_EQ(rounds.lines().intensity, atOnce.intensity);
  EXPECT_EQ(rounds.take().paths, atOnce.paths);
}

TEST(TargetError, AStopEndsIt)
{
  const auto scene = makeBusyScene();
  EXPECT_THROW(trace(*scene, fan(24), refined(0.001, 10000000), [](double done) { return done < 0.5; }), Aborted);
}

TEST(TargetError, ProgressGrowsToItsEnd)
{
  const auto scene = makeBusyScene();
  double last = 0.0;
  trace(*scene, fan(24), refined(0.2, 4096), [&](double done) {
    EXPECT_GE(done, last - 1e-9);
    EXPECT_LE(done, 1.0 + 1e-9);
    last = done;
    return true;
  });
}

/// Cells of level 1 everywhere but where they are dark, with an error each.
ShownCells cellsOf(int lines, int count, const std::vector<float>& errors)
{
  ShownCells cells;
  cells.lineCount = lines;
  cells.cellCount = count;
  cells.level.assign(std::size_t(lines * count), 1.0f);
  for (int line = 0; line < lines; ++line)
  {
    cells.error.insert(cells.error.end(), std::size_t(count), errors[std::size_t(line)]);
  }
  return cells;
}

TEST(TargetError, IsTheRmsOfStandardErrorsInDecibels)
{
  const double perShare = 20.0 / std::log(10.0);
  const LineErrors alike = lineErrors(cellsOf(9, 40, std::vector<float>(9, 0.1f)), std::vector<int>(9, 64));
  EXPECT_NEAR(alike.rmsDb(), 0.1 * perShare, 1e-5);
  EXPECT_EQ(alike.shown, std::vector<int>(9, 40));
  // More than all is all; a dark line counts by what lies beside it.
  ShownCells cells = cellsOf(9, 40, { 0, 0, 0, 0, 7, 0, 0, 0, 0 });
  std::fill_n(cells.level.begin() + 4 * 40, 40, 0.0f);
  const std::vector<int> paths{ 64, 64, 64, 64, 256, 64, 64, 64, 64 };
  const LineErrors one = lineErrors(cells, paths);
  const double whole = 40.0 * perShare * perShare;
  EXPECT_NEAR(one.squaredDb[4], whole / 5.0, 1e-3);
  EXPECT_NEAR(one.squaredDb[2], whole / 5.0 * 256 / 64, 1e-3);
  EXPECT_EQ(one.squaredDb[1], 0.0);
  // Nothing is where all is black.
  EXPECT_EQ(lineErrors(cellsOf(1, 4, { 0.0f }), { 32 }).rmsDb(), 0.0);
  cells.level.assign(cells.level.size(), 0.0f);
  EXPECT_EQ(lineErrors(cells, paths).rmsDb(), 0.0);
}

TEST(TargetError, DarkCellsDoNotCount)
{
  // With the gain of 5 dB/cm, 34 dB and 36 dB below the level of most.
  constexpr int count = 40;
  ShownCells cells = cellsOf(1, count, { 0.2f });
  for (int c = 0; c < count; ++c)
  {
    const double belowDb = c == 20 ? 34.0 : c == 30 ? 36.0 : 0.0;
    const std::size_t at = std::size_t(c);
    cells.level[at] = float(std::pow(10.0, -(0.5 * (c + 0.5) + belowDb) / 20.0));
    cells.error[at] = 0.2f * cells.level[at];
  }
  EXPECT_EQ(lineErrors(cells, { 64 }).shown[0], count - 1);
}

TEST(TargetError, TheLinesWithMostErrorAPathAreDoubled)
{
  LineErrors errors;
  errors.squaredDb = { 4.0, 1.0, 9.0, 0.0, 8.0 };
  errors.shown = { 10, 10, 10, 10, 10 };
  const std::vector<int> paths{ 32, 32, 64, 32, 128 };
  // 22 dB^2 are to become at most 50 target^2. By path: 9/64, 4/32, 8/128, 1/32.
  EXPECT_EQ(linesToDouble(errors, paths, 4096, std::sqrt(22.1 / 50.0)), std::vector<int>());
  EXPECT_EQ(linesToDouble(errors, paths, 4096, std::sqrt(21.0 / 50.0)), std::vector<int>({ 2 }));
  EXPECT_EQ(linesToDouble(errors, paths, 4096, std::sqrt(17.0 / 50.0)), std::vector<int>({ 0, 2 }));
  EXPECT_EQ(linesToDouble(errors, paths, 4096, std::sqrt(15.0 / 50.0)), std::vector<int>({ 0, 2, 4 }));
  EXPECT_EQ(linesToDouble(errors, paths, 4096, 0.0), std::vector<int>({ 0, 1, 2, 4 }));
  EXPECT_EQ(linesToDouble(errors, paths, 64, 0.0), std::vector<int>({ 0, 1 }));
}

TEST(TargetError, EchoesErrAsSumsOfPhasorsDo)
{
  TracedLines traced;
  traced.lineCount = 1;
  traced.binCount = 40;
  traced.binMm = 0.25;
  traced.echoSampleMm = 0.05;
  traced.echoCount = 190;
  const ShownCells layout = cellLayout(traced);
  ASSERT_EQ(layout.binsEach, 4);
  const double radPerMm = 20.0;
  constexpr int paths = 400;
  std::mt19937 random(5);
  // Sums of echoes at places in [3.2, 3.8) mm, over many draws.
  for (const double spreadMm : { 0.0, 0.6 })
  {
    double squares = 0.0;
    double reported = 0.0;
    constexpr int draws = 300;
    for (int draw = 0; draw < draws; ++draw)
    {
      LineEchoes echoes;
      echoes.samples.resize(std::size_t(traced.echoCount));
      echoes.last = traced.echoCount - 1;
      echoes.power.resize(std::size_t(traced.binCount));
      std::complex<double> sum;
      for (int path = 0; path < paths; ++path)
      {
        // On a sample, whose phase the grid takes off.
        const double rangeMm = 3.2 + 0.05 * std::floor(std::uniform_real_distribution<>(0.0, spreadMm)(random) / 0.05);
        const int sample = int(std::lround(rangeMm / traced.echoSampleMm));
        echoes.samples[std::size_t(sample)] += 2e-3;
        echoes.power[std::size_t(rangeMm / traced.binMm + 1e-9)] += 4e-6;
        sum += std::polar(2e-3, -radPerMm * sample * traced.echoSampleMm);
      }
      EchoCells cells;
      cells.level.resize(std::size_t(layout.cellCount));
      cells.error.resize(cells.level.size());
      fillEchoCells(traced, echoes, 0, paths, radPerMm, layout, cells);
      const double speckle = double(boundaryPerSpeckle);
      EXPECT_NEAR(cells.level[3], std::abs(sum) / paths / speckle, 1e-5);
      std::complex<double> mean;
      for (int step = 0; step < 12; ++step)
      {
        mean += std::polar(2e-3 / 12.0, -radPerMm * (3.2 + 0.05 * step));
      }
      const std::complex<double> expected = spreadMm > 0.0 ? mean : std::polar(2e-3, -radPerMm * 3.2);
      squares += std::norm(sum / double(paths) - expected) / draws;
      reported += std::pow(double(cells.error[3]) * speckle, 2.0) / draws;
      EXPECT_EQ(cells.error[2], 0.0f);
    }
    EXPECT_NEAR(std::sqrt(reported), std::sqrt(squares), 0.1 * std::sqrt(squares) + 1e-8) << spreadMm;
  }
}

TEST(TargetError, HasItsRange)
{
  const auto scene = makeBusyScene();
  for (const double targetDb : { -0.1, 6.1, std::nan("") })
  {
    EXPECT_THROW(trace(*scene, fan(1), refined(targetDb, 64)), Error) << targetDb;
  }
}

} // namespace
