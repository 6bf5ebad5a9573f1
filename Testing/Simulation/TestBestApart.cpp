// The best of candidates that are known by bounds at first.
#include "Probe/BestApart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace sono;

namespace {

struct Candidate
{
  double place;
  double bound;
  double value; ///< at most the bound
  bool isKnown;

  double now() const { return isKnown ? value : bound; }
};

/// From all values: again and again the best that is left, whose neighbours are left out.
std::vector<std::size_t> byTakingTheBest(std::vector<Candidate> candidates, std::size_t most, double apart)
{
  std::vector<std::size_t> best;
  std::vector<bool> isOut(candidates.size());
  while (best.size() < most)
  {
    std::size_t next = candidates.size();
    for (std::size_t n = 0; n < candidates.size(); ++n)
    {
      if (!isOut[n] && (next == candidates.size() || candidates[n].value > candidates[next].value))
      {
        next = n;
      }
    }
    if (next == candidates.size())
    {
      break;
    }
    best.push_back(next);
    for (std::size_t n = 0; n < candidates.size(); ++n)
    {
      isOut[n] = isOut[n] || n == next || std::abs(candidates[n].place - candidates[next].place) < apart;
    }
  }
  return best;
}

} // namespace

TEST(BestApart, OfBoundsIsThatOfAllValues)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::size_t learnt = 0;
  std::size_t all = 0;
  for (int round = 0; round < 300; ++round)
  {
    std::vector<Candidate> candidates(std::size_t(uniform(random) * 300.0));
    const bool hasTies = round % 2 == 0;
    for (Candidate& each : candidates)
    {
      each.place = 100.0 * uniform(random);
      each.bound = std::pow(uniform(random), 4.0);
      each.bound = hasTies ? std::ceil(8.0 * each.bound) / 8.0 : each.bound;
      each.value = uniform(random) < 0.3 ? each.bound : each.bound * (hasTies ? 0.5 : uniform(random));
      each.isKnown = uniform(random) < 0.2;
    }
    const double apart = 10.0 * uniform(random);
    const std::size_t most = 1 + std::size_t(round % 12);
    const std::vector<std::size_t> expected = byTakingTheBest(candidates, most, apart);
    const std::vector<std::size_t> found = bestApart(
      candidates.size(), most, [&](std::size_t a, std::size_t b) { return candidates[a].now() > candidates[b].now(); },
      [&](std::size_t a, std::size_t b) { return std::abs(candidates[a].place - candidates[b].place) < apart; },
      [&](std::size_t n) { return candidates[n].isKnown; },
      [&](const std::vector<std::size_t>& some) {
        for (const std::size_t n : some)
        {
          EXPECT_FALSE(candidates[n].isKnown);
          candidates[n].isKnown = true;
          ++learnt;
        }
      });
    EXPECT_EQ(found, expected) << round;
    all += candidates.size();
  }
  EXPECT_LT(learnt, all / 4);
}
