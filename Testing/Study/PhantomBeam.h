#pragma once

#include "PhantomImaging.h"

namespace sono::study {

/// Slope of the rms envelope of speckle with depth, dB/cm, in gel without wires under parallel Gaussian beams, whose
/// own level does not change with depth: least squares over 10 to 150 mm.
double speckleSlopeDbPerCm(int lines, unsigned seed);

/// The same of the traced intensity, which carries the attenuation: the round trip's amplitude.
double intensitySlopeDbPerCm();

/// Full widths at half maximum (-6 dB of the echo's amplitude) of a wire's echo, mm.
struct EchoWidth
{
  double lateralMm = 0.0;
  double axialMm = 0.0;
};

/// Of a wire on the axis at a depth, without speckle, lines 0.05 degrees apart.
EchoWidth wireEchoWidth(const PhantomImaging& imaging, double depthMm);

/// The closed form of the axial width for the Gaussian pulse (Data/docs/physics.md section 4): c sqrt(ln 2 / k) with
/// k = (pi f b)^2 / (4 ln 10^0.3).
double pulseWidthMm(double centreFrequencyMHz, double fractionalBandwidth);

} // namespace sono::study
