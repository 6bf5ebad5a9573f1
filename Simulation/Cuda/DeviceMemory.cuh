#pragma once

#include "Core/Progress.h"

#include <cuda_runtime.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
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

/// Number of the thread's device.
inline int currentDevice()
{
  int device = 0;
  check(cudaGetDevice(&device), "asking for its number");
  return device;
}

/// Counts what crosses the bus.
struct Traffic
{
  std::uint64_t up = 0;
  std::uint64_t down = 0;
};

/// Of a block of this kernel, the most bytes of dynamic shared memory, which it may then take. Asked once a kernel and
/// device.
template<class Kernel>
std::size_t sharedMemoryFor(Kernel kernel)
{
  static std::mutex mutex;
  static std::map<std::pair<Kernel, int>, std::size_t> known;
  int device = 0;
  check(cudaGetDevice(&device), "asking for its limits");
  const std::lock_guard<std::mutex> lock(mutex);
  const auto found = known.find({ kernel, device });
  if (found != known.end())
  {
    return found->second;
  }
  int most = 0;
  cudaFuncAttributes attributes{};
  check(cudaDeviceGetAttribute(&most, cudaDevAttrMaxSharedMemoryPerBlockOptin, device), "asking for its limits");
  check(cudaFuncGetAttributes(&attributes, kernel), "asking for its limits");
  const std::size_t bytes = std::size_t(most) - attributes.sharedSizeBytes;
  check(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, int(bytes)),
        "asking for shared memory");
  return known[{ kernel, device }] = bytes;
}

/// Whoever waits for a device keeps a core busy, which costs it the least time, or leaves it to other threads.
enum class Waiting
{
  Busy,
  Asleep
};

/// Streams, memory and uploads of a device, for one caller at a time. What is asked for in one lane waits for nothing
/// in another. A lane lives as long as the process.
struct DeviceLane;
DeviceLane* openLane(int device, Waiting waiting);

/// While it lives, the thread works in a lane, and with its device.
class OnLane
{
public:
  explicit OnLane(DeviceLane* lane);
  ~OnLane();
  OnLane(const OnLane&) = delete;
  OnLane& operator=(const OnLane&) = delete;

private:
  DeviceLane* laneBefore_;
  int deviceBefore_ = 0;
};

/// Of the thread's lane: the stream on which everything is computed, allocated and freed, in the order of the calls;
/// one for what may be computed beside it (see Beside); and one for copies to the host.
cudaStream_t deviceStream();
cudaStream_t besideStream();
cudaStream_t copyStream();

/// An event of the thread's lane, without times, for await().
cudaEvent_t openEvent();
/// Waits for all that the stream was asked for, or the event, as the lane does.
cudaError_t await(cudaStream_t stream);
cudaError_t await(cudaEvent_t event);

/// What `later` is asked for from now on waits for all that `earlier` was asked for. An error stays for the next call
/// to find.
void follow(cudaStream_t later, cudaStream_t earlier);

/// While it lives, work may be asked for beside another stream, in memory that is there already. It begins after all
/// that the other stream was asked for before, which goes on after it.
class Beside
{
public:
  explicit Beside(cudaStream_t stream);
  ~Beside();
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

private:
  cudaStream_t stream_;
};

/// Memory of a lane.
struct DeviceBlock
{
  void* memory = nullptr;
  DeviceLane* lane = nullptr;
};

/// Memory for what the thread's lane does from now on; free means when all that was asked for before is done in its
/// own. From a pool, so that both cost little. Throws Error naming the bytes when there is no room.
DeviceBlock allocateOnDevice(std::size_t bytes);
void freeOnDevice(const DeviceBlock& block);
/// Gives back what the pool of the lane's device keeps.
void trimDeviceMemory();

/// Zeros, by a kernel.
void clearOnDevice(void* memory, std::size_t bytes, cudaStream_t stream);

template<class T>
void copyOnDevice(const T* from, std::size_t count, T* to, cudaStream_t stream)
{
  if (count > 0)
  {
    check(cudaMemcpyAsync(to, from, count * sizeof(T), cudaMemcpyDeviceToDevice, stream), "copying");
  }
}

/// Uploads without waiting, unless it is much; `from` may go afterwards.
void uploadBytes(void* to, const void* from, std::size_t bytes, cudaStream_t stream);

