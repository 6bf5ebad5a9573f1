// GpuBenchmark: what the stages cost on the GPU, one `name value unit` a line. Device times are medians of many runs,
// from events; what a scene does not change is on the device already.
#include "Ceilings.h"
#include "Cuda/DeviceImager.h"
#include "EchoScenes.h"
#include "PhantomScene.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Probe/ArrayField.h"
#include "Simulator.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <string>

namespace {

using namespace sono;

constexpr int repeats = 101;
constexpr int sweepRepeats = 21;

void print(const char* name, double value, const char* unit)
{
  std::printf("%s %.6g %s\n", name, value, unit);
}

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Wall time of some work, ms: the median of runs after a few that are not counted.
double medianWallMs(int count, const std::function<void()>& work)
{
  std::vector<double> ms;
  for (int i = -5; i < count; ++i)
  {
    const auto from = std::chrono::steady_clock::now();
    work();
    if (i >= 0)
    {
      ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - from).count());
    }
  }
  return median(ms);
}

struct Runs
{
  std::vector<DeviceTimes> times;

  double medianOf(const std::function<double(const DeviceTimes&)>& pick) const
  {
    std::vector<double> values;
    for (const DeviceTimes& t : times)
    {
      values.push_back(pick(t));
    }
    return median(values);
  }
};

double computing(const DeviceTimes& t)
{
  return t.trace + t.echo + t.bmode + t.scan;
}

/// The apical view, and from it a sweep: the probe tilts to and fro by 15 degrees and turns by 20.
std::vector<ProbePose> sweepOf(int count)
{
  const ProbePose start = thoraxPhantomA4C().orthonormalized();
  std::vector<ProbePose> poses;
  for (int i = 0; i < count; ++i)
  {
    const double tilt = 0.26 * std::sin(2.0 * M_PI * i / count);
    const double turn = 0.35 * i / count;
    const Vec3d elevation = glm::cross(start.axial, start.lateral);
    ProbePose pose = start;
    pose.axial = start.axial * std::cos(tilt) + elevation * std::sin(tilt);
    pose.lateral = start.lateral * std::cos(turn) + elevation * std::sin(turn);
    poses.push_back(pose.orthonormalized());
  }
  return poses;
}

/// As in ParaView, where nobody turned a knob.
ImageInput a4c()
{
  ImageInput input;
  input.pose = thoraxPhantomA4C().orthonormalized();
  input.settings.echo.aperture = ProbeSettings().aperture(); // of a P4-2
  input.settings.matchStages();
  input.settings.setDevice(Device::Cuda);
  return input;
}

/// How often a beam looks at a cell that may hold a scatterer: lines times the volume they see.
double cellVisits(const EchoSettings& echo, int lines)
{
  const double area = M_PI * 16.0 * echo.lateralSigmaMm * echo.elevationalSigmaMm;
  return double(lines) * area * echo.depthMm / std::pow(echo.scattererCellMm, 3);
}

/// Largest difference of the real RF between GPU and CPU, of its peak.
double rfDifference(const std::vector<std::complex<float>>& gpu, const std::vector<std::complex<float>>& cpu)
{
  double worst = 0.0;
  double peak = 0.0;
  for (std::size_t i = 0; i < cpu.size(); ++i)
  {
    worst = std::max(worst, double(std::abs(gpu[i] - cpu[i]))); // of the real RF, whatever the carrier's phase
    peak = std::max(peak, double(std::abs(cpu[i])));
  }
  return worst / peak;
}

/// What the stages have to move and to compute at least, as shares of what the device can do in the time they take.
void printShares(const TracedLines& traced, const RfLines& rf, double scatterers, double ms, const Ceilings& ceilings)
{
  // Sums and echoes are written and read, then IQ, envelope, grey level; of the bins the batches' sums, mean and error.
  const double sampleBytes = double(rf.lineCount) * rf.sampleCount * (16.0 + 8.0 * 4.0 + 4.0 * 6.0);
  const double binBytes = 4.0 * double(traced.lineCount) * traced.binCount * (8.0 * 2.0 + 3.0);
  const double bytesMs = (sampleBytes + binBytes) / ceilings.gigabytesPerSecond * 1e-6;
  // Counted by hand: some 17 cells of 40 operations and 64 bins of 25 a segment, 200 operations a scatterer.
  const double operations = double(traced.segments) * (17.0 * 40.0 + 64.0 * 25.0) + scatterers * 200.0;
  const double operationsMs = operations / ceilings.teraflops * 1e-9;
  print("gpu_image_bytes_floor_ms", bytesMs, "ms");
  print("gpu_image_operations_floor_ms", operationsMs, "ms");
  print("gpu_image_share_of_bandwidth", 100.0 * bytesMs / ms, "%");
  print("gpu_image_share_of_arithmetic", 100.0 * operationsMs / ms, "%");
}

