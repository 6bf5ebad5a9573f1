#include "Cuda/DeviceMemory.cuh"

#include "Core/Policy.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <mutex>

namespace sono {

namespace {

cudaStream_t openStream()
{
  cudaStream_t stream = nullptr;
  check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "opening a stream");
  return stream;
}

cudaMemPool_t memoryPool()
{
  cudaMemPool_t pool = nullptr;
  check(cudaDeviceGetDefaultMemPool(&pool, 0), "asking for its memory");
  return pool;
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
      check(cudaEventSynchronize(read_[part_]), "uploading");
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
      check(cudaEventCreateWithFlags(&event, cudaEventDisableTiming), "creating an event");
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

/// Blocks of pinned memory that nobody holds any more, since pinning costs more than copying.
class PinnedPool
{
public:
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
    check(cudaMallocHost(&memory, bytes), "pinning memory for its results");
    return memory;
  }
  void give(void* memory, std::size_t bytes)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (freeBytes_ + bytes > keptPinnedBytes)
    {
      cudaFreeHost(memory);
      return;
    }
    free_.emplace(bytes, memory);
    freeBytes_ += bytes;
  }

private:
  std::mutex mutex_;
  std::multimap<std::size_t, void*> free_;
  std::size_t freeBytes_ = 0;
};

// Never destroyed: at the end of a process the driver may go first.
UploadRing& uploadRing()
{
  static auto* const ring = new UploadRing;
  return *ring;
}

PinnedPool& pinnedPool()
{
  static auto* const pool = new PinnedPool;
  return *pool;
}

} // namespace

cudaStream_t deviceStream()
{
  static const cudaStream_t stream = [] {
    std::uint64_t kept = keptDeviceBytes;
    check(cudaMemPoolSetAttribute(memoryPool(), cudaMemPoolAttrReleaseThreshold, &kept), "setting up its memory");
    return openStream();
  }();
  return stream;
}

cudaStream_t besideStream()
{
  static const cudaStream_t stream = openStream();
  return stream;
}

void follow(cudaStream_t later, cudaStream_t earlier)
{
  static cudaEvent_t event = nullptr; // one caller at a time, as all of the imager
  if (event || cudaEventCreateWithFlags(&event, cudaEventDisableTiming) == cudaSuccess)
  {
    cudaEventRecord(event, earlier);
    cudaStreamWaitEvent(later, event);
  }
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
  static const cudaStream_t stream = openStream();
  return stream;
}

void* allocateOnDevice(std::size_t bytes)
{
  void* memory = nullptr;
  cudaError_t error = cudaMallocAsync(&memory, bytes, deviceStream());
  if (error == cudaErrorMemoryAllocation)
  {
    cudaGetLastError();
    cudaStreamSynchronize(deviceStream());
    trimDeviceMemory();
    error = cudaMallocAsync(&memory, bytes, deviceStream());
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
  return memory;
}

void freeOnDevice(void* memory)
{
  if (memory)
  {
    cudaFreeAsync(memory, deviceStream());
  }
}

void trimDeviceMemory()
{
  cudaMemPoolTrimTo(memoryPool(), 0);
}

void uploadBytes(void* to, const void* from, std::size_t bytes, cudaStream_t stream)
{
  if (bytes <= UploadRing::partBytes)
  {
    const void* staged = uploadRing().stage(from, bytes, stream);
    check(cudaMemcpyAsync(to, staged, bytes, cudaMemcpyHostToDevice, stream), "uploading");
    return;
  }
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream), "uploading");
  check(cudaStreamSynchronize(stream), "uploading"); // what was uploaded may go
}

std::shared_ptr<void> pinnedMemory(std::size_t bytes)
{
  return { pinnedPool().take(bytes), [bytes](void* memory) { pinnedPool().give(memory, bytes); } };
}

} // namespace sono
