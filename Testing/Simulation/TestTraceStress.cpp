#include "TestScenes.h"

#include "Trace/Deposit.h"
#include "Trace/Trace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace sono;
using namespace sono::test;

#if defined(__SANITIZE_ADDRESS__)
constexpr int randomScenes = 10000;
#else
constexpr int randomScenes = 1000;
#endif

TraceSettings quickSettings()
{
  TraceSettings s;
  s.depthMm = 40.0;
  s.radialBinMm = 0.5;
  s.echoSampleMm = 0.1;
  s.pathsPerLine = 64;
  return s;
}

/// Finite everywhere, not negative, and within the number of pieces that the settings allow.
void expectSane(const TracedLines& traced, const TraceSettings& s, const std::string& what)
{
  const double mostCrossings = s.model == InterfaceModel::Acoustic ? s.maxCollisions + 2.0 : 1e30;
  for (std::size_t b = 0; b < traced.intensity.size(); ++b)
  {
    ASSERT_TRUE(std::isfinite(traced.intensity[b]) && traced.intensity[b] >= 0.0f) << what << " bin " << b;
    ASSERT_LE(traced.intensity[b], mostCrossings) << what << " bin " << b;
    ASSERT_TRUE(std::isfinite(traced.standardError[b]) && traced.standardError[b] >= 0.0f) << what << " bin " << b;
    ASSERT_TRUE(std::isfinite(traced.attenuationNpPerMHz[b]) && traced.attenuationNpPerMHz[b] >= 0.0f) << what << b;
  }
  for (const auto& e : traced.boundaryEcho)
  {
    ASSERT_TRUE(std::isfinite(e.real()) && std::isfinite(e.imag())) << what;
  }
}

/// Without tissues of equal acoustics a path has one piece between two boundaries.
void expectBoundedPieces(const TracedLines& traced, const TraceSettings& s)
{
  EXPECT_LE(double(traced.segments), traced.lineCount * (3.0 + double(s.pathsPerLine) * s.maxCollisions));
}

std::vector<Tissue> threeTissues()
{
  return { makeTissue("soft", 1.6, 1540, 0.5), makeTissue("bone", 7.8, 4080, 5.0),
           makeTissue("gas", 0.0004, 330, 1.6) };
}

/// A bone ball and a gas slab in soft tissue.
std::unique_ptr<Scene> makeBody(const Vec3i& size, const Vec3d& spacing)
{
  const Vec3d extent = Vec3d(size) * spacing;
  return makeScene(size, spacing, threeTissues(), [=](const Vec3d& p) {
    const Vec3d q = p / extent;
    return glm::length(q - Vec3d(0.5)) < 0.2 ? 1 : (q.z > 0.85 ? 2 : 0);
  });
}

void traceBoth(const Scene& scene, const std::vector<ScanLine>& lines, TraceSettings s, const std::string& what)
{
  for (const InterfaceModel model : { InterfaceModel::Acoustic, InterfaceModel::Amadou2024 })
  {
    s.model = model;
    for (const bool deterministic : { false, true })
    {
      s.deterministic = deterministic;
      const TracedLines traced = trace(scene, lines, s);
      expectSane(traced, s, what);
      expectBoundedPieces(traced, s);
    }
  }
}

TEST(TraceStress, OriginsInsideOutsideOnFacesAndAlongAxes)
{
  const auto scene = makeBody(Vec3i(32), Vec3d(1.0));
  std::vector<ScanLine> lines;
  for (const Vec3d& origin :
       { Vec3d(16.0, 16.0, 16.0), Vec3d(16.3, 16.2, 17.1), Vec3d(0.0), Vec3d(32.0), Vec3d(16.0, 16.0, 0.0),
         Vec3d(16.0, 16.0, -7.0), Vec3d(5.0, 16.5, 16.0), Vec3d(-3.0, -3.0, -3.0), Vec3d(16.0, 0.0, 32.0) })
  {
    for (int x = -1; x <= 1; ++x)
    {
      for (int y = -1; y <= 1; ++y)
      {
        for (int z = -1; z <= 1; ++z)
        {
          if (x != 0 || y != 0 || z != 0)
          {
            lines.push_back(makeLine(origin, Vec3d(x, y, z)));
            lines.push_back(makeLine(origin, Vec3d(x + 1e-9, y - 1e-8, z + 1e-12)));
          }
        }
      }
    }
  }
  traceBoth(*scene, lines, quickSettings(), "faces and axes");
}

