#include "Cuda/DeviceImager.h"

// Stands in for the GPU where SonoVDB was built without nvcc.

namespace sono {

struct DeviceImager::Work
{
};

const DeviceStatus& cudaStatus()
{
  static const DeviceStatus status{ false, "this SonoVDB was built without CUDA" };
  return status;
}

DeviceImager::DeviceImager() = default;
DeviceImager::~DeviceImager() = default;

DeviceImager& DeviceImager::instance()
{
  throw Error("the GPU cannot be used: " + cudaStatus().what + "; choose the CPU");
}

DeviceResult DeviceImager::run(const ImageJob&, const DeviceWants&, const Progress&, DeviceTimes*)
{
  return {};
}

} // namespace sono
