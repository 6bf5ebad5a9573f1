// Rough surfaces in traced scenes (Data/docs/physics.md sections 10 and 12.4).
#include "BusyScene.h"
#include "KernelScene.h"
#include "TraceFigures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace {

using namespace sono;
using namespace sono::test;

TEST(TraceRough, AMatchedBoundaryChangesNothing)
{
  for (const double height : { 0.0, 0.1, 1.0, 10.0 })
  {
    EXPECT_LE(matchedBoundaryDb(height), 8e-4) << height; // 1e-4 of the intensity
  }
}

TEST(TraceRough, BehindAWaterCystThereIsWhatItDidNotAttenuate)
{
  for (const double height : { 0.0, 0.02, 0.1, 0.5 })
  {
    for (const double enhancement : enhancementsDb(height))
    {
      EXPECT_NEAR(enhancement, waterCystEnhancementDb, 0.3) << height;
    }
  }
}

TEST(TraceRough, TheIntensityDoesNotDependOnTheNumberOfPaths)
{
  // Sixteen lines along one axis, each with paths of its own; their mean and its error from their spread.
  const auto scene = makeBusyScene();
  const std::vector<ScanLine> lines(16, fan(3)[0]);
  const auto meansOf = [&](int paths, std::vector<double>& error) {
    TraceSettings s = busySettings();
    s.pathsPerLine = paths;
    const TracedLines traced = trace(*scene, lines, s);
    std::vector<double> means(std::size_t(traced.binCount), 0.0);
    error.assign(means.size(), 0.0);
    for (std::size_t b = 0; b < means.size(); ++b)
    {
      double squares = 0.0;
      for (std::size_t l = 0; l < lines.size(); ++l)
      {
        const double value = traced.intensity[l * means.size() + b];
        means[b] += value / 16.0;
        squares += value * value / 16.0;
      }
      error[b] = std::sqrt(std::max(0.0, squares - means[b] * means[b]) / 15.0);
    }
    return means;
  };
  std::vector<double> fewError;
  std::vector<double> manyError;
  const std::vector<double> few = meansOf(100, fewError);
  const std::vector<double> many = meansOf(20000, manyError);
  double squares = 0.0;
  int count = 0;
  for (std::size_t b = 0; b < few.size(); ++b)
  {
    const double error = std::hypot(fewError[b], manyError[b]) + 1e-6;
    EXPECT_LT(std::abs(few[b] - many[b]), 6.0 * error) << b;
    squares += std::pow((few[b] - many[b]) / error, 2.0);
    ++count;
  }
  // Bins hang together, so that this is no sharp chi-squared; a drift of one error everywhere would show.
  EXPECT_LT(squares / count, 2.5);
}

TEST(TraceRough, DeterministicPathsTakeTheCoherentDirections)
{
  TraceSettings s = ballSettings();
  s.deterministic = true;
  s.reverberation = false; // whose boundaries echo with the paths
  const TracedLines smooth =
    traceThroughBall(roughTissue("gel", 1.6, 1540, 0.5, 0.0), roughTissue("a", 1.8, 1600, 0.4, 0.0), s);
  const TracedLines rough =
    traceThroughBall(roughTissue("gel", 1.6, 1540, 0.5, 1.0), roughTissue("a", 1.8, 1600, 0.4, 0.3), s);
  EXPECT_EQ(smooth.intensity, rough.intensity);
  EXPECT_TRUE(rough.boundaryEcho.empty());
  EXPECT_EQ(rough.echoCount, 0);
}

TEST(TraceAttenuationExponent, IsTheSumOverTheLayers)
{
  const std::vector<Tissue> tissues = { roughTissue("a", 1.5, 1500, 0.5, 0.1), roughTissue("b", 1.7, 1540, 1.5, 0.1),
                                        roughTissue("c", 1.6, 1600, 0.1, 0.1) };
  const auto scene = makeScene(Vec3i(40, 40, 100), Vec3d(1.0), tissues,
                               [](const Vec3d& p) { return p.z < 20.0 ? 0 : (p.z < 50.0 ? 1 : 2); });
  for (const double frequency : { 2.0, 5.0 })
  {
    TraceSettings s;
    s.deterministic = true;
    s.depthMm = 90.0;
    s.frequencyMHz = frequency;
    const TracedLines traced = trace(*scene, { makeLine({ 20.2, 20.4, 0.0 }, { 0, 0, 1 }) }, s);
    ASSERT_EQ(traced.attenuationNpPerMHz.size(), traced.intensity.size());
    for (int b = 0; b < traced.binCount; ++b)
    {
      const double r = (b + 0.5) * traced.binMm;
      const double decibels = 0.5 * std::min(r, 20.0) + 1.5 * std::min(std::max(0.0, r - 20.0), 30.0) +
                              0.1 * std::max(0.0, r - 50.0); // one way, per cm and MHz, times mm
      EXPECT_NEAR(traced.attenuationNpPerMHz[std::size_t(b)], 2.0 * decibels / 10.0 / 8.685889638, 2e-4) << r;
    }
  }
}

