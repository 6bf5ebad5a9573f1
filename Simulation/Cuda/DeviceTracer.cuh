#pragma once

#include "Cuda/DeviceMemory.cuh"
#include "Cuda/ImageJob.h"
#include "Kernel/TracePath.h"
#include "Trace/TracedBin.h"
#include "Trace/TracedReverberation.h"

#include <array>

namespace sono {

/// Boundary echoes are summed as integers, whose sum does not depend on the order: amplitude * scale.
using EchoSum = unsigned long long;

/// What tracing leaves on the device.
struct TracedArrays
{
  std::array<DeviceArray<float>, binArrayCount> bins; ///< of each BinArray: lines x bins
  DeviceArray<EchoSum> echo;                          ///< lines x echoCount x (re, im)
  DeviceArray<std::uint64_t> segments;
};

/// Traces lines on the device. Kept between jobs: the region's cells and records.
class DeviceTracer
{
public:
  /// Uploads what is new. `linesPerImage` restarts the numbering of the random streams.
  void prepare(const TraceJob& job, int linesPerImage, cudaStream_t stream, Traffic& traffic);
  /// Traces the lines [first, first + count) of the job; the results below are theirs until the next call.
  void run(int first, int count, const Progress& progress, cudaStream_t stream);

  /// Hands over what run() has just made.
  TracedArrays take() { return { std::move(arrays_), std::move(echo_), std::move(segments_) }; }
  float echoPerUnit() const { return echoPerUnit_; } ///< turns an EchoSum into an amplitude
  int binCount() const { return binCount_; }
  int echoCount() const { return echoCount_; }
  float binMm() const { return binMm_; }

private:
  std::shared_ptr<const TraceRegion> region_;
  int bakedBlocks_ = 0; // of its records
  RowCells cells_;
  DeviceArray<std::uint16_t> words_;
  DeviceArray<std::uint32_t> firstRecord_;
  DeviceArray<std::uint32_t> record_;
  DeviceArray<BvhNode> nodes_;
  DeviceArray<BvhTriangle> triangles_;
  DeviceArray<TraceMedium> media_;
  DeviceArray<TraceLine> lines_;
  DeviceArray<std::uint64_t> seeds_;
  DeviceArray<std::uint8_t> starts_;
  DeviceArray<BinSums<double>> sums_;
  DeviceArray<BinSums<float>> bins_;
  DeviceArray<BinSums<float>> shared_;
  std::array<DeviceArray<float>, binArrayCount> arrays_;
  DeviceArray<float> axisRange_, axisAmplitude_, axisAbsorbed_;
  DeviceArray<EchoSum> absorbed_;
  DeviceArray<EchoSum> reverberation_;
  DeviceArray<ReverberationAround> reverberationAround_;
  DeviceArray<float> ownLevel_, cellMm_;
  DeviceArray<EchoSum> echo_;
  DeviceArray<EchoSum> echoRest_;
  DeviceArray<std::uint64_t> segments_;
  TraceView view_;
  BvhTargets targets_;
  int linesPerImage_ = 1;
  int paths_ = 0;
  int binCount_ = 0;
  float binMm_ = 0.0f;
  double frequencyMHz_ = 1.0;
  bool rangeIsTime_ = false;
  bool reverberates_ = false;
  int echoCount_ = 0;
  float echoSampleMm_ = 0.0f;
  float radPerMm_ = 0.0f;
  float echoScale_ = 1.0f;
  float echoPerUnit_ = 1.0f;
};

} // namespace sono
