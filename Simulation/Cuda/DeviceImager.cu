#include "Cuda/DeviceImager.h"

#include "Cuda/CopyImages.h"
#include "Cuda/DeviceDisplay.cuh"
#include "Cuda/DeviceEcho.cuh"
#include "Cuda/DeviceTracer.cuh"

#include <algorithm>
#include <array>
#include <future>
#include <mutex>

namespace sono {

namespace {

/// Images that go through the stages together where pictures are wanted: enough to fill a GPU, and few enough that the
/// host copies those of one group while the next is computed.
constexpr int picturesTogether = 16;

/// Moments of a run on the device.
class StageClock
{
public:
  enum Mark
  {
    Start,
    Uploaded,
    Traced,
    Formed,
    Compressed,
    Converted,
    Downloaded,
    Marks
  };

  StageClock()
  {
    for (cudaEvent_t& e : event_)
    {
      check(cudaEventCreate(&e), "creating an event");
    }
  }
  ~StageClock()
  {
    for (cudaEvent_t e : event_)
    {
      cudaEventDestroy(e);
    }
  }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

  void mark(Mark m, cudaStream_t stream) { check(cudaEventRecord(event_[m], stream), "timing"); }
  double between(Mark a, Mark b) const
  {
    float ms = 0.0f;
    check(cudaEventElapsedTime(&ms, event_[a], event_[b]), "timing");
    return ms;
  }

private:
  std::array<cudaEvent_t, Marks> event_{};
};

/// Bytes that the stages need for an image, without what a single launch of the tracer needs.
double bytesPerImage(const ImageJob& job)
{
  double bytesPerLine = 0.0;
  if (job.trace)
  {
    bytesPerLine += 16.0 * job.trace->echoCount + 12.0 * job.trace->binCount;
  }
  if (job.echo)
  {
    bytesPerLine += 24.0 * job.echo->sumCount;
  }
  return bytesPerLine * job.linesPerImage() + (job.scan ? 4.0 * job.scan->width * job.scan->height : 0.0);
}

/// Works on the first device, whichever the caller's thread works on.
class FirstDevice
{
public:
  FirstDevice()
  {
    check(cudaGetDevice(&before_), "choosing it");
    check(cudaSetDevice(0), "choosing it");
  }
  ~FirstDevice() { cudaSetDevice(before_); }
  FirstDevice(const FirstDevice&) = delete;
  FirstDevice& operator=(const FirstDevice&) = delete;

private:
  int before_ = 0;
};

/// Lets what the device writes to outlive its writing, when an exception comes between.
class WaitAtEnd
{
public:
  explicit WaitAtEnd(cudaStream_t stream)
    : stream_(stream)
  {
  }
  ~WaitAtEnd() { cudaStreamSynchronize(stream_); }
  WaitAtEnd(const WaitAtEnd&) = delete;
  WaitAtEnd& operator=(const WaitAtEnd&) = delete;

private:
  cudaStream_t stream_;
};

} // namespace

struct DeviceImager::Work
{
  std::mutex mutex;
  cudaStream_t stream = nullptr;
  std::unique_ptr<DeviceTracer> tracer = std::make_unique<DeviceTracer>();
  std::unique_ptr<DeviceEcho> echo = std::make_unique<DeviceEcho>();
  std::unique_ptr<DeviceDisplay> display = std::make_unique<DeviceDisplay>();
  std::unique_ptr<StageClock> clock;
  std::array<PinnedArray<float>, 2> pictures; ///< in turn: one is filled while the other is copied

  void forget()
  {
    tracer = std::make_unique<DeviceTracer>();
    echo = std::make_unique<DeviceEcho>();
    display = std::make_unique<DeviceDisplay>();
    for (PinnedArray<float>& picture : pictures)
    {
      picture.release();
    }
  }

  /// Images that go through the stages together: at most what fits in a quarter of the device's memory.
  int imagesAtOnce(const ImageJob& job, const DeviceWants& wants) const
  {
    const double total = double(cudaStatus().memoryBytes);
    const double fitting = std::min(0.25 * total / std::max(1.0, bytesPerImage(job)), 65535.0); // of a grid
    const int together = wants.image ? std::min(job.images, picturesTogether) : job.images;
    return std::max(1, std::min(together, int(fitting)));
  }

  void upload(const ImageJob& job, Traffic& traffic)
  {
    if (job.trace)
    {
      tracer->prepare(*job.trace, job.linesPerImage(), stream, traffic);
    }
    if (job.echo)
    {
      echo->prepare(*job.echo, stream, traffic);
    }
    if (job.bmode)
    {
      display->prepare(job, stream, traffic);
    }
    check(cudaStreamSynchronize(stream), "uploading"); // what was uploaded may go
  }

