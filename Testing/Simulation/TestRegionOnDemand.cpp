// Records that are baked on demand are those of the whole region, and a probe on its way has one region for all poses.
#include "BusyScene.h"

#include "Core/Progress.h"
#include "Simulator.h"
#include "Trace/TraceSetup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <set>
#include <thread>

namespace sono {
namespace {

using test::busySettings;
using test::fan;
using test::makeBusyScene;

/// The busy scene's fan, slid along the face and tilted.
std::vector<ScanLine> movedFan(double slideMm, double tiltRad)
{
  std::vector<ScanLine> lines = fan(9);
  for (ScanLine& line : lines)
  {
    const Vec3d axis(line.axis.x, std::sin(tiltRad), line.axis.z);
    line = test::makeLine(line.originMm + Vec3d(slideMm, 0.0, 0.0), axis);
  }
  return lines;
}

void expectSameBits(const TracedLines& one, const TracedLines& two)
{
  EXPECT_EQ(one.intensity, two.intensity);
  EXPECT_EQ(one.standardError, two.standardError);
  EXPECT_EQ(one.boundaryEcho, two.boundaryEcho);
}

TraceRegion wholeRegion(const Scene& scene, const VoxelBox& box)
{
  return buildTraceRegion(scene.tissueVoxels().data(), scene.placement().size, scene.placement().spacingMm, box);
}

RegionOnDemand regionOnDemand(const Scene& scene, const VoxelBox& box,
                              const std::shared_ptr<const RegionOnDemand>& other = nullptr)
{
  return { scene.tissueVoxels().data(), scene.placement().size, scene.placement().spacingMm, box, {}, other };
}

/// Each record of the region as its cells give it, compared with the whole region's. How many there are.
int compareRecords(const RegionOnDemand& region, const TraceRegion& whole)
{
  const CellsOnDemand cells = region.view();
  const TissueCells expected = whole.view();
  EXPECT_EQ(region.region().cell, whole.cell);
  int count = 0;
  for (int k = 0; k < cells.size.z; ++k)
  {
    for (int j = 0; j < cells.size.y; ++j)
    {
      for (int i = 0; i < cells.size.x; ++i)
      {
        const std::uint32_t word = cells.wordAt(i, j, k);
        const std::uint32_t bits = cells.recordOf(i, j, k, word);
        EXPECT_EQ(bits, expected.recordOf(i, j, k, word));
        count += bits != 0u ? 1 : 0;
      }
    }
  }
  return count;
}

/// All eight at once against one after the other.
TEST(RegionOnDemand, RecordsAroundAPointAddUpToThoseOfTheWholeRegion)
{
  const auto scene = makeBusyScene();
  const VoxelBox box{ Vec3i(3, 5, 2), Vec3i(60, 41, 64) };
  const RegionOnDemand region = regionOnDemand(*scene, box);
  const TraceRegion whole = wholeRegion(*scene, box);
  const CellsOnDemand cells = region.view();
  const TissueCells expected = whole.view();
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  const std::vector<SideWeights> sides{ { 1.0f, 1.0f }, { 1.0f, 0.0f }, { 0.0f, 1.0f } };
  int boundaries = 0;
  for (int n = 0; n < 200000; ++n)
  {
    // From the border on one side to that on the other.
    const Vec3i low =
      Vec3i(glm::floor(Vec3f(uniform(random), uniform(random), uniform(random)) * Vec3f(cells.size + 1))) - 1;
    const Vec3f share(uniform(random), uniform(random), uniform(random));
    const int from = cells.tissueAt(low);
    const int to = cells.tissueAt(low + Vec3i(n & 1, (n >> 1) & 1, 1));
    if (from == to)
    {
      continue;
    }
    const SideWeights& weights = sides[std::size_t(n) % sides.size()];
    const RecordSum sum = sumRecords(cells, low, share, from, to, weights);
    const RecordSum reference = sumRecords(expected, low, share, from, to, weights);
    ASSERT_NEAR(sum.weight, reference.weight, 1e-6f);
    ASSERT_NEAR(glm::distance(sum.normals, reference.normals), 0.0f, 1e-6f);
    boundaries += reference.weight > 0.1f ? 1 : 0;
  }
  EXPECT_GT(boundaries, 1000);
}

TEST(RegionOnDemand, RecordsAreThoseOfTheWholeRegion)
{
  const auto scene = makeBusyScene();
  const VoxelBox box{ Vec3i(3, 5, 2), Vec3i(60, 41, 64) };
  const RegionOnDemand region = regionOnDemand(*scene, box);
  EXPECT_EQ(region.bakedBlocks(), 0);
  const int count = compareRecords(region, wholeRegion(*scene, box));
  EXPECT_GT(count, 3000);
  EXPECT_GT(region.bakedBlocks(), 100);
  EXPECT_LT(region.bakedBlocks(), 8 * 5 * 8); // blocks of one tissue have none
}

TEST(RegionOnDemand, WhatAnotherRegionKnowsIsTheSame)
{
  const auto scene = makeBusyScene();
  // Its blocks lie otherwise, and it does not reach as far.
  const auto other =
    std::make_shared<const RegionOnDemand>(scene->tissueVoxels().data(), scene->placement().size,
                                           scene->placement().spacingMm, VoxelBox{ Vec3i(5, 0, 3), Vec3i(50, 48, 40) });
  other->bakeAll();
  const VoxelBox box{ Vec3i(0), scene->placement().size };
  compareRecords(regionOnDemand(*scene, box, other), wholeRegion(*scene, box));
}

TEST(RegionOnDemand, WhatLiesBesideAnothersBlocksIsBakedAndTheSame)
{
  const auto scene = makeBusyScene();
  const VoxelBox box{ Vec3i(8, 0, 0), scene->placement().size };
  const TraceRegion whole = wholeRegion(*scene, box);
  const RegionOnDemand other = regionOnDemand(*scene, { Vec3i(0), scene->placement().size });
  other.bakeIn({ { Vec3d(other.region().box.last) * scene->placement().spacingMm / 2.0, 1.0 } });
  const int met = other.bakedBlocks();
  ASSERT_GT(met, 0);
  const RegionOnDemand region = regionOnDemand(*scene, box);
  int asked = 0;
  region.bakeBeside(other, [&] { return ++asked <= 3; }); // stopped
  EXPECT_LE(region.bakedBlocks(), 3);
  region.bakeBeside(other, [] { return true; });
  EXPECT_GT(region.bakedBlocks(), met);
  EXPECT_LE(region.bakedBlocks(), 27 * met);
  compareRecords(region, whole);
}

TEST(RegionOnDemand, PathsMeetAFewOfTheRecordsAndGiveTheSameBits)
{
  const auto scene = makeBusyScene();
  TraceSettings settings = busySettings();
  settings.pathsPerLine = 8;
  const auto lines = fan(5);
  const TracedLines onDemand = trace(*scene, lines, settings);
  const TraceSetup setup(*scene, lines, settings, {}, {}, Records::OnDemand);
  const int met = setup.cells->bakedBlocks();
  setup.cells->bakeAll();
  EXPECT_LT(met, setup.cells->bakedBlocks() / 2);
  expectSameBits(trace(*scene, lines, settings), onDemand);
}

/// What goes to a device is baked as far as paths reach: a path that met a record elsewhere would bake it.
TEST(RegionOnDemand, PathsMeetNoRecordBeyondTheReachOfTheirFan)
{
  for (const double depthMm : { 20.0, 30.0, 40.0 })
  {
    const auto scene = makeBusyScene();
    TraceSettings settings = busySettings();
    settings.depthMm = depthMm;
    settings.aperture.apertureMm = 10.0; // paths start beside the lines
    const auto lines = fan(9);
    const TraceSetup setup(*scene, lines, settings, {}, {}, Records::OnDemand);
    setup.cells->bakeIn(fanReach(*scene, lines, settings));
    const int baked = setup.cells->bakedBlocks();
    EXPECT_GT(baked, 0);
    trace(*scene, lines, settings);
    EXPECT_EQ(setup.cells->bakedBlocks(), baked) << depthMm << " mm deep";
    setup.cells->bakeAll();
    EXPECT_LT(baked, setup.cells->bakedBlocks());
  }
}

/// Views that stand far apart have balls each; lines of one face share one.
TEST(RegionOnDemand, FansThatAreApartHaveBallsOfTheirOwn)
{
  const auto scene = makeBusyScene();
  const TraceSettings settings = busySettings();
  std::vector<ScanLine> lines = fan(9);
  EXPECT_EQ(fanReach(*scene, lines, settings).size(), 1u);
  for (ScanLine line : fan(9))
  {
    line.originMm += Vec3d(100.0, 0.0, 0.0);
    lines.push_back(line);
  }
  const std::vector<LocalBall> balls = fanReach(*scene, lines, settings, 3.0);
  ASSERT_EQ(balls.size(), 2u);
  EXPECT_NEAR(glm::distance(balls[0].middleMm, balls[1].middleMm), 100.0, 1e-9);
  for (const LocalBall& ball : balls)
  {
    EXPECT_GE(ball.mm, settings.pathDepthMm() + 3.0);
    EXPECT_LT(ball.mm, settings.pathDepthMm() + 3.0 + 15.0);
  }
}

TEST(RegionOnDemand, LayingItOutTellsOfItsProgressAndCanBeStopped)
{
  const auto lines = fan(5);
  std::vector<double> told;
  const Progress tell = [&](double fraction) {
    told.push_back(fraction);
    return true;
  };
  const TraceSetup whole(*makeBusyScene(), lines, busySettings(), {}, tell, Records::OnDemand);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GT(told.size(), 64u); // some a slice
  const auto scene = makeBusyScene();
  for (const std::size_t stopAt : { std::size_t(1), told.size() / 3, told.size() / 2 })
  {
    std::size_t asked = 0;
    const Progress stop = [&](double) { return ++asked < stopAt; };
    EXPECT_THROW(TraceSetup(*scene, lines, busySettings(), {}, stop, Records::OnDemand), Aborted);
    EXPECT_EQ(asked, stopAt);
  }
  expectSameBits(trace(*scene, lines, busySettings()), trace(*makeBusyScene(), lines, busySettings()));
}

TEST(InteractiveProbe, ImageIsThatOfAFreshScene)
{
  TraceSettings settings = busySettings();
  settings.pathsPerLine = 32;
  settings.interactive = true;
  const std::shared_ptr<const Scene> scene = makeBusyScene();
  TraceSettings atRest = settings;
  atRest.interactive = false;
  trace(*scene, fan(9), atRest);
  Simulator(scene).prepareInteractive(fan(9), atRest);
  TracedLines last;
  for (int step = 0; step <= 40; ++step)
  {
    last = trace(*scene, movedFan(-20.0 + step, 0.01 * step), settings);
  }
  const auto end = movedFan(20.0, 0.4);
  expectSameBits(last, trace(*makeBusyScene(), end, settings));
  // And what the probe sees at rest does not depend on the way either, though it takes over what was baked.
  expectSameBits(trace(*scene, end, atRest), trace(*makeBusyScene(), end, atRest));
}

TEST(InteractiveProbe, FindsWhatTheProbeAtRestHasMet)
{
  const auto scene = makeBusyScene();
  const TraceSettings settings = busySettings();
  const auto lines = fan(9);
  trace(*scene, lines, settings);
  const VoxelBox box = fanBox(*scene, lines, settings);
  const int met = scene->regionOnDemand(box)->bakedBlocks();
  EXPECT_EQ(scene->interactiveRegion(box)->bakedBlocks(), 0);
  int found = 0;
  for (int wait = 0; wait < 1000 && found < met; ++wait)
  {
    scene->beginInteractiveRegion(box, false); // bakes in the background, until somebody asks
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    found = scene->interactiveRegion(box)->bakedBlocks();
  }
  EXPECT_GE(found, met);
}

TEST(InteractiveProbe, OneRegionIsPreparedForAllPoses)
{
  const auto scene = makeBusyScene();
  TraceSettings settings;
  settings.depthMm = 30.0;
  std::set<std::shared_ptr<const RegionOnDemand>> regions;
  for (int step = 0; step <= 40; ++step)
  {
    const auto lines = movedFan(-20.0 + step, 0.01 * step);
    regions.insert(scene->interactiveRegion(fanBox(*scene, lines, settings)));
  }
  EXPECT_EQ(regions.size(), 1u);
}

TEST(InteractiveProbe, ALongVolumeIsCutAtTheSamePlacesForEveryPose)
{
  const std::vector<Tissue> tissues = { test::makeTissue("a", 1.5, 1540, 0.4), test::makeTissue("b", 2.4, 1700, 0.6) };
  const auto scene =
    test::makeScene(Vec3i(4, 4, 1300), Vec3d(1.0), tissues, [](const Vec3d& p) { return int(p.z / 7.0) % 2; });
  const auto boxAround = [&](int first, int last) {
    return scene->interactiveRegion({ Vec3i(0, 0, first), Vec3i(4, 4, last) })->region().box;
  };
  const auto expectBox = [&](const VoxelBox& box, int first, int last) {
    EXPECT_EQ(box.first, Vec3i(0, 0, first));
    EXPECT_EQ(box.last, Vec3i(4, 4, last));
  };
  expectBox(boxAround(10, 300), 0, 512);
  expectBox(boxAround(400, 700), 0, 1024);
  expectBox(boxAround(600, 900), 512, 1024);
  expectBox(boxAround(1100, 1290), 1024, 1300);
}

TEST(InteractiveProbe, SeesWhatAProbeAtRestSees)
{
  const auto scene = makeBusyScene();
  TraceSettings settings = busySettings();
  settings.depthMm = 25.0; // so that the regions differ
  const auto lines = movedFan(3.0, 0.1);
  const TracedLines atRest = trace(*scene, lines, settings);
  settings.interactive = true;
  const TracedLines interactive = trace(*scene, lines, settings);
  double error = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < atRest.intensity.size(); ++i)
  {
    error += std::pow(double(atRest.intensity[i]) - interactive.intensity[i], 2);
    total += std::pow(double(atRest.intensity[i]), 2);
  }
  EXPECT_LT(std::sqrt(error / total), 1e-3); // rounding, which takes a path in a hundred thousand elsewhere
}

} // namespace
} // namespace sono
