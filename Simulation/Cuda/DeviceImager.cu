#include "Core/Policy.h"
#include "Cuda/DeviceWork.cuh"
#include "Cuda/HarmonicKernel.cuh"
#include "Cuda/IdleByDevice.h"
#include "Cuda/OwnImager.h"

#include <algorithm>
#include <tuple>

namespace sono {

namespace {

bool sameScan(const PlaneScan& a, const PlaneScan& b)
{
  const auto all = [](const PlaneScan& s) {
    return std::make_tuple(s.area.lastLine, s.area.firstMm, s.area.lastMm, s.width, s.height, s.pixelMm, s.lateralMinMm,
                           s.axialMinMm, s.fanCount, s.steering[0].sine);
  };
  return a.beams == b.beams && all(a) == all(b);
}

/// Imagers of threads that have ended.
IdleByDevice<DeviceImager>& idleImagers()
{
  static auto* const imagers = new IdleByDevice<DeviceImager>;
  return *imagers;
}

thread_local OwnImager* own = nullptr;

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
  if (own)
  {
    return own->imager();
  }
  // Never destroyed: at the end of a process the driver may go first.
  static auto* const first = new DeviceImager(status.devices.front(), Waiting::Busy);
  return *first;
}

OwnImager::OwnImager(int number)
  : number_(number)
{
  own = this;
}

DeviceImager& OwnImager::imager()
{
  if (!imager_)
  {
    const std::vector<int>& devices = cudaStatus().devices;
    device_ = devices[std::size_t(number_) % devices.size()];
    imager_ = idleImagers().take(device_);
    imager_ = imager_ ? imager_ : new DeviceImager(device_, Waiting::Asleep);
  }
  return *imager_;
}

void OwnImager::beginDevices()
{
  int before = 0;
  cudaGetDevice(&before);
  for (const int device : cudaStatus().devices)
  {
    cudaSetDevice(device);
    cudaFree(nullptr); // what goes wrong is told to whoever asks for something
  }
  cudaSetDevice(before);
}

OwnImager::~OwnImager()
{
  own = nullptr;
  if (imager_)
  {
    imager_->forget();
    idleImagers().give(device_, imager_);
  }
}

void DeviceImager::forget()
{
  const std::lock_guard<std::mutex> lock(work_->mutex);
  const OnLane lane(work_->lane);
  work_->forget();
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

void DeviceImager::Work::findMask(const PlaneScan& wanted)
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
