// Paths that start over the aperture (Data/docs/physics.md 3.1).
#include "BusyScene.h"
#include "ErrorText.h"

#include "Core/ParallelFor.h"
#include "ImageSettings.h"
#include "Trace/RecordPaths.h"
#include "Trace/TraceSetup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace sono;
using namespace sono::test;

constexpr double lateralFocusMm = 60.0;
constexpr double elevationFocusMm = 50.0;

BeamAperture wideAperture()
{
  return { 20.0, 14.0, lateralFocusMm, elevationFocusMm, 0.3, false };
}

Tissue smoothTissue(const std::string& name, double speed, double attenuation)
{
  Tissue t = makeTissue(name, 1.6, speed, attenuation);
  t.roughnessMm = 0.0;
  return t;
}

TraceSettings apertureSettings(double depthMm)
{
  TraceSettings s;
  s.depthMm = depthMm;
  s.frequencyMHz = 2.5;
  s.aperture = wideAperture();
  return s;
}

ScanLine lineDown(double x, double y, double z = 0.0)
{
  return { { x, y, z }, { 0.0, 0.0, 1.0 }, { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 } };
}

double at(const TracedLines& traced, std::size_t line, double depthMm)
{
  return traced.intensity[line * std::size_t(traced.binCount) + std::size_t(depthMm / traced.binMm)];
}

TEST(TraceAperture, AStraightPathLeavesWhatOneAlongTheAxisWould)
{
  const auto scene =
    makeScene(Vec3i(80, 80, 100), Vec3d(1.0), { smoothTissue("gel", 1540, 0.5) }, [](const Vec3d&) { return 0; });
  std::vector<ScanLine> lines = { lineDown(40.2, 40.3, 1.0), makeLine({ 40.2, 40.3, 8.0 }, { 0.3, -0.1, 1.0 }) };
  for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy })
  {
    TraceSettings s = apertureSettings(80.0);
    s.sampling = sampling;
    s.pathsPerLine = 256;
    const TracedLines apart = trace(*scene, lines, s);
    s.aperture = {};
    const TracedLines together = trace(*scene, lines, s);
    for (std::size_t b = 0; b < apart.intensity.size(); ++b)
    {
      // The last bin ends where rounding puts the depth: 7.6e-6 mm of 0.25, at worst.
      const bool isLast = (b + 1) % std::size_t(apart.binCount) == 0;
      const double tolerance = isLast ? 3.1e-5 : 1e-6;
      ASSERT_GT(together.intensity[b], 0.0f) << b;
      EXPECT_NEAR(apart.intensity[b] / together.intensity[b], 1.0, tolerance) << b;
      EXPECT_NEAR(apart.attenuationNpPerMHz[b], together.attenuationNpPerMHz[b], 1e-6) << b;
      EXPECT_LE(apart.standardError[b], tolerance * apart.intensity[b]) << b;
    }
  }
}

TEST(TraceAperture, CouplingNeitherAttenuatesNorIsLost)
{
  const auto scene = makeScene(
    Vec3i(60, 60, 60), Vec3d(1.0), { makeTissue("air", 0.0004, 330, 1.6), smoothTissue("gel", 1540, 0.5) },
    [](const Vec3d& p) { return p.z < 10.0 ? 0 : 1; }, "air");
  TraceSettings s = apertureSettings(50.0);
  s.pathsPerLine = 256;
  // From outside of the volume, from the air in it and from the body's surface.
  for (const double z : { -5.0, 3.0, 10.0 })
  {
    const TracedLines traced = trace(*scene, { lineDown(30.2, 30.3, z) }, s);
    const double couplingMm = 10.0 - z;
    for (double r = 0.125; r < couplingMm - 0.25; r += 0.25)
    {
      EXPECT_NEAR(at(traced, 0, r), 1.0, 1e-6) << z << " " << r;
    }
    const double behind = couplingMm + 20.125;
    // A ray's way through the gel is longer than the axis' by its slope alone, 0.1 at most.
    EXPECT_NEAR(at(traced, 0, behind), std::pow(10.0, -0.5 * 2.5 * 20.125 / 100.0), 1e-3) << z;
  }
}

