#pragma once

#include "Probe/PulseEchoField.h"
#include "Probe/ScanGeometry.h"

namespace sono {

/// Weight of each element, the same in transmit and receive.
enum class Apodization
{
  Boxcar, ///< 1
  Hann    ///< (1 + cos(2 pi x / A)) / 2, x from the aperture's centre, A its width
};

/// The active part of a one-dimensional array and what it sends: elements side by side along the lateral axis, focused
/// in the image plane by delays and across it by a lens.
struct ArrayAperture
{
  int elementCount = 64;          ///< active elements, 1 to 4096
  double elementWidthMm = 0.295;  ///< > 0; the aperture at most 1000 wavelengths wide and high
  double elementHeightMm = 14.0;  ///< > 0
  double kerfMm = 0.025;          ///< gap between elements, >= 0
  double faceRadiusMm = 0.0;      ///< of a convex face; 0: flat
  double transmitFocusMm = 65.0;  ///< > 0, infinity: not focused
  double elevationFocusMm = 60.0; ///< > 0, infinity: no lens
  Apodization apodization = Apodization::Boxcar;
  double centreFrequencyMHz = 3.6;                    ///< of the echo, > 0
  ImagingMode imagingMode = ImagingMode::Fundamental; ///< Harmonic, of ArrayField alone: half of that is sent
  double fractionalBandwidth = 0.0;                   ///< of the echo at -6 dB, [0, 2); 0: one frequency
  double attenuationDbPerCmMHz = 0.0; ///< one way, >= 0; leave at 0 where traced intensities carry it already
  double soundSpeedMmPerUs = 1.54;    ///< > 0

  int elevationCount = 1; ///< rows of elements across the plane, with the same kerf, 1 to 4096: those of a matrix,
                          ///< which are focused by delays as the others; one row is focused by its lens

  double elevationWidthMm() const { return elevationCount * elementHeightMm + (elevationCount - 1) * kerfMm; }
  double pitchMm() const { return elementWidthMm + kerfMm; }
  double widthMm() const { return elementCount * elementWidthMm + (elementCount - 1) * kerfMm; }
  double wavelengthMm() const { return soundSpeedMmPerUs / centreFrequencyMHz; }
  /// For callers that keep the field of each probe.
  bool operator==(const ArrayAperture& other) const;
  /// Throws Error naming the parameter and its range.
  void validate() const;
};

/// The aperture of a preset. A phased array sends with all elements; where a line takes a part of them (see
/// ScanKinds.h), it is those that make the transmit focus F/2. A matrix has as many elements along the array as across
/// it.
ArrayAperture apertureOf(const ProbePreset& preset);

/// A grid of 64 x 32 half-planes at 128 depths from 0 to depthMm that resolves the beam: four steps to lambda F# at the
/// transmit focus and at the elevation focus.
FieldGrid suggestedFieldGrid(const ArrayAperture& aperture, double depthMm);

} // namespace sono
