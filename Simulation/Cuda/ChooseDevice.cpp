#include "Core/Device.h"

#include "Cuda/DeviceImager.h"

namespace sono {

DeviceChoice chooseDevice(Device wanted)
{
  if (wanted == Device::Cpu)
  {
    return {};
  }
  const DeviceStatus status = cudaStatus();
  if (status.usable)
  {
    return { true, {} };
  }
  if (wanted == Device::Cuda)
  {
    throw Error("the GPU cannot be used, since " + status.what + ": choose Auto or CPU as the device");
  }
  return { false, "Computing on the CPU, since " + status.what + "." };
}

} // namespace sono
