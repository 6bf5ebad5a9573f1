#include "BusyScene.h"
#include "Core/SoundSpeed.h"
#include "TargetScenes.h"
#include "TestScenes.h"

#include "Trace/RecordPaths.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>

namespace {

using namespace sono;
using namespace sono::test;

const std::vector<Tissue> tissues = { makeTissue("muscle", 1.7, 1580, 0.8), makeTissue("fat", 1.38, 1450, 0.6),
                                      makeTissue("blood", 1.61, 1570, 0.2) };

/// Muscle with a slab of fat across z from 40 to 46 mm and blood behind 80 mm, as voxels.
std::unique_ptr<Scene> slabScene()
{
  return makeScene(Vec3i(60, 60, 100), Vec3d(1.0), tissues,
                   [](const Vec3d& p) { return p.z > 40.0 && p.z < 46.0 ? 1 : (p.z > 80.0 ? 2 : 0); });
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

TEST(RecordedPaths, AreChosenEvenlyAndFollowTheTracedOnes)
{
  const auto scene = slabScene();
  std::vector<ScanLine> lines;
  for (int i = 0; i < 10; ++i)
  {
    lines.push_back(makeLine({ 10.3 + 4.0 * i, 30.2, 0.0 }, { 0, 0, 1 }));
  }
  TraceSettings s = plainSettings();
  s.deterministic = true;
  auto paths = recordPaths(*scene, lines, s, 10);
  ASSERT_EQ(paths.size(), 10u);
  for (int i = 0; i < 10; ++i)
  {
    const RecordedPath& p = paths[std::size_t(i)];
    EXPECT_EQ(p.line, i);
    // Face, slab in, slab out, blood, and 4 % deeper than the image.
    ASSERT_EQ(p.pointMm.size(), 5u);
    const double z[5] = { 0.0, 40.0, 46.0, 80.0, 1.04 * 95.0 };
    for (std::size_t k = 0; k < 5; ++k)
    {
      EXPECT_NEAR(p.pointMm[k].z, z[k], 1e-3);
      EXPECT_NEAR(p.pointMm[k].x, 10.3 + 4.0 * i, 1e-3);
      EXPECT_EQ(p.bounce[k], k == 0 ? 0 : int(k) - 1);
    }
    EXPECT_FLOAT_EQ(p.intensity[0], 1.0f);
    EXPECT_NEAR(p.intensity[1], std::pow(10.0, -0.8 * 2.0 * 4.0 / 10.0), 1e-5);
  }
  s.deterministic = false;
  std::map<int, int> perLine;
  for (const RecordedPath& p : recordPaths(*scene, lines, s, 50))
  {
    ++perLine[p.line];
  }
  for (const auto& [line, count] : perLine)
  {
    EXPECT_EQ(count, 5) << line;
  }
  EXPECT_THROW(recordPaths(*scene, lines, s, 0), Error);
}

TEST(RecordedPaths, DoNotDependOnTheThreadsAndCanBeStopped)
{
  const auto scene = makeBusyScene();
  const std::vector<ScanLine> lines = fan(20);
  const TraceSettings s = busySettings();
  double last = 0.0;
  const auto paths = recordPaths(*scene, lines, s, 5000, {}, [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  });
  EXPECT_GT(last, 0.9);
  {
    const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
    const auto again = recordPaths(*scene, lines, s, 5000);
    ASSERT_EQ(again.size(), paths.size());
    for (std::size_t i = 0; i < paths.size(); ++i)
    {
      ASSERT_EQ(again[i].line, paths[i].line);
      ASSERT_EQ(again[i].pointMm, paths[i].pointMm);
      ASSERT_EQ(again[i].intensity, paths[i].intensity);
      ASSERT_EQ(again[i].hits.size(), paths[i].hits.size());
    }
  }
  const auto byLine = [](const RecordedPath& a, const RecordedPath& b) { return a.line < b.line; };
  EXPECT_TRUE(std::is_sorted(paths.begin(), paths.end(), byLine));
  int asked = 0;
  EXPECT_THROW(recordPaths(*scene, lines, s, 5000, {}, [&](double) { return ++asked < 50; }), Aborted);
  EXPECT_EQ(asked, 50);
}

TEST(BoundaryHits, OfAStraightPathAreThoseOfTheSlab)
{
  const auto scene = slabScene();
  TraceSettings s = plainSettings();
  s.deterministic = true;
  const auto path = recordPaths(*scene, { makeLine({ 30.3, 30.2, 0.0 }, { 0.3, 0.0, 1.0 }) }, s, 1).at(0);
  ASSERT_EQ(path.hits.size(), 3u);
  const double z[3] = { 40.0, 46.0, 80.0 };
  const int medium[4] = { 0, 1, 0, 2 };
  for (int i = 0; i < 3; ++i)
  {
    const BoundaryHit& hit = path.hits[std::size_t(i)];
    EXPECT_EQ(hit.bounce, i);
    EXPECT_EQ(hit.from, medium[i]);
    EXPECT_EQ(hit.to, medium[i + 1]);
    EXPECT_NEAR(hit.pointMm.z, z[i], 0.01);
    EXPECT_NEAR(glm::length(hit.normal - Vec3d(0.0, 0.0, 1.0)), 0.0, 0.01);
    EXPECT_GT(hit.echo, 0.0f);
    EXPECT_NEAR(hit.intensity, path.intensity[std::size_t(i) + 1], 0.02f * hit.intensity);
  }
  const double tangent = 0.3;
  const double angle = std::atan(tangent);
  EXPECT_NEAR(path.hits[0].incidenceCosine, std::cos(angle), 1e-3);
  EXPECT_NEAR(path.hits[0].depthMm, 40.0 / std::cos(angle), 0.02);
  EXPECT_NEAR(path.hits[0].pathMm, 40.0 / std::cos(angle), 0.02);
  // Snell in the fat, and out again as it came in.
  EXPECT_NEAR(path.hits[1].incidenceCosine, std::cos(std::asin(std::sin(angle) * 1450.0 / 1580.0)), 1e-3);
  EXPECT_NEAR(path.hits[2].incidenceCosine, std::cos(angle), 1e-3);
}

TEST(BoundaryHits, LieOnASphere)
{
  const Vec3d centre(30.2, 29.7, 40.1);
  const double radius = 15.0;
  const auto scene = makeScene(Vec3i(60, 60, 80), Vec3d(1.0), { tissues[0], tissues[1] },
                               [&](const Vec3d& p) { return glm::length(p - centre) < radius ? 1 : 0; });
  std::vector<ScanLine> lines;
  for (int i = 0; i < 16; ++i)
  {
    lines.push_back(makeLine({ 30.0, 30.0, 0.0 }, { 0.02 * (i - 8), 0.01 * (i - 5), 1.0 }));
  }
  TraceSettings s = plainSettings();
  s.depthMm = 75.0;
  s.reverberation = true;
  int count = 0;
  double offset = 0.0;
  double degrees = 0.0;
  for (const RecordedPath& path : recordPaths(*scene, lines, s, 2000))
  {
    for (const BoundaryHit& hit : path.hits)
    {
      const Vec3d outward = (hit.pointMm - centre) / glm::length(hit.pointMm - centre);
      EXPECT_NE(hit.from, hit.to);
      EXPECT_NEAR(glm::length(hit.normal), 1.0, 1e-5);
      // The refinement moves a point by a voxel at most; a voxel's face is half a voxel off at worst.
      EXPECT_NEAR(glm::length(hit.pointMm - centre), radius, 1.0);
      const double along = glm::dot(hit.normal, outward);
      EXPECT_EQ(hit.to == 1, along < 0.0); // the normal points into what lies behind
      offset += std::abs(glm::length(hit.pointMm - centre) - radius);
      degrees += std::acos(std::min(1.0, std::abs(along))) * 57.29577951308232;
      ++count;
    }
  }
  ASSERT_GT(count, 4000);
  EXPECT_LT(offset / count, 0.15); // voxels, as surface_offset_voxel
  EXPECT_LT(degrees / count, 2.5);
}

TEST(BoundaryHits, NameTargetsAfterTheTissues)
{
  const auto scene =
    makeScene(Vec3i(60, 60, 100), Vec3d(1.0), { tissues[0], tissues[1] }, [](const Vec3d&) { return 0; });
  TraceSettings s = plainSettings();
  s.deterministic = true;
  const auto box = makeBox("box", tissues[2], { 20.0, 20.0, 50.0 }, { 40.0, 40.0, 60.0 });
  const int medium = int(scene->tissues().size());
  const auto path = recordPaths(*scene, { makeLine({ 30.3, 30.2, 0.0 }, { 0, 0, 1 }) }, s, 1, { box }).at(0);
  ASSERT_EQ(path.hits.size(), 2u);
  EXPECT_EQ(path.hits[0].to, medium);
  EXPECT_EQ(path.hits[1].from, medium);
  EXPECT_NEAR(path.hits[0].pointMm.z, 50.0, 1e-4);
  EXPECT_NEAR(path.hits[1].pointMm.z, 60.0, 1e-4);
}

/// All paths of a line, their hits' echoes summed by hand, give the boundary echoes that trace() finds.
TEST(BoundaryHits, SumUpToTheTracedEchoes)
{
  const auto scene = makeBusyScene();
  const std::vector<ScanLine> lines = fan(1);
  for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy })
  {
    TraceSettings s = busySettings();
    s.sampling = sampling;
    s.model = InterfaceModel::Amadou2024; // whose boundaries echo
    const auto traced = trace(*scene, lines, s);
    std::vector<std::complex<double>> summed(traced.boundaryEcho.size());
    const double wave = 2.0 * 3.14159265358979 * s.frequencyMHz / assumedSoundSpeedMmPerUs;
    for (const RecordedPath& path : recordPaths(*scene, lines, s, s.pathsPerLine))
    {
      for (const BoundaryHit& hit : path.hits)
      {
        const Vec3d q = hit.pointMm - lines[0].originMm;
        const double r = glm::dot(q, lines[0].axis);
        const double aside = glm::length(q - lines[0].axis * r);
        const double amplitude = hit.echo * s.coherenceMm / (s.coherenceMm + aside) / s.pathsPerLine;
        const auto sample = std::size_t(r / s.echoSampleMm);
        if (r < 0.0 || sample + 1 >= summed.size())
        {
          continue;
        }
        const double fraction = r / s.echoSampleMm - double(sample);
        const double near = 2.0 * wave * fraction * s.echoSampleMm;
        const double far = 2.0 * wave * (fraction - 1.0) * s.echoSampleMm;
        summed[sample] += amplitude * (1.0 - fraction) * std::polar(1.0, -near);
        summed[sample + 1] += amplitude * fraction * std::polar(1.0, -far);
      }
    }
    double difference = 0.0;
    double total = 0.0;
    for (std::size_t i = 0; i < summed.size(); ++i)
    {
      difference += std::norm(summed[i] - std::complex<double>(traced.boundaryEcho[i]));
      total += std::norm(summed[i]);
    }
    ASSERT_GT(total, 0.0);
    EXPECT_LT(std::sqrt(difference / total), 1e-2);
  }
}

} // namespace