  TracedOnDevice traced(const ImageJob& job, int firstLine) const
  {
    if (!job.trace)
    {
      return echo->given(firstLine);
    }
    TracedOnDevice t;
    t.intensity = tracer->intensity();
    t.binCount = tracer->binCount();
    t.binMm = tracer->binMm();
    t.echoSums = tracer->echo();
    t.echoCount = tracer->echoCount();
    t.echoPerUnit = tracer->echoPerUnit();
    return t;
  }

  void allocateResult(const ImageJob& job, const DeviceWants& wants, DeviceResult& result) const
  {
    const std::size_t lines = std::size_t(job.lineCount());
    if (wants.traced)
    {
      result.intensity.resize(lines * job.trace->binCount);
      result.standardError.resize(result.intensity.size());
      result.boundaryEcho.resize(lines * job.trace->echoCount);
    }
    if (wants.rf)
    {
      result.iq.resize(lines * job.echo->sampleCount);
    }
    if (wants.bmode)
    {
      result.grey.resize(lines * job.echo->sampleCount);
    }
    if (job.bmode)
    {
      result.referenceAmplitude.resize(std::size_t(job.images));
    }
    if (wants.image)
    {
      result.pixels.resize(std::size_t(job.images));
      result.mask.resize(std::size_t(job.scan->width) * job.scan->height);
    }
  }

  /// Brings back what is wanted of the images that were just made.
  void bringBack(const ImageJob& job, const DeviceWants& wants, int firstImage, int images, PinnedArray<float>& picture,
                 DeviceResult& result, Traffic& traffic)
  {
    const std::size_t firstLine = std::size_t(firstImage) * job.linesPerImage();
    const std::size_t lines = std::size_t(images) * job.linesPerImage();
    std::vector<EchoSum> sums;
    const WaitAtEnd wait(stream);
    if (wants.traced)
    {
      const std::size_t bins = std::size_t(job.trace->binCount);
      download(tracer->intensity(), lines * bins, result.intensity, firstLine * bins, stream, traffic);
      download(tracer->standardError(), lines * bins, result.standardError, firstLine * bins, stream, traffic);
      sums.resize(2 * lines * job.trace->echoCount);
      download(tracer->echo(), sums.size(), sums, 0, stream, traffic);
    }
    if (wants.rf)
    {
      const std::size_t samples = std::size_t(job.echo->sampleCount);
      download(echo->iq(), lines * samples, result.iq, firstLine * samples, stream, traffic);
    }
    if (wants.bmode)
    {
      const std::size_t samples = std::size_t(job.echo->sampleCount);
      download(display->grey(), lines * samples, result.grey, firstLine * samples, stream, traffic);
    }
    if (job.bmode)
    {
      download(display->reference(), std::size_t(images), result.referenceAmplitude, std::size_t(firstImage), stream,
               traffic);
    }
    if (wants.image)
    {
      const std::size_t pixels = std::size_t(job.scan->width) * job.scan->height;
      picture.resize(images * pixels);
      download(display->pixels(), images * pixels, picture.data(), stream, traffic);
      if (firstImage == 0)
      {
        download(display->mask(), pixels, result.mask, 0, stream, traffic);
      }
    }
    check(cudaStreamSynchronize(stream), "computing");
    const float perUnit = tracer->echoPerUnit();
    for (std::size_t i = 0; i + 1 < sums.size(); i += 2)
    {
      result.boundaryEcho[firstLine * job.trace->echoCount + i / 2] = { float(std::int64_t(sums[i])) * perUnit,
                                                                        float(std::int64_t(sums[i + 1])) * perUnit };
    }
  }

