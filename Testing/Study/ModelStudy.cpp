// Run time against error of what a picture is made of by default, and of the model of Amadou et al. 2024, on five
// scenes: with all that reverberates, on either device.
#include "ErrorCurves.h"
#include "Study.h"

#include "Core/Device.h"

#include <tbb/global_control.h>

#include <cmath>

namespace sono::study {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// As many that windows over lines (physics page, 13.4) have most of theirs.
constexpr int modelLines = 32;
constexpr int seeds = 3;
constexpr int threads = 2;

struct Model
{
  const char* name;
  InterfaceModel model;
};

constexpr Model models[] = { { "Acoustic", InterfaceModel::Acoustic }, { "Amadou 2024", InterfaceModel::Amadou2024 } };

const std::vector<std::string> header = {
  "model", "device", "paths", "seconds", "rmse_intensity", "rmse_rf", "rmse_db"
};
const std::vector<std::string> summaryHeader = { "scene",         "model",          "device",    "slope, RF",
                                                 "slope, dB",     "s to 1 % of RF", "s to 1 dB", "s to 0.5 dB",
                                                 "paths to 1 dB", "paths to 0.5 dB" };

struct Curves
{
  std::vector<ErrorPoint> intensity, rf, decibels;
};

/// Root mean squares over seeds; seconds are of tracing, their mean.
Curves measured(const BenchScene& bench, const TraceSettings& given, const BenchReference& reference, int mostPaths)
{
  Curves curves;
  for (double paths = 10.0; paths < 1.01 * mostPaths; paths *= std::sqrt(10.0))
  {
    TraceSettings tracing = given;
    tracing.pathsPerLine = int(std::lround(paths));
    double seconds = 0.0;
    ImageError squared{};
    for (int seed = 1; seed <= seeds; ++seed)
    {
      tracing.seed = std::uint64_t(seed);
      const BenchImage image = makeBenchImage(bench, tracing, Precision::Single);
      const ImageError error = errorAgainst(reference, image);
      seconds += image.traceSeconds / seeds;
      squared.intensity += error.intensity * error.intensity / seeds;
      squared.rf += error.rf * error.rf / seeds;
      squared.decibels += error.decibels * error.decibels / seeds;
    }
    const double count = tracing.pathsPerLine;
    curves.intensity.push_back({ count, seconds, std::sqrt(squared.intensity) });
    curves.rf.push_back({ count, seconds, std::sqrt(squared.rf) });
    curves.decibels.push_back({ count, seconds, std::sqrt(squared.decibels) });
  }
  return curves;
}

/// With paths in the place of seconds.
double pathsToReach(std::vector<ErrorPoint> curve, double target)
{
  for (ErrorPoint& point : curve)
  {
    point.seconds = point.paths;
  }
  return secondsToReach(curve, target);
}

void measureScene(const std::string& name, const Model& model, bool hasGpu, Output& output, Rows& rows, Rows& summary)
{
  BenchScene bench = makeBenchScene(name, 0.0, modelLines);
  bench.tracing.model = model.model;
  bench.tracing.reverberation = model.model == InterfaceModel::Acoustic;
  bench.tracing.device = Device::Cpu;
  warmUp(bench, bench.tracing);
  const BenchReference reference = meanReference(bench, output.quick() ? 800 : 400000);
  rows.push_back({ std::string("reference of ") + model.name, "", "1", "", number(reference.floor.intensity),
                   number(reference.floor.rf), number(reference.floor.decibels) });
  for (const Device device : { Device::Cpu, Device::Cuda })
  {
    if (device == Device::Cuda && !hasGpu)
    {
      continue;
    }
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const std::string where = device == Device::Cpu ? "CPU, 2 threads" : "GPU";
    TraceSettings tracing = bench.tracing;
    tracing.device = device;
    measured(bench, tracing, reference, 10); // what a first call sets up
    const Curves curves = measured(bench, tracing, reference, output.quick() ? 100 : 31623);
    for (std::size_t i = 0; i < curves.rf.size(); ++i)
    {
      rows.push_back({ model.name, where, number(curves.rf[i].paths), number(curves.rf[i].seconds),
                       number(curves.intensity[i].error), number(curves.rf[i].error),
                       number(curves.decibels[i].error) });
    }
    summary.push_back(
      { name, model.name, where, slopeText(curves.rf, reference.floor.rf),
        slopeText(curves.decibels, reference.floor.decibels), reachedText(secondsToReach(curves.rf, 0.01)),
        reachedText(secondsToReach(curves.decibels, 1.0)), reachedText(secondsToReach(curves.decibels, 0.5)),
        reachedText(pathsToReach(curves.decibels, 1.0)), reachedText(pathsToReach(curves.decibels, 0.5)) });
  }
}

void measureModels(Output& output)
{
  const DeviceChoice choice = chooseDevice(Device::Auto);
  Rows summary;
  for (const char* name : { "stack", "cyst", "rib", "a4c", "phantom" })
  {
    Rows rows;
    for (const Model& model : models)
    {
      measureScene(name, model, choice.cuda, output, rows, summary);
    }
    output.table(std::string("error_") + name + "_models.csv", header, rows);
  }
  output.table("convergence_models.csv", summaryHeader, summary);
}

const Part part("error_models", measureModels);

} // namespace
} // namespace sono::study
