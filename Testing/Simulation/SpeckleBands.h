#pragma once

#include "BeamScenes.h"

#include "Trace/Trace.h"

#include <cmath>
#include <numeric>
#include <vector>

namespace sono::test {

/// Envelope SNR of uniform tissue around a depth.
struct SpeckleBand
{
  double depthMm;
  double snr;
  double independentSamples; ///< lines times bandMm over the correlation length of the intensity along the line
  double deviation() const { return 1.36 / std::sqrt(independentSamples); } ///< of such an SNR, Rayleigh's moments
};

constexpr double speckleBandMm = 20.0;

/// At 30, 60, 90 and 120 mm of uniform tissue under the P4-2's beams, traced and with its downshift, by 1296 lines 6.4
/// mm apart, which is more than a speckle. Envelopes are divided by their root mean square over all lines within 0.5 mm
/// of depth, since attenuation and focus change the level within a band.
inline std::vector<SpeckleBand> speckleBands(Tissue tissue)
{
  constexpr int side = 36;
  constexpr double pitchMm = 6.4;
  tissue.roughnessMm = 0.0;
  const EchoSettings s = echoOf(p42(), 132.0);
  const int edge = int(std::ceil((side * pitchMm + 24.0) / 2.0));
  const auto scene = makeScene({ edge, edge, 70 }, Vec3d(2.0), { tissue }, [](const Vec3d&) { return 0; });
  std::vector<ScanLine> lines;
  for (int l = 0; l < side * side; ++l)
  {
    lines.push_back(
      { { 15.0 + pitchMm * (l % side), 15.0 + pitchMm * (l / side), 0.5 }, { 0, 0, 1 }, { 1, 0, 0 }, { 0, 1, 0 } });
  }
  TraceSettings tracing;
  tracing.frequencyMHz = s.centreFrequencyMHz;
  tracing.depthMm = s.depthMm;
  tracing.pathsPerLine = 1; // there is no boundary to meet
  const RfLines rf = formRf(*scene, lines, trace(*scene, lines, tracing), s);
  // |exp(-r^2 / (4 s_r^2))|^2, integrated.
  const double independentMm = std::sqrt(2.0 * M_PI) * pulseSigmaMm(s.centreFrequencyMHz, s.fractionalBandwidth);
  std::vector<SpeckleBand> bands;
  for (const double depthMm : { 30.0, 60.0, 90.0, 120.0 })
  {
    const int first = int((depthMm - 0.5 * speckleBandMm) / rf.sampleMm);
    const int count = int(speckleBandMm / rf.sampleMm);
    std::vector<double> power(std::size_t(count), 0.0);
    std::vector<double> envelope(std::size_t(count), 0.0);
    for (int l = 0; l < rf.lineCount; ++l)
    {
      for (int n = 0; n < count; ++n)
      {
        const double squared = std::norm(rf.iq[std::size_t(l) * std::size_t(rf.sampleCount) + std::size_t(first + n)]);
        power[std::size_t(n)] += squared / rf.lineCount;
        envelope[std::size_t(n)] += std::sqrt(squared) / rf.lineCount;
      }
    }
    const int beside = int(0.5 / rf.sampleMm);
    double mean = 0.0;
    for (int n = beside; n < count - beside; ++n)
    {
      const auto from = power.begin() + (n - beside);
      const double around = std::accumulate(from, from + (2 * beside + 1), 0.0) / (2 * beside + 1);
      mean += envelope[std::size_t(n)] / std::sqrt(around) / (count - 2 * beside);
    }
    // Of a mean square of 1.
    bands.push_back({ depthMm, mean / std::sqrt(1.0 - mean * mean), rf.lineCount * speckleBandMm / independentMm });
  }
  return bands;
}

} // namespace sono::test
