#pragma once

#include "Kernel/BeamDeposit.h"
#include "Kernel/PathState.h"
#include "Kernel/Reverberation.h"
#include "Kernel/TraceView.h"
#include "Trace/TracedBin.h"
#include "Trace/TracedReverberation.h"

#include <array>
#include <complex>
#include <vector>

namespace sono {

/// What the media have taken of what reverberates on a line.
struct AbsorbedByBin
{
  std::vector<AbsorbedSums> tissue; ///< before its echoes, by TissueBins
  std::vector<AbsorbedSums> boundaries;
};

/// What the paths of one line leave on its main beam, on the CPU. A path deposits where it crosses the plane at r,
/// whatever its slope: I(r) is the sum of I w_R over those crossings, averaged over each radial bin. Beside it stand
/// the other sums of TracedBin.h. In Acoustic a path that has been reflected deposits by range instead, see
/// Reverberation.h.
class LineTally : public PathSink
{
public:
  /// `sums`: the first so many of the sums are kept, the others are 0 (see binSumsOf).
  LineTally(int binCount, double binMm, int sums, int echoCount, double echoSampleMm, double wavesPerMm);

  /// From now on paths are those of this line, whose arrays must outlive them; `lineKey` is that of its PathKeys.
  void begin(const TraceView& view, const TraceLine& axis, std::uint32_t lineKey, const StraightWay& way);
  /// From now on depths and distances are seen from this line.
  void start(const TraceLine& line, float coherenceMm);

  /// Deposits of echoes are multiplied by this (1 for what all paths share, 1 / N for each path).
  void setEchoWeight(float weight) { echoWeight_ = weight; }

  void segment(const PathSegment& s);
  /// The same of so many paths that follow one way, none of which has been reflected.
  void sharedSegments(const std::vector<PathSegment>& segments, int paths);
  void echo(const Vec3f& point, float amplitude);
  void arrives(const PathState& path, const PathBoundary& boundary);
  std::uint64_t segments() const { return segments_; }

  /// To be called after `pathsPerFold` paths.
  void fold();

  /// What was left in each bin, of each of `paths` paths, and forgets it.
  std::vector<BinSums<double>> takeBins(int paths);
  /// Whether anything of the line has reverberated so far.
  bool hasReverberated() const { return reverberated_ || lastEcho_ >= 0; }
  /// What reverberated in each of the TissueBins, mean of `paths` paths, and forgets it; empty: nothing has.
  std::vector<ReverberationSums> takeReverberation(int paths);
  /// What the media have taken of what reverberated, Np, by radial bin, and forgets it. To `earlier`, unless it is
  /// null, it is added before.
  std::vector<float> takeReverberatedNp(AbsorbedByBin* earlier);
  /// Adds the boundary echoes to a line's samples and forgets them.
  void takeEchoes(std::complex<float>* samples);

private:
  void addEcho(float rangeMm, float amplitude);
  void addReverberation(const PathSegment& s);
  /// Before the line's first reverberation.
  void findCells();
  /// What the media have taken of an echo whose levels are in `tissueLevels_`.
  void absorb(const TissueEcho& echo, const DepthSpan& span, const BinSpan& bins);
  template<int Sums>
  void deposit(const BeamSegment& g, const DepthSpan& span);

  int binCount_;
  int sums_;
  std::array<std::vector<float>, binSumCount> bins_;     ///< of the paths since the last fold
  std::array<std::vector<double>, binSumCount> binSums_; ///< of those before
  TissueBins tissueBins_;
  std::vector<ReverberationSums> reverberation_; ///< of the paths since it was taken
  bool reverberated_ = false;                    ///< since the line began
  AbsorbedByBin absorbed_;
  std::vector<float> cellMm_;       ///< see resolutionCell, in the middle of each bin; of a line that has reverberated
  std::vector<float> tissueLevels_; ///< of one echo, by bin from the first that it covers
  std::vector<float> tissuePowers_; ///< the same, straight back
  std::vector<std::complex<double>> echoes_;
  int firstEcho_; ///< of the samples that are not zero
  int lastEcho_ = -1;
  float binMm_;
  float echoSampleMm_;
  float radPerMm_; ///< of the round trip: 2 k
  const TraceView* view_ = nullptr;
  const TraceLine* axis_ = nullptr;
  StraightWay way_;
  std::uint32_t lineKey_ = 0;
  TraceLine line_{};
  float coherenceMm_ = 0.0f;
  float echoWeight_ = 1.0f;
  std::uint64_t segments_ = 0;
};

} // namespace sono
