#include "TargetScenes.h"
#include "TestScenes.h"

#include "Trace/TargetBvh.h"
#include "Trace/Trace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace sono;
using namespace sono::test;

const std::vector<Tissue> tissues = { makeTissue("muscle", 1.7, 1580, 0.8), makeTissue("fat", 1.38, 1450, 0.6),
                                      makeTissue("blood", 1.61, 1570, 0.2) };

/// Muscle with a slab of fat across z from 40 to 46 mm, as voxels or bare.
std::unique_ptr<Scene> slabScene(bool slab)
{
  return makeScene(Vec3i(60, 60, 100), Vec3d(1.0), tissues,
                   [=](const Vec3d& p) { return slab && p.z > 40.0 && p.z < 46.0 ? 1 : (p.z > 80.0 ? 2 : 0); });
}

TraceSettings plainSettings()
{
  TraceSettings s;
  s.depthMm = 95.0;
  s.frequencyMHz = 2.0;
  s.maxCollisions = 20;
  s.pathsPerLine = 4000;
  return s;
}

void expectNear(const std::vector<float>& a, const std::vector<float>& b, double tolerance)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    ASSERT_NEAR(a[i], b[i], tolerance) << i;
  }
}

TEST(Targets, SlabAsTriangleSurfaceIsTheSlabInVoxels)
{
  TraceSettings s = plainSettings();
  s.deterministic = true;
  const std::vector<ScanLine> lines = { makeLine({ 30.3, 30.2, 0.0 }, { 0, 0, 1 }),
                                        makeLine({ 12.3, 30.2, 0.0 }, { 0.3, 0.1, 1 }) };
  const auto box = makeBox("slab", tissues[1], { -20.0, -20.0, 40.0 }, { 80.0, 80.0, 46.0 });
  expectNear(trace(*slabScene(true), lines, s).intensity, trace(*slabScene(false), lines, s, {}, { box }).intensity,
             2e-4);
  s.model = InterfaceModel::Amadou2024; // whose boundaries echo
  const auto voxels = trace(*slabScene(true), lines, s);
  const auto triangles = trace(*slabScene(false), lines, s, {}, { box });
  expectNear(voxels.intensity, triangles.intensity, 2e-4);
  for (std::size_t i = 0; i < voxels.boundaryEcho.size(); ++i)
  {
    // Voxel records hold positions to 1/256 voxel: 2e-3 mm is 0.03 rad.
    ASSERT_LT(std::abs(voxels.boundaryEcho[i] - triangles.boundaryEcho[i]), 0.04 * 0.11) << i;
  }
}

TEST(Targets, TrianglesTurnedInsideOutAreTheSameTarget)
{
  auto box = makeBox("slab", tissues[1], { -20.0, -20.0, 40.0 }, { 80.0, 80.0, 46.0 });
  const std::vector<ScanLine> lines = { makeLine({ 30.3, 30.2, 0.0 }, { 0.1, 0.2, 1 }) };
  const auto scene = slabScene(false);
  const auto one = trace(*scene, lines, plainSettings(), {}, { box });
  for (auto& t : box.triangles)
  {
    std::swap(t[1], t[2]);
  }
  EXPECT_EQ(one.intensity, trace(*scene, lines, plainSettings(), {}, { box }).intensity);
}

TEST(Targets, LineThatStartsInsideLeavesThroughTheFarSide)
{
  TraceSettings s = plainSettings();
  s.deterministic = true;
  const auto box = makeBox("probe cover", tissues[1], { 20.0, 20.0, -5.0 }, { 40.0, 40.0, 10.0 });
  const auto traced = trace(*slabScene(false), { makeLine({ 30.3, 30.2, 1.0 }, { 0, 0, 1 }) }, s, {}, { box });
  // 9 mm of fat, then muscle.
  const double r0 = (1.7 - 1.38) / (1.7 + 1.38);
  const double expected =
    (1.0 - r0 * r0) * std::pow(10.0, -(0.6 * 2.0 * 0.9 + 0.8 * 2.0 * (20.125 - 9.0) / 10.0) / 10.0);
  EXPECT_NEAR(traced.intensity[std::size_t(20.0 / traced.binMm)], expected, 1e-5);
}

