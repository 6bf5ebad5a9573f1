#pragma once

#include "Cuda/DeviceMemory.cuh"
#include "Cuda/ImageJob.h"

namespace sono {

/// Grey levels and pixels on the device.
class DeviceDisplay
{
public:
  void prepare(const ImageJob& job, cudaStream_t stream, Traffic& traffic);
  /// Grey levels of `images` images; `envelope` (lines x samples) gets the receiver's noise.
  void compress(float* envelope, int images, cudaStream_t stream);
  void convert(int images, cudaStream_t stream);

  const float* grey() const { return grey_.data(); }
  const double* reference() const { return reference_.data(); }
  const float* pixels() const { return pixels_.data(); }
  const std::uint8_t* mask() const { return mask_.data(); }

private:
  BModeJob settings_; ///< without its tables
  int lines_ = 0;     ///< of an image
  int samples_ = 0;
  std::optional<PlaneScan> scan_;
  DeviceArray<float> factor_;
  DeviceArray<double> gainDb_;
  DeviceArray<std::uint8_t> rank_;
  DeviceArray<double> reference_;
  DeviceArray<float> grey_;
  DeviceArray<float> pixels_;
  DeviceArray<std::uint8_t> mask_;
};

} // namespace sono
