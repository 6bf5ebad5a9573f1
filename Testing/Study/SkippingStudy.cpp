// What each skip buys: time and memory of a scene with one of them switched off at a time.
#include "Core/SoundSpeed.h"
#include "EchoSkips.h"
#include "PhantomImaging.h"
#include "RegionSwitches.h"
#include "Study.h"

#include "Kernel/TracePath.h"
#include "Trace/Deposit.h"
#include "Trace/TraceSetup.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <memory>

namespace sono {

/// A beam without limits: a path ends where its collisions or the region do.
struct EndlessBeam
{
};

inline float remainingLength(const TraceView&, const EndlessBeam&, const PathState&)
{
  return 3e38f;
}

} // namespace sono

namespace sono::study {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// Which of the tracer's own short cuts a run takes.
struct ShortCuts
{
  bool sharedStart = true; ///< what all paths of a line share is traced once
  bool limits = true;      ///< paths end where nothing of them is deposited or heard
};

/// Processor seconds since `begin`. The study of skips keeps to one thread, so they are its time, and what other
/// programs do does not count.
double secondsSince(std::clock_t begin)
{
  return double(std::clock() - begin) / CLOCKS_PER_SEC;
}

void traceLines(const TraceSetup& setup, const TraceSettings& tracing, const ShortCuts& cuts)
{
  const auto space = setup.space();
  LineTally tally(tracing.binCount(), tracing.radialBinMm, binSumsOf(tracing.model), tracing.echoCount(),
                  tracing.echoSampleMm, tracing.frequencyMHz / assumedSoundSpeedMmPerUs);
  for (std::size_t i = 0; i < setup.lines.size(); ++i)
  {
    tally.begin(setup.view, setup.lines[i], std::uint32_t(i), {});
    LineStart start = startLine(setup.view, space, setup.lines[i], tally);
    for (int path = 0; path < setup.paths && start.meets; ++path)
    {
      if (!cuts.sharedStart)
      {
        start = startLine(setup.view, space, setup.lines[i], tally);
      }
      const PathKey key{ std::uint32_t(i), 0u, std::uint32_t(path), setup.seed };
      if (cuts.limits)
      {
        tracePath(setup.view, space, setup.lines[i], start, key, tally);
      }
      else
      {
        tracePath(setup.view, space, EndlessBeam{}, start, key, tally);
      }
    }
  }
}

/// Of the scene's lines, with all records baked before.
double secondsToTrace(const BenchScene& bench, const TraceSettings& tracing, const ShortCuts& cuts)
{
  const TraceSetup setup(*bench.scene, bench.lines, tracing, bench.targets, {});
  const std::clock_t begin = std::clock();
  traceLines(setup, tracing, cuts);
  return secondsSince(begin);
}

/// Median ratio of two times measured alternately, so that the machine's moods cancel.
double medianRatio(const std::function<double()>& with, const std::function<double()>& without)
{
  std::vector<double> ratios;
  for (int i = 0; i < 5; ++i)
  {
    const double base = with();
    ratios.push_back(without() / base);
  }
  std::sort(ratios.begin(), ratios.end());
  return ratios[2];
}

double megabytes(double bytes)
{
  return bytes / 1e6;
}

std::shared_ptr<const RegionOnDemand> regionOf(const Scene& scene, const VoxelBox& box)
{
  const GridPlacement& grid = scene.placement();
  return std::make_shared<RegionOnDemand>(scene.tissueVoxels().data(), grid.size, grid.spacingMm, box);
}

double secondsToLayOut(const Scene& scene, const VoxelBox& box)
{
  const std::clock_t begin = std::clock();
  regionOf(scene, box);
  return secondsSince(begin);
}

/// What is waited for at a probe's new place: the cache is laid out, and its records are baked beforehand, or those
/// that paths meet while they run.
double secondsToFirstTrace(const BenchScene& bench, const TraceSettings& tracing, Records records)
{
  TraceSetup setup(*bench.scene, bench.lines, tracing, bench.targets, {}, Records::OnDemand);
  const std::clock_t begin = std::clock();
  setup.cells = regionOf(*bench.scene, setup.region->box);
  setup.region = { setup.cells, &setup.cells->region() };
  if (records == Records::All)
  {
    setup.cells->bakeAll();
  }
  traceLines(setup, tracing, {});
  return secondsSince(begin);
}

void measureScene(const std::string& name, bool quick, Rows& rows)
{
  const auto make = [&] { return makeBenchScene(name, quick ? 2.0 : 0.0); };
  const BenchScene bench = make();
  TraceSettings tracing = bench.tracing;
  tracing.pathsPerLine = quick ? 20 : 500;
  const auto base = [&] { return secondsToTrace(bench, tracing, {}); };
  const TraceSetup setup(*bench.scene, bench.lines, tracing, bench.targets, {});
  const TraceRegion& region = *setup.region;
  const double held = double(region.bytes());
  const auto add = [&](const std::string& skip, const std::string& what, double time, double memory) {
    rows.push_back({ name, skip, what, number(time), number(memory) });
  };

  const BenchScene unskipped = make();
  removeSkips(unskipped);
  add("cubes of one tissue", "tracing", medianRatio(base, [&] { return secondsToTrace(unskipped, tracing, {}); }), 1.0);
  add("the start of a line, traced once for all its paths", "tracing",
      medianRatio(base,
                  [&] {
                    return secondsToTrace(bench, tracing, { false, true });
                  }),
      1.0);
  add("the end of what is deposited or heard", "tracing",
      medianRatio(base,
                  [&] {
                    return secondsToTrace(bench, tracing, { true, false });
                  }),
      1.0);
  TraceSettings endless = tracing;
  endless.rouletteDb = -1000.0;
  add("roulette below -100 dB", "tracing", medianRatio(base, [&] { return secondsToTrace(bench, endless, {}); }), 1.0);

  // One record for every voxel instead of those at boundaries.
  const double dense = double(region.cell.size()) * (sizeof(region.cell[0]) + sizeof(region.record[0]));
  add("records of boundary voxels alone", "memory of the cache", 1.0, dense / held);

  const VoxelBox whole{ Vec3i(0), bench.scene->placement().size };
  const double full = double(regionOf(*bench.scene, whole)->region().bytes());
  add("what the fan cannot reach", "laying out the cache (" + number(megabytes(held)) + " MB)",
      medianRatio([&] { return secondsToLayOut(*bench.scene, region.box); },
                  [&] { return secondsToLayOut(*bench.scene, whole); }),
      full / held);
  add("records that no path meets", "cache and first trace",
      medianRatio([&] { return secondsToFirstTrace(bench, tracing, Records::OnDemand); },
                  [&] { return secondsToFirstTrace(bench, tracing, Records::All); }),
      1.0);
}

double secondsToForm(const BenchScene& bench, const TracedLines& traced, const EchoSkips& skips)
{
  const std::clock_t begin = std::clock();
  formRfBySkipping(bench, traced, skips);
  return secondsSince(begin);
}

/// The side of the scatterers, for one group of lines.
void measureEcho(const std::string& name, bool quick, Rows& rows)
{
  BenchScene bench = makeBenchScene(name, quick ? 2.0 : 0.0, 8);
  TraceSettings tracing = bench.tracing;
  tracing.pathsPerLine = 100;
  tracing.device = Device::Cpu;
  tracing.model = InterfaceModel::Amadou2024; // whose cells formRfBySkipping() walks
  const TracedLines traced = trace(*bench.scene, bench.lines, tracing, {}, bench.targets);
  const auto ratio = [&](bool EchoSkips::*skip) {
    EchoSkips without;
    without.*skip = false;
    return medianRatio([&] { return secondsToForm(bench, traced, {}); },
                       [&] { return secondsToForm(bench, traced, without); });
  };
  const auto add = [&](const std::string& skip, const std::string& what, double time, double memory) {
    rows.push_back({ name, skip, what, number(time), number(memory) });
  };
  add("bricks that two lines see, made once", "RF", ratio(&EchoSkips::madeTwice), 1.0);
  add("cells without a scatterer", "RF", ratio(&EchoSkips::absent), 1.0);
  add("depths without intensity", "RF", ratio(&EchoSkips::dark), 1.0);
  // Minutes where it is switched off: once.
  EchoSkips everywhere;
  everywhere.unseenBricks = false;
  add("bricks that no beam sees", "RF",
      quick ? 1.0 : secondsToForm(bench, traced, everywhere) / secondsToForm(bench, traced, {}), 1.0);
  const double voxels = double(bench.scene->tissueVoxels().size());
  add("scatterers made where they are seen, not stored", "memory of the scene's tissues", 1.0,
      quick ? 1.0 : 1.0 + scattererCount(bench) * 4.0 * sizeof(float) / voxels);

  const PhantomImaging imaging = phantomImaging(128);
  bench.echo.field = imaging.echo.field;
  bench.echo.depthMm = std::min(bench.echo.depthMm, imaging.echo.depthMm);
  add("faint parts of a computed field", "RF with that field", ratio(&EchoSkips::faint), 1.0);
}

void measureSkipping(Output& output)
{
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  Rows rows;
  for (const std::string name : { "stack", "cyst", "rib", "a4c", "phantom" })
  {
    measureScene(name, output.quick(), rows);
    measureEcho(name, output.quick(), rows);
  }
  output.table("skipping.csv",
               { "scene", "skip switched off", "of", "time without it (times)", "memory without it (times)" }, rows);
}

const Part part("skipping", measureSkipping);

} // namespace
} // namespace sono::study