TEST(TraceStress, ALineThatStartsOnAFaceSeesTheTissueAheadOnly)
{
  const auto scene =
    makeScene(Vec3i(20), Vec3d(1.0), threeTissues(), [](const Vec3d& p) { return p.z < 10.0 ? 0 : 1; });
  TraceSettings s = quickSettings();
  s.depthMm = 8.0;
  s.model = InterfaceModel::Amadou2024; // whose boundaries echo
  for (const double sense : { 1.0, -1.0 })
  {
    const TracedLines traced = trace(*scene, { makeLine({ 10.3, 10.2, 10.0 }, { 0.0, 0.0, sense }) }, s);
    for (const auto& e : traced.boundaryEcho)
    {
      ASSERT_EQ(std::abs(e), 0.0f) << sense;
    }
  }
}

TEST(TraceStress, LabelsTouchAtCornersAndEdges)
{
  for (const int period : { 1, 2, 3 })
  {
    const auto scene = makeScene(Vec3i(20), Vec3d(1.0), threeTissues(), [=](const Vec3d& p) {
      return (int(p.x) / period + int(p.y) / period + int(p.z) / period) % 2;
    });
    std::vector<ScanLine> lines;
    for (const Vec3d& axis : { Vec3d(1, 1, 1), Vec3d(1, 1, 0), Vec3d(0, 0, 1), Vec3d(1, 2, 3) })
    {
      lines.push_back(makeLine({ 0.0, 0.0, 0.0 }, axis));
      lines.push_back(makeLine({ 3.0, 3.0, 0.0 }, axis));
      lines.push_back(makeLine({ 3.5, 3.2, 0.0 }, axis));
    }
    traceBoth(*scene, lines, quickSettings(), "checkerboard " + std::to_string(period));
  }
}

TEST(TraceStress, OneVoxelLabelsAConstantMapAndTwoHundredLabels)
{
  const std::vector<ScanLine> lines{ makeLine({ 8.5, 8.5, 0.0 }, { 0, 0, 1 }),
                                     makeLine({ 8.2, 8.3, 0.0 }, { 0.1, 0.2, 1 }) };
  const auto one = makeScene(Vec3i(16), Vec3d(1.0), threeTissues(),
                             [](const Vec3d& p) { return glm::length(p - Vec3d(8.5, 8.5, 6.5)) < 0.1 ? 1 : 0; });
  traceBoth(*one, lines, quickSettings(), "one voxel");
  const auto constant = makeScene(Vec3i(16), Vec3d(1.0), threeTissues(), [](const Vec3d&) { return 0; });
  traceBoth(*constant, lines, quickSettings(), "constant");
  const auto single = makeScene(Vec3i(1), Vec3d(16.0), threeTissues(), [](const Vec3d&) { return 0; });
  traceBoth(*single, lines, quickSettings(), "single voxel");
  std::vector<Tissue> many;
  for (int i = 0; i < 200; ++i)
  {
    many.push_back(makeTissue("t" + std::to_string(i), 1.0 + 0.01 * i, 1400.0 + i, 0.1));
  }
  std::mt19937 random(3);
  const auto labels = makeScene(Vec3i(16), Vec3d(1.0), many, [&](const Vec3d&) { return int(random() % 200); });
  traceBoth(*labels, lines, quickSettings(), "200 labels");
}

TEST(TraceStress, SpacingsObliqueLeftHandedAndFarAway)
{
  const double c = std::cos(0.4);
  const double n = std::sin(0.4);
  const Mat3d oblique(Vec3d(c, n, 0.0), Vec3d(-n * c, c * c, n), Vec3d(n * n, -n * c, c));
  const Mat3d leftHanded(oblique[1], oblique[0], oblique[2]);
  TissueTable table;
  for (const Tissue& t : threeTissues())
  {
    table.add(t);
  }
  for (const Vec3d& spacing : { Vec3d(0.05), Vec3d(5.0), Vec3d(0.2, 0.2, 2.0), Vec3d(2.0, 0.2, 0.2) })
  {
    const auto plain = makeBody(Vec3i(24), spacing);
    TraceSettings s = quickSettings();
    s.depthMm = 20.0 * spacing.z;
    s.radialBinMm = s.depthMm / 50.0;
    s.echoSampleMm = s.depthMm / 500.0;
    const Vec3d start = Vec3d(11.3, 12.2, 0.0) * spacing;
    const TracedLines expected = trace(*plain, { makeLine(start, { 0, 0, 1 }) }, s);
    expectSane(expected, s, "spacing");
    for (const Mat3d& direction : { oblique, leftHanded })
    {
      for (const double far : { 0.0, 1e5 })
      {
        LabelVolume volume = plain->volume();
        volume.placement.direction = direction;
        volume.placement.originMm = Vec3d(far, -far, far);
        const Scene scene(volume, table, "none");
        const ScanLine line = makeLine(scene.worldFromLocal(start), direction[2]);
        const TracedLines traced = trace(scene, { line }, s);
        // The same scene seen by the same random numbers; what differs is the rounding of 1e5 mm, 1e-11 mm.
        for (std::size_t b = 0; b < traced.intensity.size(); ++b)
        {
          ASSERT_NEAR(traced.intensity[b], expected.intensity[b],
                      1e-3 + 5.0 * (traced.standardError[b] + expected.standardError[b]))
            << spacing.x << " " << spacing.z << " far " << far << " bin " << b;
        }
      }
    }
  }
}

