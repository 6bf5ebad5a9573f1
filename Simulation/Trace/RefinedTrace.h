#pragma once

#include "Trace/LineRounds.h"

namespace sono {

/// Lines traced in rounds until their picture is as exact as the settings' target error (Data/docs/physics.md 9.2).
///
/// The first round gives every line `firstPaths`; each further one doubles those of the lines that linesToDouble()
/// says, until it says none or all have the largest number of that kind within pathsPerLine. What a line got depends on
/// the arguments alone, not on the threads; what its paths leave is what a fixed number of as many leaves (LineRounds).
/// Without a target error, without chance, or where pathsPerLine is less than twice `firstPaths`, the first round is
/// all.
class RefinedTrace
{
public:
  /// With the first round. Throws as trace(); `progress` is that of all rounds, as far as is known.
  RefinedTrace(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
               const std::vector<TargetSurface>& targets, const Progress& progress);

  /// One more round; false, and nothing done, when it is as exact as it gets. Throws Aborted when asked to stop; then
  /// nothing but the destructor may be called.
  bool refine(const Progress& progress);
  /// As they are now: a picture that gets better with every round.
  TracedLines lines() const;
  TracedLines take();

private:
  bool mayDouble() const;
  Progress partOfRound(const Progress& progress) const;

  LineRounds rounds_;
  double targetDb_;
  int mostPaths_ = 0; ///< firstPaths times a power of two, or where there is one round its paths
  int roundCount_ = 1;
  int round_ = 0;
  std::vector<int> paths_;
  LineErrors errors_;
};

} // namespace sono
