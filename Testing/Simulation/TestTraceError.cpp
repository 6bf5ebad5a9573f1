#include "BusyScene.h"

#include "Trace/Deposit.h"
#include "Trace/Trace.h"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include <cmath>

namespace {

using namespace sono;
using namespace sono::test;

TEST(TraceError, StandardErrorIsTheSpreadOverThirtySeeds)
{
  const auto scene = makeBusyScene();
  const auto lines = fan(16);
  constexpr int seeds = 30;
  for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy })
  {
    for (const int paths : { 100, 256 })
    {
      TraceSettings s = busySettings();
      s.reverberation = true; // branches are drawn then
      s.sampling = sampling;
      s.pathsPerLine = paths;
      std::vector<double> sum;
      std::vector<double> squares;
      double reported = 0.0;
      for (int seed = 0; seed < seeds; ++seed)
      {
        s.seed = std::uint64_t(100 + seed);
        const TracedLines traced = trace(*scene, lines, s);
        sum.resize(traced.intensity.size());
        squares.resize(traced.intensity.size());
        for (std::size_t b = 0; b < sum.size(); ++b)
        {
          sum[b] += traced.intensity[b];
          squares[b] += double(traced.intensity[b]) * traced.intensity[b];
          reported += double(traced.standardError[b]) * traced.standardError[b] / seeds;
        }
      }
      double observed = 0.0;
      for (std::size_t b = 0; b < sum.size(); ++b)
      {
        observed += (squares[b] - sum[b] * sum[b] / seeds) / (seeds - 1);
      }
      EXPECT_NEAR(std::sqrt(reported / observed), 1.0, 0.15) << int(sampling) << " paths " << paths;
    }
  }
}

TEST(TraceError, LowDiscrepancyNeedsFewerPaths)
{
  // A first boundary with a lobe, and nothing beyond: the stratified pairs must pay there.
  const auto scene =
    makeScene(Vec3i(60), Vec3d(1.0), { makeTissue("a", 1.5, 1540, 0.5), makeTissue("b", 1.8, 1600, 0.5) },
              [](const Vec3d& p) { return p.z < 20.0 ? 0 : 1; });
  const auto lines = fan(12);
  double error[2] = { 0.0, 0.0 };
  for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy })
  {
    TraceSettings s = busySettings();
    s.reverberation = true; // branches are drawn then
    s.pathsPerLine = 1024;
    s.sampling = sampling;
    const TracedLines traced = trace(*scene, lines, s);
    for (const float e : traced.standardError)
    {
      error[int(sampling)] += double(e) * e;
    }
  }
  // Half the error is a quarter of the paths.
  EXPECT_LT(std::sqrt(error[int(Sampling::LowDiscrepancy)]), 0.5 * std::sqrt(error[int(Sampling::Independent)]));
}

void expectSameBits(const TracedLines& one, const TracedLines& two)
{
  EXPECT_EQ(one.intensity, two.intensity);
  EXPECT_EQ(one.standardError, two.standardError);
  EXPECT_EQ(one.boundaryEcho, two.boundaryEcho);
  EXPECT_EQ(one.segments, two.segments);
}

TEST(TraceDeterminism, OneTwoAndEightThreadsGiveTheSameBits)
{
  const auto lines = fan(24);
  for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy })
  {
    TraceSettings s = busySettings();
    s.sampling = sampling;
    std::vector<TracedLines> results;
    for (const std::size_t threads : { 1, 2, 8 })
    {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
      // A scene of its own, so that the region is built on as many threads, too.
      results.push_back(trace(*makeBusyScene(), lines, s));
    }
    expectSameBits(results[0], results[1]);
    expectSameBits(results[0], results[2]);
  }
}

