#pragma once

#include "Core/Parameters.h"
#include "Kernel/ApertureProfile.h"
#include "Probe/ScanGeometry.h"

#include <complex>

namespace sono {

/// A line's beam of Gaussians (Data/docs/physics.md sections 12.1 and 12.3). The aperture must be named. `frequencyMHz`
/// is what the probe receives. A point at the focus on the axis of a line straight ahead has the weight 1.
///
/// Of a harmonic the beam that is sent is the square of the one of half the frequency: 1/sqrt(2) as wide. A lens, whose
/// two ways are then not alike, gets one Gaussian for both that has their product at the face and at the focus; between
/// them the product is up to 6 % narrower than right, and 0.3 dB stronger.
ApertureProfile apertureProfile(const BeamAperture& aperture, double frequencyMHz,
                                ImagingMode mode = ImagingMode::Fundamental);
/// The same for one line: less by the elements' directivity, wider by the narrower aperture that is seen from there.
ApertureProfile steeredProfile(const ApertureProfile& straight, const BeamAperture& aperture, double frequencyMHz,
                               const ScanLine& line, ImagingMode mode = ImagingMode::Fundamental);

/// Pressure of the transmitted beam on its axis, 1 at the face: per axis 1 / sqrt(q), q = 1 - z/F - i lambda z/(pi
/// W_a^2), so that |q| = W/W_a of (12.2). Where no aperture is named, the plane wave's: 1. `frequencyMHz` is sent.
std::complex<double> sentGain(const BeamAperture& aperture, double frequencyMHz, double depthMm);

/// The depth where the transmitted beam, of `frequencyMHz`, is narrowest: that of the transmit focus, else of the
/// elevation focus, else where the aperture's far field begins, D^2 / (4 lambda).
double focusDepthMm(const BeamAperture& aperture, double frequencyMHz);

/// How narrow the aperture looks along a line that is steered: squared cosines, along the array and across it.
Vec2d apertureCosines2(const ScanLine& line);

/// Two-way amplitude of an element that is seen along a line, 1 straight ahead: sinc and cosine, both squared (12.3);
/// of a harmonic, squared at half the frequency, times once at the one that is received.
double directivity(const BeamAperture& aperture, double frequencyMHz, const ScanLine& line,
                   ImagingMode mode = ImagingMode::Fundamental);

} // namespace sono
