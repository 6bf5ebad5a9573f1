#pragma once

#include "Cuda/DeviceImager.h"
#include "Cuda/DeviceLabels.cuh"
#include "Cuda/DeviceResults.cuh"

#include <array>
#include <memory>
#include <mutex>
#include <vector>

// What an imager holds, for the files that ask the device for something: its stages, and what comes back to the host.

namespace sono {

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

template<class T>
SharedSpan<T> pinnedSpan(const std::shared_ptr<void>& memory, std::size_t count)
{
  return { std::shared_ptr<const T>(memory, static_cast<const T*>(memory.get())), count };
}

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

  /// That of the layout, which is kept.
  void findMask(const PlaneScan& wanted);
};

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

} // namespace sono
