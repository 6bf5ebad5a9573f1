#pragma once

#include "Image/BModeSettings.h"
#include "Probe/ImagingMode.h"

#include <vector>

namespace sono {

/// The power of haze at equidistant nodes of each line; see hazyEnvelope.
struct HazePower
{
  std::vector<float> power; ///< lines x nodeCount; empty: no haze
  int nodeCount = 0;
  float nodesPerSample = 0.0f;
};

/// What the body wall's reverberation adds (Data/docs/physics.md section 14.1): many weak arrivals, so that power adds,
///   10^((hazeDb - hazeFallDbPerCmMHz frequency depth + hazeVariationDb n) / 10) / its mean over n,
/// with n a smooth standard normal field of (noiseSeed, place): cells of 0.8 mm along the lines and of 1/75 of the
/// lines across, the same in all planes of a matrix. Nothing where haze is not asked for.
/// In a harmonic picture the haze is what of the harmonic has grown before its first echo in the body wall, of which
/// the first 10 mm count: times (growth min(depth, 10 mm))^2 / 3, the mean over where in the wall that echo lies.
HazePower makeHaze(const BModeSettings& settings, int lineCount, int sampleCount, double sampleMm);

/// How a harmonic picture's haze grows in a body wall of fat and muscle, share of what is sent per mm (see
/// harmonicSourcePerMm); 0 of the fundamental. What is sent: MHz, and the pressure at the face.
double bodyWallGrowthPerMm(ImagingMode mode, double sentMHz, double facePressureKPa);

} // namespace sono
