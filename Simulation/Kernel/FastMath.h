#pragma once

#include "Kernel/HostDevice.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace sono {

/// exp(x) for x <= 0, relative error below 2e-7 (minimax polynomial of 2^f on [0, 1)); 0 below -87. Branch-free, so
/// that host loops vectorise.
SONO_HD inline float expNegative(float x)
{
  const float y = (x > -87.0f ? x : -87.0f) * 1.44269504f;
  const float whole = floorf(y);
  const float f = y - whole;
  float p = 1.8775767e-3f;
  p = p * f + 8.9893397e-3f;
  p = p * f + 5.5826318e-2f;
  p = p * f + 2.4015361e-1f;
  p = p * f + 6.9315308e-1f;
  p = p * f + 9.9999994e-1f;
  const std::int32_t bits = (std::int32_t(whole) + 127) << 23;
  float scale;
  memcpy(&scale, &bits, sizeof scale);
  return p * scale;
}

/// cos and sin for |x| <= 1.6, absolute error below 4e-7 (Taylor to x^12 and x^11).
SONO_HD inline float cosSmall(float x)
{
  const float q = x * x;
  return 1.0f + q * (-0.5f + q * (4.16666667e-2f + q * (-1.38888889e-3f + q * (2.48015873e-5f + q * -2.75573192e-7f))));
}
SONO_HD inline float sinSmall(float x)
{
  const float q = x * x;
  return x * (1.0f + q * (-1.66666667e-1f + q * (8.33333333e-3f + q * (-1.98412698e-4f + q * 2.75573192e-6f))));
}

} // namespace sono
