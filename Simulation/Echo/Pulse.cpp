#include "Echo/Pulse.h"

#include "Progress.h"
#include "Simd.h"
#include "Trace/Trace.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;

SONO_SIMD_CLONES void convolveInterior(const float* in, int first, int last, const float* kernel, int taps, float* out)
{
  constexpr int tile = 32; // sums of a tile stay in registers
  const int half = taps / 2;
  int s = first;
  for (; s + tile <= last; s += tile)
  {
    float sum[tile] = {};
    const float* from = in + s - half;
    for (int k = 0; k < taps; ++k)
    {
      const float w = kernel[k];
      for (int i = 0; i < tile; ++i)
      {
        sum[i] += w * from[k + i];
      }
    }
    std::copy(sum, sum + tile, out + s);
  }
  for (; s < last; ++s)
  {
    float sum = 0.0f;
    for (int k = 0; k < taps; ++k)
    {
      sum += kernel[k] * in[s - half + k];
    }
    out[s] = sum;
  }
}

} // namespace

double pulseSigmaMm(double centreFrequencyMHz, double fractionalBandwidth)
{
  const double root = pi * centreFrequencyMHz * fractionalBandwidth;
  const double k = root * root / (4.0 * 0.3 * std::log(10.0)); // per microsecond squared
  return assumedSoundSpeedMmPerUs / (2.0 * std::sqrt(2.0 * k));
}

std::vector<float> pulseEnvelope(double sigmaMm, double sampleMm)
{
  const double sigma = sigmaMm / sampleMm;
  if (sigma < 0.8)
  {
    throw Error("the sampling frequency is too low for the pulse (" + std::to_string(sigma) +
                " samples a standard deviation of its envelope): raise it or lower the bandwidth");
  }
  const double narrowed = std::sqrt(sigma * sigma - 1.0 / 6.0);
  const int half = int(std::ceil(4.2 * sigma));
  std::vector<float> envelope;
  for (int i = -half; i <= half; ++i)
  {
    envelope.push_back(float(sigma / narrowed * std::exp(-0.5 * (i / narrowed) * (i / narrowed))));
  }
  return envelope;
}

void convolve(const float* in, int count, const std::vector<float>& envelope, float* out)
{
  const int taps = int(envelope.size());
  const int half = taps / 2;
  const int first = std::min(half, count);
  const int last = std::max(first, count - half);
  convolveInterior(in, first, last, envelope.data(), taps, out);
  const auto edge = [&](int s) {
    float sum = 0.0f;
    for (int k = std::max(0, half - s); k < taps && s - half + k < count; ++k)
    {
      sum += envelope[std::size_t(k)] * in[s - half + k];
    }
    out[s] = sum;
  };
  for (int s = 0; s < first; ++s)
  {
    edge(s);
  }
  for (int s = last; s < count; ++s)
  {
    edge(s);
  }
}

} // namespace sono
