// Run time against error: paths, samplers, precisions, threads and devices on five scenes, and what else errs: voxels,
// surfaces, radial bins.
#include "BeamScenes.h"
#include "ErrorCurves.h"
#include "RegionSwitches.h"
#include "SamplingName.h"
#include "Study.h"

#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numeric>
#include <thread>

namespace sono::study {
namespace {

const std::vector<std::string> header = { "sampler", "precision",      "device",  "paths",
                                          "seconds", "rmse_intensity", "rmse_rf", "rmse_db" };
const std::vector<std::string> sceneNames = { "stack", "cyst", "rib", "a4c", "phantom" };

/// Neighbouring lines of a scene: few, so that a million paths of each take seconds.
constexpr int curveLines = 4;

/// What a curve is measured with.
struct Way
{
  Sampling sampling;
  Precision precision;
  int threads; ///< 0: the GPU

  std::string sampler() const { return test::nameOf(sampling); }
  std::string precisionName() const { return precision == Precision::Double ? "double" : "single"; }
  std::string device() const
  {
    return threads == 0 ? "GPU" : "CPU, " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
  }
};

struct Measured
{
  ImageError error{};
  double seconds = 0.0; ///< of tracing
};

Measured measure(const BenchScene& bench, TraceSettings tracing, const BenchReference& reference, const Way& way)
{
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(std::max(1, way.threads)));
  tracing.sampling = way.sampling;
  tracing.device = way.threads == 0 ? Device::Cuda : Device::Cpu;
  const BenchImage image = makeBenchImage(bench, tracing, way.precision);
  return { errorAgainst(reference, image), image.traceSeconds };
}

std::vector<std::string> row(const std::string& curve, const Way& way, int paths, double seconds,
                             const ImageError& error)
{
  return { curve,           way.precisionName(),     way.device(),     number(paths),
           number(seconds), number(error.intensity), number(error.rf), number(error.decibels) };
}

/// A table that a reader sees before the plots: how fast each way converges, and when it is good enough.
const std::vector<std::string> summaryHeader = { "scene",
                                                 "sampler",
                                                 "precision",
                                                 "device",
                                                 "slope, intensity",
                                                 "slope, RF",
                                                 "slope, dB",
                                                 "s to 1 % of intensity",
                                                 "s to 1 % of RF",
                                                 "s to 1 dB",
                                                 "most paths",
                                                 "intensity there",
                                                 "RF there",
                                                 "dB there" };

std::vector<std::string> summaryRow(const std::string& scene, const Way& way,
                                    const std::array<std::vector<ErrorPoint>, 3>& curves, const ImageError& floor)
{
  return { scene,
           way.sampler(),
           way.precisionName(),
           way.device(),
           slopeText(curves[0], floor.intensity),
           slopeText(curves[1], floor.rf),
           slopeText(curves[2], floor.decibels),
           reachedText(secondsToReach(curves[0], 0.01)),
           reachedText(secondsToReach(curves[1], 0.01)),
           reachedText(secondsToReach(curves[2], 1.0)),
           number(curves[0].back().paths),
           number(curves[0].back().error),
           number(curves[1].back().error),
           number(curves[2].back().error) };
}

using Rows = std::vector<std::vector<std::string>>;

void measureCurve(const BenchScene& bench, const BenchReference& reference, const Way& way, int mostPaths,
                  Output& output, Rows& rows, Rows& summary)
{
  std::array<std::vector<ErrorPoint>, 3> curves;
  for (int paths = 1; paths <= mostPaths; paths *= 10)
  {
    TraceSettings tracing = bench.tracing;
    tracing.pathsPerLine = paths;
    const Measured m = measure(bench, tracing, reference, way);
    rows.push_back(row(way.sampler(), way, paths, m.seconds, m.error));
    curves[0].push_back({ double(paths), m.seconds, m.error.intensity });
    curves[1].push_back({ double(paths), m.seconds, m.error.rf });
    curves[2].push_back({ double(paths), m.seconds, m.error.decibels });
  }
  summary.push_back(summaryRow(bench.name, way, curves, reference.floor));
  if (way.precision == Precision::Single && (way.threads == 0 || way.threads == 2))
  {
    const std::string name = "error_" + bench.name + "_" + way.sampler() + (way.threads == 0 ? "_gpu" : "");
    const Slope slope = convergenceSlope(curves[0], reference.floor.intensity);
    output.figure(name + "_slope", slope.value, "log_error/log_paths");
    output.figure(name + "_slope_std", slope.error, "log_error/log_paths");
    output.figure(name + "_to_1_percent_s", secondsToReach(curves[0], 0.01), "s");
    output.figure(name + "_to_1_db_s", secondsToReach(curves[2], 1.0), "s");
  }
}

/// The reference, and a row for its own error.
BenchReference referenceOf(const BenchScene& bench, const Output& output, Rows& rows)
{
  const BenchReference reference = makeReference(bench, output.quick() ? 6000 : 4000000);
  rows.push_back({ "reference", "", "", "1", "", number(reference.floor.intensity), number(reference.floor.rf),
                   number(reference.floor.decibels) });
  return reference;
}

/// The CPU's curves of a scene.
void measureCurves(const BenchScene& bench, const BenchReference& reference, Output& output, Rows& rows, Rows& summary)
{
  const int mostPaths = output.quick() ? 1000 : 1000000;
  for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy })
  {
    measureCurve(bench, reference, { sampling, Precision::Single, 1 }, mostPaths, output, rows, summary);
    measureCurve(bench, reference, { sampling, Precision::Single, 2 }, mostPaths, output, rows, summary);
    measureCurve(bench, reference, { sampling, Precision::Double, 2 }, mostPaths, output, rows, summary);
  }
}

