#pragma once

#include "Echo/BeamSplat.h"
#include "Echo/FieldLevel.h"
#include "Echo/FormRf.h"
#include "Echo/Pulse.h"
#include "Echo/ReverberationSpeckle.h"
#include "Echo/SampleLoops.h"
#include "Kernel/SurfaceEcho.h"
#include "Kernel/TimeOfFlight.h"

#include <complex>
#include <optional>
#include <vector>

namespace sono {

/// Turns a line's scatterer sum, by depth, into IQ, by range: times the traced intensity, moved to the range at which a
/// depth is shown, plus the traced boundary echoes (times the level of the field at their depth, where there is one),
/// convolved with the pulse, whose frequency sinks where the traced lines attenuate (not in Amadou2024, and not for a
/// pulse from a file). What is summed by range goes half a pulse deeper than the line, since what lies there still
/// echoes into it; what is summed by depth as much deeper again as sound may be faster than assumed.
class LineFinisher
{
public:
  /// `traced` may be null (intensity 1, no boundaries); it must outlive this. `level` is that of the settings' field,
  /// null for a Gaussian beam. Throws Error when the sampling cannot carry the pulse.
  LineFinisher(const EchoSettings& settings, InterfaceModel model, const TracedLines* traced, const FieldLevel* level,
               ReverberationSpeckle speckle);

  int sumCount() const { return int(sumCount_); } ///< samples by depth
  int rangeCount() const { return rangeCount_; }  ///< samples by range
  double radPerMm() const { return radPerMm_; }
  const PulseKernel& pulse() const { return pulse_; }
  LineSum emptySum() const;
  /// Depth, mm, below which scatterers cannot be seen in this line.
  float reachMm(int line) const;
  /// What the tracer knows of a line.
  SurfaceIntensity intensity(int line) const;
  /// A sum by range with the traced boundary echoes of a line, times the field's level, phases kept.
  LineSum boundaryEchoes(int line) const;
  const ReverberationSpeckle& reverberation() const { return speckle_; }
  /// What the lines share of its noise: nothing where none reverberates.
  ReverberationNodes reverberationNodes() const;
  /// Room for finish(), to be used again; `late` is zero.
  struct Room
  {
    std::vector<float> tableByDepth, depthRe, depthIm;
    std::vector<float> offset, exponent, table, re, im, lateRe, lateIm, turnRe, turnIm, far; ///< by range
    std::vector<float> outRe, outIm;
    std::vector<float> levels; ///< by bin
  };
  Room room() const;
  /// Writes the settings' sampleCount() samples. `surfaces`, which may be null, carries its intensity already.
  void finish(int line, const LineSum& sum, const LineSum* surfaces, const ReverberationNodes& nodes, Room& room,
              std::complex<float>* iq) const;

private:
  RangeMap rangeMap(int line) const;
  void addReflected(int line, Room& room, const SamplePair& heard) const;
  void addReverberating(int line, const ReverberationNodes& nodes, Room& room, std::complex<float>* iq) const;
  /// What the media take of what has been reflected, Np per MHz in each bin; null where the frequency stays.
  const float* reflectedNp(int line) const;
  bool hasBoundaryEchoes(int line) const;
  /// Samples of depth, at least one, behind which nothing is heard, and of range that show so many.
  int heardDepths(int line, const LineSum* surfaces) const;
  int rangesOf(const RangeMap& map, int depths) const;
  bool reverberates(int line) const;
  bool sinks(int line) const;

  const TracedLines* traced_;
  int samples_;
  double sampleMm_;
  double radPerMm_;
  PulseKernel pulse_;
  std::vector<float> boundaryLevel_; // at each sample of the traced echoes; empty: 1
  int rangeCount_;
  std::size_t sumCount_;
  Carrier carrier_;      // of the demodulation, for each sample of range
  double binsPerSample_; // of the traced lines
  ReverberationSpeckle speckle_;
  std::optional<Downshift> downshift_; // nothing where the frequency stays
};

} // namespace sono
