#pragma once

#include "Core/Progress.h"
#include "Echo/EchoSettings.h"
#include "Echo/PointScatterers.h"
#include "Probe/ScanGeometry.h"
#include "Scene/Scene.h"
#include "Trace/Trace.h"

#include <complex>
#include <vector>

// From traced lines to RF. A tissue's scatterers are never stored: they are generated brick by brick where a beam sees
// them, and bricks that neighbouring lines see are generated once for a group of them.
//
//   scatterers of the tissues            explicit scatterers
//   NestedScatterers (4^3 cells,         PointScatterers (sorted once)
//   density follows the beam's cell;
//   Amadou2024: TissueScatterers)
//           \                                  /
//            bricks that a beam sees: forSeenBricks, forBrickRows; with a field, FieldSight culls those that do not
//            matter
//                              |
//            LineSum: w a exp(-i 2k (r - r_s)) on the RF's samples (splat, BeamSplat.h), w the beam's weight
//                              |
//            LineFinisher:  times I(r) of the traced line
//                           plus the boundary echoes of the traced line, which carry their intensity already
//                           demodulated with the centre frequency
//                           convolved with the pulse's envelope (PulseKernel)
//                              |
//            RfLines: IQ of each line
//
// EchoSetup is made once for all lines; the CPU's loop over groups of lines is in FormRf.cpp, the GPU's in
// Cuda/DeviceEcho.cu. Both run the same kernels (Kernel/Scatterer.h, EchoSplat.h).

namespace sono {

/// RF lines as demodulated IQ: the real RF at range r is Re(iq exp(i 2 k r)), k = 2 pi f / c0; |iq| is the envelope.
struct RfLines
{
  int lineCount = 0;
  int sampleCount = 0;
  double sampleMm = 0.0; ///< sample s lies at range s * sampleMm
  double centreFrequencyMHz = 0.0;
  double samplingMHz = 0.0;
  std::vector<std::complex<float>> iq; ///< lineCount x sampleCount

  std::vector<float> rf() const;
  std::vector<float> envelope() const;
};

/// What formRf() will give, without its IQ.
RfLines rfLayout(int lineCount, const EchoSettings& settings);

/// What echoes, and how much of the pulse reaches it. Nothing is owned; null means none of it.
struct EchoSources
{
  const Scene* scene = nullptr;        ///< procedural, world-locked scatterers of its tissues
  const TracedLines* traced = nullptr; ///< intensity and boundary echoes; null: intensity 1 everywhere, no boundaries
  const PointScatterers* points = nullptr;             ///< explicit scatterers; their amplitudes are what they echo
  InterfaceModel model = InterfaceModel::Acoustic;     ///< of lines that are traced elsewhere; `traced` has its own
  const std::vector<TargetSurface>* targets = nullptr; ///< the same; null: none
};

/// COLE on the analytic signal (Data/docs/physics.md section 4; Gao 2009, Storve 2017): scatterers weighted by the beam
/// and the traced intensity, plus the traced boundary echoes, convolved with the pulse. What lies behind the transducer
/// does not echo. At 50 MHz the result is within 0.1 % (NRMSE) of the sum over all scatterers at their exact places:
/// each is split linearly between two samples, which costs a band b MHz wide about (b / samplingMHz)^2 of its
/// amplitude; that loss is undone on average over the places between two samples. On the CPU, whatever device the
/// settings name; the result depends on the arguments alone, to the bit, not on the threads. Throws Error naming the
/// parameter that is out of range, Aborted when asked to stop.
RfLines formRf(const EchoSources& sources, const std::vector<ScanLine>& lines, const EchoSettings& settings,
               const Progress& progress = {});

/// The usual case: a scene and its traced lines.
RfLines formRf(const Scene& scene, const std::vector<ScanLine>& lines, const TracedLines& traced,
               const EchoSettings& settings, const Progress& progress = {});

} // namespace sono
