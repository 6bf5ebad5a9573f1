#pragma once

#include "Core/Parameters.h"

#include <string>

namespace sono {

/// Where to compute. The results of the two differ by rounding.
enum class Device
{
  Auto, ///< the GPU where there is one, else the CPU
  Cpu,
  Cuda
};

inline Parameter deviceParameter()
{
  return { "device",
           "Device",
           {},
           "Where to compute: Auto takes the GPU where there is one, else the CPU. The results differ by rounding.",
           { "Auto", "CPU", "CUDA" } };
}

struct DeviceChoice
{
  bool cuda = false;
  std::string note; ///< where Auto fell back to the CPU, one sentence that says why
};

/// Throws Error when the GPU is wanted and cannot be used.
DeviceChoice chooseDevice(Device wanted);

} // namespace sono
