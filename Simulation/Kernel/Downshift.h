#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/HostDevice.h"

namespace sono {

// Attenuation lowers the pulse's frequency (Data/docs/physics.md section 12.4). With the two-way exponent B f the
// Gaussian spectrum keeps its width, its centre moves to f0 - B s_f^2, and it is exp(B^2 s_f^2 / 2) stronger than the
// intensity at f0 says. B changes slowly over a pulse, so one pulse serves all depths: the demodulated sum is
// multiplied by F exp(i phi), convolved, and multiplied by exp(-i phi), phi being the integral over depth of 2 (k(f0) -
// k(f)).

/// Of a pulse, for one line's samples.
struct Downshift
{
  float spectrumMHz2; ///< s_f^2
  float maxNpPerMHz;  ///< of B: the centre does not fall below s_f
  float turnsPerMHz;  ///< of phi, from one sample to the next, for a shift of 1 MHz: 2 sample / c0
};

/// Rotation of a sample by its phase in turns, and what it is multiplied by besides.
struct DownshiftAt
{
  float re;
  float im;
};

/// B as far as it lowers the frequency.
SONO_HD inline float shiftingExponent(const Downshift& d, float npPerMHz)
{
  return smaller(larger(npPerMHz, 0.0f), d.maxNpPerMHz);
}
/// Turns of phi between two samples.
SONO_HD inline float downshiftTurns(const Downshift& d, float exponent)
{
  return d.turnsPerMHz * d.spectrumMHz2 * exponent;
}
/// F
SONO_HD inline float downshiftGain(const Downshift& d, float exponent)
{
  return quickDivide(1.0f, expNegative(-0.5f * d.spectrumMHz2 * exponent * exponent));
}
/// exp(i 2 pi turns), turns in [-0.5, 0.5]
SONO_HD inline DownshiftAt downshiftRotation(float turns)
{
  const float half = 3.14159265f * turns;
  const float c = cosSmall(half);
  const float s = sinSmall(half);
  return { c * c - s * s, 2.0f * c * s };
}

} // namespace sono
