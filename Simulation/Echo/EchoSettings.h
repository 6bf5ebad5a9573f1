#pragma once

#include "Core/Device.h"
#include "Core/SoundSpeed.h"
#include "Probe/PulseEchoField.h"
#include "Probe/PulseFile.h"

#include <cstdint>
#include <memory>

namespace sono {

struct EchoSettings
{
  Device device = Device::Auto;
  double centreFrequencyMHz = 2.5;  ///< > 0, below half the sampling frequency
  double fractionalBandwidth = 0.6; ///< at -6 dB, (0, 2)
  double samplingMHz = 50.0;        ///< RF sampling frequency
  double depthMm = 160.0;           ///< > 0
  double lateralSigmaMm = 1.0;      ///< Gaussian beam, > 0
  double elevationalSigmaMm = 1.0;  ///< > 0
  /// The beam's two-way weights instead of the Gaussian, of every line; the sigmas are then not used. It must reach
  /// the image's depth. What lies in front of its first depth or beside it does not echo. Null: the Gaussian.
  std::shared_ptr<const PulseEchoField> field;
  /// The pulse instead of the Gaussian, demodulated with the centre frequency and scaled to an envelope of peak 1; the
  /// fractional bandwidth is then not used. Null: the Gaussian.
  std::shared_ptr<const SampledPulse> pulse;
  double scattererCellMm = 0.5; ///< edge h of the scatterer cells; density is mu1 / h^3. Below half a wavelength cells
                                ///< are too regular for equal scatterers: their level falls
  double scattererLevelDb = -30.0; ///< rms echo of a tissue with mu1 = 1, mu0 = 1 against a perfect reflector across
                                   ///< the beam. With a field, both fall off alike in depth from its focus, where the
                                   ///< reflector's echo is 1 (see FieldLevel)
  std::uint64_t seed = 1;          ///< of the scatterers

  /// Throws Error naming the parameter and its range.
  void validate() const;
  /// Radial distance of two RF samples, mm.
  double sampleMm() const { return assumedSoundSpeedMmPerUs / (2.0 * samplingMHz); }
  int sampleCount() const;
};

} // namespace sono
