#pragma once

#include "Kernel/ArrayBeam.h"
#include "Trace/Rod.h"

#include <complex>
#include <vector>

namespace sono {

struct EchoSettings;

/// What comes straight back from a rod, against the echo of its front as a surface of the same reflection, as seen from
/// that front, for exp(i w t): 1 and what rings (Faran 1951, "Sound scattering by solid cylinders and spheres").
std::complex<double> rodEcho(const Rod& rod, double frequencyMHz);

/// The same in time without the 1, as far as a pulse has it: what follows each echo of the rod's surface on a line.
/// Tap j lies (j - lead) * stride samples later.
struct RodRing
{
  std::vector<ComplexWeight> taps; ///< empty: it does not ring
  int stride = 1;
  int lead = 0;
};

/// 12 mm of it, of which the last 8 fade. Those made last are kept.
RodRing rodRing(const Rod& rod, const EchoSettings& settings);

/// Adds to a line, re and im of each sample, what follows the surface's echoes on `surface`, and these.
void addRung(const RodRing& ring, const std::vector<float>& surface, std::vector<float>& line);

} // namespace sono