/// Half of a plane at z0 is opaque: where the `axis`-coordinate is above the edge. Lines pass it at any distance.
void expectShadowOfEdge(int axis, double z0, double quarterMm, double focusMm)
{
  const double edge = 20.0;
  const auto scene = makeScene(Vec3i(80, 80, 400), Vec3d(0.5, 0.5, 0.25),
                               { smoothTissue("gel", 1540, 0.3), smoothTissue("lead", 1540, 1000.0) },
                               [=](const Vec3d& p) { return p[axis] > edge && p.z > z0 && p.z < z0 + 0.25 ? 1 : 0; });
  const double half = quarterMm * std::abs(1.0 - z0 / focusMm); // width of the bundle there, to either side
  std::vector<ScanLine> lines;
  std::vector<double> expected;
  for (int i = -6; i <= 6; ++i)
  {
    const double offset = 0.2 * i * half;
    lines.push_back(axis == 0 ? lineDown(edge + offset, 20.1) : lineDown(20.1, edge + offset));
    expected.push_back(std::clamp(0.5 - 0.5 * offset / half, 0.0, 1.0));
  }
  TraceSettings s = apertureSettings(95.0);
  s.pathsPerLine = 4096;
  const TracedLines traced = trace(*scene, lines, s);
  for (std::size_t l = 0; l < lines.size(); ++l)
  {
    for (const double r : { z0 + 2.125, 0.5 * (z0 + 95.0), 94.125 })
    {
      const double open = std::pow(10.0, -0.3 * 2.5 * r / 100.0);
      EXPECT_NEAR(at(traced, l, r) / open, expected[l], 0.01) << "axis " << axis << " line " << l << " at " << r;
    }
    EXPECT_NEAR(at(traced, l, z0 - 2.125), std::pow(10.0, -0.3 * 2.5 * (z0 - 2.125) / 100.0), 1e-4);
  }
}

TEST(TraceAperture, BehindAnEdgeThereIsTheShareOfTheApertureThatSeesIt)
{
  expectShadowOfEdge(0, 20.0, 5.0, lateralFocusMm);
  expectShadowOfEdge(0, 85.0, 5.0, lateralFocusMm); // beyond the focus
  expectShadowOfEdge(1, 20.0, 3.5, elevationFocusMm);
}

// The twin of a ball in gel: rays in double precision, straight on at every boundary. What is reflected reverberates,
// and is no part of the intensity.

struct Medium
{
  double speed;
  double decayPerMm;
};

struct Twin
{
  Vec3d centre;
  double radiusMm;
  Medium gel;
  Medium ball;
  double coherenceMm;
  double depthMm; ///< where I is asked for

  /// I w_R at the depth, of a ray as far as it is transmitted.
  double follow(const Vec3d& origin, const Vec3d& axis, Vec3d p, Vec3d d, double intensity, bool inside, int met) const
  {
    const Vec3d q = p - centre;
    const double b = glm::dot(q, d);
    const double root = b * b - glm::dot(q, q) + radiusMm * radiusMm;
    const double t = inside ? -b + std::sqrt(std::max(0.0, root)) : (root > 0.0 ? -b - std::sqrt(root) : -1.0);
    const bool hits = t > 1e-9;
    const double k = inside ? ball.decayPerMm : gel.decayPerMm;
    double sum = 0.0;
    const double mu = glm::dot(d, axis);
    const double crossing = (depthMm - glm::dot(p - origin, axis)) / mu;
    if (crossing > 0.0 && (!hits || crossing < t))
    {
      const double aside = glm::length(p + d * crossing - origin - axis * depthMm);
      sum += intensity * std::exp(-k * crossing) * coherenceMm / (coherenceMm + aside);
    }
    if (!hits || met == 7)
    {
      return sum;
    }
    intensity *= std::exp(-k * t);
    p += d * t;
    const Vec3d n = (inside ? 1.0 : -1.0) * (p - centre) / radiusMm; // ahead
    const double c1 = inside ? ball.speed : gel.speed;
    const double c2 = inside ? gel.speed : ball.speed;
    const double cos1 = glm::dot(d, n);
    const double sin2 = c2 / c1 * std::sqrt(std::max(0.0, 1.0 - cos1 * cos1));
    const double cos2 = std::sqrt(std::max(0.0, 1.0 - sin2 * sin2));
    const double r = sin2 >= 1.0 ? 1.0 : (cos1 - cos2) / (cos1 + cos2); // of equal impedances
    if (r * r < 1.0)
    {
      const Vec3d across = d - cos1 * n;
      sum += follow(origin, axis, p, glm::normalize(c2 / c1 * across + cos2 * n), intensity * (1.0 - r * r), !inside,
                    met + 1);
    }
    return sum;
  }

