#include "Ceilings.h"
#include "Cuda/DeviceMemory.cuh"

#include <algorithm>
#include <functional>
#include <vector>

namespace sono {

namespace {

constexpr int chains = 8; // independent, to hide the latency of an operation
constexpr int steps = 4096;

__global__ void multiplyAndAdd(float* out, float a, float b)
{
  float x[chains];
  for (int c = 0; c < chains; ++c)
  {
    x[c] = float(threadIdx.x + c);
  }
  for (int s = 0; s < steps; ++s)
  {
#pragma unroll
    for (int c = 0; c < chains; ++c)
    {
      x[c] = x[c] * a + b;
    }
  }
  float sum = 0.0f;
  for (int c = 0; c < chains; ++c)
  {
    sum += x[c];
  }
  out[blockIdx.x * blockDim.x + threadIdx.x] = sum;
}

double medianMs(const std::function<void()>& work)
{
  cudaEvent_t from;
  cudaEvent_t to;
  check(cudaEventCreate(&from), "timing");
  check(cudaEventCreate(&to), "timing");
  std::vector<float> ms;
  for (int i = 0; i < 11; ++i)
  {
    check(cudaEventRecord(from), "timing");
    work();
    check(cudaEventRecord(to), "timing");
    check(cudaEventSynchronize(to), "timing");
    float t = 0.0f;
    check(cudaEventElapsedTime(&t, from, to), "timing");
    ms.push_back(t);
  }
  std::sort(ms.begin(), ms.end());
  return ms[ms.size() / 2];
}

} // namespace

Ceilings measureCeilings()
{
  const OnLane here(openLane(0, Waiting::Busy)); // for as long as the program runs
  Ceilings ceilings{};
  {
    const std::size_t bytes = std::size_t(1) << 30;
    DeviceArray<char> a;
    DeviceArray<char> b;
    a.resize(bytes);
    b.resize(bytes);
    check(cudaMemset(a.data(), 1, bytes), "filling memory");
    const double ms =
      medianMs([&] { check(cudaMemcpyAsync(b.data(), a.data(), bytes, cudaMemcpyDeviceToDevice), "copying"); });
    ceilings.gigabytesPerSecond = 2.0 * double(bytes) / ms * 1e-6;
  }
  const int blocks = 132 * 16;
  const int threads = 256;
  DeviceArray<float> out;
  out.resize(std::size_t(blocks) * threads);
  const double ms = medianMs([&] { multiplyAndAdd<<<blocks, threads>>>(out.data(), 0.999f, 0.001f); });
  ceilings.teraflops = 2.0 * chains * steps * double(blocks) * threads / ms * 1e-9;
  return ceilings;
}

} // namespace sono
