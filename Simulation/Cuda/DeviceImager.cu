#include "Cuda/DeviceImager.h"

#include "Core/Policy.h"
#include "Cuda/DeviceLabels.cuh"
#include "Cuda/DeviceResults.cuh"
#include "Cuda/HarmonicKernel.cuh"
#include "Cuda/OwnImager.h"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>

namespace sono {

namespace {

/// The device's time between two moments of a stream.
class Stopwatch
{
public:
  Stopwatch()
  {
    for (cudaEvent_t& e : event_)
    {
      check(cudaEventCreate(&e), "creating an event");
    }
  }
  void start() { check(cudaEventRecord(event_[0], deviceStream()), "timing"); }
  void stop()
  {
    check(cudaEventRecord(event_[1], deviceStream()), "timing");
    ran_ = true;
  }
  double ms() const
  {
    float ms = 0.0f;
    if (ran_)
    {
      check(cudaEventElapsedTime(&ms, event_[0], event_[1]), "timing");
    }
    return ms;
  }

private:
  std::array<cudaEvent_t, 2> event_{};
  bool ran_ = false;
};

bool sameScan(const PlaneScan& a, const PlaneScan& b)
{
  const auto all = [](const PlaneScan& s) {
    return std::make_tuple(s.area.lastLine, s.area.firstMm, s.area.lastMm, s.width, s.height, s.pixelMm, s.lateralMinMm,
                           s.axialMinMm, s.fanCount, s.steering[0].sine);
  };
  return a.beams == b.beams && all(a) == all(b);
}

__global__ void echoesFromSums(const EchoSum* sums, std::size_t count, float perUnit, float2* echo)
{
  const std::size_t i = blockIdx.x * std::size_t(blockDim.x) + threadIdx.x;
  if (i < count)
  {
    echo[i] = { float((long long)(sums[2 * i])) * perUnit, float((long long)(sums[2 * i + 1])) * perUnit };
  }
}

template<class T>
SharedSpan<T> pinnedSpan(const std::shared_ptr<void>& memory, std::size_t count)
{
  return { std::shared_ptr<const T>(memory, static_cast<const T*>(memory.get())), count };
}

} // namespace

/// Holds what is read until it has been.
class DeviceImager::Download
{
public:
  ~Download()
  {
    cudaEventSynchronize(done);
    cudaEventDestroy(done);
  }
  Download() = default;
  Download(const Download&) = delete;
  Download& operator=(const Download&) = delete;

  cudaEvent_t done = openEvent();
  PictureCopy copy;
  std::shared_ptr<const DevicePicture> picture;
  std::shared_ptr<const DeviceLabelSlice> labels;
};

struct DeviceImager::Work
{
  DeviceLane* lane = nullptr;
  std::mutex mutex;
  Traffic traffic;
  std::unique_ptr<DeviceTracer> tracer = std::make_unique<DeviceTracer>();
  std::unique_ptr<DeviceEcho> echo = std::make_unique<DeviceEcho>();
  std::unique_ptr<DeviceDisplay> display = std::make_unique<DeviceDisplay>();
  std::unique_ptr<DeviceLabels> labels = std::make_unique<DeviceLabels>();
  // The jobs whose numbers are on the device.
  std::shared_ptr<const TraceJob> traceJob;
  std::shared_ptr<const EchoJob> echoJob;
  bool hasPieces = false; ///< of that job
  std::shared_ptr<const BModeJob> bmodeJob;
  // The last layout's mask.
  PlaneScan scan{};
  std::shared_ptr<const DeviceArray<std::uint8_t>> mask;
  SharedSpan<std::uint8_t> hostMask;
  Stopwatch tracing, forming, compressing, converting;
  cudaEvent_t uploaded = nullptr; ///< the echo job
  cudaEvent_t converted = nullptr;

  void forget()
  {
    traceJob = nullptr;
    echoJob = nullptr;
    bmodeJob = nullptr;
    mask = nullptr;
    await(deviceStream());
    tracer = std::make_unique<DeviceTracer>();
    echo = std::make_unique<DeviceEcho>();
    display = std::make_unique<DeviceDisplay>();
    labels = std::make_unique<DeviceLabels>();
    await(deviceStream());
    trimDeviceMemory();
  }

