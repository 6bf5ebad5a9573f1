#pragma once

#include "Core/Progress.h"

#include <cuda_runtime.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace sono {

/// Throws Error with CUDA's own words when a call failed.
inline void check(cudaError_t error, const char* doing)
{
  if (error != cudaSuccess)
  {
    cudaGetLastError(); // an error that is not sticky ends here
    throw Error(std::string("the GPU failed while ") + doing + " (" + cudaGetErrorString(error) +
                "): choose the CPU, or start the program again if it goes on");
  }
}

/// Counts what crosses the bus.
struct Traffic
{
  std::uint64_t up = 0;
  std::uint64_t down = 0;
};

/// Of a block of this kernel, bytes of dynamic shared memory. Asked once a kernel.
template<class Kernel>
std::size_t sharedMemoryFor(Kernel kernel)
{
  static std::mutex mutex;
  static std::map<Kernel, std::size_t> known;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto found = known.find(kernel);
  if (found != known.end())
  {
    return found->second;
  }
  int device = 0;
  int most = 0;
  cudaFuncAttributes attributes{};
  check(cudaGetDevice(&device), "asking for its limits");
  check(cudaDeviceGetAttribute(&most, cudaDevAttrMaxSharedMemoryPerBlockOptin, device), "asking for its limits");
  check(cudaFuncGetAttributes(&attributes, kernel), "asking for its limits");
  return known[kernel] = std::size_t(most) - attributes.sharedSizeBytes;
}

/// An array on the device that only grows.
template<class T>
class DeviceArray
{
public:
  DeviceArray() = default;
  DeviceArray(const DeviceArray&) = delete;
  DeviceArray& operator=(const DeviceArray&) = delete;
  ~DeviceArray() { release(); }

  T* data() const { return data_; }
  std::size_t size() const { return size_; }

  void release()
  {
    cudaFree(data_);
    data_ = nullptr;
    capacity_ = size_ = 0;
  }

  /// Contents are lost when it grows.
  void resize(std::size_t count)
  {
    if (count > capacity_)
    {
      release();
      const std::size_t bytes = count * sizeof(T);
      void* memory = nullptr;
      const cudaError_t error = cudaMalloc(&memory, bytes);
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
      data_ = static_cast<T*>(memory);
      capacity_ = count;
    }
    size_ = count;
  }

  void upload(const T* from, std::size_t count, cudaStream_t stream, Traffic& traffic)
  {
    resize(count);
    if (count > 0)
    {
      check(cudaMemcpyAsync(data_, from, count * sizeof(T), cudaMemcpyHostToDevice, stream), "uploading");
      traffic.up += count * sizeof(T);
    }
  }
  void upload(const std::vector<T>& from, cudaStream_t stream, Traffic& traffic)
  {
    upload(from.data(), from.size(), stream, traffic);
  }

  void clear(cudaStream_t stream) { check(cudaMemsetAsync(data_, 0, size_ * sizeof(T), stream), "clearing memory"); }

private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

/// An array of the host that the device writes at the bus's full speed. Only grows.
template<class T>
class PinnedArray
{
public:
  PinnedArray() = default;
  PinnedArray(const PinnedArray&) = delete;
  PinnedArray& operator=(const PinnedArray&) = delete;
  ~PinnedArray() { release(); }

  T* data() const { return data_; }

  void release()
  {
    cudaFreeHost(data_);
    data_ = nullptr;
    capacity_ = 0;
  }

  /// Contents are lost when it grows.
  void resize(std::size_t count)
  {
    if (count > capacity_)
    {
      release();
      void* memory = nullptr;
      check(cudaMallocHost(&memory, count * sizeof(T)), "pinning memory for its results");
      data_ = static_cast<T*>(memory);
      capacity_ = count;
    }
  }

private:
  T* data_ = nullptr;
  std::size_t capacity_ = 0;
};

/// Brings `count` values back; the caller synchronises.
template<class T, class U>
void download(const T* from, std::size_t count, U* to, cudaStream_t stream, Traffic& traffic)
{
  static_assert(sizeof(T) == sizeof(U), "one value becomes one value");
  check(cudaMemcpyAsync(to, from, count * sizeof(T), cudaMemcpyDeviceToHost, stream), "downloading");
  traffic.down += count * sizeof(T);
}

template<class T, class U>
void download(const T* from, std::size_t count, std::vector<U>& to, std::size_t at, cudaStream_t stream,
              Traffic& traffic)
{
  download(from, count, to.data() + at, stream, traffic);
}

} // namespace sono
