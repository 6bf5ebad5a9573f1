#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace sono {

/// Of `count` candidates the best ones, `most` at most, no two of them neighbours: the first in their order, and on
/// from there whichever is no neighbour of one before. Candidates that are ranked by a bound, since to know them takes
/// long, are made known where that matters.
/// @param isBetter of two candidates by what is known; where neither is, the one with the smaller number goes first
/// @param isKnown whether a candidate is ranked by itself, not by what it comes to at most
/// @param learn makes some candidates known, which come to no more than their bounds
template<class IsBetter, class AreNeighbours, class IsKnown, class Learn>
std::vector<std::size_t> bestApart(std::size_t count, std::size_t most, const IsBetter& isBetter,
                                   const AreNeighbours& areNeighbours, const IsKnown& isKnown, const Learn& learn)
{
  constexpr std::size_t together = 8; // learnt beside each other
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::vector<std::size_t> best;
  for (;;)
  {
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return isBetter(a, b) || (a < b && !isBetter(b, a)); });
    best.clear();
    std::vector<std::size_t> unknown;
    for (auto at = order.begin(); at != order.end() && best.size() < most && unknown.size() < together; ++at)
    {
      const bool isApart =
        std::none_of(best.begin(), best.end(), [&](std::size_t other) { return areNeighbours(*at, other); });
      if (isApart && !isKnown(*at))
      {
        unknown.push_back(*at);
      }
      else if (isApart && unknown.empty())
      {
        best.push_back(*at);
      }
    }
    if (unknown.empty())
    {
      return best;
    }
    learn(unknown);
  }
}

} // namespace sono
