#include "Probe/BeamReachTable.h"

#include <glm/common.hpp>

#include <algorithm>

namespace sono {

void BeamReachTable::add(const Vec2f& reachMm)
{
  largest_.front().push_back(reachMm);
  for (std::size_t k = 1; std::size_t(1) << k <= largest_.front().size(); ++k)
  {
    if (k == largest_.size())
    {
      largest_.emplace_back();
    }
    const std::vector<Vec2f>& halves = largest_[k - 1];
    largest_[k].push_back(glm::max(halves.back(), halves[halves.size() - 1 - (std::size_t(1) << (k - 1))]));
  }
}

Vec2f BeamReachTable::widest(float fromMm, float toMm) const
{
  const int last = steps() - 1;
  const int to = std::clamp(int(toMm / stepMm_), 0, last);
  const int from = std::min(std::clamp(int(fromMm / stepMm_), 0, last), to);
  std::size_t k = 0;
  while (2 << k <= to - from + 1)
  {
    ++k;
  }
  const std::vector<Vec2f>& runs = largest_[k];
  return glm::max(runs[std::size_t(from)], runs[std::size_t(to + 1 - (1 << k))]);
}

} // namespace sono
