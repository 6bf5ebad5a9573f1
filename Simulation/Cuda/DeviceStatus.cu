#include "Cuda/DeviceImager.h"

#include <cuda_runtime.h>

#include <cstdlib>

namespace sono {

namespace {

DeviceStatus askForStatus()
{
  // Streams of several lanes share fewer ways to the device otherwise, and wait for each other there.
  setenv("CUDA_DEVICE_MAX_CONNECTIONS", "32", 0);
  int count = 0;
  const cudaError_t error = cudaGetDeviceCount(&count);
  if (error != cudaSuccess || count == 0)
  {
    cudaGetLastError();
    return { false,
             error == cudaErrorInsufficientDriver || error == cudaErrorNoDevice || count == 0
               ? "no NVIDIA GPU with a driver for CUDA " + std::to_string(CUDART_VERSION / 1000) + " was found"
               : std::string("the GPU does not answer (") + cudaGetErrorString(error) + ")",
             0,
             {} };
  }
  DeviceStatus status;
  for (int device = 0; device < count; ++device)
  {
    cudaDeviceProp properties{};
    if (cudaGetDeviceProperties(&properties, device) != cudaSuccess)
    {
      cudaGetLastError();
      status.what = status.what.empty() ? "the GPU does not say what it is" : status.what;
    }
    else if (properties.major * 10 + properties.minor < 75)
    {
      const std::string old = std::string("the ") + properties.name + " is older than CUDA " +
                              std::to_string(CUDART_VERSION / 1000) + " serves";
      status.what = status.what.empty() ? old : status.what;
    }
    else
    {
      if (!status.usable)
      {
        status.usable = true;
        status.what = std::string(properties.name) + ", " + std::to_string(properties.totalGlobalMem >> 20) + " MiB";
        status.memoryBytes = properties.totalGlobalMem;
      }
      status.devices.push_back(device);
    }
  }
  return status;
}

} // namespace

const DeviceStatus& cudaStatus()
{
  static const DeviceStatus status = askForStatus();
  return status;
}

} // namespace sono
