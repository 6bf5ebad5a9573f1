#include "Cuda/DeviceMemory.cuh"

#include "Core/Policy.h"
#include "Cuda/DeviceImager.h"
#include "Cuda/GreyTexture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <map>
#include <mutex>

namespace sono {

namespace {

thread_local DeviceLane* currentLane = nullptr;

cudaStream_t openStream()
{
  cudaStream_t stream = nullptr;
  check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "opening a stream");
  return stream;
}

/// The device's, of which no lane waits for what another frees.
cudaMemPool_t openPool(int device)
{
  cudaMemPool_t pool = nullptr;
  check(cudaDeviceGetDefaultMemPool(&pool, device), "asking for its memory");
  std::uint64_t kept = keptDeviceBytes;
  check(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &kept), "setting up its memory");
  int waits = 0;
  check(cudaMemPoolSetAttribute(pool, cudaMemPoolReuseAllowInternalDependencies, &waits), "setting up its memory");
  return pool;
}

__global__ void clearWords(std::uint32_t* words, std::size_t count)
{
  const std::size_t step = std::size_t(gridDim.x) * blockDim.x;
  for (std::size_t i = std::size_t(blockIdx.x) * blockDim.x + threadIdx.x; i < count; i += step)
  {
    words[i] = 0;
  }
}

__global__ void copyBytes(const std::uint8_t* from, std::size_t count, std::uint8_t* to)
{
  const std::size_t i = std::size_t(blockIdx.x) * blockDim.x + threadIdx.x;
  if (i < count)
  {
    to[i] = from[i];
  }
}

/// Uploads go through pinned memory: from pageable memory a copy may wait for all that the device has to do before.
/// A part of the ring is used again when the device has read it.
class UploadRing
{
public:
  /// The largest upload that passes.
  static constexpr std::size_t partBytes = std::size_t(2) << 20;

  void* stage(const void* from, std::size_t bytes, cudaStream_t stream)
  {
    open();
    if (used_ + bytes > partBytes)
    {
      check(cudaEventRecord(read_[part_], stream), "uploading");
      part_ = (part_ + 1) % parts;
      check(await(read_[part_]), "uploading");
      used_ = 0;
    }
    char* at = memory_ + part_ * partBytes + used_;
    std::memcpy(at, from, bytes);
    used_ += (bytes + 255) / 256 * 256;
    return at;
  }

private:
  static constexpr int parts = 4;

  void open()
  {
    if (memory_)
    {
      return;
    }
    for (cudaEvent_t& event : read_)
    {
      event = openEvent();
    }
    void* memory = nullptr;
    check(cudaMallocHost(&memory, parts * partBytes), "pinning memory for uploads");
    memory_ = static_cast<char*>(memory);
  }

  char* memory_ = nullptr;
  std::array<cudaEvent_t, parts> read_{};
  int part_ = 0;
  std::size_t used_ = 0;
};

/// Memory that host and device read, as CUDA makes it and takes it back.
struct SharedMemory
{
  cudaError_t (*make)(void** memory, std::size_t bytes);
  cudaError_t (*unmake)(void* memory);
  const char* making;
};

/// Blocks of such memory that nobody holds any more, since making it costs more than copying.
class MemoryPool
{
public:
  explicit MemoryPool(SharedMemory kind)
    : kind_(kind)
  {
  }

  /// Sizes in steps of an eighth, so that those of another depth or sector find what is free: pinning takes the
  /// driver's lock, for which all lanes wait.
  static std::size_t roomFor(std::size_t bytes)
  {
    std::size_t step = 4096;
    while (16 * step <= bytes)
    {
      step *= 2;
    }
    return (bytes + step - 1) / step * step;
  }

  void* take(std::size_t bytes)
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const auto found = free_.find(bytes);
      if (found != free_.end())
      {
        void* memory = found->second;
        free_.erase(found);
        freeBytes_ -= bytes;
        return memory;
      }
    }
    void* memory = nullptr;
    check(kind_.make(&memory, bytes), kind_.making);
    return memory;
  }
  void give(void* memory, std::size_t bytes)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (freeBytes_ + bytes > keptPinnedBytes)
    {
      kind_.unmake(memory);
      return;
    }
    free_.emplace(bytes, memory);
    freeBytes_ += bytes;
  }

private:
  const SharedMemory kind_;
  std::mutex mutex_;
  std::multimap<std::size_t, void*> free_;
  std::size_t freeBytes_ = 0;
};

std::shared_ptr<void> fromPool(MemoryPool& pool, std::size_t wanted)
{
  const std::size_t bytes = MemoryPool::roomFor(wanted);
  return { pool.take(bytes), [bytes, &pool](void* memory) { pool.give(memory, bytes); } };
}

std::atomic<bool> staying{ false }; // see picturesStay()

} // namespace

struct DeviceLane
{
  DeviceLane(int number, Waiting howToWait)
    : device(number)
    , waiting(howToWait)
  {
    const OnLane lane(this);
    pool = openPool(device);
    compute = openStream();
    beside = openStream();
    copy = openStream();
    check(cudaEventCreateWithFlags(&earlier, cudaEventDisableTiming), "creating an event");
    asked = openEvent();
  }

  int device;
  Waiting waiting;
  cudaMemPool_t pool = nullptr;
  cudaStream_t compute = nullptr;
  cudaStream_t beside = nullptr;
  cudaStream_t copy = nullptr;
  cudaEvent_t earlier = nullptr;
  cudaEvent_t asked = nullptr; // the last that somebody waits for
  UploadRing ring;
};

DeviceLane* openLane(int device, Waiting waiting)
{
  return new DeviceLane(device, waiting);
}

