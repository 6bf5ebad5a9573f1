#pragma once

#include "Cuda/DeviceMemory.cuh"
#include "Cuda/ImageJob.h"

namespace sono {

/// Grey levels in beam space on the device.
struct GreyArrays
{
  DeviceArray<float> grey;       ///< images x lines x samples
  DeviceArray<double> reference; ///< of each image
  int lines = 0;                 ///< of an image
  int samples = 0;
};

/// Grey levels and pixels on the device.
class DeviceDisplay
{
public:
  /// Uploads the tables of a job.
  void prepare(const BModeJob& job, cudaStream_t stream, Traffic& traffic);
  /// For the grey levels of `images` images of `lines` lines each.
  static GreyArrays room(int images, int lines, int samples);
  /// Of some of those images the grey levels, from the envelopes of all.
  void compress(const float* envelopes, int firstImage, int images, GreyArrays& to, cudaStream_t stream);
  /// Of each image its pixels as bytes (see greyByte).
  DeviceArray<std::uint8_t> convert(const PlaneScan& scan, const float* grey, int images, cudaStream_t stream);
  /// The same as levels from 0 to 1, and 0 outside.
  DeviceArray<float> convertLevels(const PlaneScan& scan, const float* grey, int images, cudaStream_t stream);
  /// 1 for each pixel inside the scanned area, else 0.
  DeviceArray<std::uint8_t> maskOf(const PlaneScan& scan, cudaStream_t stream);

private:
  /// Values smoothed along the lines and across them; they stay until the next call.
  const float* smooth(const float* values, std::size_t count, int samples, cudaStream_t stream);
  /// The envelopes with noise and haze, smoothed where they are what is; they stay until the next call.
  const float* receive(const float* envelope, std::size_t count, int lines, int samples, cudaStream_t stream);

  BModeJob settings_; ///< without its tables
  DeviceArray<float> factor_;
  DeviceArray<double> gainDb_;
  DeviceArray<float> lateralGainDb_;
  DeviceArray<float> greyMap_;
  DeviceArray<float> axialSmoothing_;
  DeviceArray<float> lateralSmoothing_;
  DeviceArray<float> haze_;
  DeviceArray<std::uint8_t> rank_;
  DeviceArray<float> received_;
  DeviceArray<float> smoothedAlong_;
  DeviceArray<float> smoothedAcross_;
};

} // namespace sono