void measureImage(Simulator& simulator, const Ceilings& ceilings)
{
  ImageInput input = a4c();
  const RfResult rf = simulator.rf(input);
  print("gpu_scene_upload_mb", double(DeviceImager::instance().lastTimes().uploadedBytes) * 1e-6, "MB");
  const TracedLines traced = simulator.traced(input).host();
  const auto lines = makeScanLines(input.settings.geometry, input.pose);
  const RfLines onCpu =
    formRf(*simulator.scene(), lines, trace(*simulator.scene(), lines, input.settings.tracing), input.settings.echo);
  print("gpu_cpu_max_rel", rfDifference(rf.host().iq, onCpu.iq), "of_peak");

  // Each image is another one, as of a probe that moves or of a seed that changes.
  Runs runs;
  Runs direct; // of the same without reverberation, in between
  DeviceTimes before{};
  const auto image = [&] {
    ++input.settings.tracing.seed;
    simulator.picture(simulator.image(input));
  };
  for (int i = 0; i < repeats; ++i)
  {
    input.settings.tracing.reverberation = false;
    image();
    direct.times.push_back(DeviceImager::instance().lastTimes());
    input.settings.tracing.reverberation = true;
    image();
    image();
    runs.times.push_back(DeviceImager::instance().lastTimes());
  }
  before = DeviceImager::instance().lastTimes();
  image();
  runs.times.push_back(DeviceImager::instance().lastTimes());
  const DeviceTimes last = runs.times.back();
  print("gpu_image_ms", runs.medianOf(computing), "ms");
  print("gpu_direct_image_ms", direct.medianOf(computing), "ms");
  print("gpu_reverberation_cost_ratio", runs.medianOf(computing) / direct.medianOf(computing), "times");
  print("gpu_trace_ms", runs.medianOf([](const DeviceTimes& t) { return t.trace; }), "ms");
  print("gpu_echo_ms", runs.medianOf([](const DeviceTimes& t) { return t.echo; }), "ms");
  print("gpu_bmode_ms", runs.medianOf([](const DeviceTimes& t) { return t.bmode; }), "ms");
  print("gpu_scan_ms", runs.medianOf([](const DeviceTimes& t) { return t.scan; }), "ms");
  print("gpu_image_wall_ms", medianWallMs(repeats, image), "ms");
  print("gpu_moved_image_wall_ms",
        medianWallMs(repeats,
                     [&] {
                       input.pose.positionMm.x += 1e-3; // in the same region
                       image();
                     }),
        "ms");
  print("gpu_gain_wall_ms",
        medianWallMs(repeats,
                     [&] {
                       input.settings.bmode.gainDb += 0.01;
                       simulator.picture(simulator.image(input));
                     }),
        "ms");
  print("gpu_image_uploaded_kb", double(last.uploadedBytes - before.uploadedBytes) * 1e-3, "kB");
  print("gpu_image_downloaded_kb", double(last.downloadedBytes - before.downloadedBytes) * 1e-3, "kB");
  const double traceSeconds = 1e-3 * runs.medianOf([](const DeviceTimes& t) { return t.trace; });
  const double echoSeconds = 1e-3 * runs.medianOf([](const DeviceTimes& t) { return t.echo; });
  const double scatterers = cellVisits(input.settings.echo, input.settings.geometry.lineCount);
  print("gpu_paths_per_s", double(traced.lineCount) * input.settings.tracing.pathsPerLine / traceSeconds, "1/s");
  print("gpu_segments_per_s", double(traced.segments) / traceSeconds, "1/s");
  print("gpu_scatterers_per_s", scatterers / echoSeconds, "1/s");
  printShares(traced, rf.layout(), scatterers, runs.medianOf(computing), ceilings);
}

