#pragma once

#include "Kernel/HostDevice.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace sono {

/// exp(x) for x <= 0, relative error below 3e-7 + 1e-7 |x| (minimax polynomial of 2^f on [0, 1)); exp(-87) below -87.
/// Branch-free, so that host loops vectorise. On the GPU its own instruction, which is as exact.
SONO_HD inline float expNegative(float x)
{
#if defined(__CUDA_ARCH__)
  return __expf(x > -87.0f ? x : -87.0f);
#else
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
#endif
}

/// a / b and sqrt(x), x >= 0, where an error of 3e-7 does not matter. On the GPU the exact ones are many instructions.
SONO_HD inline float quickDivide(float a, float b)
{
#if defined(__CUDA_ARCH__)
  return __fdividef(a, b);
#else
  return a / b;
#endif
}
SONO_HD inline float quickSqrt(float x)
{
#if defined(__CUDA_ARCH__)
  return x * rsqrtf(x > 1e-30f ? x : 1e-30f);
#else
  return sqrtf(x);
#endif
}

/// sin and cos of an angle in [-pi, pi], to the last digit or two. The GPU's own instruction, 4e-7 off, will not do:
/// each bounce off a curved surface magnifies an error of the direction.
SONO_HD inline void sinCos(float x, float& sine, float& cosine)
{
#if defined(__CUDA_ARCH__)
  sincosf(x, &sine, &cosine);
#else
  sine = sinf(x);
  cosine = cosf(x);
#endif
}

/// cos and sin for |x| <= 1.6, absolute error below 2e-7 (Taylor to x^12 and x^11).
SONO_HD inline float cosSmall(float x)
{
  const float q = x * x;
  float c = 2.08767570e-9f;
  c = c * q - 2.75573192e-7f;
  c = c * q + 2.48015873e-5f;
  c = c * q - 1.38888889e-3f;
  c = c * q + 4.16666667e-2f;
  c = c * q - 0.5f;
  return c * q + 1.0f;
}
SONO_HD inline float sinSmall(float x)
{
  const float q = x * x;
  float s = -2.50521084e-8f;
  s = s * q + 2.75573192e-6f;
  s = s * q - 1.98412698e-4f;
  s = s * q + 8.33333333e-3f;
  s = s * q - 1.66666667e-1f;
  return s * q * x + x;
}

/// log(x) for normal x > 0, absolute error below 2e-7 (1 + |log(x)|) (polynomial on [sqrt(1/2), sqrt(2)) after Cephes'
/// logf). Branch-free, so that host loops vectorise.
SONO_HD inline float logPositive(float x)
{
  std::int32_t bits;
  memcpy(&bits, &x, sizeof bits);
  constexpr std::int32_t rootHalf = 0x3f3504f3; // bits of sqrt(1/2)
  const std::int32_t exponent = (bits - rootHalf) >> 23;
  bits -= exponent * (1 << 23);
  float m;
  memcpy(&m, &bits, sizeof m);
  m -= 1.0f;
  float p = 7.0376836292e-2f;
  p = p * m - 1.1514610310e-1f;
  p = p * m + 1.1676998740e-1f;
  p = p * m - 1.2420140846e-1f;
  p = p * m + 1.4249322787e-1f;
  p = p * m - 1.6668057665e-1f;
  p = p * m + 2.0000714765e-1f;
  p = p * m - 2.4999993993e-1f;
  p = p * m + 3.3333331174e-1f;
  return m * m * (m * p - 0.5f) + m + float(exponent) * 0.693147181f;
}

/// A product that goes into no fused multiplication and addition, so that both devices decide alike by it. On a CPU the
/// file must be compiled with -ffp-contract=off where it is so by default.
SONO_HD inline float roundedProduct(float a, float b)
{
#if defined(__CUDA_ARCH__)
  return __fmul_rn(a, b);
#else
  return a * b;
#endif
}

/// fmin and fmax are one instruction of the GPU, but calls on a CPU, where these are one.
SONO_HD inline float smaller(float a, float b)
{
#if defined(__CUDA_ARCH__)
  return fminf(a, b);
#else
  return a < b ? a : b;
#endif
}
SONO_HD inline float larger(float a, float b)
{
#if defined(__CUDA_ARCH__)
  return fmaxf(a, b);
#else
  return a > b ? a : b;
#endif
}

} // namespace sono