/// How what is no matter of paths is measured.
constexpr Way otherWay{ Sampling::LowDiscrepancy, Precision::Single, 2 };

TraceSettings otherSettings(const BenchScene& bench, int paths)
{
  TraceSettings tracing = bench.tracing;
  tracing.sampling = otherWay.sampling;
  tracing.pathsPerLine = paths;
  tracing.device = Device::Cpu;
  return tracing;
}

/// Coarser radial bins with the same paths: nothing but the bins differs.
void measureBins(const BenchScene& bench, int paths, Rows& rows)
{
  TraceSettings tracing = otherSettings(bench, paths);
  tracing.radialBinMm = 0.05;
  const BenchReference reference{ makeBenchImage(bench, tracing, otherWay.precision), {} };
  for (const double bin : { 0.1, 0.25, 0.5, 1.0, 2.0 })
  {
    tracing.radialBinMm = bin;
    const Measured m = measure(bench, tracing, reference, otherWay);
    rows.push_back(row("radial_bin_" + number(bin) + "_mm", otherWay, paths, m.seconds, m.error));
  }
}

/// Two images that differ by chance alone.
std::array<BenchImage, 2> twoImages(const BenchScene& bench, TraceSettings tracing)
{
  std::array<BenchImage, 2> images;
  for (BenchImage& image : images)
  {
    image = makeBenchImage(bench, tracing, otherWay.precision);
    ++tracing.seed;
  }
  return images;
}

/// Voxel faces instead of the smoothed surfaces, and coarser voxels, against the finest voxels.
void measureVoxels(const std::string& name, double finestMm, const std::vector<double>& spacingsMm, int paths,
                   Rows& rows)
{
  const BenchScene finest = makeBenchScene(name, finestMm);
  const std::array<BenchImage, 2> references = twoImages(finest, otherSettings(finest, paths));
  const auto add = [&](const std::string& what, const BenchScene& bench) {
    const std::array<BenchImage, 2> images = twoImages(bench, otherSettings(bench, paths));
    rows.push_back(row(what, otherWay, paths, images[0].traceSeconds, errorWithoutNoise(images, references)));
  };
  for (const double spacing : spacingsMm)
  {
    const BenchScene bench = makeBenchScene(name, spacing);
    warmUp(bench, bench.tracing);
    add("voxel_" + number(spacing) + "_mm", bench);
    removeSurfaces(bench);
    add("voxel_" + number(spacing) + "_mm_faces", bench);
  }
}