OnLane::OnLane(DeviceLane* lane)
  : laneBefore_(currentLane)
{
  check(cudaGetDevice(&deviceBefore_), "choosing it");
  check(cudaSetDevice(lane->device), "choosing it");
  currentLane = lane;
}

OnLane::~OnLane()
{
  currentLane = laneBefore_;
  cudaSetDevice(deviceBefore_);
}

cudaEvent_t openEvent()
{
  cudaEvent_t event = nullptr;
  const unsigned asleep = currentLane->waiting == Waiting::Asleep ? cudaEventBlockingSync : cudaEventDefault;
  check(cudaEventCreateWithFlags(&event, cudaEventDisableTiming | asleep), "creating an event");
  return event;
}

cudaError_t await(cudaStream_t stream)
{
  if (currentLane->waiting == Waiting::Busy)
  {
    return cudaStreamSynchronize(stream);
  }
  const cudaError_t error = cudaEventRecord(currentLane->asked, stream);
  return error == cudaSuccess ? await(currentLane->asked) : error;
}

cudaError_t await(cudaEvent_t event)
{
  return cudaEventSynchronize(event);
}

cudaStream_t deviceStream()
{
  return currentLane->compute;
}

cudaStream_t besideStream()
{
  return currentLane->beside;
}

void follow(cudaStream_t later, cudaStream_t earlier)
{
  // One caller at a time, as all of an imager.
  cudaEventRecord(currentLane->earlier, earlier);
  cudaStreamWaitEvent(later, currentLane->earlier);
}

Beside::Beside(cudaStream_t stream)
  : stream_(stream)
{
  follow(besideStream(), stream_);
}

Beside::~Beside()
{
  follow(stream_, besideStream());
}

cudaStream_t copyStream()
{
  return currentLane->copy;
}

DeviceBlock allocateOnDevice(std::size_t bytes)
{
  DeviceLane& lane = *currentLane;
  void* memory = nullptr;
  cudaError_t error = cudaMallocFromPoolAsync(&memory, bytes, lane.pool, lane.compute);
  if (error == cudaErrorMemoryAllocation)
  {
    cudaGetLastError();
    await(deviceStream());
    trimDeviceMemory();
    error = cudaMallocFromPoolAsync(&memory, bytes, lane.pool, lane.compute);
  }
  if (error == cudaErrorMemoryAllocation)
  {
    cudaGetLastError();
    std::size_t free = 0;
    std::size_t total = 0;
    cudaMemGetInfo(&free, &total);
    throw Error("the GPU has no room for " + std::to_string(bytes) + " bytes (" + std::to_string(free) + " of " +
                std::to_string(total) +
                " are free): close what else uses it, take fewer lines or poses, or choose the CPU");
  }
  check(error, "allocating memory");
  return { memory, &lane };
}

void freeOnDevice(const DeviceBlock& block)
{
  if (block.memory)
  {
    const OnLane lane(block.lane);
    cudaFreeAsync(block.memory, deviceStream());
  }
}

void trimDeviceMemory()
{
  cudaMemPoolTrimTo(currentLane->pool, 0);
}

void clearOnDevice(void* memory, std::size_t bytes, cudaStream_t stream)
{
  constexpr int threads = 256;
  constexpr std::size_t mostBlocks = 1024;
  const std::size_t words = bytes / sizeof(std::uint32_t); // all that is cleared consists of such
  const auto blocks = unsigned(std::min(mostBlocks, (words + threads - 1) / threads));
  clearWords<<<blocks, threads, 0, stream>>>(static_cast<std::uint32_t*>(memory), words);
  check(cudaGetLastError(), "clearing memory");
}

void uploadBytes(void* to, const void* from, std::size_t bytes, cudaStream_t stream)
{
  if (bytes <= UploadRing::partBytes)
  {
    const void* staged = currentLane->ring.stage(from, bytes, stream);
    check(cudaMemcpyAsync(to, staged, bytes, cudaMemcpyHostToDevice, stream), "uploading");
    return;
  }
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream), "uploading");
  check(await(stream), "uploading"); // what was uploaded may go
}

// Pools are never destroyed: at the end of a process the driver may go first.

std::shared_ptr<void> pinnedMemory(std::size_t wanted)
{
  static auto* const pool =
    new MemoryPool({ [](void** memory, std::size_t bytes) { return cudaMallocHost(memory, bytes); }, cudaFreeHost,
                     "pinning memory for its results" });
  return fromPool(*pool, wanted);
}

std::shared_ptr<void> managedMemory(std::size_t wanted)
{
  static auto* const pool =
    new MemoryPool({ [](void** memory, std::size_t bytes) { return cudaMallocManaged(memory, bytes); }, cudaFree,
                     "allocating memory for its pictures" });
  return fromPool(*pool, wanted);
}

bool picturesStay()
{
  return staying && currentLane->waiting == Waiting::Busy;
}

void leaveOnDevice(const std::uint8_t* from, std::size_t bytes, void* to, cudaStream_t stream)
{
  constexpr int threads = 256;
  copyBytes<<<unsigned((bytes + threads - 1) / threads), threads, 0, stream>>>(from, bytes,
                                                                               static_cast<std::uint8_t*>(to));
  check(cudaGetLastError(), "copying");
}

void keepPicturesOnGpu()
{
  bool canAll = cudaStatus().usable;
  for (const int device : cudaStatus().devices)
  {
    int can = 0;
    canAll = canAll && cudaDeviceGetAttribute(&can, cudaDevAttrConcurrentManagedAccess, device) == cudaSuccess && can;
  }
  staying = canAll;
}

} // namespace sono
