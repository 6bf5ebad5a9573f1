#pragma once

#include "Device.h"
#include "Echo/PointScatterers.h"
#include "Probe/PulseEchoField.h"
#include "Probe/PulseFile.h"
#include "Probe/ScanGeometry.h"
#include "Progress.h"
#include "Scene/Scene.h"
#include "Trace/Trace.h"

#include <complex>
#include <cstdint>
#include <memory>
#include <vector>

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

/// RF lines as demodulated IQ: the real RF at depth r is Re(iq exp(i 2 k r)), k = 2 pi f / c0; |iq| is the envelope.
struct RfLines
{
  int lineCount = 0;
  int sampleCount = 0;
  double sampleMm = 0.0; ///< sample s lies at depth s * sampleMm
  double centreFrequencyMHz = 0.0;
  double samplingMHz = 0.0;
  std::vector<std::complex<float>> iq; ///< lineCount x sampleCount

  std::vector<float> rf() const;
  std::vector<float> envelope() const;
};

/// What echoes, and how much of the pulse reaches it. Nothing is owned; null means none of it.
struct EchoSources
{
  const Scene* scene = nullptr;        ///< procedural, world-locked scatterers of its tissues
  const TracedLines* traced = nullptr; ///< intensity and boundary echoes; null: intensity 1 everywhere, no boundaries
  const PointScatterers* points = nullptr; ///< explicit scatterers; their amplitudes are not scaled by scattererLevelDb
};

/// COLE on the analytic signal (PHYSICS section 4; Gao 2009, Storve 2017): scatterers weighted by the beam and the
/// traced intensity, plus the traced boundary echoes, convolved with the pulse. What lies behind the transducer does
/// not echo. At 50 MHz the result is within 0.1 % (NRMSE) of the sum over all scatterers at their exact places: each is
/// split linearly between two samples, which costs a band b MHz wide about (b / samplingMHz)^2 of its amplitude; that
/// loss is undone on average over the places between two samples. The result depends on the arguments and the
/// device alone, to the bit, not on the threads. Throws Error naming the parameter that is out of range, Aborted when asked to stop.
RfLines formRf(const EchoSources& sources, const std::vector<ScanLine>& lines, const EchoSettings& settings,
               const Progress& progress = {});

/// The usual case: a scene and its traced lines.
RfLines formRf(const Scene& scene, const std::vector<ScanLine>& lines, const TracedLines& traced,
               const EchoSettings& settings, const Progress& progress = {});

} // namespace sono
