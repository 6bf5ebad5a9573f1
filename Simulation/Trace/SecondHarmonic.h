#pragma once

#include "Probe/ScanGeometry.h"
#include "Scene/Scene.h"
#include "Trace/Trace.h"

#include <complex>
#include <vector>

namespace sono {

// The second harmonic along scan lines (Data/docs/physics.md section 14.2), out of two traces: at the frequency that is
// sent and at its double.

/// What a probe sends.
struct SentSound
{
  double frequencyMHz;
  double facePressureKPa;
};

/// How the harmonic grows, 1/mm: dp2/dr = S p1^2 of pressures p / sqrt(Z) as shares of the one that is sent,
///   S = beta pi f p0 / (c^2 sqrt(Z Z0)),   Z0 the impedance at the face                                        (14.3)
double harmonicSourcePerMm(const Tissue& tissue, double faceMRayl, const SentSound& sent);

/// The trace at the frequency that is sent, of which the intensity alone counts.
TraceSettings sentTone(TraceSettings settings);

/// The same trace at twice the frequency.
TraceSettings doubledTone(TraceSettings settings);

/// S in the middle of each bin of the lines' axes, lines x binCount, where the label map has another tissue than the
/// outside one; 0 elsewhere. The face is in the first one.
std::vector<float> harmonicSources(const Scene& scene, const std::vector<ScanLine>& lines,
                                   const TraceSettings& settings);

/// G in the middle of each bin (see sentGain).
std::vector<std::complex<double>> sentGains(const TraceSettings& settings);

/// `doubled`, whose intensities, and errors with them, are multiplied by how much of the harmonic has grown there:
///   J(r) = I2(r) C / sqrt(1 + 8/3 u^2),   C(r) = |integral of S G I1 / sqrt(I2) dz|,   u = C sqrt(I2 / I1)     (14.5)
/// the amplitude of echoes at twice the frequency, relative to that which a perfect mirror has of the frequency sent,
/// for a beam whose amplitude goes with depth as the one sent (BeamModel's). u is p2/p1 as if p1 lost nothing; the root
/// is what it loses, to the third order of Fubini's series, and keeps p2 below 0.61 p1.
///
/// Both traces must be of the same lines and bins, and attenuation must grow no faster than with the frequency, as that
/// of all tissues here. Then I2 <= I1 and, by Schwarz' inequality over the paths, I1^2 <= I2; where few paths say
/// otherwise, in shadows, they are taken as if it were so. Where I2 is below -200 dB, B is 0.
TracedLines secondHarmonic(const TracedLines& sent, TracedLines doubled, const std::vector<float>& sourcesPerMm,
                           const std::vector<std::complex<double>>& gains);

} // namespace sono