  std::shared_ptr<DeviceTraced> trace(const std::shared_ptr<const TraceJob>& job, LineRange lines,
                                      const Progress& progress, cudaStream_t stream);
  /// Turns the trace of the doubled tone into that of the harmonic.
  void grow(const HarmonicJob& job, float echoSampleMm, const DeviceTraced& sent, const DeviceTraced& doubled,
            cudaStream_t stream);

  void prepare(const std::shared_ptr<const EchoJob>& job)
  {
    if (echoJob != job)
    {
      echoJob = nullptr; // stays so when the upload fails
      hasPieces = false;
      echo->prepare(*job, deviceStream(), traffic);
      check(cudaEventRecord(uploaded, deviceStream()), "uploading");
      echoJob = job;
    }
  }

  void prepare(const std::shared_ptr<const BModeJob>& job)
  {
    if (bmodeJob != job)
    {
      bmodeJob = nullptr; // stays so when the upload fails
      display->prepare(*job, deviceStream(), traffic);
      bmodeJob = job;
    }
  }

  template<class T, class U>
  std::vector<U> bring(const T* from, std::size_t count)
  {
    std::vector<U> values(count);
    download(from, count, values.data(), deviceStream(), traffic);
    return values;
  }

  void findMask(const PlaneScan& wanted)
  {
    if (mask && sameScan(scan, wanted))
    {
      return;
    }
    mask = nullptr;
    const auto made = std::make_shared<const DeviceArray<std::uint8_t>>(display->maskOf(wanted, deviceStream()));
    const std::shared_ptr<void> memory = pinnedMemory(made->size());
    download(made->data(), made->size(), static_cast<std::uint8_t*>(memory.get()), deviceStream(), traffic);
    check(await(deviceStream()), "computing");
    hostMask = pinnedSpan<std::uint8_t>(memory, made->size());
    scan = wanted;
    mask = made;
  }
};

namespace {

/// Imagers of threads that have ended, by device.
struct Idle
{
  std::mutex mutex;
  std::multimap<int, DeviceImager*> imagers;
};

Idle& idle()
{
  static auto* const made = new Idle;
  return *made;
}

thread_local DeviceImager* own = nullptr;

} // namespace

DeviceImager::DeviceImager(int device, Waiting waiting)
{
  DeviceLane* lane = openLane(device, waiting);
  const OnLane onLane(lane);
  work_ = std::make_unique<Work>();
  work_->lane = lane;
  check(cudaEventCreateWithFlags(&work_->uploaded, cudaEventDisableTiming), "creating an event");
  check(cudaEventCreateWithFlags(&work_->converted, cudaEventDisableTiming), "creating an event");
}

DeviceImager& DeviceImager::instance()
{
  const DeviceStatus& status = cudaStatus();
  if (!status.usable)
  {
    throw Error("the GPU cannot be used: " + status.what + "; choose the CPU");
  }
  // Never destroyed: at the end of a process the driver may go first.
  static auto* const first = new DeviceImager(status.devices.front(), Waiting::Busy);
  return own ? *own : *first;
}

OwnImager::OwnImager(int number)
{
  const DeviceStatus& status = cudaStatus();
  if (!status.usable)
  {
    return;
  }
  device_ = status.devices[std::size_t(number) % status.devices.size()];
  {
    const std::lock_guard<std::mutex> lock(idle().mutex);
    const auto found = idle().imagers.find(device_);
    if (found != idle().imagers.end())
    {
      imager_ = found->second;
      idle().imagers.erase(found);
    }
  }
  imager_ = imager_ ? imager_ : new DeviceImager(device_, Waiting::Asleep);
  own = imager_;
}

OwnImager::~OwnImager()
{
  if (imager_)
  {
    own = nullptr;
    imager_->forget();
    const std::lock_guard<std::mutex> lock(idle().mutex);
    idle().imagers.emplace(device_, imager_);
  }
}

void DeviceImager::forget()
{
  const std::lock_guard<std::mutex> lock(work_->mutex);
  const OnLane lane(work_->lane);
  work_->forget();
}

template<class Do>
auto DeviceImager::guarded(const Do& work)
{
  const std::lock_guard<std::mutex> lock(work_->mutex);
  const OnLane lane(work_->lane);
  try
  {
    return work(*work_, deviceStream());
  }
  catch (const Aborted&)
  {
    await(deviceStream());
    throw;
  }
  catch (...)
  {
    cudaGetLastError();
    work_->forget();
    throw;
  }
}

std::shared_ptr<DeviceTraced> DeviceImager::Work::trace(const std::shared_ptr<const TraceJob>& job, LineRange lines,
                                                        const Progress& progress, cudaStream_t stream)
{
  if (traceJob != job)
  {
    traceJob = nullptr; // stays so when the upload fails
    tracer->prepare(*job, job->linesPerImage, stream, traffic);
    traceJob = job;
  }
  tracing.start();
  tracer->run(lines.first, lines.count, progress, stream);
  tracing.stop();
  auto made = std::make_shared<DeviceTraced>();
  made->arrays = tracer->take();
  made->lineCount = lines.count;
  made->view.intensity = made->arrays.bins[intensityArray].data();
  made->view.attenuation = made->arrays.bins[attenuationArray].data();
  made->view.depthOffset = job->rangeIsTime ? made->arrays.bins[depthOffsetArray].data() : nullptr;
  made->view.reverberation =
    job->rangeIsTime && job->view.reverberates ? made->arrays.bins[reverberationArray].data() : nullptr;
  made->view.reverberationNp = made->view.reverberation ? made->arrays.bins[reverberationNpArray].data() : nullptr;
  made->view.binCount = job->binCount;
  made->view.binMm = job->binMm;
  made->view.echoSums = made->arrays.echo.data();
  made->view.echoCount = job->echoCount;
  made->view.echoPerUnit = tracer->echoPerUnit();
  return made;
}

void DeviceImager::Work::grow(const HarmonicJob& job, float echoSampleMm, const DeviceTraced& sent,
                              const DeviceTraced& doubled, cudaStream_t stream)
{
  DeviceArray<float> sources;
  DeviceArray<double2> gains;
  sources.upload(job.sourcesPerMm, stream, traffic);
  gains.upload(reinterpret_cast<const double2*>(job.gains.data()), job.gains.size(), stream, traffic);
  HarmonicLaunch launch{};
  launch.sent = sent.view.intensity;
  launch.sourcesPerMm = sources.data();
  launch.gains = gains.data();
  for (int array = 0; array < binArrayCount; ++array)
  {
    launch.doubled[array] = doubled.arrays.bins[std::size_t(array)].data();
  }
  launch.doubled[reverberationArray] = doubled.view.reverberation ? launch.doubled[reverberationArray] : nullptr;
  launch.echo = doubled.arrays.echo.data();
  launch.binCount = doubled.view.binCount;
  launch.echoCount = doubled.view.echoCount;
  launch.binMm = double(doubled.view.binMm);
  launch.echoSampleMm = double(echoSampleMm);
  constexpr int threads = 256;
  const std::size_t shared = std::size_t(launch.binCount) * (sizeof(double) + sizeof(float));
  if (shared > sharedMemoryFor(growHarmonic))
  {
    throw Error("the trace has " + std::to_string(launch.binCount) +
                " bins of depth, more than the GPU takes for a harmonic: use wider bins or the CPU");
  }
  growHarmonic<<<unsigned(doubled.lineCount), threads, shared, stream>>>(launch);
  addSegments<<<1, 1, 0, stream>>>(sent.arrays.segments.data(), doubled.arrays.segments.data());
  check(cudaGetLastError(), "computing");
}

std::shared_ptr<const DeviceTraced> DeviceImager::trace(const std::shared_ptr<const TraceJob>& job, LineRange lines,
                                                        const Progress& progress)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    return std::shared_ptr<const DeviceTraced>(w.trace(job, lines, progress, stream));
  });
}

