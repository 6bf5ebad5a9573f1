#include "BeamScenes.h"
#include "BusyScene.h"
#include "ErrorText.h"

#include "BackgroundTrace.h"
#include "Echo/FormRf.h"
#include "Folders.h"
#include "Labels/AssignTissues.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Simulator.h"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <thread>

// Lines that get paths until their picture is as exact as is wanted: Data/docs/physics.md 9.2.

namespace {

using namespace sono;
using namespace sono::test;
using sono::testing::errorOf;
using sono::testing::expectContains;

/// A scene and how it is scanned.
struct Scan
{
  std::shared_ptr<const Scene> scene;
  std::vector<ScanLine> lines;
  TraceSettings tracing;
  EchoSettings echo;
};

Scan scanWith(std::shared_ptr<const Scene> scene, const ProbePose& pose, int lineCount, double depthMm)
{
  ImageSettings settings;
  settings.geometry = p42().geometry;
  settings.geometry.lineCount = lineCount;
  settings.geometry.depthMm = depthMm;
  settings.echo = echoOf(p42(), depthMm);
  settings.echo.samplingMHz = 20.0;
  settings.tracing.radialBinMm = 0.5;
  settings.tracing.device = Device::Cpu;
  settings.matchStages();
  return { std::move(scene), makeScanLines(settings.geometry, pose.orthonormalized()), settings.tracing,
           settings.echo };
}

Scan busyScan()
{
  static const std::shared_ptr<const Scene> scene = makeBusyScene();
  ProbePose pose;
  pose.positionMm = { 32.3, 24.2, 0.5 };
  return scanWith(scene, pose, 64, 50.0);
}

std::shared_ptr<const Scene> thorax()
{
  static const std::shared_ptr<const Scene> scene = [] {
    LabelVolume volume = makeThoraxPhantom(2.0);
    const TissueTable table = TissueTable::read(dataFile("tissues.csv"));
    assignTissues(volume, LabelTissueMap::read(dataFile("label_tissues.csv")), table, "air");
    return std::make_shared<Scene>(std::move(volume), table, "air");
  }();
  return scene;
}

Scan fourChambers()
{
  return scanWith(thorax(), thoraxPhantomA4C(), 48, 140.0);
}

/// The probe turned by a quarter about its axis.
Scan twoChambers()
{
  ProbePose pose = thoraxPhantomA4C().orthonormalized();
  pose.lateral = glm::cross(pose.axial, pose.lateral);
  return scanWith(thorax(), pose, 48, 140.0);
}

TracedLines refined(const Scan& scan, TraceSettings settings, const Progress& progress = {})
{
  Simulator simulator(scan.scene);
  return simulator.trace(scan.lines, settings, {}, progress).host();
}

/// Rms dB of the envelopes of all lines, at the RF's own sampling, against a reference, above -60 dB of its peak.
double trueErrorDb(const Scan& scan, const TracedLines& traced, const std::vector<float>& reference)
{
  const std::vector<float> is = formRf(*scan.scene, scan.lines, traced, scan.echo).envelope();
  std::vector<float> sorted = reference;
  std::sort(sorted.begin(), sorted.end());
  const double peak = sorted[sorted.size() - 1 - sorted.size() / 200];
  double squares = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < is.size(); ++i)
  {
    const double a = std::max(-60.0, 20.0 * std::log10(is[i] / peak));
    const double b = std::max(-60.0, 20.0 * std::log10(reference[i] / peak));
    if (std::max(a, b) > -60.0)
    {
      squares += (a - b) * (a - b);
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

/// What is claimed against what is true, as means of the squares over seeds.
void expectHonest(const Scan& scan, double targetDb)
{
  TraceSettings many = scan.tracing;
  many.pathsPerLine = 16384;
  many.seed = 99;
  const std::vector<float> reference =
    formRf(*scan.scene, scan.lines, trace(*scan.scene, scan.lines, many), scan.echo).envelope();
  constexpr int seeds = 4;
  double claimed = 0.0;
  double is = 0.0;
  for (int seed = 1; seed <= seeds; ++seed)
  {
    TraceSettings s = scan.tracing;
    s.targetErrorDb = targetDb;
    s.pathsPerLine = 8192;
    s.seed = std::uint64_t(seed);
    const TracedLines traced = refined(scan, s);
    EXPECT_LE(traced.errorDb, targetDb);
    EXPECT_LT(traced.paths, s.pathsPerLine);
    const double error = trueErrorDb(scan, traced, reference);
    EXPECT_GT(error, 0.6 * traced.errorDb) << "seed " << seed;
    EXPECT_LT(error, 1.6 * traced.errorDb) << "seed " << seed;
    claimed += traced.errorDb * traced.errorDb;
    is += error * error;
    std::printf("target %.2f seed %d: %d paths, claimed %.3f, true %.3f dB\n", targetDb, seed, traced.paths,
                traced.errorDb, error);
  }
  const double ratio = std::sqrt(is / claimed);
  EXPECT_GT(ratio, 0.7);
  EXPECT_LT(ratio, 1.4);
}

TEST(TargetError, IsTrueOfACurvedScene)
{
  expectHonest(busyScan(), 0.3);
}

TEST(TargetError, IsTrueOfFourChambers)
{
  expectHonest(fourChambers(), 1.0);
}

TEST(TargetError, IsTrueOfTwoChambers)
{
  expectHonest(twoChambers(), 1.0);
}

void expectSameLines(const TracedLines& a, const TracedLines& b, double tolerance)
{
  const auto expectSame = [](const auto& x, const auto& y, double within, const char* name) {
    ASSERT_EQ(x.size(), y.size()) << name;
    double difference = 0.0;
    double all = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      difference += std::norm(x[i] - y[i]);
      all += std::norm(y[i]);
    }
    EXPECT_LE(std::sqrt(difference), within * std::sqrt(all)) << name;
  };
  expectSame(a.intensity, b.intensity, tolerance, "intensity");
  expectSame(a.attenuationNpPerMHz, b.attenuationNpPerMHz, tolerance, "attenuation");
  expectSame(a.depthOffsetMm, b.depthOffsetMm, tolerance, "offset");
  expectSame(a.reverberation, b.reverberation, tolerance, "reverberation");
  expectSame(a.reverberationNpPerMHz, b.reverberationNpPerMHz, tolerance, "attenuation of reverberation");
  expectSame(a.boundaryEcho, b.boundaryEcho, tolerance, "echoes");
  // Differences of means that are nearly the same.
  expectSame(a.standardError, b.standardError, 10.0 * tolerance, "error");
  expectSame(a.reverberationError, b.reverberationError, 10.0 * tolerance, "error of reverberation");
  EXPECT_EQ(a.paths, b.paths);
}

TEST(TargetError, RoundsLeaveWhatAsManyPathsAtOnceDo)
{
  const auto scene = makeBusyScene();
  std::vector<TraceSettings> kinds(4, busySettings());
  kinds[0].sampling = Sampling::Independent;
  kinds[1].aperture = p42().aperture();
  kinds[2].model = InterfaceModel::Amadou2024;
  kinds[3].reverberation = false;
  for (TraceSettings& s : kinds)
  {
    s.pathsPerLine = 301;
    TraceRounds rounds(*scene, fan(16), s, {}, {});
    for (const int paths : { 8, 64, 128, 150, 301 })
    {
      rounds.traceTo(paths, paths < s.pathsPerLine, {});
    }
    const TracedLines once = trace(*scene, fan(16), s);
    expectSameLines(rounds.traced(), once, 2e-6);
  }
}

TEST(TargetError, OneTwoAndEightThreadsGiveTheSameBits)
{
  const Scan scan = busyScan();
  TraceSettings s = scan.tracing;
  s.targetErrorDb = 1.0;
  s.pathsPerLine = 1024;
  std::vector<TracedLines> results;
  for (const std::size_t threads : { 1, 2, 8 })
  {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(refined(scan, s));
  }
  for (const std::size_t other : { 1, 2 })
  {
    EXPECT_EQ(results[0].errorDb, results[other].errorDb);
    expectSameLines(results[0], results[other], 0.0);
  }
}

TEST(TargetError, AtMostSoManyPathsAreTraced)
{
  const Scan scan = busyScan();
  TraceSettings s = scan.tracing;
  s.targetErrorDb = 0.01;
  for (const int most : { 1, 40, 64, 65, 100, 300 })
  {
    s.pathsPerLine = most;
    const TracedLines traced = refined(scan, s);
    EXPECT_EQ(traced.paths, most);
    EXPECT_EQ(traced.errorDb > 0.0, most > 1) << most; // one round has nothing to be held against
    TraceSettings fixed = s;
    fixed.targetErrorDb = 0.0;
    expectSameLines(traced, refined(scan, fixed), 2e-6);
  }
  s.deterministic = true;
  EXPECT_EQ(refined(scan, s).paths, 1);
}

TEST(TargetError, AFixedNumberOfPathsIsAskedForWithoutOne)
{
  const Scan scan = busyScan();
  TraceSettings s = scan.tracing;
  s.pathsPerLine = 96;
  const TracedLines traced = refined(scan, s);
  EXPECT_EQ(traced.paths, 96);
  EXPECT_EQ(traced.errorDb, 0.0);
}

TEST(TargetError, ATimeBudgetEndsInTime)
{
  const Scan scan = busyScan();
  TraceSettings s = scan.tracing;
  s.pathsPerLine = 10000000;
  s.timeBudgetS = 1e-6; // the first round alone
  EXPECT_EQ(refined(scan, s).paths, 64);
  s.timeBudgetS = 0.5; // of hours, however busy the machine
  const int paths = refined(scan, s).paths;
  EXPECT_GE(paths, 64);
  EXPECT_LT(paths, s.pathsPerLine / 10);
  s.timeBudgetS = 3600.0;
  s.targetErrorDb = 5.0; // is reached before
  EXPECT_LT(refined(scan, s).paths, 1000);
}

TEST(TargetError, ChangeIsInDecibelsOfWhatIsAboveTheFloor)
{
  std::vector<float> now(1000, 1.0f);
  std::vector<float> before(1000, float(std::pow(10.0, 2.0 / 20.0)));
  EXPECT_NEAR(changeDb(before, now), 2.0, 1e-5);
  before.assign(1000, 1.0f);
  before[3] = float(std::pow(10.0, 12.0 / 20.0));
  EXPECT_NEAR(changeDb(before, now), 12.0 / std::sqrt(1000.0), 1e-5);
  // Below -60 dB all is alike, and does not count.
  for (std::size_t i = 0; i < 900; ++i)
  {
    now[i] = 1e-4f;
    before[i] = i < 100 ? 1e-2f : 1e-5f;
  }
  EXPECT_NEAR(changeDb(before, now), 20.0 * std::sqrt(100.0 / 200.0), 1e-4);
  EXPECT_EQ(changeDb(std::vector<float>(10, 0.0f), std::vector<float>(10, 0.0f)), 0.0);
}

TEST(TargetError, PicturesGetBetterInTheBackgroundAndEndAsWithout)
{
  const Scan scan = busyScan();
  TraceSettings s = scan.tracing;
  s.targetErrorDb = 0.8;
  s.pathsPerLine = 2048;
  Simulator simulator(scan.scene);
  simulator.setProgressive(true);
  const TracedResult first = simulator.trace(scan.lines, s);
  EXPECT_EQ(first.layout().paths, 64);
  int pictures = 1;
  int paths = 64;
  while (simulator.isRefining() || simulator.hasBetter())
  {
    EXPECT_EQ(simulator.trace(scan.lines, s).layout().paths, paths) << "until it is taken over";
    if (simulator.hasBetter())
    {
      simulator.improve();
      EXPECT_GT(simulator.trace(scan.lines, s).layout().paths, paths);
      paths = simulator.trace(scan.lines, s).layout().paths;
      ++pictures;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_GT(pictures, 1);
  const TracedLines atOnce = refined(scan, s);
  expectSameLines(simulator.trace(scan.lines, s).host(), atOnce, 0.0);
  EXPECT_EQ(simulator.trace(scan.lines, s).layout().errorDb, atOnce.errorDb);
}

TEST(TargetError, WhoWantsTheLastPictureWaitsForIt)
{
  const Scan scan = busyScan();
  TraceSettings s = scan.tracing;
  s.targetErrorDb = 0.8;
  s.pathsPerLine = 2048;
  Simulator simulator(scan.scene);
  simulator.setProgressive(true);
  simulator.trace(scan.lines, s);
  simulator.setProgressive(false);
  const TracedResult last = simulator.trace(scan.lines, s);
  EXPECT_EQ(last.layout().errorDb, refined(scan, s).errorDb);
  EXPECT_FALSE(simulator.isRefining());
  EXPECT_TRUE(simulator.trace(scan.lines, s) == last);
}

TEST(TargetError, AnotherPictureEndsTheOneBeforeAtOnce)
{
  const Scan scan = busyScan();
  TraceSettings s = scan.tracing;
  s.targetErrorDb = 0.001;
  s.pathsPerLine = 10000000;
  Simulator simulator(scan.scene);
  simulator.setProgressive(true);
  simulator.trace(scan.lines, s);
  s.pathsPerLine = 64;
  s.targetErrorDb = 0.0;
  const auto before = std::chrono::steady_clock::now();
  EXPECT_EQ(simulator.trace(scan.lines, s).layout().paths, 64);
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(2));
  EXPECT_FALSE(simulator.isRefining());
}

TEST(TargetError, AStopEndsItAndProgressGrows)
{
  const Scan scan = busyScan();
  TraceSettings s = scan.tracing;
  s.targetErrorDb = 0.001;
  s.pathsPerLine = 10000000;
  int asked = 0;
  double last = 0.0;
  EXPECT_THROW(refined(scan, s,
                       [&](double done) {
                         EXPECT_GE(done, last - 1e-9);
                         EXPECT_LE(done, 1.0 + 1e-9);
                         last = done;
                         return ++asked < 300;
                       }),
               Aborted);
  // Also while the last picture is waited for; nothing is left over.
  Simulator simulator(scan.scene);
  simulator.setProgressive(true);
  simulator.trace(scan.lines, s);
  simulator.setProgressive(false);
  asked = 295;
  EXPECT_THROW(simulator.trace(scan.lines, s, {}, [&](double) { return ++asked < 300; }), Aborted);
  EXPECT_FALSE(simulator.isRefining());
}

TEST(TargetError, AHarmonicHasOneToo)
{
  const Scan scan = busyScan();
  TraceSettings s = scan.tracing;
  s.imagingMode = ImagingMode::Harmonic;
  s.frequencyMHz = 1.5;
  s.targetErrorDb = 1.5;
  s.pathsPerLine = 4096;
  const TracedLines traced = refined(scan, s);
  EXPECT_LE(traced.errorDb, 1.5);
  TraceSettings fixed = s;
  fixed.targetErrorDb = 0.0;
  fixed.pathsPerLine = traced.paths;
  expectSameLines(traced, refined(scan, fixed), 2e-6);
}

TEST(TargetError, BadValuesAreNamed)
{
  const Scan scan = busyScan();
  const auto errorWith = [&](double targetDb, double budgetS) {
    TraceSettings s = scan.tracing;
    s.targetErrorDb = targetDb;
    s.timeBudgetS = budgetS;
    return errorOf([&] { refined(scan, s); });
  };
  for (const double bad : { -0.1, 10.1, std::nan("") })
  {
    expectContains(errorWith(bad, 0.0), "targetErrorDb is ");
    expectContains(errorWith(bad, 0.0), "it must be between 0 and 10");
  }
  for (const double bad : { -1.0, 3601.0, std::nan("") })
  {
    expectContains(errorWith(0.5, bad), "timeBudgetS is ");
    expectContains(errorWith(0.5, bad), "it must be between 0 and 3600");
  }
}

} // namespace
