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

/// What the paths of a batch of a line have left so far, not divided by their number: more paths may follow.
struct BatchSums
{
  std::array<std::vector<double>, binSumCount> bins; ///< of each radial bin
  std::vector<ReverberationSums> reverberation;      ///< of each of the TissueBins
};

///@{
/// Of each of `paths` paths.
std::vector<BinSums<double>> meanBins(const BatchSums& batch, int paths);
std::vector<ReverberationSums> meanReverberation(const BatchSums& batch, int paths);
///@}

/// The same as BatchSums of all paths of a line.
struct LineEchoes
{
  std::vector<std::complex<double>> samples; ///< of the boundary echoes
  int first = 0;                             ///< of the samples that are not zero
  int last = -1;
  std::vector<double> power; ///< squared amplitudes of the echoes in each radial bin
  /// What the media have taken of what reverberated.
  std::vector<AbsorbedSums> absorbedByTissue; ///< before its echoes, in each of the TissueBins
  std::vector<AbsorbedSums> absorbedToBoundaries;

  /// Adds `weight` times the boundary echoes to a line's samples.
  void addTo(std::complex<float>* line, double weight) const;
  /// What the media have taken, Np, by radial bin.
  std::vector<float> takenNp(const TissueBins& tissueBins) const;
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

  void segment(const PathSegment& s);
  void echo(const Vec3f& point, float amplitude);
  void arrives(const PathState& path, const PathBoundary& boundary);
  std::uint64_t segments() const { return segments_; }

  /// To be called at nextFold().
  void fold();

  ///@{
  /// No sums, and the tally's own for those given: the next paths add to them until they are taken back.
  BatchSums emptyBatch() const;
  LineEchoes emptyEchoes() const;
  void exchange(BatchSums& sums);
  void exchange(LineEchoes& echoes);
  ///@}

  /// What was left in each bin, of each of `paths` paths, and forgets it.
  std::vector<BinSums<double>> takeBins(int paths);
  /// Adds `weight` times the boundary echoes to a line's samples and forgets them.
  void takeEchoes(std::complex<float>* samples, double weight);

private:
  void addEcho(float rangeMm, float amplitude);
  void addReverberation(const PathSegment& s);
  template<int Sums>
  void deposit(const BeamSegment& g, const DepthSpan& span);

  int binCount_;
  int sums_;
  std::array<std::vector<float>, binSumCount> bins_; ///< of the paths since the last fold
  TissueBins tissueBins_;
  std::size_t echoCount_;
  BatchSums batch_; ///< of the paths before
  LineEchoes echoes_;
  bool reverberated_ = false; ///< since the line began
  std::vector<float> cellMm_; ///< see resolutionCell, in the middle of each bin; of a line that has reverberated
  float binMm_;
  float echoSampleMm_;
  float radPerMm_; ///< of the round trip: 2 k
  const TraceView* view_ = nullptr;
  const TraceLine* axis_ = nullptr;
  StraightWay way_;
  std::uint32_t lineKey_ = 0;
  TraceLine line_{};
  float coherenceMm_ = 0.0f;
  std::uint64_t segments_ = 0;
};

} // namespace sono