std::shared_ptr<const DeviceTraced> DeviceImager::traceHarmonic(const std::shared_ptr<const TraceJob>& sent,
                                                                const std::shared_ptr<const TraceJob>& doubled,
                                                                const HarmonicJob& harmonic, const Progress& progress)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    const LineRange all{ 0, int(sent->lines.size()) };
    const auto ofSent = w.trace(sent, all, partOf(progress, 0.0, 0.5), stream);
    const auto ofDoubled = w.trace(doubled, all, partOf(progress, 0.5, 1.0), stream);
    w.grow(harmonic, doubled->echoSampleMm, *ofSent, *ofDoubled, stream);
    return std::shared_ptr<const DeviceTraced>(ofDoubled);
  });
}

void DeviceImager::prepare(const std::shared_ptr<const EchoJob>& job)
{
  guarded([&](Work& w, cudaStream_t) { w.prepare(job); });
}

std::shared_ptr<const DeviceRf> DeviceImager::formRf(const std::shared_ptr<const EchoJob>& job, LineRange lines,
                                                     const DeviceTraced* traced, bool wantsIq)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    w.prepare(job);
    if (!w.hasPieces)
    {
      w.echo->findPieces(*job, w.uploaded, w.traffic);
      w.hasPieces = true;
    }
    w.forming.start();
    w.echo->run(lines.first, lines.count, traced ? traced->view : w.echo->given(lines.first), wantsIq, stream);
    w.forming.stop();
    const auto made = std::make_shared<DeviceRf>();
    made->iq = w.echo->takeIq();
    made->envelope = w.echo->takeEnvelope();
    made->lineCount = lines.count;
    made->sampleCount = job->sampleCount;
    return std::shared_ptr<const DeviceRf>(made);
  });
}