TEST(TraceStress, SegmentsThatEndOnEdgesOfBinsLeaveTheirLengthAndNothingNegative)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<float> width(0.005f, 0.5f);
  std::uniform_int_distribution<int> edge(0, 60);
  const TraceLine line{ Vec3f(0.0f), Vec3f(0.0f, 0.0f, 1.0f) };
  for (int n = 0; n < 20000; ++n)
  {
    const float binMm = width(random);
    const int first = edge(random);
    const float from = float(first) * binMm;
    const float to = float(first + 1 + edge(random)) * binMm;
    LineTally tally(130, double(binMm), 1, 0, 1.0, 1.0);
    tally.start(line, 100.0f);
    const bool down = n % 2 == 0;
    tally.segment(
      { Vec3f(0.0f, 0.0f, down ? from : to), Vec3f(0.0f, 0.0f, down ? 1.0f : -1.0f), to - from, 1.0f, 0.0f, 0.0f });
    double length = 0.0;
    for (const BinSums<double>& bin : tally.takeBins(1))
    {
      ASSERT_GE(bin.of[intensitySum], 0.0) << binMm << " " << first;
      length += bin.of[intensitySum] * binMm;
    }
    ASSERT_NEAR(length, to - from, 1e-5 * to) << binMm << " " << first;
  }
}

TEST(TraceStress, SettingsAtTheirLimits)
{
  const auto scene = makeBody(Vec3i(32), Vec3d(1.0));
  const std::vector<ScanLine> lines{ makeLine({ 16.3, 16.2, 0.0 }, { 0, 0, 1 }),
                                     makeLine({ 12.3, 13.2, 0.0 }, { 0.1, 0.1, 1 }) };
  TraceSettings s = quickSettings();
  s.coherenceMm = 0.0;
  traceBoth(*scene, lines, s, "C0 = 0");
  s = quickSettings();
  s.pathsPerLine = 1;
  traceBoth(*scene, lines, s, "N = 1");
  s.pathsPerLine = 7;
  traceBoth(*scene, lines, s, "N = 7");
  s = quickSettings();
  s.maxCollisions = 0;
  traceBoth(*scene, lines, s, "no collisions");
  s = quickSettings();
  s.depthMm = 0.01;
  s.radialBinMm = 0.01;
  s.echoSampleMm = 0.001;
  traceBoth(*scene, lines, s, "hardly any depth");
  s = quickSettings();
  for (const double sigma : { 0.0, 1e-7, 1e-3, 1e3, 1e300 })
  {
    for (const double mean : { 0.0, -M_PI, 1.5, M_PI })
    {
      s.lobeSigmaDeg = sigma * 180.0 / M_PI;
      s.lobeMeanDeg = mean * 180.0 / M_PI;
      traceBoth(*scene, lines, s, "lobe " + std::to_string(sigma) + " " + std::to_string(mean));
    }
  }
}

TEST(TraceStress, RoughnessAtItsLimits)
{
  for (const double height : { 0.0, 1e-9, 1e-3, 10.0 })
  {
    for (const double correlation : { 0.01, 1.0, 100.0 })
    {
      std::vector<Tissue> tissues = threeTissues();
      tissues[1].roughnessMm = height;
      tissues[1].correlationMm = correlation;
      const auto scene = makeScene(Vec3i(24), Vec3d(1.0), tissues, [](const Vec3d& p) {
        return glm::length(p - Vec3d(12.0)) < 6.0 ? 1 : (p.z > 20.0 ? 2 : 0);
      });
      traceBoth(*scene, { makeLine({ 12.3, 12.2, 0.0 }, { 0, 0, 1 }), makeLine({ 5.9, 12.2, 0.0 }, { 0, 0, 1 }) },
                quickSettings(), "roughness " + std::to_string(height) + " " + std::to_string(correlation));
    }
  }
}

