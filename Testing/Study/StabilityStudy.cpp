// Single against double precision on every scene, and cost and error as scenes degrade (PHYSICS section 8).
#include "StabilityStudy.h"

#include "Study.h"

#include "Progress.h"
#include "TestScenes.h"

#include <chrono>
#include <cmath>
#include <functional>

namespace sono::study {
namespace {

/// A way to make things hard.
struct Hardship
{
  std::string name;
  std::function<BenchScene()> make;
};

BenchScene bundled(const std::string& name, const std::function<void(TraceSettings&)>& change = {})
{
  BenchScene bench = makeBenchScene(name);
  if (change)
  {
    change(bench.tracing);
  }
  return bench;
}

/// A ball of one tissue in another, and a wall of a third behind them.
BenchScene ballScene(const Vec3d& spacing, double contrast, double attenuation, const Vec3d& originMm = Vec3d(0.0),
                     const std::function<int(const Vec3d&)>& labels = {})
{
  BenchScene bench;
  bench.name = "ball";
  std::vector<Tissue> tissues = { test::makeTissue("a", 1.5, 1540, attenuation),
                                  test::makeTissue("b", 1.5 * contrast, 1600, attenuation),
                                  test::makeTissue("c", 2.4, 1700, attenuation) };
  for (Tissue& t : tissues)
  {
    t.scattererProbability = 1.0;
    t.scattererSigma = 0.3;
  }
  const Vec3i size(60, 60, 60);
  const Vec3d extent = Vec3d(size) * spacing;
  const auto scene = test::makeScene(size, spacing, tissues, [&](const Vec3d& p) {
    if (labels)
    {
      return labels(p / spacing);
    }
    return glm::length(p / extent - Vec3d(0.5, 0.5, 0.4)) < 0.15 ? 1 : (p.z > 0.75 * extent.z ? 2 : 0);
  });
  LabelVolume volume = scene->volume();
  volume.placement.originMm += originMm;
  TissueTable table;
  for (const Tissue& t : tissues)
  {
    table.add(t);
  }
  bench.scene = std::make_unique<Scene>(std::move(volume), table, "none");
  bench.tracing.depthMm = extent.z;
  bench.tracing.radialBinMm = extent.z / 240.0;
  bench.tracing.frequencyMHz = bench.echo.centreFrequencyMHz;
  bench.tracing.echoSampleMm = bench.echo.sampleMm();
  bench.echo.depthMm = bench.tracing.depthMm;
  for (int i = 0; i < 16; ++i)
  {
    const double angle = (i - 7.5) * 0.02;
    const Vec3d start = originMm + extent * Vec3d(0.503, 0.507, 0.0);
    bench.lines.push_back(test::makeLine(start, { std::sin(angle), 0.01, std::cos(angle) }));
  }
  return bench;
}

const std::vector<Hardship>& hardships()
{
  static const std::vector<Hardship> all = {
    { "stack", [] { return bundled("stack"); } },
    { "cyst", [] { return bundled("cyst"); } },
    { "rib", [] { return bundled("rib"); } },
    { "a4c", [] { return bundled("a4c"); } },
    { "a4c, lobe of 6 degrees, 20 collisions",
      [] {
        return bundled("a4c", [](TraceSettings& t) {
          t.lobeSigmaRad = 0.1047;
          t.maxCollisions = 20;
          t.coherenceMm = 20.0;
        });
      } },
    { "a4c, no chance", [] { return bundled("a4c", [](TraceSettings& t) { t.deterministic = true; }); } },
    { "a4c, Amadou2024",
      [] { return bundled("a4c", [](TraceSettings& t) { t.model = InterfaceModel::Amadou2024; }); } },
    { "a4c, 200 collisions", [] { return bundled("a4c", [](TraceSettings& t) { t.maxCollisions = 200; }); } },
    { "a4c, C0 = 0", [] { return bundled("a4c", [](TraceSettings& t) { t.coherenceMm = 0.0; }); } },
    { "a4c, one path", [] { return bundled("a4c", [](TraceSettings& t) { t.pathsPerLine = 1; }); } },
    { "phantom without wires", [] { return bundled("phantom"); } },
    { "ball in a box, 1 mm", [] { return ballScene(Vec3d(1.0), 1.3, 0.5); } },
    { "ball, voxels of 0.05 mm", [] { return ballScene(Vec3d(0.05), 1.3, 0.5); } },
    { "ball, voxels of 5 mm", [] { return ballScene(Vec3d(5.0), 1.3, 0.5); } },
    { "ball, voxels 1:10", [] { return ballScene(Vec3d(0.3, 0.3, 3.0), 1.3, 0.5); } },
    { "ball of air, impedances 1:5000", [] { return ballScene(Vec3d(1.0), 1.0 / 5000.0, 0.5); } },
    { "ball 5000 times as hard", [] { return ballScene(Vec3d(1.0), 5000.0, 0.5); } },
    { "ball hardly different, 1:1.0001", [] { return ballScene(Vec3d(1.0), 1.0001, 0.5); } },
    { "ball, attenuation until nothing is left", [] { return ballScene(Vec3d(1.0), 1.3, 400.0); } },
    { "ball, no attenuation", [] { return ballScene(Vec3d(1.0), 1.3, 0.0); } },
    { "ball, 100 m from the origin", [] { return ballScene(Vec3d(1.0), 1.3, 0.5, Vec3d(1e5, -1e5, 1e5)); } },
    { "labels in turn, one voxel each",
      [] {
        return ballScene(Vec3d(1.0), 1.3, 0.5, Vec3d(0.0),
                         [](const Vec3d& v) { return (int(v.x) + int(v.y) + int(v.z)) % 3; });
      } },
    { "walls of one voxel",
      [] {
        return ballScene(Vec3d(1.0), 1.3, 0.5, Vec3d(0.0), [](const Vec3d& v) { return int(v.z) % 7 == 3 ? 1 : 0; });
      } },
  };
  return all;
}

} // namespace

Difference singleAgainstDouble(const BenchScene& bench, TraceSettings tracing)
{
  tracing.device = Device::Cpu; // the twin's
  const BenchImage single = makeBenchImage(bench, tracing, Precision::Single);
  const BenchImage twice = makeBenchImage(bench, tracing, Precision::Double);
  const double paths = double(tracing.pathsPerLine) * double(bench.lines.size());
  Difference d;
  d.of = imageError(single, twice);
  d.microsecondsPerPath = 1e6 * single.traceSeconds / paths;
  d.segmentsPerPath = single.segments / paths;
  double noise = 0.0;
  double power = 0.0;
  for (std::size_t i = 0; i < twice.intensity.size(); ++i)
  {
    d.finite = d.finite && std::isfinite(single.intensity[i]) && std::isfinite(single.standardError[i]);
    noise += single.standardError[i] * single.standardError[i];
    power += twice.intensity[i] * twice.intensity[i];
  }
  for (const std::complex<double>& v : single.iq)
  {
    d.finite = d.finite && std::isfinite(v.real()) && std::isfinite(v.imag());
  }
  d.noise = std::sqrt(noise / power);
  return d;
}

namespace {

void measureStability(Output& output)
{
  std::vector<std::vector<std::string>> rows;
  double worst = 0.0;
  for (const Hardship& hardship : hardships())
  {
    const BenchScene bench = hardship.make();
    TraceSettings tracing = bench.tracing;
    tracing.pathsPerLine = std::min(tracing.pathsPerLine, output.quick() ? 40 : 1000);
    const Difference d = singleAgainstDouble(bench, tracing);
    rows.push_back({ hardship.name, d.finite ? "yes" : "NO", number(d.microsecondsPerPath), number(d.segmentsPerPath),
                     number(d.of.intensity), number(d.of.rf), number(d.of.decibels), number(d.noise) });
    worst = std::max(worst, d.finite ? d.of.intensity : 1.0);
  }
  output.table("stability.csv",
               { "scene", "finite", "microseconds a path", "segments a path", "single against double: intensity", "RF",
                 "dB", "standard error of the intensity" },
               rows);
  output.figure("single_against_double_worst", worst, "of_rms");
}

const Part part("stability", measureStability);

} // namespace
} // namespace sono::study
