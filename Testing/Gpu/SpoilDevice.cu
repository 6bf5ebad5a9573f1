#include "SpoilDevice.h"

#include <cuda_runtime.h>

namespace sono::test {

namespace {

__global__ void trap()
{
  __trap();
}

} // namespace

TakenMemory::TakenMemory()
{
  std::size_t free = 0;
  std::size_t total = 0;
  cudaMemGetInfo(&free, &total);
  const std::size_t left = std::size_t(64) << 20;
  while (!taken_ && free > left && cudaMalloc(&taken_, free - left) != cudaSuccess)
  {
    cudaGetLastError();
    free -= std::size_t(16) << 20;
  }
}

TakenMemory::~TakenMemory()
{
  cudaFree(taken_);
}

void loseDevice()
{
  trap<<<1, 1>>>();
  cudaDeviceSynchronize();
}

} // namespace sono::test
