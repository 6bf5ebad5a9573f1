#pragma once

#include "Core/Parameters.h"
#include "Kernel/ApertureProfile.h"
#include "Probe/ScanGeometry.h"

namespace sono {

/// A line's beam of Gaussians (Data/docs/physics.md sections 12.1 and 12.3). The aperture must be named. `frequencyMHz`
/// is the probe's centre frequency. A point at the focus on the axis of a line straight ahead has the weight 1.
ApertureProfile apertureProfile(const BeamAperture& aperture, double frequencyMHz);
/// The same for one line: less by the elements' directivity, wider by the narrower aperture that is seen from there.
ApertureProfile steeredProfile(const ApertureProfile& straight, const BeamAperture& aperture, double frequencyMHz,
                               const ScanLine& line);

/// The depth where the transmitted beam is narrowest: that of the transmit focus, else of the elevation focus, else
/// where the aperture's far field begins, D^2 / (4 lambda).
double focusDepthMm(const BeamAperture& aperture, double frequencyMHz);

/// How narrow the aperture looks along a line that is steered: squared cosines, along the array and across it.
Vec2d apertureCosines2(const ScanLine& line);

/// Two-way amplitude of an element that is seen along a line, 1 straight ahead: sinc and cosine, both squared (12.3).
double directivity(const BeamAperture& aperture, double frequencyMHz, const ScanLine& line);

} // namespace sono
