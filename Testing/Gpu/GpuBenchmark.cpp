// GpuBenchmark A4C.sonojob S1.sonojob: what the stages cost on the GPU, one `name value unit` a line. Device times are
// medians of many runs, from events; what a scene does not change is on the device already.
#include "Ceilings.h"
#include "Cuda/DeviceImager.h"
#include "JobFile.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>

namespace {

using namespace sono;

constexpr int repeats = 101;
constexpr int batchRepeats = 21;

void print(const char* name, double value, const char* unit)
{
  std::printf("%s %.6g %s\n", name, value, unit);
}

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Runs
{
  std::vector<DeviceTimes> times;
  std::vector<double> wallMs;

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

Runs runOften(const ImageJob& job, const DeviceWants& wants, int count)
{
  Runs runs;
  for (int i = 0; i < 5; ++i)
  {
    DeviceImager::instance().run(job, wants);
  }
  for (int i = 0; i < count; ++i)
  {
    DeviceTimes times;
    const auto from = std::chrono::steady_clock::now();
    DeviceImager::instance().run(job, wants, {}, &times);
    runs.wallMs.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - from).count());
    runs.times.push_back(times);
  }
  return runs;
}

double computing(const DeviceTimes& t)
{
  return t.trace + t.echo + t.bmode + t.scan;
}

/// The first images of a batch alone.
ImageJob firstImages(const ImageJob& all, int images)
{
  const std::size_t lines = std::size_t(images) * std::size_t(all.linesPerImage());
  ImageJob job = all;
  job.images = images;
  job.trace->lines.resize(lines);
  job.echo->lineCount = int(lines);
  job.echo->tissues->beams.resize(lines);
  return job;
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
void printShares(const ImageJob& job, std::uint64_t segments, double scatterers, double ms, const Ceilings& ceilings)
{
  // Sums and echoes are written and read, then IQ, envelope, grey level; of the bins the batches' sums, mean and error.
  const double sampleBytes = double(job.echo->lineCount) * job.echo->sumCount * (16.0 + 8.0 * 4.0 + 4.0 * 6.0);
  const double binBytes = 4.0 * double(job.trace->lines.size()) * job.trace->binCount * (8.0 * 2.0 + 3.0);
  const double bytesMs = (sampleBytes + binBytes) / ceilings.gigabytesPerSecond * 1e-6;
  // Counted by hand: some 17 cells of 40 operations and 64 bins of 25 a segment, 200 operations a scatterer.
  const double operations = double(segments) * (17.0 * 40.0 + 64.0 * 25.0) + scatterers * 200.0;
  const double operationsMs = operations / ceilings.teraflops * 1e-9;
  print("gpu_image_bytes_floor_ms", bytesMs, "ms");
  print("gpu_image_operations_floor_ms", operationsMs, "ms");
  print("gpu_image_share_of_bandwidth", 100.0 * bytesMs / ms, "%");
  print("gpu_image_share_of_arithmetic", 100.0 * operationsMs / ms, "%");
}

void measureImage(const JobFile& file, const Ceilings& ceilings)
{
  const ImageJob one = firstImages(file.job, 1);
  DeviceWants picture;
  picture.image = true;
  DeviceTimes first;
  DeviceWants rf;
  rf.rf = true;
  rf.traced = true;
  const DeviceResult result = DeviceImager::instance().run(one, rf, {}, &first);
  print("gpu_scene_upload_mb", double(first.uploadedBytes) * 1e-6, "MB");
  print("gpu_cpu_max_rel", rfDifference(result.iq, file.cpuIq), "of_peak");

  const Runs runs = runOften(one, picture, repeats);
  print("gpu_image_ms", runs.medianOf(computing), "ms");
  print("gpu_trace_ms", runs.medianOf([](const DeviceTimes& t) { return t.trace; }), "ms");
  print("gpu_echo_ms", runs.medianOf([](const DeviceTimes& t) { return t.echo; }), "ms");
  print("gpu_bmode_ms", runs.medianOf([](const DeviceTimes& t) { return t.bmode; }), "ms");
  print("gpu_scan_ms", runs.medianOf([](const DeviceTimes& t) { return t.scan; }), "ms");
  print("gpu_upload_ms", runs.medianOf([](const DeviceTimes& t) { return t.upload; }), "ms");
  print("gpu_download_ms", runs.medianOf([](const DeviceTimes& t) { return t.download; }), "ms");
  print("gpu_image_wall_ms", median(runs.wallMs), "ms");
  print("gpu_image_uploaded_kb", double(runs.times.back().uploadedBytes) * 1e-3, "kB");
  print("gpu_image_downloaded_kb", double(runs.times.back().downloadedBytes) * 1e-3, "kB");
  const double traceSeconds = 1e-3 * runs.medianOf([](const DeviceTimes& t) { return t.trace; });
  const double echoSeconds = 1e-3 * runs.medianOf([](const DeviceTimes& t) { return t.echo; });
  print("gpu_paths_per_s", double(one.trace->lines.size()) * one.trace->paths / traceSeconds, "1/s");
  print("gpu_segments_per_s", double(result.segments) / traceSeconds, "1/s");
  print("gpu_scatterers_per_s", file.scatterers / echoSeconds, "1/s");
  printShares(one, result.segments, file.scatterers, runs.medianOf(computing), ceilings);

  for (const int images : { 1, 2, 4, 8, 16, 32, 64 })
  {
    const Runs batch = runOften(firstImages(file.job, images), picture, batchRepeats);
    const std::string name = "gpu_batch_" + std::to_string(images);
    print((name + "_images_per_s").c_str(), 1e3 * images / batch.medianOf(computing), "1/s");
    print((name + "_wall_images_per_s").c_str(), 1e3 * images / median(batch.wallMs), "1/s");
  }
  const Runs all = runOften(file.job, picture, batchRepeats);
  print("gpu_images_per_s", 1e3 * file.job.images / all.medianOf(computing), "1/s");
}

void measureCole(const JobFile& file)
{
  DeviceWants rf;
  rf.rf = true;
  const DeviceResult result = DeviceImager::instance().run(file.job, rf);
  print("gpu_cole_cpu_max_rel", rfDifference(result.iq, file.cpuIq), "of_peak");
  const Runs runs = runOften(file.job, {}, repeats);
  const double ms = runs.medianOf([](const DeviceTimes& t) { return t.echo; });
  print("gpu_cole_ms", ms, "ms");
  print("gpu_cole_scatterers_per_s", file.scatterers / ms * 1e3, "1/s");
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 3)
  {
    std::fprintf(stderr, "usage: GpuBenchmark A4C.sonojob S1.sonojob (from WriteGpuJobs)\n");
    return 2;
  }
  try
  {
    const DeviceStatus status = cudaStatus();
    std::fprintf(stderr, "GpuBenchmark: %s\n", status.what.c_str());
    if (!status.usable)
    {
      return 1;
    }
    const Ceilings ceilings = measureCeilings();
    print("gpu_copy_gb_per_s", ceilings.gigabytesPerSecond, "GB/s");
    print("gpu_tflops", ceilings.teraflops, "TFLOP/s");
    measureImage(readJob(argv[1]), ceilings);
    measureCole(readJob(argv[2]));
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "GpuBenchmark: %s\n", error.what());
    return 1;
  }
  return 0;
}