  /// The mean over 10^6 rays of a line, uniform over the inner half of the aperture.
  double meanOver(const ScanLine& line) const
  {
    constexpr int side = 1000;
    double sum = 0.0;
    for (int i = 0; i < side; ++i)
    {
      for (int j = 0; j < side; ++j)
      {
        const double dl = 10.0 * ((i + 0.5) / side - 0.5);
        const double de = 7.0 * ((j + 0.5) / side - 0.5);
        const Vec3d origin = line.originMm + dl * line.lateral + de * line.elevation;
        const Vec3d axis =
          glm::normalize(line.axis - dl / lateralFocusMm * line.lateral - de / elevationFocusMm * line.elevation);
        sum += follow(origin, axis, origin, axis, 1.0, false, 0);
      }
    }
    return sum / (side * double(side));
  }
};

double largestStep(const std::vector<double>& values)
{
  double step = 0.0;
  for (std::size_t i = 1; i < values.size(); ++i)
  {
    step = std::max(step, std::abs(values[i] - values[i - 1]));
  }
  return step;
}

TEST(TraceAperture, NoStreaksBehindABall)
{
  const Vec3d centre(30.0, 20.0, 25.0);
  const double radius = 8.0;
  const auto scene =
    makeScene(Vec3i(120, 80, 160), Vec3d(0.5), { smoothTissue("gel", 1540, 0.3), smoothTissue("ball", 1640, 3.0) },
              [=](const Vec3d& p) { return glm::length(p - centre) < radius ? 1 : 0; });
  std::vector<ScanLine> lines;
  for (int i = -12; i <= 12; ++i)
  {
    lines.push_back(lineDown(centre.x + 1.0 * i, centre.y + 0.1));
  }
  TraceSettings s = apertureSettings(70.0);
  s.pathsPerLine = 4096;
  const auto decay = [&](double a) { return a * s.frequencyMHz * std::log(10.0) / 100.0; };
  for (const double depth : { 45.125, 65.125 })
  {
    const Twin twin{ centre, radius, { 1540, decay(0.3) }, { 1640, decay(3.0) }, s.coherenceMm, depth };
    std::vector<double> right(lines.size());
    parallelFor(int(lines.size()), {}, [&](int l) { right[std::size_t(l)] = twin.meanOver(lines[std::size_t(l)]); });
    const auto profile = [&](const TraceSettings& settings) {
      const TracedLines traced = trace(*scene, lines, settings);
      std::vector<double> values;
      for (std::size_t l = 0; l < lines.size(); ++l)
      {
        values.push_back(at(traced, l, depth));
      }
      return values;
    };
    const std::vector<double> found = profile(s);
    TraceSettings alongTheAxis = s;
    alongTheAxis.aperture = {};
    const std::vector<double> streaked = profile(alongTheAxis);
    for (std::size_t l = 0; l < lines.size(); ++l)
    {
      EXPECT_NEAR(found[l], right[l], 0.02) << "line " << l << " at " << depth;
    }
    EXPECT_NEAR(largestStep(found), largestStep(right), 0.02) << depth;
    EXPECT_GT(largestStep(streaked), 1.5 * largestStep(right)) << depth;
    std::printf("largest step at %.0f mm: %.3f, twin %.3f, along the axis %.3f\n", depth, largestStep(found),
                largestStep(right), largestStep(streaked));
  }
}

