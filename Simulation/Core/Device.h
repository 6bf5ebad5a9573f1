#pragma once

#include <string>

namespace sono {

/// Where to compute. The results of the two differ by rounding.
enum class Device
{
  Auto, ///< the GPU where there is one, else the CPU
  Cpu,
  Cuda
};

struct DeviceChoice
{
  bool cuda = false;
  std::string note; ///< where Auto fell back to the CPU, one sentence that says why
};

/// Throws Error when the GPU is wanted and cannot be used.
DeviceChoice chooseDevice(Device wanted);

} // namespace sono