  DeviceResult run(const ImageJob& job, const DeviceWants& wants, const Progress& progress, DeviceTimes* times)
  {
    Traffic traffic;
    DeviceResult result;
    DeviceTimes sum;
    allocateResult(job, wants, result);
    const WaitAtEnd wait(stream);
    std::array<std::future<void>, 2> copying; // into the result, which outlives them
    clock->mark(StageClock::Start, stream);
    upload(job, traffic);
    clock->mark(StageClock::Uploaded, stream);
    const int atOnce = imagesAtOnce(job, wants);
    int group = 0;
    for (int image = 0; image < job.images; image += atOnce)
    {
      const int images = std::min(atOnce, job.images - image);
      const int firstLine = image * job.linesPerImage();
      const int lines = images * job.linesPerImage();
      if (image > 0)
      {
        clock->mark(StageClock::Uploaded, stream);
      }
      if (job.trace)
      {
        const double share = double(images) / job.images;
        const double before = double(image) / job.images;
        tracer->run(firstLine, lines, partOf(progress, before, before + share), stream);
      }
      clock->mark(StageClock::Traced, stream);
      if (job.echo)
      {
        echo->run(firstLine, lines, traced(job, firstLine), wants.rf, stream);
      }
      clock->mark(StageClock::Formed, stream);
      if (job.bmode)
      {
        display->compress(echo->envelope(), images, stream);
      }
      clock->mark(StageClock::Compressed, stream);
      if (job.scan)
      {
        display->convert(images, stream);
      }
      clock->mark(StageClock::Converted, stream);
      PinnedArray<float>& picture = pictures[group % 2];
      std::future<void>& copied = copying[group % 2];
      if (copied.valid())
      {
        copied.get(); // what it held may go
      }
      bringBack(job, wants, image, images, picture, result, traffic);
      clock->mark(StageClock::Downloaded, stream);
      check(cudaStreamSynchronize(stream), "computing");
      if (wants.image)
      {
        const std::size_t pixels = std::size_t(job.scan->width) * job.scan->height;
        copied = std::async(std::launch::async, [from = picture.data(), pixels, to = &result.pixels[image], images] {
          copyImages(from, pixels, to, images);
        });
      }
      ++group;
      sum.upload += image == 0 ? clock->between(StageClock::Start, StageClock::Uploaded) : 0.0;
      sum.trace += clock->between(StageClock::Uploaded, StageClock::Traced);
      sum.echo += clock->between(StageClock::Traced, StageClock::Formed);
      sum.bmode += clock->between(StageClock::Formed, StageClock::Compressed);
      sum.scan += clock->between(StageClock::Compressed, StageClock::Converted);
      sum.download += clock->between(StageClock::Converted, StageClock::Downloaded);
      report(progress, double(image + images) / job.images);
    }
    if (job.trace)
    {
      check(cudaMemcpy(&result.segments, tracer->segments(), sizeof result.segments, cudaMemcpyDeviceToHost),
            "downloading");
    }
    for (std::future<void>& copied : copying)
    {
      if (copied.valid())
      {
        copied.get();
      }
    }
    sum.uploadedBytes = traffic.up;
    sum.downloadedBytes = traffic.down;
    if (times)
    {
      *times = sum;
    }
    return result;
  }
};

namespace {

DeviceStatus askForStatus()
{
  int count = 0;
  const cudaError_t error = cudaGetDeviceCount(&count);
  if (error != cudaSuccess || count == 0)
  {
    cudaGetLastError();
    return { false, error == cudaErrorInsufficientDriver || error == cudaErrorNoDevice || count == 0
                      ? "no NVIDIA GPU with a driver for CUDA " + std::to_string(CUDART_VERSION / 1000) + " was found"
                      : std::string("the GPU does not answer (") + cudaGetErrorString(error) + ")" };
  }
  cudaDeviceProp properties{};
  if (cudaGetDeviceProperties(&properties, 0) != cudaSuccess)
  {
    cudaGetLastError();
    return { false, "the GPU does not say what it is" };
  }
  if (properties.major * 10 + properties.minor < 75)
  {
    return { false, std::string("the ") + properties.name + " is older than CUDA " +
                      std::to_string(CUDART_VERSION / 1000) + " serves" };
  }
  return { true, std::string(properties.name) + ", " + std::to_string(properties.totalGlobalMem >> 20) + " MiB",
           properties.totalGlobalMem };
}

} // namespace

const DeviceStatus& cudaStatus()
{
  static const DeviceStatus status = askForStatus();
  return status;
}

DeviceImager::DeviceImager()
  : work_(std::make_unique<Work>())
{
  const DeviceStatus status = cudaStatus();
  if (!status.usable)
  {
    throw Error("the GPU cannot be used: " + status.what + "; choose the CPU");
  }
  const FirstDevice device;
  check(cudaStreamCreateWithFlags(&work_->stream, cudaStreamNonBlocking), "opening a stream");
  work_->clock = std::make_unique<StageClock>();
}

DeviceImager::~DeviceImager() = default;

DeviceImager& DeviceImager::instance()
{
  // Never destroyed: at the end of a process the driver may go first.
  static auto* imager = new DeviceImager;
  return *imager;
}

DeviceResult DeviceImager::run(const ImageJob& job, const DeviceWants& wants, const Progress& progress,
                               DeviceTimes* times)
{
  const std::lock_guard<std::mutex> lock(work_->mutex);
  const FirstDevice device;
  try
  {
    return work_->run(job, wants, progress, times);
  }
  catch (const Aborted&)
  {
    cudaStreamSynchronize(work_->stream);
    throw;
  }
  catch (...)
  {
    cudaStreamSynchronize(work_->stream);
    cudaGetLastError();
    work_->forget();
    throw;
  }
}

} // namespace sono