/// Every so many samples of each line.
BenchImage decimated(const BenchImage& fine, int every)
{
  BenchImage out = fine;
  out.iq.clear();
  const std::size_t samples = fine.iq.size() / std::size_t(fine.lineCount);
  for (std::size_t line = 0; line < std::size_t(fine.lineCount); ++line)
  {
    for (std::size_t s = 0; s < samples; s += std::size_t(every))
    {
      out.iq.push_back(fine.iq[line * samples + s]);
    }
  }
  return out;
}

/// As loud as another, since a gain is free.
BenchImage levelled(BenchImage image, const BenchImage& other)
{
  const auto energy = [](const BenchImage& of) {
    return std::accumulate(of.iq.begin(), of.iq.end(), 0.0,
                           [](double sum, const std::complex<double>& v) { return sum + std::norm(v); });
  };
  const double factor = std::sqrt(energy(other) / energy(image));
  for (std::complex<double>& v : image.iq)
  {
    v *= factor;
  }
  return image;
}

/// What forming echoes errs by, with the same paths: samples of RF, the beam's Gaussians instead of the computed field,
/// a pulse whose band is a tenth wider, and, as the measure of what only changes the speckle, other scatterers.
void measureEcho(int paths, Rows& rows)
{
  BenchScene bench = makeBenchScene("a4c");
  bench.echo = test::echoOf(test::p42(), bench.tracing.depthMm);
  bench.tracing.frequencyMHz = bench.echo.centreFrequencyMHz;
  bench.tracing.aperture = bench.echo.aperture;
  warmUp(bench, bench.tracing);
  const auto imageOf = [&](const EchoSettings& echo) {
    BenchScene formed = bench;
    formed.echo = echo;
    TraceSettings tracing = otherSettings(bench, paths);
    tracing.echoSampleMm = echo.sampleMm();
    return makeBenchImage(formed, tracing, otherWay.precision);
  };
  const auto add = [&](const std::string& what, const BenchImage& image, const BenchImage& reference) {
    rows.push_back(row(what, otherWay, paths, image.traceSeconds, imageError(image, reference)));
  };
  EchoSettings echo = bench.echo;
  const BenchImage usual = imageOf(echo);
  {
    EchoSettings fine = echo;
    fine.samplingMHz = 4.0 * echo.samplingMHz;
    const BenchImage reference = imageOf(fine);
    add("rf_" + number(echo.samplingMHz) + "_MHz", usual, decimated(reference, 4));
    EchoSettings coarse = echo;
    coarse.samplingMHz = 0.4 * echo.samplingMHz;
    add("rf_" + number(coarse.samplingMHz) + "_MHz", imageOf(coarse), decimated(reference, 10));
  }
  EchoSettings other = echo;
  other.beam = BeamForm::Computed;
  const BenchImage computed = imageOf(other);
  add("beam_gaussians", levelled(usual, computed), computed);
  other = echo;
  other.fractionalBandwidth *= 1.1;
  add("pulse_band_a_tenth_wider", imageOf(other), usual);
  other = echo;
  ++other.seed;
  add("other_scatterers", imageOf(other), usual);
}