TEST(TraceAttenuationExponent, IsThatOfTheDirectSound)
{
  // In front of a mirror's half, what comes back reverberates: it does not count.
  const double f = 2.0;
  const double a = 1.0;
  const auto scene = makeScene(Vec3i(40, 40, 80), Vec3d(1.0),
                               { roughTissue("a", 1.5, 1500, a, 0.0), roughTissue("b", 4.5, 1500, a, 0.0) },
                               [](const Vec3d& p) { return p.z < 40.0 ? 0 : 1; });
  TraceSettings s;
  s.depthMm = 70.0;
  s.frequencyMHz = f;
  s.pathsPerLine = 8192;
  const TracedLines traced = trace(*scene, { makeLine({ 20.2, 20.4, 0.0 }, { 0, 0, 1 }) }, s);
  const double perMm = 2.0 * a / 10.0 / 8.685889638; // of B
  for (const double depth : { 10.125, 25.125, 38.125, 45.125, 65.125 })
  {
    EXPECT_NEAR(traced.attenuationNpPerMHz[std::size_t(depth / traced.binMm)], perMm * depth, 3e-4) << depth;
  }
}

/// Hashes all that paths tell, to the bit (FNV-1a).
struct HashSink : PathSink
{
  std::uint64_t hash = 1469598103934665603ull;

  void mix(float value)
  {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; ++i)
    {
      hash = (hash ^ (bits >> (8 * i) & 255u)) * 1099511628211ull;
    }
  }
  void mix(const Vec3f& v)
  {
    mix(v.x);
    mix(v.y);
    mix(v.z);
  }
  void segment(const PathSegment& s)
  {
    mix(s.start);
    mix(s.direction);
    mix(s.length);
    mix(s.intensity);
    mix(s.decayPerMm);
  }
  void echo(const Vec3f& point, float amplitude)
  {
    mix(point);
    mix(amplitude);
  }
};

TEST(Amadou2024, PathsAreThoseOfBeforeRoughSurfacesToTheBit)
{
  std::vector<TraceMedium> media = { makeMedium(1.5f, 1500.0f), makeMedium(1.7f, 1600.0f), makeMedium(7.8f, 4080.0f) };
  for (TraceMedium& m : media)
  {
    m.decayPerMm = 0.01f * m.impedance;
    m.tau = 0.8f;
    m.gamma = 0.5f;
  }
  KernelScene scene(Vec3i(48), Vec3d(1.0), media, [](const Vec3d& p) {
    return glm::length(p - Vec3d(22.0, 25.0, 26.0)) < 9.0 ? 2 : (p.z < 12.0 ? 0 : 1);
  });
  scene.view.model = InterfaceModel::Amadou2024;
  scene.view.maxCollisions = 7;
  scene.view.rouletteIntensity = 1e-4f;
  const double sigmas[] = { 0.0, 0.1, 0.785398 };
  // Recorded on x86-64 with glibc's functions, with the sources before rough surfaces, and once more when normals came
  // from fits further away, which nothing of the lobe knows. The last one again: at 45 degrees paths now see the ball's
  // inside where they did not.
  const std::uint64_t expected[] = { 0xa4299a7a0ce44cd0ull, 0xf21345bf2023baa3ull, 0x4df5652cad09f142ull };
  for (int i = 0; i < 3; ++i)
  {
    scene.view.lobe = makeLobe(0.0, sigmas[i], 0.0, 1.570796);
    HashSink sink;
    const TraceLine line{ { 23.3f, 25.4f, 0.0f }, glm::normalize(Vec3f(0.02f, -0.05f, 1.0f)) };
    const LineStart start = startLine(scene.view, scene.space(), line, sink);
    ASSERT_TRUE(start.meets);
    for (std::uint32_t p = 0; p < 500; ++p)
    {
      tracePath(scene.view, scene.space(), line, start, PathKey{ 3, 1, p }, sink);
    }
    EXPECT_EQ(sink.hash, expected[i]) << sigmas[i];
  }
}

} // namespace
