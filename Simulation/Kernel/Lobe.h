#pragma once

#include "Kernel/HostDevice.h"
#include "Kernel/Vec.h"

#include <cmath>

namespace sono
{

/// The directional lobe around the mirror or refracted direction: phi ~ normal(mu, sigma) truncated to [a, b],
/// theta ~ U(0, 2 pi) (Amadou 2024, section 2.4.3). Constants come from makeLobe in double precision.
struct Lobe
{
  float mu = 0.0f;
  float sigma = 0.0f; ///< 0: always mu, clamped to [a, b]
  float a = 0.0f;
  float b = 0.0f;
  float alpha = 0.0f;     ///< (a - mu) / sigma, after mirroring
  float beta = 0.0f;      ///< (b - mu) / sigma, after mirroring
  float tailAlpha = 0.0f; ///< upper tail probability Q(alpha)
  float tailBeta = 0.0f;  ///< Q(beta)
  float tailRatio = 0.0f; ///< Q(beta) / Q(alpha)
  float density = 0.0f;   ///< factor of exp(-x^2/2) in psi
  bool mirrored = false;  ///< the interval lies mostly below mu: sampled with the sign of x turned
};

/// Throws nothing; arguments are validated by TraceSettings::validate. sigma may be 0 or infinite in effect.
inline Lobe makeLobe(double mu, double sigma, double a, double b)
{
  Lobe lobe;
  lobe.mu = float(mu);
  lobe.a = float(a);
  lobe.b = float(b);
  // Below this the lobe is a mirror in single precision.
  if (sigma < 1e-6)
  {
    return lobe;
  }
  lobe.sigma = float(sigma);
  double alpha = (a - mu) / sigma;
  double beta = (b - mu) / sigma;
  if (alpha + beta < 0.0)
  {
    lobe.mirrored = true;
    const double t = alpha;
    alpha = -beta;
    beta = -t;
  }
  const double tailAlpha = 0.5 * std::erfc(alpha / std::sqrt(2.0));
  const double tailBeta = 0.5 * std::erfc(beta / std::sqrt(2.0));
  lobe.alpha = float(alpha);
  lobe.beta = float(beta);
  lobe.tailAlpha = float(tailAlpha);
  lobe.tailBeta = float(tailBeta);
  lobe.tailRatio = tailAlpha > 0.0 ? float(tailBeta / tailAlpha) : 0.0f;
  lobe.density = tailAlpha > tailBeta
                   ? float(1.0 / (sigma * std::sqrt(2.0 * 3.14159265358979323846) * (tailAlpha - tailBeta)))
                   : 0.0f;
  return lobe;
}

/// Quantile of the upper normal tail beyond alpha >= 5, where Q itself would underflow: solves
/// Q(x) / Q(alpha) = ratio with Mills' ratio Q(x) = phi(x) / x (1 - 1/x^2 + 3/x^4).
SONO_HD inline float normalFarTail(float alpha, float ratio)
{
  const float ia = 1.0f / (alpha * alpha);
  const float millsAlpha = (1.0f - ia + 3.0f * ia * ia) / alpha;
  // y = (x^2 - alpha^2) / 2 is well scaled where x itself would lose its digits.
  float y = -logf(ratio);
  float x = alpha;
  for (int i = 0; i < 4; ++i)
  {
    x = sqrtf(alpha * alpha + 2.0f * y);
    const float ix = 1.0f / (x * x);
    y = -logf(ratio) + logf((1.0f - ix + 3.0f * ix * ix) / (x * millsAlpha));
  }
  return x;
}

/// x with upper tail probability q, q in (0, 1), single precision: Giles 2010 ("Approximating the erfinv
/// function") evaluated from the smaller tail, so that both tails keep their relative precision.
SONO_HD inline float normalFromUpperTail(float q)
{
  constexpr float tailFive = 2.86651572e-7f; // Q(5); the fit below ends there
  if (q < tailFive)
  {
    return normalFarTail(5.0f, q / tailFive);
  }
  const bool upper = q < 0.5f;
  const float p = upper ? q : 1.0f - q; // the smaller tail
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

/// phi for u in (0, 1): inverse of the truncated normal's distribution function. Always in [a, b].
SONO_HD inline float samplePolar(const Lobe& lobe, float u)
{
  if (lobe.sigma == 0.0f)
  {
    return fminf(fmaxf(lobe.mu, lobe.a), lobe.b);
  }
  const float v = lobe.mirrored ? u : 1.0f - u; // fraction of the tail beyond, in both cases
  float x;
  if (lobe.alpha >= 5.0f)
  {
    x = normalFarTail(lobe.alpha, lobe.tailRatio + v * (1.0f - lobe.tailRatio));
  }
  else
  {
    x = normalFromUpperTail(lobe.tailBeta + v * (lobe.tailAlpha - lobe.tailBeta));
  }
  const float phi = lobe.mu + (lobe.mirrored ? -x : x) * lobe.sigma;
  return fminf(fmaxf(phi, lobe.a), lobe.b);
}

/// psi(phi) on [a, b]; 0 when the lobe is a mirror (it has no density then).
SONO_HD inline float polarDensity(const Lobe& lobe, float phi)
{
  if (lobe.sigma == 0.0f)
  {
    return 0.0f;
  }
  const float x = (phi - lobe.mu) / lobe.sigma;
  return lobe.density * expf(-0.5f * x * x);
}

/// Direction at polar angle phi and azimuth 2 pi u around the unit vector `axis` (basis: Duff et al. 2017).
SONO_HD inline Vec3f directionAround(const Vec3f& axis, float phi, float u)
{
  const float sign = axis.z >= 0.0f ? 1.0f : -1.0f;
  const float p = -1.0f / (sign + axis.z);
  const float q = axis.x * axis.y * p;
  const Vec3f s(1.0f + sign * axis.x * axis.x * p, sign * q, -sign * axis.x);
  const Vec3f t(q, sign + axis.y * axis.y * p, -axis.y);
  const float azimuth = 6.28318531f * u;
  const float sinPhi = sinf(phi);
  return glm::normalize(axis * cosf(phi) + s * (sinPhi * cosf(azimuth)) + t * (sinPhi * sinf(azimuth)));
}

} // namespace sono
