#pragma once

#include "Trace/Deposit.h"
#include "Trace/ShownError.h"
#include "Trace/Trace.h"
#include "Trace/TraceSetup.h"

#include <memory>
#include <vector>

namespace sono {

struct LineSums;
struct TracedReverberation;

/// Lines that get their paths in rounds. What a line's paths leave depends on their number, not on the rounds: it is,
/// to the bit, what a single round of as many leaves, but for boundary echoes, which are so to within their rounding.
class LineRounds
{
public:
  /// Nothing is traced yet. Throws as trace().
  LineRounds(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
             const std::vector<TargetSurface>& targets, const Progress& progress);
  ~LineRounds();
  LineRounds(const LineRounds&) = delete;
  LineRounds& operator=(const LineRounds&) = delete;

  int mostPaths() const { return setup_.paths; }
  /// `lines`, ascending, then have `paths` each, by index, at least as many as before, and no fewer than batchCount
  /// where `more` rounds follow. Sums are kept only for these: 120 to 400 KB a line. Throws Aborted when asked to stop;
  /// then nothing but the destructor may be called.
  void trace(const std::vector<int>& lines, const std::vector<int>& paths, bool more, const Progress& progress);

  /// With the means of what was traced so far.
  const TracedLines& traced() const { return out_; }
  TracedLines take() { return std::move(out_); }
  const ShownCells& cells() const { return cells_; }

private:
  const TraceSetup setup_;
  const March march_;
  TracedLines out_;
  std::vector<LineSums> sums_; ///< of the lines, while more rounds follow
  std::unique_ptr<TracedReverberation> reverberation_;
  ShownCells cells_;
  EchoCells echoCells_;
};

} // namespace sono
