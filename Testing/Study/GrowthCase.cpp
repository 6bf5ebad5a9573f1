#include "GrowthCase.h"

#include "../Benchmark/SyntheticTorso.h"
#include "PhantomImaging.h"
#include "Study.h"

#include "Phantoms/ThoraxPhantom.h"
#include "Probe/ScanGeometry.h"
#include "Simulator.h"

#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace sono::study {
namespace {

GrowthCost::Seconds now()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return { std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
           double(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
             1e-6 * double(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec) };
}

GrowthCost::Seconds since(const GrowthCost::Seconds& start)
{
  const GrowthCost::Seconds end = now();
  return { end.wall - start.wall, end.core - start.core };
}

double peakMegabytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) * 1024.0 / 1e6; // Linux counts in KiB
}

/// The P4-2 with the defaults of everything.
ImageInput inputFor(bool quick)
{
  const ProbePreset preset = readProbePreset(dataFile("probes/phased_p4-2.json"));
  ImageInput input;
  input.settings.geometry = preset.geometry;
  input.settings.geometry.lineCount = quick ? 16 : 128;
  input.settings.echo.centreFrequencyMHz = preset.centreFrequencyMHz;
  input.settings.echo.fractionalBandwidth = preset.fractionalBandwidth;
  input.settings.echo.aperture = preset.aperture();
  return input;
}

/// On the chest of the synthetic torso, along y.
ProbePose onTorso()
{
  ProbePose pose;
  pose.positionMm = { 230.0, 82.0, 140.0 };
  pose.axial = { 0.0, 1.0, 0.0 };
  pose.lateral = { 1.0, 0.0, 0.0 };
  return pose;
}

void picture(Simulator& simulator, const ImageInput& input)
{
  if (input.settings.geometry.isVolume())
  {
    simulator.bmode(input); // what a volume is scan-converted to is as large as its user wants
  }
  else
  {
    simulator.image(input);
  }
}

} // namespace

std::vector<GrowthAxis> growthAxes(bool quick)
{
  if (quick)
  {
    return { { "labels", "labels", { 10, 20 } },       { "volume", "10^6 voxels of one body", { 0.24, 0.48 } },
             { "lines", "scan lines", { 8, 16 } },     { "depth", "depth, cm", { 4, 8 } },
             { "elevations", "elevations", { 1, 2 } }, { "cores", "cores", { 1, 2 } } };
  }
  return { { "labels", "labels", { 10, 25, 50, 100, 200 } },
           { "volume", "10^6 voxels of one body", { 1.94, 5.73, 15.5, 45.8, 123 } },
           { "lines", "scan lines", { 64, 128, 256, 512, 1024 } },
           { "depth", "depth, cm", { 4, 7.5, 15, 30 } },
           { "elevations", "elevations", { 1, 4, 16, 64 } },
           { "cores", "cores", { 1, 2 } } };
}

GrowthCost runGrowthCase(const std::string& axis, double value, bool quick)
{
  ImageInput input = inputFor(quick);
  std::unique_ptr<tbb::global_control> limit;
  LabelVolume body;
  int labels = 40;
  if (axis == "labels")
  {
    labels = int(value);
  }
  else if (axis == "cores")
  {
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, std::size_t(value));
  }
  else if (axis == "lines")
  {
    input.settings.geometry.lineCount = int(value);
  }
  else if (axis == "elevations")
  {
    input.settings.geometry.kind = ScanKind::Matrix;
    input.settings.geometry.lineCount = quick ? 4 : 64;
    input.settings.geometry.elevationLineCount = int(value);
    input.settings.echo.aperture.elevationApertureMm = input.settings.echo.aperture.apertureMm;
    input.settings.echo.aperture.elevationIsArray = true;
  }
  else if (axis == "depth")
  {
    input.settings.geometry.depthMm = 10.0 * value;
  }
  input.settings.setDevice(axis == "gpu" ? Device::Cuda : Device::Cpu);
  input.settings.matchStages();

  GrowthCost cost;
  std::shared_ptr<const Scene> scene;
  // On a machine that only has a GPU, the torso's tissues are not where it looks for them.
  const bool isThorax = axis == "volume" || axis == "gpu";
  if (isThorax)
  {
    body = makeThoraxPhantom(axis == "gpu" ? 1.0 : std::cbrt(15.5 / value)); // 15.5 million voxels at 1 mm
    input.pose = thoraxPhantomA4C();
  }
  else
  {
    body = makeSyntheticTorso(quick ? Vec3i(64, 64, 48) : Vec3i(256, 256, 192), labels);
    input.pose = onTorso();
  }
  GrowthCost::Seconds start = now();
  scene = isThorax ? sceneOf(std::move(body)) : makeTorsoScene(std::move(body));
  cost.scene = since(start);
  Simulator simulator(scene);
  start = now();
  picture(simulator, input);
  cost.first = since(start);
  std::vector<GrowthCost::Seconds> next;
  for (int run = 0; run < (quick ? 1 : 3); ++run)
  {
    ++input.settings.tracing.seed;
    start = now();
    picture(simulator, input);
    next.push_back(since(start));
  }
  std::sort(next.begin(), next.end(), [](const auto& a, const auto& b) { return a.core < b.core; });
  cost.next = next[next.size() / 2];
  cost.peakMb = peakMegabytes();
  return cost;
}

} // namespace sono::study
