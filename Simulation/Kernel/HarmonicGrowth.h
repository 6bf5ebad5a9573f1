#pragma once

#include "Kernel/HostDevice.h"

#include <cmath>

// How the second harmonic grows along a line (Data/docs/physics.md 14.2), by bins of depth. Written once, for the CPU
// and the GPU. `sent` and `doubled` are the intensities of the two traces in a bin.

namespace sono {

/// Below it, -200 dB, nothing is heard that grows there, and the quotient is of noise.
constexpr float leastDoubledIntensity = 1e-10f;

/// Where few paths say otherwise, in shadows, I2 <= I1 all the same.
SONO_HD inline double sentAtLeast(float sent, float doubled)
{
  return double(sent > doubled ? sent : doubled);
}

/// S I1 / sqrt(I2) dz, what a bin adds to C (14.5) but for the beam's G.
SONO_HD inline double harmonicStrength(float sent, float doubled, float sourcePerMm, double binMm)
{
  const double i2 = double(doubled);
  const double root = sqrt(i2 > double(leastDoubledIntensity) ? i2 : double(leastDoubledIntensity));
  const double share = sentAtLeast(sent, doubled) / root;
  const double strength = double(sourcePerMm) * (share < 1.0 ? share : 1.0) * binMm;
  return doubled > leastDoubledIntensity ? strength : 0.0;
}

/// The integral of (14.5) along a line, bin by bin from the face on.
struct HarmonicSum
{
  double re = 0.0;
  double im = 0.0;

  /// Adds a bin of this strength and gain; returns C squared in its middle.
  SONO_HD double add(double strength, double gainRe, double gainIm)
  {
    const double hereRe = strength * gainRe;
    const double hereIm = strength * gainIm;
    const double middleRe = re + 0.5 * hereRe;
    const double middleIm = im + 0.5 * hereIm;
    re += hereRe;
    im += hereIm;
    return middleRe * middleRe + middleIm * middleIm;
  }
};

/// C / sqrt(1 + 8/3 u^2) (14.5), of C squared.
SONO_HD inline float harmonicGrowth(float sent, float doubled, double amount2)
{
  constexpr double depletion = 8.0 / 3.0;
  const double i1 = sentAtLeast(sent, doubled);
  const double ofSent2 = amount2 * double(doubled) / (i1 > 1e-300 ? i1 : 1e-300);
  return float(sqrt(amount2 / (1.0 + depletion * ofSent2)));
}

/// Of a sample of the boundary echoes, the bin whose harmonic it has: that of half of its range. What reverberates has
/// been reflected, a first multiple about halfway to where it is shown; behind that it is too weak to let its harmonic
/// grow.
SONO_HD inline int binOfEchoSample(int sample, double echoSampleMm, double binMm, int binCount)
{
  const int bin = int(0.5 * sample * echoSampleMm / binMm);
  return bin < binCount ? bin : binCount - 1;
}

} // namespace sono
