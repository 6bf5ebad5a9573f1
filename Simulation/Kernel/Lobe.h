#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/HostDevice.h"
#include "Kernel/NormalDeviate.h"
#include "Kernel/Vec.h"

#include <cmath>

namespace sono {

/// The directional lobe around the mirror or refracted direction: phi ~ normal(mu, sigma) truncated to [a, b],
/// theta ~ U(0, 2 pi) (Amadou 2024, section 2.4.3). Constants come from makeLobe in double precision.
struct Lobe
{
  float mu = 0.0f;
  float sigma = 0.0f; ///< 0: always mu, clamped to [a, b]
  float a = 0.0f;
  float b = 0.0f;
  float alpha = 0.0f;     ///< (a - mu) / sigma, after mirroring
  float tailAlpha = 0.0f; ///< upper tail probability Q(alpha)
  float tailBeta = 0.0f;  ///< Q(beta), beta = (b - mu) / sigma after mirroring
  float tailRatio = 0.0f; ///< Q(beta) / Q(alpha)
  float density = 0.0f;   ///< psi at mu, extrapolated where mu is outside; in a far tail psi at alpha
  bool mirrored = false;  ///< the interval lies mostly below mu: sampled with the sign of x turned
};

/// Throws nothing; arguments are validated by TraceSettings::validate.
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
  // Above this it is uniform to 1e-4, and the tails would not resolve the interval.
  sigma = std::fmin(sigma, 100.0);
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
  lobe.alpha = float(alpha);
  if (lobe.alpha >= farTail)
  {
    const double mills = millsRatio(alpha);
    const double ratio = std::exp(-0.5 * (beta - alpha) * (beta + alpha)) * millsRatio(beta) / mills;
    lobe.tailRatio = float(ratio);
    lobe.density = float(1.0 / (sigma * mills * (1.0 - ratio)));
    return lobe;
  }
  const double tailAlpha = 0.5 * std::erfc(alpha / std::sqrt(2.0));
  const double tailBeta = 0.5 * std::erfc(beta / std::sqrt(2.0));
  lobe.tailAlpha = float(tailAlpha);
  lobe.tailBeta = float(tailBeta);
  lobe.density = float(1.0 / (sigma * std::sqrt(2.0 * 3.14159265358979323846) * (tailAlpha - tailBeta)));
  return lobe;
}

/// phi for u in (0, 1): inverse of the truncated normal's distribution function. Always in [a, b].
SONO_HD inline float samplePolar(const Lobe& lobe, float u)
{
  if (lobe.sigma == 0.0f)
  {
    return fminf(fmaxf(lobe.mu, lobe.a), lobe.b);
  }
  const float v = lobe.mirrored ? u : 1.0f - u; // fraction of the tail beyond, in both cases
  float phi;
  if (lobe.alpha >= farTail)
  {
    const float excess = normalFarTail(lobe.alpha, lobe.tailRatio + v * (1.0f - lobe.tailRatio)) * lobe.sigma;
    phi = lobe.mirrored ? lobe.b - excess : lobe.a + excess;
  }
  else
  {
    const float x = normalFromUpperTail(lobe.tailBeta + v * (lobe.tailAlpha - lobe.tailBeta));
    phi = lobe.mu + (lobe.mirrored ? -x : x) * lobe.sigma;
  }
  return fminf(fmaxf(phi, lobe.a), lobe.b);
}

/// psi(phi) for phi in [a, b]; 0 when the lobe is a mirror (it has no density then).
SONO_HD inline float polarDensity(const Lobe& lobe, float phi)
{
  if (lobe.sigma == 0.0f)
  {
    return 0.0f;
  }
  if (lobe.alpha >= farTail)
  {
    // x^2 - alpha^2 from the distance to the near end: the squares would cancel.
    const float excess = (lobe.mirrored ? lobe.b - phi : phi - lobe.a) / lobe.sigma;
    return lobe.density * expf(-excess * (lobe.alpha + 0.5f * excess));
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
  float sinPhi;
  float cosPhi;
  float sinAzimuth;
  float cosAzimuth;
  sinCos(phi, sinPhi, cosPhi);
  sinCos(6.28318531f * (u - 0.5f), sinAzimuth, cosAzimuth); // half a turn back: both change their sign
  return glm::normalize(axis * cosPhi - s * (sinPhi * cosAzimuth) - t * (sinPhi * sinAzimuth));
}

} // namespace sono
