#pragma once

#include "Kernel/TracePath.h"

#include <complex>
#include <vector>

namespace sono {

/// What the paths of one line leave on its main beam, on the CPU. A path deposits where it crosses the plane at r,
/// whatever its slope: I(r) is the sum of I w_R over those crossings, averaged over each radial bin.
class LineTally
{
public:
  LineTally(int binCount, double binMm, int echoCount, double echoSampleMm, double wavesPerMm);

  void start(const TraceLine& line, float coherenceMm, std::complex<float>* echo);
  void clearBins();
  const std::vector<float>& bins() const { return bins_; }

  /// Deposits of echoes are multiplied by this (1 for what all paths share, 1 / N for each path).
  void setEchoWeight(float weight) { echoWeight_ = weight; }

  void segment(const PathSegment& s);
  void echo(const Vec3f& point, float amplitude);
  std::uint64_t segments() const { return segments_; }

private:
  std::vector<float> bins_;
  float binMm_;
  int echoCount_;
  float echoSampleMm_;
  float radPerMm_; ///< of the round trip: 2 k
  TraceLine line_{};
  float coherenceMm_ = 0.0f;
  std::complex<float>* echo_ = nullptr;
  float echoWeight_ = 1.0f;
  std::uint64_t segments_ = 0;
};

} // namespace sono