std::shared_ptr<const DeviceGrey> DeviceImager::compress(const std::shared_ptr<const BModeJob>& job, const DeviceRf& rf,
                                                         int images)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    const auto made = std::make_shared<DeviceGrey>();
    made->images = images;
    made->arrays = w.display->room(images, rf.lineCount / images, rf.sampleCount);
    w.prepare(job);
    w.compressing.start();
    w.display->compress(rf.envelope.data(), 0, images, made->arrays, stream);
    w.compressing.stop();
    return std::shared_ptr<const DeviceGrey>(made);
  });
}

std::shared_ptr<const DeviceGrey> DeviceImager::compress(const std::vector<std::shared_ptr<const BModeJob>>& ofImages,
                                                         const DeviceRf& rf)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    const auto made = std::make_shared<DeviceGrey>();
    made->images = int(ofImages.size());
    made->arrays = w.display->room(made->images, rf.lineCount / made->images, rf.sampleCount);
    w.compressing.start();
    for (int image = 0; image < made->images; ++image)
    {
      w.prepare(ofImages[std::size_t(image)]);
      w.display->compress(rf.envelope.data(), image, 1, made->arrays, stream);
    }
    w.compressing.stop();
    return std::shared_ptr<const DeviceGrey>(made);
  });
}

std::shared_ptr<const DevicePicture> DeviceImager::convert(const PlaneScan& scan,
                                                           std::shared_ptr<const DeviceGrey> grey)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    w.findMask(scan);
    w.converting.start();
    const auto made = std::make_shared<DevicePicture>();
    made->bytes = w.display->convert(scan, grey->arrays.grey.data(), grey->images, stream);
    w.converting.stop();
    made->mask = w.mask;
    made->hostMask = w.hostMask;
    made->scan = scan;
    made->images = grey->images;
    made->grey = grey;
    return std::shared_ptr<const DevicePicture>(made);
  });
}

std::shared_ptr<const DeviceLabelSlice> DeviceImager::slice(const LabelJob& job, const DevicePicture& picture,
                                                            const DeviceTraced* traced)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    const auto made = std::make_shared<DeviceLabelSlice>();
    const float* offsetMm = traced ? traced->view.depthOffset : nullptr;
    made->labels =
      w.labels->slice(job, picture.scan.width, picture.scan.height, picture.mask->data(), offsetMm, stream, w.traffic);
    return std::shared_ptr<const DeviceLabelSlice>(made);
  });
}

FetchedTrace DeviceImager::fetch(const DeviceTraced& traced)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    const TracedArrays& arrays = traced.arrays;
    DeviceArray<float2> echo;
    echo.resize(arrays.echo.size() / 2);
    constexpr int threads = 256;
    if (echo.size() > 0)
    {
      echoesFromSums<<<unsigned((echo.size() + threads - 1) / threads), threads, 0, stream>>>(
        arrays.echo.data(), echo.size(), traced.view.echoPerUnit, echo.data());
      check(cudaGetLastError(), "computing");
    }
    FetchedTrace out;
    for (const DeviceArray<float>& array : arrays.bins)
    {
      out.bins.push_back(w.bring<float, float>(array.data(), array.size()));
    }
    out.boundaryEcho = w.bring<float2, std::complex<float>>(echo.data(), echo.size());
    download(arrays.segments.data(), 1, &out.segments, stream, w.traffic);
    check(await(stream), "computing");
    return out;
  });
}

