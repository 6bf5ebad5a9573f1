#pragma once

#include "Core/Progress.h"
#include "Probe/ScanGeometry.h"
#include "Scene/Scene.h"
#include "Trace/Targets.h"
#include "Trace/TraceSettings.h"

#include <complex>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace sono {

/// Where the values of a traced array lie along a line.
enum class TracedAxis
{
  Bins,      ///< of depth
  RangeBins, ///< as many, by range, or none
  EchoSamples
};

/// What the tracer gives: for each line and radial bin the mean one-way intensity (1 at the transducer) and its
/// Monte-Carlo standard error; the attenuation of what arrives there; and boundary echoes, of Amadou2024 all, of
/// Acoustic those that were reflected before, as complex amplitudes on the echo grid: an echo of amplitude A at range r
/// adds A exp(-i 2 k (r - r_s)), split linearly between the two nearest samples s, k = 2 pi f / c0.
struct TracedLines
{
  InterfaceModel model = InterfaceModel::Acoustic; ///< what it was traced with; boundaries echo in Amadou2024 alone
  int lineCount = 0;
  int binCount = 0;
  double binMm = 0.0;               ///< bin b covers [b, b+1) * binMm of depth
  std::vector<float> intensity;     ///< lineCount x binCount
  std::vector<float> standardError; ///< lineCount x binCount
  /// lineCount x binCount: the two-way exponent of the amplitude per MHz, B in exp(-B f), mean over the paths weighted
  /// as the intensity is; 0 where nothing arrives, and in Amadou2024, whose pulse keeps its frequency. Empty: not
  /// known.
  std::vector<float> attenuationNpPerMHz;
  /// lineCount x binCount: depth less range in mm, of what lies on the line's axis and is shown at the range b binMm,
  /// in between as RangeMap has it (Data/docs/physics.md 13.1). Empty: range is depth, as in Amadou2024, or of no
  /// interest, as where the intensity alone is asked for.
  std::vector<float> depthOffsetMm;
  /// lineCount x binCount, by range, in the middles of bins: level of the speckle that reverberates, amplitude against
  /// soft tissue's of 5e-4 /(cm sr) at intensity 1, and its Monte-Carlo standard error (13.2). Empty: nothing does.
  std::vector<float> reverberation;
  std::vector<float> reverberationError;
  /// The same as attenuationNpPerMHz of what reverberates, boundary echoes included.
  std::vector<float> reverberationNpPerMHz;
  int echoCount = 0;                             ///< 0: none, as of Acoustic without reverberation
  double echoSampleMm = 0.0;                     ///< sample s lies at s * echoSampleMm
  std::vector<std::complex<float>> boundaryEcho; ///< lineCount x echoCount
  std::uint64_t segments = 0;                    ///< path segments traced
  int paths = 0;                                 ///< of each line
  double errorDb = 0.0; ///< of the picture, where it was asked for (see RefinedTrace.h); 0: not known
  std::shared_ptr<const std::vector<TargetSurface>> targets; ///< that it was traced with; null: none

  /// The arrays of bins that paths leave, with the names that they have in a pipeline, in the order of BinArray
  /// (Trace/TracedBin.h).
  template<class Self, class Visitor>
  static void visitBins(Self& self, Visitor&& visitor)
  {
    visitor(self.intensity, "Intensity");
    visitor(self.standardError, "StandardError");
    visitor(self.attenuationNpPerMHz, "AttenuationNpPerMHz");
  }
  /// All arrays with their names and places there.
  template<class Self, class Visitor>
  static void visitArrays(Self& self, Visitor&& visitor)
  {
    visitBins(self, [&](auto& values, const char* name) { visitor(values, name, TracedAxis::Bins); });
    visitor(self.depthOffsetMm, "DepthOffsetMm", TracedAxis::RangeBins);
    visitor(self.reverberation, "Reverberation", TracedAxis::RangeBins);
    visitor(self.reverberationError, "ReverberationError", TracedAxis::RangeBins);
    visitor(self.reverberationNpPerMHz, "ReverberationNpPerMHz", TracedAxis::RangeBins);
    visitor(self.boundaryEcho, "BoundaryEcho", TracedAxis::EchoSamples);
  }
};

/// What trace() will give, without its arrays. Throws Error when it would not fit.
TracedLines tracedLayout(int lineCount, const TraceSettings& settings, const std::vector<TargetSurface>& targets = {});

struct LineMeans;
class LineTally;
struct TraceSetup;

/// Traces every line on the CPU in rounds, whatever device the settings name. So many paths in rounds leave what as
/// many at once do, but for rounding. The result depends on the arguments alone, to the bit, not on the threads.
class TraceRounds
{
public:
  /// Nothing is traced yet. Throws Error when no line meets the volume or a target is not closed, Aborted when asked to
  /// stop. The scene must live as long.
  TraceRounds(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
              const std::vector<TargetSurface>& targets, const Progress& progress);
  ~TraceRounds();
  TraceRounds(const TraceRounds&) = delete;
  TraceRounds& operator=(const TraceRounds&) = delete;

  /// Until each line has had `paths`, more than before. Where `more` are to follow, the first round has at least
  /// batchCount, and what a line has left is kept, 100 to 200 KB each. Throws Aborted when asked to stop; then nothing
  /// but the destructor may be called.
  void traceTo(int paths, bool more, const Progress& progress);
  /// Of these lines alone, by their numbers, all the paths at once, once a line: what traceTo() gives of them, where
  /// nothing reverberates. What others would leave is 0.
  void traceLines(const std::vector<int>& lines, int paths, const Progress& progress = {});
  const TracedLines& traced() const { return out_; }
  TracedLines take() { return std::move(out_); }

private:
  LineTally makeTally() const;

  std::unique_ptr<const TraceSetup> setup_;
  March march_;
  TracedLines out_;
  std::vector<LineMeans> earlier_; ///< of each line; empty: there is one round
};

/// One round of all the settings' paths, whatever error they ask for. Throws as TraceRounds.
TracedLines trace(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                  const Progress& progress = {}, const std::vector<TargetSurface>& targets = {});

} // namespace sono
