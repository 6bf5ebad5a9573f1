// Run time against error: paths, samplers and threads on five scenes, and what else errs: voxels, surfaces, radial
// bins.
#include "ImageError.h"
#include "RegionSwitches.h"
#include "SamplingName.h"
#include "Study.h"

#include <tbb/global_control.h>

#include <cmath>
#include <optional>

namespace sono::study {
namespace {

const std::vector<std::string> header = { "sampler", "precision",      "threads", "paths",
                                          "seconds", "rmse_intensity", "rmse_rf", "rmse_db" };

struct Measured
{
  ImageError error{};
  double seconds = 0.0; ///< of tracing
};

Measured measure(const BenchScene& bench, const TraceSettings& tracing, const BenchImage& reference)
{
  const BenchImage image = makeBenchImage(bench, tracing);
  return { imageError(image, reference), image.traceSeconds };
}

std::vector<std::string> row(const std::string& curve, int threads, int paths, const Measured& m)
{
  return { curve,
           "single",
           number(threads),
           number(paths),
           number(m.seconds),
           number(m.error.intensity),
           number(m.error.rf),
           number(m.error.decibels) };
}

/// Error against paths by least squares in logarithms: error = factor paths^slope.
struct PowerLaw
{
  double slope = 0.0;
  double factor = 0.0;

  static PowerLaw through(const std::vector<std::pair<double, double>>& points)
  {
    double n = 0.0;
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double xy = 0.0;
    for (const auto& [paths, error] : points)
    {
      const double lx = std::log(paths);
      const double ly = std::log(std::max(error, 1e-12));
      n += 1.0;
      x += lx;
      y += ly;
      xx += lx * lx;
      xy += lx * ly;
    }
    PowerLaw law;
    law.slope = (n * xy - x * y) / (n * xx - x * x);
    law.factor = std::exp((y - law.slope * x) / n);
    return law;
  }
  double pathsFor(double error) const { return std::pow(error / factor, 1.0 / slope); }
};

/// The reference image. The stack's is a finite sum; the others' come from shared paths with another seed.
BenchImage makeReference(const BenchScene& bench, int paths)
{
  TraceSettings tracing = bench.tracing;
  tracing.sampling = Sampling::SharedPaths;
  tracing.pathsPerLine = paths;
  tracing.seed = 4711;
  BenchImage reference = makeBenchImage(bench, tracing);
  if (bench.name == "stack")
  {
    const std::vector<double> exact = stackIntensity(tracing);
    for (std::size_t i = 0; i < reference.traced.intensity.size(); ++i)
    {
      reference.traced.intensity[i] = float(exact[i % exact.size()]);
    }
  }
  return reference;
}

void measureSamplers(const BenchScene& bench, const BenchImage& reference, int mostPaths, Output& output,
                     std::vector<std::vector<std::string>>& rows)
{
  for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy, Sampling::SharedPaths })
  {
    if (bench.name == "stack" && sampling == Sampling::SharedPaths)
    {
      continue; // a mirror has no lobe to share
    }
    std::vector<std::pair<double, double>> intensity;
    std::vector<std::pair<double, double>> decibels;
    double secondsPerPath = 0.0;
    for (int paths = 1; paths <= mostPaths; paths *= 10)
    {
      TraceSettings tracing = bench.tracing;
      tracing.sampling = sampling;
      tracing.pathsPerLine = paths;
      // The whole study is to take minutes.
      if (secondsPerPath * paths > (output.quick() ? 0.3 : 15.0))
      {
        break;
      }
      const Measured two = measure(bench, tracing, reference);
      rows.push_back(row(test::nameOf(sampling), 2, paths, two));
      secondsPerPath = two.seconds / paths;
      if (paths >= 100)
      {
        intensity.emplace_back(paths, two.error.intensity);
        decibels.emplace_back(paths, two.error.decibels);
      }
      if (secondsPerPath * paths < 0.5)
      {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        rows.push_back(row(test::nameOf(sampling), 1, paths, measure(bench, tracing, reference)));
      }
    }
    if (intensity.size() < 2 || intensity.front().second == 0.0)
    {
      continue;
    }
    const std::string name = "error_" + bench.name + "_" + test::nameOf(sampling);
    const PowerLaw law = PowerLaw::through(intensity);
    output.figure(name + "_slope", law.slope, "log_error/log_paths");
    output.figure(name + "_to_1_percent_s", law.pathsFor(0.01) * secondsPerPath, "s");
    output.figure(name + "_to_1_db_s", PowerLaw::through(decibels).pathsFor(1.0) * secondsPerPath, "s");
  }
}