/// The stages with the other model, and with beams that widen: medians, and the difference from the CPU.
void measureKind(Simulator& simulator, const std::string& name, ImageInput input)
{
  const auto lines = makeScanLines(input.settings.geometry, input.pose);
  const RfLines onCpu =
    formRf(*simulator.scene(), lines, trace(*simulator.scene(), lines, input.settings.tracing), input.settings.echo);
  print((name + "_cpu_max_rel").c_str(), rfDifference(simulator.rf(input).host().iq, onCpu.iq), "of_peak");
  Runs runs;
  for (int i = 0; i < repeats; ++i)
  {
    ++input.settings.tracing.seed;
    simulator.rf(input);
    runs.times.push_back(DeviceImager::instance().lastTimes());
  }
  print((name + "_trace_ms").c_str(), runs.medianOf([](const DeviceTimes& t) { return t.trace; }), "ms");
  print((name + "_echo_ms").c_str(), runs.medianOf([](const DeviceTimes& t) { return t.echo; }), "ms");
}

void measureKinds(Simulator& simulator)
{
  ImageInput input = a4c();
  input.settings.tracing.model = InterfaceModel::Amadou2024;
  measureKind(simulator, "gpu_amadou", input);
  input = a4c();
  input.settings.echo.aperture = {};
  input.settings.matchStages();
  measureKind(simulator, "gpu_one_width", input);
  ArrayAperture aperture;
  aperture.fractionalBandwidth = 0.74;
  input.settings.echo.arrayField = std::make_shared<const ArrayField>(aperture, input.settings.echo.depthMm);
  measureKind(simulator, "gpu_array", input);
}

void measureSweeps(Simulator& simulator)
{
  const ImageSettings settings = a4c().settings;
  std::vector<std::uint8_t> taken;
  const auto sink = [&](const SweptPictures& pictures) {
    const PlaneImage layout = planeImageLayout(settings.geometry, settings.pixelMm);
    const std::size_t bytes = std::size_t(layout.width) * layout.height * std::size_t(pictures.count);
    taken.resize(std::max(taken.size(), bytes));
    std::copy(pictures.grey, pictures.grey + bytes, taken.begin());
  };
  for (const int images : { 1, 4, 16, 64 })
  {
    const auto poses = sweepOf(images);
    const double ms = medianWallMs(sweepRepeats, [&] { simulator.sweep(poses, settings, false, sink); });
    print(("gpu_sweep_" + std::to_string(images) + "_wall_images_per_s").c_str(), 1e3 * images / ms, "1/s");
  }
  simulator.sweep(sweepOf(16), settings, false, sink);
  const DeviceTimes times = DeviceImager::instance().lastTimes();
  print("gpu_images_per_s", 16e3 / computing(times), "1/s");
  print("gpu_batch_trace_ms", times.trace / 16.0, "ms");
  print("gpu_batch_echo_ms", times.echo / 16.0, "ms");
}

void measureCole()
{
  test::SceneS1 s1;
  s1.settings.device = Device::Cuda;
  const auto points = std::make_shared<const PointScatterers>(s1.points);
  Simulator simulator;
  const RfLines onCpu = formRf({ nullptr, nullptr, points.get() }, s1.lines, s1.settings);
  const RfResult result = simulator.formRf(s1.lines, {}, s1.settings, points);
  print("gpu_cole_cpu_max_rel", rfDifference(result.host().iq, onCpu.iq), "of_peak");
  Runs runs;
  for (int i = 0; i < repeats; ++i)
  {
    s1.settings.scattererLevelDb += 1e-6; // of no weight for points, but asked anew
    simulator.formRf(s1.lines, {}, s1.settings, points);
    runs.times.push_back(DeviceImager::instance().lastTimes());
  }
  const double ms = runs.medianOf([](const DeviceTimes& t) { return t.echo; });
  print("gpu_cole_ms", ms, "ms");
  print("gpu_cole_scatterers_per_s", double(s1.points.size()) / ms * 1e3, "1/s");
}

} // namespace

int main()
{
  try
  {
    const DeviceStatus& status = cudaStatus();
    std::fprintf(stderr, "GpuBenchmark: %s\n", status.what.c_str());
    if (!status.usable)
    {
      return 1;
    }
    const Ceilings ceilings = measureCeilings();
    print("gpu_copy_gb_per_s", ceilings.gigabytesPerSecond, "GB/s");
    print("gpu_tflops", ceilings.teraflops, "TFLOP/s");
    Simulator simulator(makePhantomScene(makeThoraxPhantom(1.0)));
    measureImage(simulator, ceilings);
    measureKinds(simulator);
    measureSweeps(simulator);
    measureCole();
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "GpuBenchmark: %s\n", error.what());
    return 1;
  }
  return 0;
}