TEST(Targets, InsideATargetTheLabelMapDoesNotCount)
{
  TraceSettings s = plainSettings();
  s.deterministic = true;
  // The box covers the slab of fat wholly where the line runs.
  const auto box = makeBox("cover", tissues[2], { 20.0, 20.0, 30.0 }, { 40.0, 40.0, 60.0 });
  const std::vector<ScanLine> line = { makeLine({ 30.3, 30.2, 0.0 }, { 0, 0, 1 }) };
  EXPECT_EQ(trace(*slabScene(true), line, s, {}, { box }).intensity,
            trace(*slabScene(false), line, s, {}, { box }).intensity);
}

TEST(Targets, OpenOrBrokenSurfacesAreRefusedByName)
{
  const auto scene = slabScene(false);
  const std::vector<ScanLine> line = { makeLine({ 30.3, 30.2, 0.0 }, { 0, 0, 1 }) };
  const auto message = [&](const TargetSurface& target) {
    try
    {
      trace(*scene, line, plainSettings(), {}, { target });
    }
    catch (const Error& e)
    {
      return std::string(e.what());
    }
    return std::string();
  };
  auto box = makeBox("needle", tissues[1], Vec3d(20.0), Vec3d(40.0));
  EXPECT_EQ(message(box), "");
  box.triangles.pop_back();
  EXPECT_NE(message(box).find("'needle' is not a closed surface"), std::string::npos);
  box = makeBox("needle", tissues[1], Vec3d(20.0), Vec3d(40.0));
  box.pointsMm[3].x = NAN;
  EXPECT_NE(message(box).find("'needle'"), std::string::npos);
  box.triangles.clear();
  box.pointsMm[3].x = 0.0;
  EXPECT_NE(message(box).find("'needle' has no triangles"), std::string::npos);
  box = makeBox("needle", tissues[1], Vec3d(20.0), Vec3d(40.0));
  box.triangles[0][1] = 99;
  EXPECT_NE(message(box).find("'needle'"), std::string::npos);
}

/// A sphere of triangles.
TargetSurface makeSphere(const Vec3d& centre, double radius, int rings)
{
  TargetSurface sphere{ "sphere", tissues[1], { centre + Vec3d(0, 0, radius), centre - Vec3d(0, 0, radius) }, {} };
  const int around = 2 * rings;
  for (int r = 1; r < rings; ++r)
  {
    for (int a = 0; a < around; ++a)
    {
      const double polar = M_PI * r / rings;
      const double azimuth = 2.0 * M_PI * a / around;
      sphere.pointsMm.push_back(centre + radius * Vec3d(std::sin(polar) * std::cos(azimuth),
                                                        std::sin(polar) * std::sin(azimuth), std::cos(polar)));
    }
  }
  const auto at = [&](int ring, int a) { return 2 + (ring - 1) * around + a % around; };
  for (int a = 0; a < around; ++a)
  {
    sphere.triangles.push_back({ 0, at(1, a), at(1, a + 1) });
    sphere.triangles.push_back({ 1, at(rings - 1, a + 1), at(rings - 1, a) });
    for (int r = 1; r + 1 < rings; ++r)
    {
      sphere.triangles.push_back({ at(r, a), at(r + 1, a), at(r + 1, a + 1) });
      sphere.triangles.push_back({ at(r, a), at(r + 1, a + 1), at(r, a + 1) });
    }
  }
  return sphere;
}

