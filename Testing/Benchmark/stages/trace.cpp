// Tracing, A4C of the bundled thorax at 1 mm: time, growth with what lies outside the fan, error against paths, time to
// a picture of little noise, closed forms.
#include "Trace/Trace.h"
#include "ApicalImage.h"
#include "Core/Progress.h"
#include "Core/SoundSpeed.h"
#include "FalseRehits.h"
#include "Folders.h"
#include "HollowHits.h"
#include "Labels/AssignTissues.h"
#include "PhantomScene.h"
#include "Phantoms/ThoraxPhantom.h"
#include "PictureNoise.h"
#include "RelativeRms.h"
#include "SamplingName.h"
#include "Stage.h"
#include "TestScenes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>

namespace sono {
namespace {

TraceSettings a4cSettings()
{
  TraceSettings settings;
  settings.pathsPerLine = 1000;
  settings.maxCollisions = 7;
  return settings;
}

std::vector<ScanLine> a4cLines()
{
  return makeScanLines(ScanGeometry(), thoraxPhantomA4C().orthonormalized());
}

double tracingSeconds(const Scene& scene, const std::vector<ScanLine>& lines)
{
  Stopwatch watch;
  trace(scene, lines, a4cSettings());
  return watch.lap();
}

/// Median of the ratios of two scenes' tracing times, measured alternately so that the machine's moods cancel.
double timeRatio(const Scene& base, const Scene& grown, const std::vector<ScanLine>& lines)
{
  tracingSeconds(base, lines);
  tracingSeconds(grown, lines);
  std::vector<double> ratios;
  for (int i = 0; i < 9; ++i)
  {
    const double seconds = tracingSeconds(base, lines);
    ratios.push_back(tracingSeconds(grown, lines) / seconds);
  }
  return medianOf(ratios);
}

/// The phantom with everything farther than `keepMm` from the probe turned into `count` labels of different tissues.
std::unique_ptr<Scene> sceneWithFarLabels(int count, double keepMm)
{
  LabelVolume volume = makeThoraxPhantom(1.0);
  const Vec3d probe = thoraxPhantomA4C().positionMm;
  const GridPlacement& p = volume.placement;
  std::size_t at = 0;
  for (int k = 0; k < p.size.z; ++k)
  {
    for (int j = 0; j < p.size.y; ++j)
    {
      for (int i = 0; i < p.size.x; ++i, ++at)
      {
        if (glm::distance(p.worldFromIndex(Vec3d(i, j, k)), probe) > keepMm)
        {
          volume.voxels[at] = std::uint16_t(1000 + (i / 7 + j / 5 + k / 6) % count);
        }
      }
    }
  }
  volume.collectLabels();
  TissueTable table = TissueTable::read(dataFile("tissues.csv"));
  for (LabelInfo& label : volume.labels)
  {
    if (label.id >= 1000)
    {
      label.tissue = "far_" + std::to_string(label.id);
      table.add(test::makeTissue(label.tissue, 1.5 + 1e-3 * (label.id - 1000), 1540.0, 0.5));
    }
  }
  const LabelTissueMap map = LabelTissueMap::read(dataFile("label_tissues.csv"));
  assignTissues(volume, map, table, "air");
  return std::make_unique<Scene>(std::move(volume), table, "air");
}

/// The phantom in a volume twice as long each way, the rest filled with copies of its border.
std::unique_ptr<Scene> eightfoldScene()
{
  const LabelVolume small = makeThoraxPhantom(1.0);
  LabelVolume volume = small;
  const Vec3i n = small.placement.size;
  const Vec3i before = n / 2;
  volume.placement.size = n * 2;
  volume.placement.originMm = small.placement.worldFromIndex(-Vec3d(before));
  volume.voxels.resize(volume.placement.voxelCount());
  std::size_t at = 0;
  for (int k = 0; k < 2 * n.z; ++k)
  {
    for (int j = 0; j < 2 * n.y; ++j)
    {
      for (int i = 0; i < 2 * n.x; ++i)
      {
        const Vec3i from = glm::clamp(Vec3i(i, j, k) - before, Vec3i(0), n - 1);
        volume.voxels[at++] =
          small.voxels[std::size_t(from.x) + std::size_t(n.x) * (std::size_t(from.y) + std::size_t(n.y) * from.z)];
      }
    }
  }
  return makePhantomScene(std::move(volume));
}

/// Largest relative error of the echoes of five layers at normal incidence against the product formula.
double stackEchoError()
{
  const std::vector<Tissue> tissues = { test::makeTissue("a", 1.38, 1450, 0.6), test::makeTissue("b", 1.70, 1580, 1.1),
                                        test::makeTissue("c", 1.61, 1570, 0.2), test::makeTissue("d", 7.8, 4080, 5.0),
                                        test::makeTissue("e", 1.65, 1550, 0.7) };
  const double face[5] = { 20.0, 35.0, 65.0, 69.0, 1e9 };
  const auto scene = test::makeScene(Vec3i(40, 40, 120), Vec3d(1.0), tissues, [&](const Vec3d& p) {
    int layer = 0;
    while (p.z > face[layer])
    {
      ++layer;
    }
    return layer;
  });
  TraceSettings s;
  s.model = InterfaceModel::Amadou2024; // whose boundaries echo on the paths
  s.deterministic = true;
  s.maxCollisions = 20;
  s.depthMm = 100.0;
  s.frequencyMHz = 3.6;
  const auto traced = trace(*scene, { test::makeLine({ 20.3, 20.2, 0.0 }, { 0, 0, 1 }) }, s);
  const double k2 = 4.0 * 3.14159265358979323846 * s.frequencyMHz / assumedSoundSpeedMmPerUs;
  double worst = 0.0;
  double intensity = 1.0;
  for (std::size_t i = 0; i < 4; ++i)
  {
    std::complex<double> sum = 0.0;
    for (int e = 0; e < traced.echoCount; ++e)
    {
      const double r = e * traced.echoSampleMm;
      if (std::abs(r - face[i]) < 0.5)
      {
        sum += std::complex<double>(traced.boundaryEcho[std::size_t(e)]) * std::polar(1.0, -k2 * r);
      }
    }
    const double thickness = face[i] - (i == 0 ? 0.0 : face[i - 1]);
    intensity *= std::pow(10.0, -tissues[i].attenuationDbPerCmMHz * s.frequencyMHz * thickness / 100.0);
    const double z1 = tissues[i].impedanceMRayl;
    const double z2 = tissues[i + 1].impedanceMRayl;
    const double r0 = (z2 - z1) / (z2 + z1);
    worst = std::max(worst, std::abs(std::abs(sum) / (r0 * r0 * intensity) - 1.0));
    intensity *= 1.0 - r0 * r0;
  }
  return worst;
}

/// Largest angle between the refracted direction and Snell's, over angles and speeds.
double snellError()
{
  double worst = 0.0;
  for (double c2 = 400.0; c2 < 4200.0; c2 += 37.0)
  {
    for (double t1 = 0.0; t1 < 1.57; t1 += 0.01)
    {
      const double sin2 = std::sin(t1) * c2 / 1540.0;
      if (sin2 > 0.999)
      {
        break;
      }
      const Vec3f d(Vec3d(std::sin(t1), 0.0, std::cos(t1)));
      const Vec3f n(0.0f, 0.0f, 1.0f);
      const float cos1 = glm::dot(d, n);
      const Reflection r = reflectionAt(InterfaceModel::Acoustic, 1.5f, 1.7f, 1540.0f, float(c2), cos1);
      const Vec3d w = glm::normalize(Vec3d(refractedDirection(d, n, cos1, r)));
      worst = std::max(worst, std::abs(std::atan2(w.x, w.z) - std::asin(sin2)));
    }
  }
  return worst;
}

/// Error and time against paths for one setting, and how many independent paths one of low discrepancy is worth
/// where the image has 1000 of them.
void printErrorCurve(const Scene& scene, const std::vector<ScanLine>& lines, TraceSettings settings,
                     const std::string& name)
{
  settings.pathsPerLine = 100000;
  settings.seed = 99;
  settings.sampling = Sampling::LowDiscrepancy;
  const TracedLines reference = trace(scene, lines, settings);
  settings.seed = 1;
  double independentError = 0.0;
  double independentSeconds = 0.0;
  for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy })
  {
    settings.sampling = sampling;
    for (const int paths : { 64, 256, 1000, 4096 })
    {
      settings.pathsPerLine = paths;
      Stopwatch watch;
      const TracedLines traced = trace(scene, lines, settings);
      const double seconds = watch.lap();
      const double error = test::relativeRms(traced.intensity, reference.intensity);
      const std::string figure = name + "_rmse_" + test::nameOf(sampling) + "_" + std::to_string(paths);
      printFigure(figure, error, "of_rms");
      printFigure(figure + "_s", seconds, "s");
      if (paths != 1000)
      {
        continue;
      }
      if (sampling == Sampling::Independent)
      {
        independentError = error;
        independentSeconds = seconds;
        continue;
      }
      const double ratio = std::pow(independentError / error, 2);
      printFigure(name + "_equal_rmse_path_ratio", ratio, "times");
      printFigure(name + "_equal_rmse_time_ratio", ratio * independentSeconds / seconds, "times");
    }
  }
}