/// Coarser radial bins with the same paths: nothing but the bins differs.
void measureBins(const BenchScene& bench, int paths, std::vector<std::vector<std::string>>& rows)
{
  TraceSettings tracing = bench.tracing;
  tracing.sampling = Sampling::SharedPaths;
  tracing.pathsPerLine = paths;
  tracing.radialBinMm = 0.05;
  const BenchImage reference = makeBenchImage(bench, tracing);
  for (const double bin : { 0.1, 0.25, 0.5, 1.0, 2.0 })
  {
    tracing.radialBinMm = bin;
    rows.push_back(row("radial_bin_" + number(bin) + "_mm", 2, paths, measure(bench, tracing, reference)));
  }
}

/// Voxel faces instead of the smoothed surfaces, and coarser voxels, against the finest voxels.
void measureVoxels(const std::string& name, double finestMm, const std::vector<double>& spacingsMm, int paths,
                   std::vector<std::vector<std::string>>& rows)
{
  const auto settings = [&](const BenchScene& bench) {
    TraceSettings tracing = bench.tracing;
    tracing.sampling = Sampling::SharedPaths;
    tracing.pathsPerLine = paths;
    return tracing;
  };
  const BenchScene finest = makeBenchScene(name, finestMm);
  const BenchImage reference = makeBenchImage(finest, settings(finest));
  for (const double spacing : spacingsMm)
  {
    const BenchScene bench = makeBenchScene(name, spacing);
    rows.push_back(row("voxel_" + number(spacing) + "_mm", 2, paths, measure(bench, settings(bench), reference)));
    removeSurfaces(bench);
    rows.push_back(row("voxel_" + number(spacing) + "_mm_faces", 2, paths, measure(bench, settings(bench), reference)));
  }
}

/// Squared error times paths of independent sampling over that of shared paths, 1000 paths a line, several seeds, for
/// half of the image's lines.
void measureRatio(Output& output)
{
  const BenchScene bench = makeBenchScene("a4c", 0.0, output.quick() ? 16 : 64);
  const BenchImage reference = makeReference(bench, output.quick() ? 3000 : 20000);
  double squared[2] = { 0.0, 0.0 };
  double seconds[2] = { 0.0, 0.0 };
  for (const Sampling sampling : { Sampling::Independent, Sampling::SharedPaths })
  {
    const int which = sampling == Sampling::SharedPaths ? 1 : 0;
    for (int seed = 1; seed <= 6; ++seed)
    {
      TraceSettings tracing = bench.tracing;
      tracing.sampling = sampling;
      tracing.pathsPerLine = output.quick() ? 100 : 1000;
      tracing.seed = std::uint64_t(seed);
      const Measured m = measure(bench, tracing, reference);
      squared[which] += m.error.intensity * m.error.intensity;
      seconds[which] += m.seconds;
    }
  }
  output.figure("equal_rmse_path_ratio", squared[0] / squared[1], "times");
  output.figure("equal_rmse_time_ratio", squared[0] / squared[1] * seconds[0] / seconds[1], "times");
}

void measureError(Output& output)
{
  for (const std::string name : { "stack", "cyst", "rib", "a4c", "phantom" })
  {
    std::vector<std::vector<std::string>> rows;
    std::optional<BenchScene> bench = makeBenchScene(name);
    const BenchImage reference = makeReference(*bench, output.quick() ? 3000 : 60000);
    measureSamplers(*bench, reference, output.quick() ? 1000 : 1000000, output, rows);
    if (name == "a4c")
    {
      measureRatio(output);
    }
    const int paths = output.quick() ? 100 : 4000;
    if (name == "cyst" || name == "rib" || name == "a4c")
    {
      measureBins(*bench, paths, rows);
      bench.reset();
      const bool thorax = name == "a4c";
      const std::vector<double> spacings = output.quick() ? std::vector<double>{ 3.0 }
                                                          : (thorax ? std::vector<double>{ 3.0, 2.0, 1.5, 1.0 }
                                                                    : std::vector<double>{ 2.0, 1.0, 0.7, 0.5 });
      measureVoxels(name, output.quick() ? 2.0 : (thorax ? 0.7 : 0.35), spacings, paths, rows);
    }
    output.table("error_" + name + ".csv", header, rows);
  }
}

const Part part("error", measureError);

} // namespace
} // namespace sono::study
