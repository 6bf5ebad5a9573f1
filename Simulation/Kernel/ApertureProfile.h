#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/HostDevice.h"

namespace sono {

/// One axis of a beam of Gaussians (Data/docs/physics.md section 12.1), as a scatterer's weight wants it. The squares
/// of the inverse deviations need no root: with W the radius at 1/e of the transmitted amplitude,
///   1 / s_T^2 = 2 / W^2,  W^2 = waist2 (1 - z perFocus)^2 + spread2 z^2                                        (12.2)
///   1 / s_R^2 = perNarrowest2 min(aperture2 / z^2, 1)                                                         (12.1)
/// where the smaller part of the aperture that is open near the face, min(D, z), is the second factor.
struct ApertureAxis
{
  float waist2;        ///< W_a^2, mm^2
  float perFocus;      ///< 1 / F, 1/mm; 0: not focused
  float spread2;       ///< (lambda / (pi W_a))^2
  float aperture2;     ///< D^2, mm^2
  float perNarrowest2; ///< (1 / (0.376 sqrt(2) lambda))^2, 1/mm^2
  bool lens;           ///< received through the same fixed focus, (12.2), instead of (12.1)
  float cosine2;       ///< of the line's angle: the aperture seen from there is narrower, so the beam is wider
};

/// A line's beam: along the array, across it, and what the amplitude on its axis is multiplied by.
struct ApertureProfile
{
  ApertureAxis lateral;
  ApertureAxis elevational;
  float gain;
};

/// Gaussian weight at a depth: amplitude exp(-(dL^2 perLateral2 + dE^2 perElevational2) / 2).
struct ProfileAt
{
  float perLateral2; ///< 1 / s_L^2, 1/mm^2
  float perElevational2;
  float amplitude; ///< on the axis, as energy is kept: each way 1 / sqrt(s_L s_E)
};

SONO_HD inline float perTransmit2(const ApertureAxis& a, float z)
{
  const float bend = 1.0f - z * a.perFocus;
  return quickDivide(2.0f, a.waist2 * bend * bend + a.spread2 * z * z);
}

SONO_HD inline float perReceive2(const ApertureAxis& a, float z, float transmit2)
{
  const float z2 = larger(z * z, 1e-12f);
  return a.lens ? transmit2 : a.perNarrowest2 * smaller(quickDivide(a.aperture2, z2), 1.0f);
}

/// At a depth z >= 0, mm.
SONO_HD inline ProfileAt profileAt(const ApertureProfile& p, float z)
{
  const float tl = perTransmit2(p.lateral, z);
  const float rl = perReceive2(p.lateral, z, tl);
  const float te = perTransmit2(p.elevational, z);
  const float re = perReceive2(p.elevational, z, te);
  return { (tl + rl) * p.lateral.cosine2, (te + re) * p.elevational.cosine2,
           p.gain * quickSqrt(quickSqrt(tl * rl * te * re)) };
}

} // namespace sono
