#pragma once

#include "Echo/EchoSettings.h"
#include "TraceByMode.h"

#include <chrono>

namespace sono {

/// Lines traced in rounds until their picture is as exact as the settings want (Data/docs/physics.md 9.2): the first
/// gives every line 64 paths, each further one as many again.
///
/// How exact the picture is, is seen in it: the envelopes of some of the lines, of the scene's own speckle under the
/// usual pulse, change by D dB (changeDb) from n1 to n2 paths. The error's square falls as 1 / n, and the n2 hold the
/// n1, so D^2 is the difference of both squares, and what is left is
///
///     e = D sqrt(n1 / (n2 - n1))                                                                               (9.1)
///
/// One change may by chance be small where few paths tell much: e^2 is the mean of this and of what the rounds before
/// make expect, their e^2 times n1 / n2.
///
/// With a target error alone the result depends on the arguments alone, not on the threads. For one thread at a time.
class RefinedTrace
{
public:
  /// With the first round; settings.refines() must hold. Throws as trace(). The scene must live as long.
  RefinedTrace(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
               const std::vector<TargetSurface>& targets, const Progress& progress);

  /// One more round; false, and nothing done, when it is as exact as it is wanted or may get. Throws Aborted when asked
  /// to stop; then there is no further round.
  bool refine(const Progress& progress);
  /// After the last round; its numbers say how many paths lines had and how exact their picture is.
  const TracedResult& result() const { return result_; }

private:
  using Clock = std::chrono::steady_clock;

  int nextPaths() const;
  void traceTo(int paths, const Progress& progress);
  double errorOf(const TracedLines& traced, int paths);

  const Scene& scene_;
  const TraceSettings settings_;
  const Clock::time_point start_;
  PathRounds rounds_;
  EchoSettings shown_;
  std::vector<std::size_t> indices_; ///< of the lines that are looked at
  std::vector<ScanLine> lines_;      ///< these
  std::vector<float> envelope_;      ///< of them, after the last round
  TracedResult result_;
  int paths_ = 0;
  double errorDb_ = 0.0; ///< 0: not known yet
  double secondsPerPath_ = 0.0;
  double done_ = 0.0; ///< of the progress
};

/// Of two envelopes of as many samples, rms dB over what is above -60 dB of the peak, the level that 0.5 % of the
/// second exceed; what lies below counts as -60 dB.
double changeDb(const std::vector<float>& before, const std::vector<float>& now);

} // namespace sono