TEST(TraceAperture, TheIntensityDoesNotDependOnTheNumberOfPaths)
{
  // Sixteen lines along one axis, each with paths of its own; their mean and its error from their spread.
  const auto scene = makeBusyScene();
  const std::vector<ScanLine> lines(16, fan(3)[0]);
  const auto meansOf = [&](int paths, std::vector<double>& error) {
    TraceSettings s = busySettings();
    s.aperture = wideAperture();
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
  std::vector<double> manyError;
  const std::vector<double> many = meansOf(100000, manyError);
  for (const int paths : { 100, 1000, 10000 })
  {
    std::vector<double> fewError;
    const std::vector<double> few = meansOf(paths, fewError);
    double squares = 0.0;
    for (std::size_t b = 0; b < few.size(); ++b)
    {
      const double error = std::hypot(fewError[b], manyError[b]) + 1e-6;
      EXPECT_LT(std::abs(few[b] - many[b]), 6.0 * error) << paths << " bin " << b;
      squares += std::pow((few[b] - many[b]) / error, 2.0);
    }
    EXPECT_LT(squares / double(few.size()), 2.5) << paths; // as in TraceRough
  }
}

TEST(TraceAperture, TheStandardErrorCountsTheStarts)
{
  // Half of a plane is opaque and nothing bends: chance decides where paths start, and nothing else.
  const auto scene =
    makeScene(Vec3i(60, 60, 60), Vec3d(1.0), { smoothTissue("gel", 1540, 0.3), smoothTissue("lead", 1540, 1000.0) },
              [](const Vec3d& p) { return p.x > 30.0 && p.y > 28.0 && p.z > 20.0 && p.z < 21.0 ? 1 : 0; });
  const std::vector<ScanLine> lines = { lineDown(29.3, 29.4), lineDown(30.2, 30.3), lineDown(31.7, 28.6) };
  for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy })
  {
    TraceSettings s = apertureSettings(50.0);
    s.sampling = sampling;
    s.pathsPerLine = 1000;
    constexpr int seeds = 60;
    std::vector<double> sum(lines.size());
    std::vector<double> squares(lines.size());
    double reported = 0.0;
    for (int seed = 0; seed < seeds; ++seed)
    {
      s.seed = std::uint64_t(100 + seed);
      const TracedLines traced = trace(*scene, lines, s);
      for (std::size_t l = 0; l < lines.size(); ++l)
      {
        const double value = at(traced, l, 40.0);
        sum[l] += value;
        squares[l] += value * value;
        const double error = traced.standardError[l * std::size_t(traced.binCount) + std::size_t(40.0 / traced.binMm)];
        reported += error * error / seeds;
      }
    }
    double observed = 0.0;
    for (std::size_t l = 0; l < lines.size(); ++l)
    {
      observed += (squares[l] - sum[l] * sum[l] / seeds) / (seeds - 1);
    }
    EXPECT_NEAR(std::sqrt(reported / observed), 1.0, 0.15) << int(sampling);
  }
}

TEST(TraceAperture, RaysFillTheInnerHalfAndMeetAtTheFocus)
{
  const auto scene =
    makeScene(Vec3i(80, 80, 100), Vec3d(1.0), { smoothTissue("gel", 1540, 0.5) }, [](const Vec3d&) { return 0; });
  TraceSettings s = apertureSettings(90.0);
  s.pathsPerLine = 400;
  ScanLine line = makeLine({ 30.2, 40.3, 8.0 }, { 0.3, -0.1, 1.0 });
  for (const bool steered : { false, true })
  {
    line.steeringLateral = steered ? 0.6 : 0.0;
    const double halfMm = steered ? 0.8 * 5.0 : 5.0;
    double lateral = 0.0;
    double elevational = 0.0;
    const auto paths = recordPaths(*scene, { line }, s, 400);
    ASSERT_EQ(paths.size(), 400u);
    for (const RecordedPath& path : paths)
    {
      const Vec3d start = path.pointMm.front() - line.originMm;
      const Vec3d d = glm::normalize(path.pointMm.back() - path.pointMm.front());
      EXPECT_NEAR(glm::dot(start, line.axis), 0.0, 1e-4);
      lateral = std::max(lateral, std::abs(glm::dot(start, line.lateral)));
      elevational = std::max(elevational, std::abs(glm::dot(start, line.elevation)));
      const double along = glm::dot(d, line.axis);
      EXPECT_NEAR(glm::dot(start + d * (lateralFocusMm / along), line.lateral), 0.0, 1e-3);
      EXPECT_NEAR(glm::dot(start + d * (elevationFocusMm / along), line.elevation), 0.0, 1e-3);
    }
    EXPECT_LE(lateral, halfMm);
    EXPECT_GT(lateral, 0.95 * halfMm);
    EXPECT_LE(elevational, 3.5);
    EXPECT_GT(elevational, 0.95 * 3.5);
  }
  // A matrix focuses across the plane as along it; without a focus rays are parallel.
  s.aperture.elevationIsArray = true;
  s.aperture.transmitFocusMm = 0.0;
  for (const RecordedPath& path : recordPaths(*scene, { line }, s, 50))
  {
    EXPECT_NEAR(glm::dot(glm::normalize(path.pointMm.back() - path.pointMm.front()), line.axis), 1.0, 1e-6);
  }
}

