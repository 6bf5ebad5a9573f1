#include "Cuda/DeviceWork.cuh"

// What comes back to the host.

namespace sono {

namespace {

__global__ void echoesFromSums(const EchoSum* sums, std::size_t count, float perUnit, float2* echo)
{
  const std::size_t i = blockIdx.x * std::size_t(blockDim.x) + threadIdx.x;
  if (i < count)
  {
    echo[i] = { float((long long)(sums[2 * i])) * perUnit, float((long long)(sums[2 * i + 1])) * perUnit };
  }
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
    const bool stays = picture->images == 1 && picturesStay();
    const std::shared_ptr<void> bytes = stays ? managedMemory(count) : pinnedMemory(count);
    begun->picture = picture;
    begun->labels = labels;
    begun->copy.bytes = pinnedSpan<std::uint8_t>(bytes, count);
    begun->copy.mask = picture->hostMask;
    if (stays)
    {
      leaveOnDevice(picture->bytes.data(), count, bytes.get(), copyStream());
    }
    else
    {
      download(picture->bytes.data(), count, static_cast<std::uint8_t*>(bytes.get()), copyStream(), w.traffic);
    }
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

DeviceBytes DeviceImager::bytesOf(std::shared_ptr<const DevicePicture> picture, int image)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    check(await(stream), "computing");
    const std::size_t count = picture->bytes.size() / std::size_t(picture->images);
    return DeviceBytes{ picture->bytes.data() + std::size_t(image) * count, count, currentDevice(), picture, w.lane };
  });
}

DeviceBytes DeviceImager::upload(const std::vector<std::uint8_t>& bytes)
{
  return guarded([&](Work& w, cudaStream_t stream) {
    const auto memory = std::make_shared<DeviceArray<std::uint8_t>>();
    memory->upload(bytes, stream, w.traffic);
    check(await(stream), "uploading");
    return DeviceBytes{ memory->data(), bytes.size(), currentDevice(), memory, w.lane };
  });
}

void giveBackAfter(DeviceBytes bytes, std::uintptr_t stream)
{
  if (!bytes.memory)
  {
    return;
  }
  const OnLane lane(bytes.lane);
  const cudaEvent_t asked = openEvent();
  // A device that was lost fails here; its memory is gone as well.
  if (cudaEventRecord(asked, reinterpret_cast<cudaStream_t>(stream)) == cudaSuccess)
  {
    cudaStreamWaitEvent(deviceStream(), asked);
  }
  cudaEventDestroy(asked);
  bytes.memory = nullptr; // in the lane's order, if nobody else holds it
}

} // namespace sono