TEST(TraceDeterminism, ALineDependsOnItselfAndItsIndexAlone)
{
  const auto scene = makeBusyScene();
  const auto lines = fan(7);
  TraceSettings s = busySettings();
  // A reach that covers the whole volume for any choice of lines, so that the coordinates round alike.
  s.depthMm = 200.0;
  const TracedLines together = trace(*scene, lines, s);
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    const TracedLines alone = trace(*scene, std::vector<ScanLine>(i + 1, lines[i]), s);
    const auto begin = std::ptrdiff_t(i) * together.binCount;
    const auto echo = std::ptrdiff_t(i) * together.echoCount;
    EXPECT_TRUE(std::equal(alone.intensity.begin() + begin, alone.intensity.begin() + begin + alone.binCount,
                           together.intensity.begin() + begin));
    EXPECT_TRUE(std::equal(alone.standardError.begin() + begin, alone.standardError.begin() + begin + alone.binCount,
                           together.standardError.begin() + begin));
    EXPECT_TRUE(std::equal(alone.boundaryEcho.begin() + echo, alone.boundaryEcho.begin() + echo + alone.echoCount,
                           together.boundaryEcho.begin() + echo));
  }
}

TEST(TraceError, ManyLikePathsAddUpToOne)
{
  // Where all paths leave the same, a plain sum of floats drifts: the RF of planar layers by 0.8 % at a million paths.
  constexpr int paths = 300000;
  const TraceLine line{ Vec3f(0.0f), Vec3f(0.0f, 0.0f, 1.0f) };
  const PathSegment segment{ Vec3f(0.1f, 0.0f, 1.3f), Vec3f(0.0f, 0.0f, 1.0f), 20.0f, 0.3f, 0.01f, 0.0f };
  const auto leave = [&](int count, std::vector<std::complex<float>>& echoes) {
    LineTally tally(30, 1.0, binSumCount, 2000, 0.0154, 1.6);
    TraceView view;
    view.model = InterfaceModel::Amadou2024; // whose boundaries echo by paths
    view.coherenceMm = 100.0f;
    tally.begin(view, line, 0, {});
    tally.setEchoWeight(1.0f / float(count));
    for (int i = 0; i < count; ++i)
    {
      if (i % pathsPerFold == 0)
      {
        tally.fold();
      }
      tally.segment(segment);
      tally.echo(Vec3f(0.1f, 0.0f, 21.3f), 0.07f);
    }
    tally.takeEchoes(echoes.data());
    return tally.takeBins(count);
  };
  std::vector<std::complex<float>> oneEcho(2000);
  std::vector<std::complex<float>> manyEchoes(2000);
  const std::vector<BinSums<double>> one = leave(1, oneEcho);
  const std::vector<BinSums<double>> many = leave(paths, manyEchoes);
  for (std::size_t b = 0; b < one.size(); ++b)
  {
    for (int sum = 0; sum < binSumCount; ++sum)
    {
      EXPECT_NEAR(many[b].of[sum], one[b].of[sum], 1e-5 * one[b].of[sum]) << b;
    }
  }
  for (std::size_t s = 0; s < oneEcho.size(); ++s)
  {
    EXPECT_LE(std::abs(manyEchoes[s] - oneEcho[s]), 1e-6f * std::abs(oneEcho[s]) + 1e-12f) << s;
  }
}

TEST(TraceError, ATraceOfManyLikePathsIsThatOfAFew)
{
  // Straight through a boundary that does not reflect: every path leaves the same.
  const auto scene =
    makeScene(Vec3i(20, 20, 40), Vec3d(1.0), { makeTissue("a", 1.5, 1540, 0.5), makeTissue("b", 1.5, 1600, 0.5) },
              [](const Vec3d& p) { return p.z < 10.0 ? 0 : 1; });
  const std::vector<ScanLine> lines = { makeLine({ 10.2, 10.3, 0.0 }, { 0.0, 0.0, 1.0 }) };
  TraceSettings s;
  s.depthMm = 35.0;
  s.radialBinMm = 1.0;
  s.coherenceMm = 1e6;
  s.frequencyMHz = 2.0;
  s.pathsPerLine = 8; // one a batch
  const TracedLines few = trace(*scene, lines, s);
  s.pathsPerLine = 1000000;
  const TracedLines many = trace(*scene, lines, s);
  for (std::size_t b = 12; b < 33; ++b)
  {
    // Sums of 512 floats, each rounded to 2^-24 of at most the whole.
    EXPECT_NEAR(double(many.intensity[b]) / few.intensity[b], 1.0, 512.0 / (1 << 24)) << b;
  }
}

} // namespace
