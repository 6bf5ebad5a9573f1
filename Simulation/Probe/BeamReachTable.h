#pragma once

#include "Kernel/Vec.h"

#include <vector>

namespace sono {

/// How far from its axis a beam that widens in depth is seen: the largest distances along the array (x) and across it
/// (y), mm, in steps of depth, of a line straight ahead.
class BeamReachTable
{
public:
  explicit BeamReachTable(float stepMm)
    : stepMm_(stepMm)
  {
  }

  /// Adds the next step: n reaches over depths [n, n + 1) stepMm.
  void add(const Vec2f& reachMm);

  float stepMm() const { return stepMm_; }
  int steps() const { return int(largest_.front().size()); }
  const Vec2f& step(int n) const { return largest_.front()[std::size_t(n)]; }

  /// The largest ones between two depths; those of the first and the last step hold beyond them.
  Vec2f widest(float fromMm, float toMm) const;

private:
  float stepMm_;
  /// The largest of 2^k steps from each on: any number of steps is two such runs that overlap. Bricks ask by the
  /// million.
  std::vector<std::vector<Vec2f>> largest_{ {} };
};

} // namespace sono
