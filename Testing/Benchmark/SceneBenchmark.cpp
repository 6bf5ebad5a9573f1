// Time and peak memory of each step of preprocessing, by size of the volume and number of labels, whole and for what
// one fan reaches. Run with --benchmark_filter to choose; prints one row a step.
#include "Stage.h"
#include "SyntheticTorso.h"

#include <benchmark/benchmark.h>

#include <fstream>
#include <string>

namespace sono {
namespace {

/// Linux counts the peak anew from here.
void resetPeak()
{
  std::ofstream("/proc/self/clear_refs") << "5";
}

/// Largest resident memory since resetPeak, in MB of 10^6 bytes.
double peakSinceReset()
{
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
  {
    if (word == "VmHWM:")
    {
      double kibibytes = 0.0;
      status >> kibibytes;
      return kibibytes * 1024.0 / 1e6;
    }
  }
  return 0.0;
}

enum Step
{
  construct,
  labelGrid,
  surfaces,
  recordsWhole,
  recordsFan
};

const char* const stepNames[] = { "construct", "label_grid", "surfaces", "records_whole", "records_fan" };

std::size_t bakeRecords(const Scene& scene, const VoxelBox& box)
{
  const auto region = scene.regionOnDemand(box);
  region->bakeAll();
  return region->region().bytes();
}

/// Returns bytes of what the step made.
std::size_t runStep(const Scene& scene, Step step)
{
  switch (step)
  {
    case construct:
      return scene.tissueVoxels().size();
    case labelGrid:
      return scene.labelGrid().grid.bytes();
    case surfaces:
    {
      scene.buildAll();
      std::size_t bytes = 0;
      for (const LabelInfo& label : scene.volume().labels)
      {
        bytes += scene.surface(label.id).sdf.bytes();
      }
      return bytes;
    }
    case recordsWhole:
      return bakeRecords(scene, { Vec3i(0), scene.placement().size });
    default:
      return bakeRecords(scene, torsoFanBox(scene));
  }
}

void measureStep(benchmark::State& state, Vec3i size, int labelCount, Step step)
{
  const LabelVolume volume = makeSyntheticTorso(size, labelCount);
  for (auto _ : state)
  {
    LabelVolume copy = volume;
    resetPeak();
    Stopwatch watch;
    const auto scene = makeTorsoScene(std::move(copy));
    double seconds = watch.lap();
    if (step == surfaces)
    {
      scene->labelGrid(); // buildAll would count it as well
    }
    watch.lap();
    const std::size_t bytes = runStep(*scene, step);
    seconds = step == construct ? seconds : watch.lap();
    state.SetIterationTime(seconds);
    state.counters["peak_MB"] = peakSinceReset();
    state.counters["made_MB"] = double(bytes) / 1e6;
  }
}

void registerAll()
{
  for (const Vec3i size : { Vec3i(256), Vec3i(512, 512, 300) })
  {
    for (const int labelCount : { 10, 40, 100 })
    {
      for (const Step step : { construct, labelGrid, surfaces, recordsWhole, recordsFan })
      {
        const std::string name = std::to_string(size.x) + "x" + std::to_string(size.y) + "x" + std::to_string(size.z) +
                                 "/" + std::to_string(labelCount) + "_labels/" + stepNames[step];
        benchmark::RegisterBenchmark(name.c_str(), measureStep, size, labelCount, step)
          ->UseManualTime()
          ->Iterations(1)
          ->Unit(benchmark::kMillisecond);
      }
    }
  }
}

} // namespace
} // namespace sono

int main(int argc, char** argv)
{
  sono::registerAll();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