/// Memory of the host that the device writes at the bus's full speed; from a pool.
std::shared_ptr<void> pinnedMemory(std::size_t bytes);
/// Memory whose pages lie where they were written or read last, device or host; from a pool.
std::shared_ptr<void> managedMemory(std::size_t bytes);
/// Whether keepPicturesOnGpu() was asked for, and the thread's lane is not that of a worker, whose pictures go into
/// files and tensors.
bool picturesStay();
/// A copy into managed memory by the device, where it then lies.
void leaveOnDevice(const std::uint8_t* from, std::size_t bytes, void* to, cudaStream_t stream);

/// An array on the device that only grows.
template<class T>
class DeviceArray
{
public:
  DeviceArray() = default;
  DeviceArray(DeviceArray&& other) noexcept
    : block_(std::exchange(other.block_, {}))
    , size_(std::exchange(other.size_, 0))
    , capacity_(std::exchange(other.capacity_, 0))
  {
  }
  DeviceArray& operator=(DeviceArray&& other) noexcept
  {
    std::swap(block_, other.block_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
    return *this;
  }
  ~DeviceArray() { release(); }

  T* data() const { return static_cast<T*>(block_.memory); }
  std::size_t size() const { return size_; }

  void release()
  {
    freeOnDevice(block_);
    block_ = {};
    capacity_ = size_ = 0;
  }

  /// Contents are lost when it grows.
  void resize(std::size_t count)
  {
    if (count > capacity_)
    {
      release();
      block_ = allocateOnDevice(count * sizeof(T));
      capacity_ = count;
    }
    size_ = count;
  }

  void upload(const T* from, std::size_t count, cudaStream_t stream, Traffic& traffic)
  {
    resize(count);
    if (count > 0)
    {
      uploadBytes(data(), from, count * sizeof(T), stream);
      traffic.up += count * sizeof(T);
    }
  }
  void upload(const std::vector<T>& from, cudaStream_t stream, Traffic& traffic)
  {
    upload(from.data(), from.size(), stream, traffic);
  }

  /// Keeps its contents; room for more is taken ahead.
  void grow(std::size_t count, cudaStream_t stream)
  {
    if (count > capacity_)
    {
      DeviceArray larger;
      larger.resize(2 * count);
      copyOnDevice(data(), size_, larger.data(), stream);
      *this = std::move(larger);
    }
    size_ = count;
  }

  void clear(cudaStream_t stream)
  {
    if (size_ > 0)
    {
      clearOnDevice(data(), size_ * sizeof(T), stream);
    }
  }

private:
  DeviceBlock block_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

/// Sums that begin at zero. They are cleared as soon as they have been read, beside what the device does then.
template<class T>
class ZeroedSums
{
public:
  ZeroedSums() = default;
  ~ZeroedSums() { awaitZeros(); } // before the memory goes
  ZeroedSums(const ZeroedSums&) = delete;
  ZeroedSums& operator=(const ZeroedSums&) = delete;

  T* data() const { return sums_.data(); }

  /// So many zeros, for what the stream does from now on.
  void begin(std::size_t count, cudaStream_t stream)
  {
    const bool isZero = count <= zeros_;
    stream_ = stream;
    awaitZeros();
    sums_.resize(count);
    if (!isZero)
    {
      sums_.clear(stream);
    }
  }
  /// Nothing that the stream does from now on reads them.
  void end()
  {
    if (sums_.size() > 0)
    {
      follow(besideStream(), stream_);
      sums_.clear(besideStream());
      zeros_ = sums_.size();
    }
  }

private:
  void awaitZeros()
  {
    if (zeros_ > 0)
    {
      follow(stream_, besideStream());
      zeros_ = 0;
    }
  }

  DeviceArray<T> sums_;
  cudaStream_t stream_ = nullptr; // of the last begin()
  std::size_t zeros_ = 0;         // from the first sum on
};

/// Brings `count` values back; the caller synchronises.
template<class T, class U>
void download(const T* from, std::size_t count, U* to, cudaStream_t stream, Traffic& traffic)
{
  static_assert(sizeof(T) == sizeof(U), "one value becomes one value");
  if (count > 0)
  {
    check(cudaMemcpyAsync(to, from, count * sizeof(T), cudaMemcpyDeviceToHost, stream), "downloading");
    traffic.down += count * sizeof(T);
  }
}

} // namespace sono