/// Squared error of I times paths of independent sampling over that of low discrepancy, and the same times time: 1000
/// paths a line, eight seeds, 16 neighbouring lines, against 400 times as many paths; with all that reverberates or
/// without.
void measureRatio(const std::string& scene, bool reverberates, const std::string& figureEnd, Output& output)
{
  const BenchScene bench = makeBenchScene(scene);
  TraceSettings tracing = bench.tracing;
  tracing.device = Device::Cpu;
  tracing.reverberation = reverberates;
  const int paths = output.quick() ? 100 : 1000;
  tracing.pathsPerLine = 400 * paths;
  tracing.seed = 1001;
  const BenchImage reference = makeBenchImage(bench, tracing, Precision::Single);
  tracing.pathsPerLine = paths;
  double squared[2] = { 0.0, 0.0 };
  double seconds[2] = { 0.0, 0.0 };
  for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy })
  {
    const int which = sampling == Sampling::LowDiscrepancy ? 1 : 0;
    tracing.sampling = sampling;
    for (int seed = 1; seed <= 8; ++seed)
    {
      tracing.seed = std::uint64_t(seed);
      const BenchImage image = makeBenchImage(bench, tracing, Precision::Single);
      seconds[which] += image.traceSeconds;
      squared[which] += std::pow(intensityError(image, reference), 2);
    }
  }
  output.figure("equal_rmse_path_ratio" + figureEnd, squared[0] / squared[1], "times");
  output.figure("equal_rmse_time_ratio" + figureEnd, squared[0] / squared[1] * seconds[0] / seconds[1], "times");
}

/// What is not a matter of paths, of the scenes that have surfaces.
void measureOtherErrors(const std::string& name, Output& output, Rows& rows)
{
  const int paths = output.quick() ? 100 : 4000;
  measureBins(makeBenchScene(name), paths, rows);
  if (name == "a4c")
  {
    measureEcho(paths, rows);
  }
  if (output.quick())
  {
    measureVoxels(name, 2.0, { 4.0 }, paths, rows);
  }
  else if (name == "a4c")
  {
    measureVoxels(name, 0.5, { 3.0, 2.0, 1.5, 1.0 }, paths, rows);
  }
  else
  {
    // The rib's layers lie at 2, 8 and 22 mm: voxels that do not divide them would move its faces.
    measureVoxels(name, 0.25, { 2.0, 1.0, 0.5 }, paths, rows);
  }
}

void measureError(Output& output)
{
  Rows summary;
  for (const std::string& name : sceneNames)
  {
    Rows rows;
    {
      const BenchScene bench = makeBenchScene(name, 0.0, curveLines);
      warmUp(bench, bench.tracing);
      measureCurves(bench, referenceOf(bench, output, rows), output, rows, summary);
    }
    measureRatio(name, true, "_" + name, output);
    if (name == "a4c")
    {
      measureRatio(name, false, "", output);
    }
    if (name == "cyst" || name == "rib" || name == "a4c")
    {
      measureOtherErrors(name, output, rows);
    }
    output.table("error_" + name + ".csv", header, rows);
  }
  output.table("convergence.csv", summaryHeader, summary);
}

/// The GPU's curves, where there is one, beside those of all the machine's processors.
void measureErrorOnGpu(Output& output)
{
  const DeviceChoice choice = chooseDevice(Device::Auto);
  if (!choice.cuda)
  {
    std::fprintf(stderr, "study error_gpu: %s\n", choice.note.c_str());
    return;
  }
  const int threads = int(std::thread::hardware_concurrency());
  const int mostPaths = output.quick() ? 1000 : 1000000;
  Rows summary;
  for (const std::string& name : sceneNames)
  {
    Rows rows;
    const BenchScene bench = makeBenchScene(name, 0.0, curveLines);
    const BenchReference reference = referenceOf(bench, output, rows);
    for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy })
    {
      TraceSettings warm = bench.tracing;
      warm.pathsPerLine = 1;
      measure(bench, warm, reference, { sampling, Precision::Single, 0 });
      measureCurve(bench, reference, { sampling, Precision::Single, 0 }, mostPaths, output, rows, summary);
      measureCurve(bench, reference, { sampling, Precision::Single, threads }, mostPaths, output, rows, summary);
    }
    output.table("error_" + name + "_gpu.csv", header, rows);
  }
  output.table("convergence_gpu.csv", summaryHeader, summary);
}

const Part part("error", measureError);
const Part gpuPart("error_gpu", measureErrorOnGpu);

} // namespace
} // namespace sono::study