FetchedArrivals DeviceImager::fetchArrivals(const DeviceTraced& traced)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    const auto& bins = traced.arrays.bins;
    FetchedArrivals out;
    std::vector<std::shared_ptr<void>> pinned;
    for (const int array : { intensityArray, depthOffsetArray })
    {
      const DeviceArray<float>& values = bins[std::size_t(array)];
      pinned.push_back(pinnedMemory(values.size() * sizeof(float)));
      download(values.data(), values.size(), static_cast<float*>(pinned.back().get()), stream, w.traffic);
    }
    check(await(stream), "computing");
    const auto valuesOf = [&](std::size_t n, int array) {
      const auto* from = static_cast<const float*>(pinned[n].get());
      return std::vector<float>(from, from + bins[std::size_t(array)].size());
    };
    out.intensity = valuesOf(0, intensityArray);
    out.depthOffsetMm = valuesOf(1, depthOffsetArray);
    return out;
  });
}

std::vector<std::complex<float>> DeviceImager::fetchIq(const DeviceRf& rf)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    auto iq = w.bring<float2, std::complex<float>>(rf.iq.data(), rf.iq.size());
    check(await(stream), "computing");
    return iq;
  });
}

std::vector<float> DeviceImager::fetch(const DeviceGrey& grey, std::vector<double>& reference)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    auto levels = w.bring<float, float>(grey.arrays.grey.data(), grey.arrays.grey.size());
    reference = w.bring<double, double>(grey.arrays.reference.data(), grey.arrays.reference.size());
    check(await(stream), "computing");
    return levels;
  });
}

std::vector<float> DeviceImager::fetchLevels(const DevicePicture& picture)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    const DeviceArray<float> levels =
      w.display->convertLevels(picture.scan, picture.grey->arrays.grey.data(), picture.images, stream);
    auto values = w.bring<float, float>(levels.data(), levels.size());
    check(await(stream), "computing");
    return values;
  });
}

SharedSpan<std::uint8_t> DeviceImager::maskOf(const DevicePicture& picture)
{
  return picture.hostMask;
}

std::shared_ptr<DeviceImager::Download> DeviceImager::beginDownload(std::shared_ptr<const DevicePicture> picture,
                                                                    std::shared_ptr<const DeviceLabelSlice> labels)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    const auto begun = std::make_shared<Download>();
    check(cudaEventRecord(w.converted, stream), "computing");
    check(cudaStreamWaitEvent(copyStream(), w.converted), "computing");
    const std::size_t count = picture->bytes.size();
    const std::shared_ptr<void> bytes = pinnedMemory(count);
    begun->picture = picture;
    begun->labels = labels;
    begun->copy.bytes = pinnedSpan<std::uint8_t>(bytes, count);
    begun->copy.mask = picture->hostMask;
    download(picture->bytes.data(), count, static_cast<std::uint8_t*>(bytes.get()), copyStream(), w.traffic);
    if (labels)
    {
      const std::shared_ptr<void> memory = pinnedMemory(count * sizeof(std::uint16_t));
      begun->copy.labels = pinnedSpan<std::uint16_t>(memory, count);
      download(labels->labels.data(), count, static_cast<std::uint16_t*>(memory.get()), copyStream(), w.traffic);
    }
    check(cudaEventRecord(begun->done, copyStream()), "computing");
    return begun;
  });
}

PictureCopy DeviceImager::wait(const std::shared_ptr<Download>& download)
{
  const cudaError_t error = await(download->done);
  guarded([&](Work&, cudaStream_t) { check(error, "computing"); });
  return download->copy;
}

int DeviceImager::imagesThatFit(double bytesPerImage)
{
  const double fitting = groupShareOfDeviceMemory * double(cudaStatus().memoryBytes) / std::max(1.0, bytesPerImage);
  return std::max(1, int(std::min(fitting, 65535.0))); // of a grid
}

DeviceTimes DeviceImager::lastTimes()
{
  return guarded([&](Work& w, cudaStream_t stream) {
    check(await(stream), "computing");
    return DeviceTimes{ w.tracing.ms(),    w.forming.ms(), w.compressing.ms(),
                        w.converting.ms(), w.traffic.up,   w.traffic.down };
  });
}

} // namespace sono
