#pragma once

#include "Core/Device.h"
#include "Core/Parameters.h"
#include "Core/SoundSpeed.h"
#include "Probe/ArrayField.h"
#include "Probe/PulseEchoField.h"
#include "Probe/PulseFile.h"
#include "Probe/ScanGeometry.h"

#include <cstdint>
#include <memory>

namespace sono {

/// What a line's beam is made of, where the probe names its aperture.
enum class BeamForm
{
  Gaussian, ///< of the aperture
  Computed  ///< the complex beam of its elements
};

/// The sampling frequency of RF lines that is asked for, or for 0 eight samples a period: against finer ones an
/// envelope of the usual bandwidths is then off by 0.2 dB (Data/docs/physics.md 4.2).
inline double rfSamplingMHz(double wantedMHz, double centreFrequencyMHz)
{
  return wantedMHz == 0.0 ? 8.0 * centreFrequencyMHz : wantedMHz;
}

struct EchoSettings
{
  Device device = Device::Auto;
  double centreFrequencyMHz = 2.5;  ///< that is received, > 0, below half the sampling frequency
  double fractionalBandwidth = 0.6; ///< of what is received, at -6 dB, (0, 2)
  /// Harmonic: half that frequency is sent, and the beam is made by the square of what is. A field and a pulse that are
  /// given count as they are.
  ImagingMode imagingMode = ImagingMode::Fundamental;
  double samplingMHz = 0.0; ///< RF sampling frequency, at most 1000; 0: that of rfSamplingMHz
  double depthMm = 160.0;   ///< > 0
  /// Of the probe: where it is named, the beam is that of its Gaussians, which widen in depth and are weaker to the
  /// side. Amadou2024's lines are not.
  BeamAperture aperture;
  BeamForm beam = BeamForm::Gaussian; ///< Computed: a simulator computes `arrayField` where it is not given
  double lateralSigmaMm = 1.0;        ///< Gaussian beam of one width, where there is no aperture
  double elevationalSigmaMm = 1.0;
  /// The beam's two-way weights instead of the Gaussian, of every line; aperture and sigmas are then not used. It must
  /// reach the image's depth. What lies in front of its first depth or beside it does not echo. Null: the Gaussian.
  std::shared_ptr<const PulseEchoField> field;
  /// The computed complex beam of the probe's elements instead, to the image's depth; there is then no `field`, and the
  /// sigmas are not used. Lines to the side are weaker by the aperture's directivity. Null: no such beam.
  std::shared_ptr<const ArrayField> arrayField;
  /// The pulse instead of the Gaussian, demodulated with the centre frequency and scaled to an envelope of peak 1; the
  /// fractional bandwidth is then not used. Null: the Gaussian.
  std::shared_ptr<const SampledPulse> pulse;
  /// The next two belong to Amadou2024; Acoustic takes levels and densities from the tissues' backscatter coefficients
  /// and the resolution cell (see NestedScatterers, ScattererDensity).
  double scattererCellMm = 0.5; ///< edge h of the scatterer cells; density is mu1 / h^3. Below half a wavelength cells
                                ///< are too regular for equal scatterers: their level falls
  double scattererLevelDb = -30.0; ///< rms echo of a tissue with mu1 = 1, mu0 = 1 against a perfect reflector across
                                   ///< the beam. With a field, both fall off alike in depth from its focus, where the
                                   ///< reflector's echo is 1 (see FieldLevel)
  std::uint64_t seed = 1;          ///< of the scatterers
  bool interactive = false; ///< for a probe that moves: on the CPU fewer scatterers and coarser surfaces (Policy.h)

  /// The parameters of the stage; depth, frequency and bandwidth come from the probe.
  template<class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor(self.beam,
            Parameter{ "beam",
                       "Beam",
                       {},
                       "What the beam is made of: Gaussians of the probe's aperture, or the complex sum over "
                       "its elements, with side lobes and finer speckle out of focus, at three times the "
                       "time. The latter needs a probe that names its aperture.",
                       { "Gaussian", "Computed" } });
    visitor(self.lateralSigmaMm,
            Parameter{ "lateralSigmaMm", "Lateral Sigma (mm)", aboveUpTo(0, 50),
                       "Standard deviation of the Gaussian beam along the array in mm, above 0 up to 50; of probes "
                       "that do not name their aperture, and of Amadou 2024." });
    visitor(self.elevationalSigmaMm,
            Parameter{ "elevationalSigmaMm", "Elevational Sigma (mm)", aboveUpTo(0, 50),
                       "Standard deviation of the Gaussian beam across the image plane in mm, above 0 up to 50; of "
                       "probes that do not name their aperture, and of Amadou 2024." });
    visitor(self.scattererLevelDb,
            Parameter{ "scattererLevelDb", "Scatterer Level (dB)", between(-200, 200),
                       "RMS echo of a tissue full of scatterers against a perfect plane reflector in dB, -200 to "
                       "200. For the model Amadou 2024 alone: Acoustic takes the tissues' backscatter coefficients." });
    visitor(self.scattererCellMm, Parameter{ "scattererCellMm", "Scatterer Cell (mm)", between(0.05, 10),
                                             "Edge h of the cells that hold one scatterer each in mm, 0.05 to 10; "
                                             "their density is mu1 / h^3. For the model Amadou 2024 alone: in "
                                             "Acoustic the density follows the beam." });
    visitor(self.device, deviceParameter());
    visitor(self.seed,
            Parameter{ "scattererSeed", "Scatterer Seed", atLeast(0),
                       "Seed of the scatterers, at least 0, no unit: the same seed gives the same speckle." });
  }
  /// Of the RF lines, which the tracer's boundary echoes share.
  template<class Self, class Visitor>
  static void visitSampling(Self& self, Visitor&& visitor)
  {
    visitor(
      self.samplingMHz,
      Parameter{ "samplingMHz", "Sampling (MHz)", between(0, 1000),
                 "Sampling frequency of the RF lines in MHz, up to 1000 and more than twice the centre frequency; "
                 "also that of the boundary echoes. 0: eight times the centre frequency, which pictures need." });
  }

  /// Throws Error naming the parameter and its range.
  void validate() const;
  double sentFrequencyMHz() const { return sentMHz(imagingMode, centreFrequencyMHz); }
  double samplingInMHz() const { return rfSamplingMHz(samplingMHz, centreFrequencyMHz); }
  /// Radial distance of two RF samples, mm.
  double sampleMm() const { return assumedSoundSpeedMmPerUs / (2.0 * samplingInMHz()); }
  int sampleCount() const;
};

} // namespace sono
