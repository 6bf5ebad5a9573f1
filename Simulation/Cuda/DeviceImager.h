#pragma once

#include "Core/Progress.h"
#include "Cuda/ImageJob.h"

#include <complex>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sono {

/// What is brought back from the device; the rest never crosses the bus.
struct DeviceWants
{
  bool traced = false;
  bool rf = false;
  bool bmode = false;
  bool image = false;
};

/// What was wanted; see TracedLines, RfLines, BModeLines and PlaneImage for the shapes, one image after the other.
struct DeviceResult
{
  std::vector<float> intensity;
  std::vector<float> standardError;
  std::vector<std::complex<float>> boundaryEcho;
  std::uint64_t segments = 0;
  std::vector<std::complex<float>> iq;
  std::vector<float> grey;
  std::vector<double> referenceAmplitude; ///< of each image
  std::vector<std::vector<float>> pixels; ///< of each image
  std::vector<std::uint8_t> mask;         ///< one for all images
};

/// Device times of a run's stages, ms, from events.
struct DeviceTimes
{
  double upload = 0.0;
  double trace = 0.0;
  double echo = 0.0;
  double bmode = 0.0;
  double scan = 0.0;
  double download = 0.0;
  std::uint64_t uploadedBytes = 0;
  std::uint64_t downloadedBytes = 0;
};

/// Whether this process can compute on a GPU.
struct DeviceStatus
{
  bool usable = false;
  std::string what; ///< the GPU's name and memory, or one clause that says why there is none
  std::uint64_t memoryBytes = 0;
};
/// Asked once a process.
const DeviceStatus& cudaStatus();

/// Runs jobs on the first CUDA device. What a scene does not change (voxels, boundary records, fields) is uploaded once
/// and kept; buffers grow and are kept. One job at a time; a second caller waits. The result does not depend on the
/// order in which threads run, to the bit.
class DeviceImager
{
public:
  /// The process's imager. Throws Error when there is no usable device.
  static DeviceImager& instance();
  ~DeviceImager();

  /// Throws Error naming the bytes when the device has no room and the failure when it was lost, Aborted when asked to
  /// stop; the imager stays usable, all that it kept being given back.
  DeviceResult run(const ImageJob& job, const DeviceWants& wants, const Progress& progress = {},
                   DeviceTimes* times = nullptr);

private:
  DeviceImager();
  struct Work;
  std::unique_ptr<Work> work_;
};

} // namespace sono