/// The time of a whole image of so many paths that their noise and what its sampling is off are 1 or 0.5 dB together;
/// figures end with the probe's name.
void printTimeToNoise(const Scene& scene, ImageSettings settings, const std::string& probe)
{
  const double samplingDb = PictureNoise::samplingDb(scene, settings);
  printFigure("sampling_error_db" + probe, samplingDb, "dB");
  const PictureNoise noise(scene, settings);
  printFigure("noise_of_256_paths_db" + probe, noise.decibels(256), "dB");
  for (const auto& [db, name] : { std::pair{ 1.0, "1db" }, std::pair{ 0.5, "05db" } })
  {
    settings.tracing.pathsPerLine = noise.pathsWithin(std::sqrt(db * db - samplingDb * samplingDb));
    // Others' work on the same processor comes and goes within a second or two.
    constexpr double longEnoughS = 8.0;
    std::vector<double> seconds;
    Stopwatch watch;
    for (double spentS = 0.0; seconds.size() < 9 || spentS < longEnoughS; spentS += watch.lap())
    {
      seconds.push_back(warmImageSeconds(scene, settings).image);
    }
    printFigure(std::string("paths_to_") + name + probe, settings.tracing.pathsPerLine, "paths");
    printFigure(std::string("time_to_") + name + probe + "_s", medianOf(seconds), "s");
  }
}