TEST(TraceStress, AttenuationThatUnderflows)
{
  std::vector<Tissue> tissues{ makeTissue("a", 1.5, 1540, 1e5), makeTissue("b", 1.9, 1700, 1e300) };
  tissues[1].tau = 0.0;
  tissues[1].gamma = -2.0;
  const auto scene = makeScene(Vec3i(20), Vec3d(1.0), tissues, [](const Vec3d& p) { return p.z < 10.0 ? 0 : 1; });
  traceBoth(*scene, { makeLine({ 10.3, 10.2, 0.0 }, { 0, 0, 1 }), makeLine({ 10.3, 10.2, 9.999 }, { 0.9, 0, 0.1 }) },
            quickSettings(), "underflow");
}

TEST(TraceStress, GrazingIncidenceWithNegativeGammaAndHugeContrast)
{
  std::vector<Tissue> tissues{ makeTissue("a", 1.0, 1500, 0.0), makeTissue("b", 5000.0, 1500, 0.0) };
  tissues[1].gamma = -2.0;
  const auto scene =
    makeScene(Vec3i(20, 20, 40), Vec3d(1.0), tissues, [](const Vec3d& p) { return p.x < 10.0 ? 0 : 1; });
  for (const double slope : { 1e-1, 1e-3, 1e-5, 1e-9 })
  {
    const TracedLines traced = trace(
      *scene, { makeLine({ 9.99999, 10.2, 0.0 }, { slope, 0, 1 }), makeLine({ 10.0, 10.2, 0.0 }, { -slope, 0, 1 }) },
      quickSettings());
    expectSane(traced, quickSettings(), "grazing");
  }
}

TEST(TraceStress, APathTrappedBetweenTwoBoundariesEnds)
{
  // A slow layer in a fast medium: beyond a thousandth of a radian every reflection inside it is total.
  // Facets that lean by two thousandths turn paths away from the normal, but not out of the layer.
  std::vector<Tissue> tissues{ makeTissue("fast", 1.5, 30000, 0.0), makeTissue("slow", 1.6, 30, 0.0) };
  tissues[0].correlationMm = tissues[1].correlationMm = 100.0;
  const auto scene =
    makeScene(Vec3i(160, 160, 12), Vec3d(0.5), tissues, [](const Vec3d& p) { return p.z > 2.0 && p.z < 3.0 ? 1 : 0; });
  TraceSettings s = quickSettings();
  s.maxCollisions = 1000;
  s.depthMm = 1000.0;
  s.radialBinMm = 10.0;
  s.reverberation = true;
  const TracedLines traced = trace(*scene, { makeLine({ 40.3, 40.2, 0.0 }, { 0, 0, 1 }) }, s);
  expectSane(traced, s, "trapped");
  expectBoundedPieces(traced, s);
  // A millimetre of the layer takes as long as 51: about 40 ways through it fill twice the depth.
  EXPECT_GT(traced.segments, 20u * std::uint64_t(s.pathsPerLine));
}

