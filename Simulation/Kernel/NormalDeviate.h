#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/HostDevice.h"

#include <cmath>

// Quantiles of the standard normal distribution, from its upper tail Q(x).

namespace sono {

/// Standard normal deviate whose upper tail probability is u, a uniform of (0, 1) of 24 bits: Giles 2010
/// ("Approximating the erfinv function"), absolute error below 2e-6. Branch-free, so that host loops vectorise.
SONO_HD inline float normalDeviate(float u)
{
  const float p = u < 0.5f ? u : 1.0f - u; // the smaller tail keeps its digits
  const float w = -logPositive(4.0f * p * (1.0f - p));
  const float c = w - 2.5f;
  float central = 2.81022636e-08f;
  central = 3.43273939e-07f + central * c;
  central = -3.5233877e-06f + central * c;
  central = -4.39150654e-06f + central * c;
  central = 0.00021858087f + central * c;
  central = -0.00125372503f + central * c;
  central = -0.00417768164f + central * c;
  central = 0.246640727f + central * c;
  central = 1.50140941f + central * c;
  const float t = sqrtf(w > 0.0f ? w : 0.0f) - 3.0f;
  float tail = -0.000200214257f;
  tail = 0.000100950558f + tail * t;
  tail = 0.00134934322f + tail * t;
  tail = -0.00367342844f + tail * t;
  tail = 0.00573950773f + tail * t;
  tail = -0.0076224613f + tail * t;
  tail = 0.00943887047f + tail * t;
  tail = 1.00167406f + tail * t;
  tail = 2.83297682f + tail * t;
  const float x = 1.41421356f * (w < 5.0f ? central : tail) * (1.0f - 2.0f * p);
  return u < 0.5f ? x : -x;
}

/// From here on the upper tail is taken from its asymptotic series: Q itself would lose its digits, then underflow.
constexpr float farTail = 5.0f;

/// Mills' ratio Q(x) / phi(x) by Laplace's continued fraction, x >= farTail.
inline double millsRatio(double x)
{
  double fraction = x;
  for (int k = 60; k > 0; --k)
  {
    fraction = x + k / fraction;
  }
  return 1.0 / fraction;
}

/// Quantile of the upper normal tail beyond alpha >= farTail: x - alpha for Q(x) / Q(alpha) = ratio, with Mills' ratio
/// Q(x) = phi(x) / x (1 - 1/x^2 + 3/x^4).
SONO_HD inline float normalFarTail(float alpha, float ratio)
{
  const float ia = 1.0f / (alpha * alpha);
  const float seriesAlpha = (1.0f - ia + 3.0f * ia * ia) / alpha;
  const float target = -logf(fmaxf(ratio, 1e-30f));
  // y = (x^2 - alpha^2) / 2 is well scaled where x itself would lose its digits.
  float y = target;
  for (int i = 0; i < 4; ++i)
  {
    const float x = sqrtf(alpha * alpha + 2.0f * y);
    const float ix = 1.0f / (x * x);
    y = fmaxf(0.0f, target + logf((1.0f - ix + 3.0f * ix * ix) / (x * seriesAlpha)));
  }
  return 2.0f * y / (alpha + sqrtf(alpha * alpha + 2.0f * y));
}

/// x with upper tail probability q in [0, 1], single precision, finite also at the ends: Giles 2010 ("Approximating the
/// erfinv function") evaluated from the smaller tail, so that both tails keep their relative precision.
SONO_HD inline float normalFromUpperTail(float q)
{
  constexpr float tailFive = 2.86651572e-7f; // Q(5); the fit below ends there
  if (q < tailFive)
  {
    return 5.0f + normalFarTail(5.0f, q / tailFive);
  }
  const bool upper = q < 0.5f;
  // The smaller tail; half a step of single precision where q has rounded to 1.
  const float p = fmaxf(upper ? q : 1.0f - q, 2.98023224e-8f);
  float w = -logf(4.0f * p * (1.0f - p));
  float r;
  if (w < 5.0f)
  {
    w -= 2.5f;
    r = 2.81022636e-08f;
    r = 3.43273939e-07f + r * w;
    r = -3.5233877e-06f + r * w;
    r = -4.39150654e-06f + r * w;
    r = 0.00021858087f + r * w;
    r = -0.00125372503f + r * w;
    r = -0.00417768164f + r * w;
    r = 0.246640727f + r * w;
    r = 1.50140941f + r * w;
  }
  else
  {
    w = sqrtf(w) - 3.0f;
    r = -0.000200214257f;
    r = 0.000100950558f + r * w;
    r = 0.00134934322f + r * w;
    r = -0.00367342844f + r * w;
    r = 0.00573950773f + r * w;
    r = -0.0076224613f + r * w;
    r = 0.00943887047f + r * w;
    r = 1.00167406f + r * w;
    r = 2.83297682f + r * w;
  }
  const float x = 1.41421356f * r * (1.0f - 2.0f * p);
  return upper ? x : -x;
}

} // namespace sono