/// Hits on balls, shells and walls, 100,000 in each.
void printRoundHits()
{
  test::RoundHits all;
  for (const test::RoundBody& body : test::roundBodies())
  {
    for (const test::Turning& turning : test::allTurnings())
    {
      const test::RoundHits one = test::meetRoundBody(body, turning, 100000);
      all.hits += one.hits;
      all.off += one.off;
      all.through += one.through;
      all.worst = std::max(all.worst, one.worst);
      all.away += one.away;
      all.again += one.again;
    }
  }
  printFigure("hollow_hits", all.hits, "hits");
  printFigure("hollow_hits_off", all.off, "hits");
  printFigure("hollow_hits_worst", all.worst, "voxel");
  printFigure("hollow_ways_through", all.through, "hits");
  printFigure("hollow_rehit_percent", 100.0 * all.again / all.away, "%");
}

void measureTrace()
{
  const auto lines = a4cLines();
  const auto scene = makePhantomScene(makeThoraxPhantom(1.0));
  tracingSeconds(*scene, lines);
  std::vector<double> seconds;
  for (int i = 0; i < 9; ++i)
  {
    seconds.push_back(tracingSeconds(*scene, lines));
  }
  printFigure("trace_a4c_s", medianOf(seconds), "s");
  ImageSettings unnamed; // no aperture
  unnamed.matchStages();
  printTimeToNoise(*scene, unnamed, "");
  printTimeToNoise(*scene, a4cWith(InterfaceModel::Acoustic), "_p42");
  {
    const auto ten = sceneWithFarLabels(10, 165.0);
    const auto hundred = sceneWithFarLabels(100, 165.0);
    printFigure("label_growth_ratio", timeRatio(*ten, *hundred, lines), "times");
  }
  printFigure("volume_growth_ratio", timeRatio(*scene, *eightfoldScene(), lines), "times");
  printFigure("stack_echo_max_rel_error", stackEchoError(), "of_echo");
  printFigure("snell_max_rad", snellError(), "rad");
  printFigure("false_rehit_percent",
              100.0 * std::max(test::falseRehitShare(30.0, 100000), test::falseRehitShare(90.0, 100000)), "%");
  printRoundHits();
  const std::vector<ScanLine> third(lines.begin() + 40, lines.begin() + 80);
  printErrorCurve(*scene, third, a4cSettings(), "trace");
  TraceSettings example = a4cSettings(); // of Plugin/examples/simulate.py
  example.maxCollisions = 20;
  example.coherenceMm = 20.0;
  printErrorCurve(*scene, third, example, "trace_example");
}

const Stage stage("trace", measureTrace);

} // namespace
} // namespace sono