/// A tiny scene and settings of all kinds from one seed. `met` counts those in which paths ran.
void traceRandomScene(unsigned seed, int& met)
{
  std::mt19937 random(seed);
  const auto uniform = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  const auto whole = [&](int from, int to) { return std::uniform_int_distribution<int>(from, to)(random); };
  const auto unit = [&] { return glm::normalize(Vec3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)) + 1e-6); };
  std::vector<Tissue> tissues;
  TissueTable table;
  for (int i = 0, count = whole(1, 6); i < count; ++i)
  {
    Tissue t = makeTissue("t" + std::to_string(i), std::pow(10.0, uniform(-3.5, 1.0)), uniform(300.0, 4500.0),
                          whole(0, 9) == 0 ? 1e6 : uniform(0.0, 20.0));
    t.tau = uniform(0.0, 3.0);
    t.gamma = uniform(-2.0, 2.0);
    t.roughnessMm = whole(0, 3) ? std::pow(10.0, uniform(-4.0, 1.0)) : 0.0;
    t.correlationMm = std::pow(10.0, uniform(-2.0, 2.0));
    tissues.push_back(t);
    table.add(t);
  }
  LabelVolume volume;
  volume.placement.size = Vec3i(whole(1, 12), whole(1, 12), whole(1, 12));
  volume.placement.spacingMm = Vec3d(std::pow(10.0, uniform(-1.3, 0.7)));
  volume.placement.spacingMm[whole(0, 2)] *= whole(0, 1) ? 1.0 : uniform(1.0, 10.0);
  const Vec3d z = unit();
  const Vec3d x = glm::normalize(glm::cross(unit(), z));
  volume.placement.direction = whole(0, 1) ? Mat3d(x, glm::cross(z, x), z) : Mat3d(glm::cross(z, x), x, z);
  volume.placement.originMm = unit() * (whole(0, 3) ? 10.0 : 1e5);
  const int blocks = whole(1, 4);
  std::vector<int> pattern(64);
  for (int& p : pattern)
  {
    p = whole(0, int(tissues.size()) - 1);
  }
  for (int i = 0, n = int(volume.placement.voxelCount()); i < n; ++i)
  {
    const Vec3i size = volume.placement.size;
    const Vec3i v = Vec3i(i % size.x, i / size.x % size.y, i / (size.x * size.y)) / blocks;
    volume.voxels.push_back(std::uint16_t(pattern[std::size_t(v.x % 4 + 4 * (v.y % 4) + 16 * (v.z % 4))]));
  }
  volume.collectLabels();
  for (LabelInfo& label : volume.labels)
  {
    label.tissue = tissues[std::size_t(label.id)].name;
  }
  const Vec3d extent = Vec3d(volume.placement.size) * volume.placement.spacingMm;
  const Scene scene(std::move(volume), table, whole(0, 1) ? "t0" : "none");

  TraceSettings s;
  s.model = whole(0, 1) ? InterfaceModel::Acoustic : InterfaceModel::Amadou2024;
  s.reverberation = seed % 4 != 0;
  s.faceReflection = 0.5 * (seed % 3);
  s.sampling = Sampling(whole(0, 1));
  s.pathsPerLine = whole(1, 24);
  s.maxCollisions = whole(0, 30);
  s.coherenceMm = whole(0, 3) ? uniform(0.0, 10.0) : 0.0;
  s.deterministic = whole(0, 5) == 0;
  s.lobeSigmaDeg = whole(0, 3) ? std::pow(10.0, uniform(-4.0, 1.0)) * 180.0 / M_PI : 0.0;
  s.lobeMeanDeg = uniform(-1.0, 2.0) * 180.0 / M_PI;
  s.depthMm = std::min(1000.0, uniform(0.2, 2.5) * glm::length(extent));
  s.radialBinMm = s.depthMm / whole(1, 60);
  s.echoSampleMm = s.depthMm / whole(1, 300);
  s.frequencyMHz = uniform(0.5, 15.0);
  s.seed = seed;
  std::vector<ScanLine> lines;
  for (int i = 0; i < 3; ++i)
  {
    Vec3d origin = Vec3d(uniform(-0.3, 1.3), uniform(-0.3, 1.3), uniform(-0.3, 1.3)) * extent;
    if (whole(0, 2) == 0)
    {
      origin = glm::round(origin / scene.placement().spacingMm) * scene.placement().spacingMm;
    }
    Vec3d axis = whole(0, 2) ? glm::normalize(0.5 * extent - origin + 0.2 * extent * unit()) : unit();
    if (whole(0, 3) == 0)
    {
      axis = Vec3d(0.0);
      axis[whole(0, 2)] = whole(0, 1) ? 1.0 : -1.0;
    }
    lines.push_back(makeLine(scene.worldFromLocal(origin), scene.placement().direction * axis));
  }
  const std::string what = "random scene " + std::to_string(seed);
  try
  {
    const TracedLines traced = trace(scene, lines, s);
    expectSane(traced, s, what);
    expectBoundedPieces(traced, s);
    met += traced.segments > 10 ? 1 : 0;
  }
  catch (const Error& error)
  {
    // The only thing that may be wrong: every line misses.
    ASSERT_NE(std::string(error.what()).find("probe"), std::string::npos) << what << ": " << error.what();
  }
}

TEST(TraceStress, RandomScenes)
{
  int met = 0;
  for (int seed = 0; seed < randomScenes && !HasFatalFailure(); ++seed)
  {
    traceRandomScene(unsigned(seed), met);
  }
  EXPECT_GT(met, randomScenes / 3);
}

} // namespace
