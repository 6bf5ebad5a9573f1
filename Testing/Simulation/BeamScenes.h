#pragma once

#include "FieldScenes.h"
#include "Folders.h"

#include "Probe/ScanGeometry.h"

#include <array>
#include <cmath>
#include <utility>

namespace sono::test {

constexpr double halfWidth = 2.3548200450309493; // 2 sqrt(2 ln 2): of a Gaussian, in sigmas

/// (depth, width at half height of the lateral autocorrelation of speckle), mm, of the P4-2: the broadband sum over its
/// elements, Data/docs/physics.md section 12.2.
constexpr std::array<std::pair<double, double>, 4> elementSpeckleWidths{
  { { 30.0, 0.93 }, { 60.0, 1.58 }, { 90.0, 2.44 }, { 120.0, 3.55 } }
};

inline ProbePreset p42()
{
  return readProbePreset(dataFile("probes/phased_p4-2.json"));
}

/// Image formation with the probe's pulse and aperture.
inline EchoSettings echoOf(const ProbePreset& preset, double depthMm)
{
  EchoSettings s;
  s.centreFrequencyMHz = preset.centreFrequencyMHz;
  s.fractionalBandwidth = preset.fractionalBandwidth;
  s.depthMm = depthMm;
  s.aperture = preset.aperture();
  return s;
}

/// Width at half height of the lateral autocorrelation of uniform speckle around a depth: that of a point's echoes on
/// parallel lines, summed over depth.
inline double speckleWidthMm(const EchoSettings& s, double depthMm)
{
  const int lineCount = 301;
  const double pitchMm = depthMm / 1200.0;
  const auto lines = parallelLines(lineCount, { -0.5 * (lineCount - 1) * pitchMm, 0.0, 0.0 }, pitchMm);
  const PointScatterers point({ { { 0.0, 0.0, depthMm }, 1.0f } });
  const RfLines rf = formRf({ nullptr, nullptr, &point }, lines, s);
  const int first = std::max(0, int((depthMm - 6.0) / rf.sampleMm));
  const int last = std::min(rf.sampleCount, int((depthMm + 6.0) / rf.sampleMm));
  double before = 1.0;
  double zero = 0.0;
  for (int shift = 0; shift < lineCount; ++shift)
  {
    std::complex<double> sum;
    for (int l = 0; l + shift < lineCount; ++l)
    {
      const auto* a = rf.iq.data() + std::size_t(l) * std::size_t(rf.sampleCount);
      const auto* b = rf.iq.data() + std::size_t(l + shift) * std::size_t(rf.sampleCount);
      for (int n = first; n < last; ++n)
      {
        sum += std::complex<double>(a[n]) * std::conj(std::complex<double>(b[n]));
      }
    }
    zero = shift == 0 ? std::abs(sum) : zero;
    const double level = std::abs(sum) / zero;
    if (level <= 0.5)
    {
      return 2.0 * pitchMm * (shift - (0.5 - level) / (before - level));
    }
    before = level;
  }
  return 0.0;
}

} // namespace sono::test
