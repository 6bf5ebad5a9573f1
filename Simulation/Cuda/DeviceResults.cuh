#pragma once

#include "Cuda/DeviceDisplay.cuh"
#include "Cuda/DeviceEcho.cuh"
#include "Cuda/DeviceTracer.cuh"

namespace sono {

// What lies on the device after a stage; see DeviceImager.h.

struct DeviceTraced
{
  TracedArrays arrays;
  int lineCount = 0;
  TracedOnDevice view; ///< of the arrays
};

struct DeviceRf
{
  DeviceArray<float2> iq;      ///< lines x samples; empty where it was not wanted
  DeviceArray<float> envelope; ///< the same
  int lineCount = 0;
  int sampleCount = 0;
};

struct DeviceGrey
{
  GreyArrays arrays;
  int images = 1;
};

struct DevicePicture
{
  DeviceArray<std::uint8_t> bytes; ///< images x height x width
  std::shared_ptr<const DeviceArray<std::uint8_t>> mask;
  SharedSpan<std::uint8_t> hostMask;
  PlaneScan scan{};
  int images = 1;
  std::shared_ptr<const DeviceGrey> grey; ///< that it was made from
};

struct DeviceLabelSlice
{
  DeviceArray<std::uint16_t> labels; ///< images x height x width
};

} // namespace sono