TEST(TargetBvh, MeetsWhatEmbreeMeets)
{
  std::vector<TargetSurface> targets;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 12; ++i)
  {
    const Vec3d centre = 100.0 * Vec3d(uniform(random), uniform(random), uniform(random));
    targets.push_back(i % 3 == 0 ? makeBox("box", tissues[1], centre - 4.0, centre + 7.0)
                                 : makeSphere(centre, 2.0 + 10.0 * uniform(random), 4 + i));
  }
  const auto triangles = localTriangles(targets, Mat3d(1.0), Vec3d(0.0));
  const TargetScene embree(triangles);
  const TargetBvh bvh = buildTargetBvh(triangles);
  int hits = 0;
  for (int i = 0; i < 200000; ++i)
  {
    const Vec3f position(100.0 * Vec3d(uniform(random), uniform(random), uniform(random)));
    Vec3f direction(Vec3d(uniform(random), uniform(random), uniform(random)) - 0.5);
    if (i % 10 == 0)
    {
      direction = Vec3f(0.0f); // along an axis
      direction[i / 10 % 3] = i % 20 == 0 ? 1.0f : -1.0f;
    }
    direction = glm::normalize(direction);
    const bool inside = i % 2 == 0;
    const TargetHit a = embree.nearest(position, direction, 80.0f, inside);
    const TargetHit b = bvh.view().nearest(position, direction, 80.0f, inside);
    // Hits within rounding of each other, or of the ray's end, may go either way.
    ASSERT_NEAR(a.t, b.t, 2e-3) << i;
    if (a.target != b.target)
    {
      ASSERT_TRUE(a.target < 0 || b.target < 0) << i << ' ' << a.target << ' ' << b.target;
      ASSERT_GT(std::min(a.t, b.t), 79.99f) << i;
      continue;
    }
    hits += a.target >= 0 ? 1 : 0;
  }
  EXPECT_GT(hits, 10000);
}

/// Blobs of two tissues in a third.
std::unique_ptr<Scene> blobScene()
{
  return makeScene(Vec3i(70, 60, 90), Vec3d(0.9, 1.0, 1.1), tissues, [](const Vec3d& p) {
    const double a = std::sin(p.x * 0.23) + std::cos(p.y * 0.31) + std::sin(p.z * 0.19);
    return a > 0.8 ? 1 : (a < -0.8 ? 2 : 0);
  });
}

TEST(Marches, NanoVDBAndTheRegionCacheGiveTheSameImage)
{
  const auto scene = blobScene();
  std::vector<ScanLine> lines;
  for (int i = 0; i < 16; ++i)
  {
    lines.push_back(makeLine({ 31.0, 30.0, 0.0 }, { std::sin(0.08 * (i - 8)), 0.05, 1.0 }));
  }
  TraceSettings s = plainSettings();
  s.pathsPerLine = 400;
  const auto cache = trace(*scene, lines, s);
  s.march = March::NanoVDB;
  const auto nano = trace(*scene, lines, s);
  // The same faces at the same times up to rounding; a path may part from its twin where rounding turns a corner.
  double difference = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < cache.intensity.size(); ++i)
  {
    difference += std::abs(cache.intensity[i] - nano.intensity[i]);
    total += cache.intensity[i];
  }
  EXPECT_LT(difference, 1e-3 * total);
  EXPECT_NEAR(double(cache.segments), double(nano.segments), 2e-3 * double(cache.segments));
}

TEST(Roulette, LeavesTheMeanUnchangedAndShortensPaths)
{
  const auto scene = blobScene();
  const std::vector<ScanLine> lines = { makeLine({ 31.0, 30.0, 0.0 }, { 0.1, 0.05, 1.0 }) };
  TraceSettings s = plainSettings();
  s.frequencyMHz = 8.0;
  s.sampling = Sampling::Independent;
  s.pathsPerLine = 20000;
  double chi = 0.0;
  int bins = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed)
  {
    s.rouletteDb = -1000.0;
    s.seed = seed;
    const auto all = trace(*scene, lines, s);
    s.rouletteDb = -30.0; // far above what one would use, so that a bias would show
    s.seed = 100 + seed;
    const auto roulette = trace(*scene, lines, s);
    EXPECT_LT(roulette.segments, all.segments * 9 / 10);
    for (int b = 40; b < all.binCount; b += 8)
    {
      const double error = std::hypot(all.standardError[std::size_t(b)], roulette.standardError[std::size_t(b)]);
      if (error > 0.0)
      {
        const double z = (all.intensity[std::size_t(b)] - roulette.intensity[std::size_t(b)]) / error;
        chi += z * z;
        ++bins;
      }
    }
  }
  // Errors from eight batches each: z is t-distributed with about 14 degrees of freedom, mean square 14/12. Bins of one
  // line hang together, so that one pair of seeds may say anything from 0.2 to 6; a bias of one standard error
  // everywhere would double the mean of all.
  ASSERT_GT(bins, 24 * 20);
  EXPECT_LT(chi / bins, 2.0);
}

} // namespace