TEST(TraceAperture, WithoutChanceAndInAmadou2024AllPathsStartTogether)
{
  const auto scene = makeBusyScene();
  TraceSettings s = busySettings();
  const auto expectTheSame = [&] {
    s.aperture = {};
    const TracedLines without = trace(*scene, fan(5), s);
    s.aperture = wideAperture();
    const TracedLines with = trace(*scene, fan(5), s);
    EXPECT_EQ(with.intensity, without.intensity);
    EXPECT_EQ(with.standardError, without.standardError);
    EXPECT_EQ(with.boundaryEcho, without.boundaryEcho);
    EXPECT_EQ(with.segments, without.segments);
  };
  s.model = InterfaceModel::Amadou2024;
  expectTheSame();
  s.model = InterfaceModel::Acoustic;
  s.deterministic = true;
  expectTheSame();
}

TEST(TraceAperture, BothMarchesGiveTheSame)
{
  const auto scene = makeBusyScene();
  TraceSettings s = busySettings();
  s.aperture = wideAperture();
  const TracedLines cells = trace(*scene, fan(5), s);
  s.march = March::NanoVDB;
  const TracedLines nano = trace(*scene, fan(5), s);
  for (std::size_t b = 0; b < cells.intensity.size(); ++b)
  {
    EXPECT_NEAR(cells.intensity[b], nano.intensity[b], 1e-4) << b;
  }
}

TEST(TraceAperture, TheRegionHoldsEveryRay)
{
  const auto scene =
    makeScene(Vec3i(80), Vec3d(4.0), { smoothTissue("gel", 1540, 0.5) }, [](const Vec3d&) { return 0; });
  const TraceSettings s = apertureSettings(60.0);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto direction = [&] {
    Vec3d d(2.0);
    while (glm::length(d) > 1.0 || glm::length(d) < 0.1)
    {
      d = Vec3d(uniform(random), uniform(random), uniform(random));
    }
    return glm::normalize(d);
  };
  for (int n = 0; n < 200; ++n)
  {
    const ScanLine line = makeLine(Vec3d(160.0), direction());
    const VoxelBox box = fanBox(*scene, { line }, s);
    for (int i = 0; i < 200; ++i)
    {
      const double dl = 5.0 * uniform(random);
      const double de = 3.5 * uniform(random);
      const Vec3d axis =
        glm::normalize(line.axis - dl / lateralFocusMm * line.lateral - de / elevationFocusMm * line.elevation);
      Vec3d d = direction();
      d = glm::dot(d, axis) < 0.0 ? -d : d;
      const Vec3d cell = (line.originMm + dl * line.lateral + de * line.elevation + s.depthMm * d) / 4.0;
      for (int a = 0; a < 3; ++a)
      {
        ASSERT_GE(cell[a], box.first[a]);
        ASSERT_LE(cell[a], box.last[a]);
      }
    }
  }
}

TEST(TraceAperture, IsTheProbesForAllStages)
{
  ImageSettings s;
  s.echo.aperture = wideAperture();
  s.matchStages();
  EXPECT_EQ(s.tracing.aperture, wideAperture());
  EXPECT_NO_THROW(s.requireMatch());
  s.tracing.aperture.transmitFocusMm += 1.0;
  sono::testing::expectContains(sono::testing::errorOf([&] { s.requireMatch(); }), "the aperture");
  s.tracing.aperture.transmitFocusMm = -1.0;
  sono::testing::expectContains(sono::testing::errorOf([&] { s.tracing.validate(); }), "transmitFocusMm");
}

} // namespace
