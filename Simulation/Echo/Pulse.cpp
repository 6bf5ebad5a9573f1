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

SONO_SIMD_CLONES void weightedSums(const float* in, const float* kernel, int taps, int count, float* out)
{
  constexpr int tile = 64; // the sums of a tile stay in registers
  int s = 0;
  for (; s + tile <= count; s += tile)
  {
    float sum[tile] = {};
    for (int k = 0; k < taps; ++k)
    {
      for (int i = 0; i < tile; ++i)
      {
        sum[i] += kernel[k] * in[s + k + i];
      }
    }
    std::copy(sum, sum + tile, out + s);
  }
  for (; s < count; ++s)
  {
    float sum = 0.0f;
    for (int k = 0; k < taps; ++k)
    {
      sum += kernel[k] * in[s + k];
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

void convolve(const float* in, const std::vector<float>& envelope, int count, float* out)
{
  weightedSums(in, envelope.data(), int(envelope.size()), count, out);
}

} // namespace sono
