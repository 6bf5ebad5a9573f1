// The loop that all others run through: every index once, the first error out, a stop on demand.
#include "Core/Error.h"
#include "Core/ParallelFor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace sono {
namespace {

TEST(ParallelFor, RunsEveryIndexOnceAndItsWritesAreSeenAfterwards)
{
  std::vector<int> runs(10000, 0); // not atomic: each belongs to one task
  parallelFor(int(runs.size()), {}, [&](int i) { ++runs[std::size_t(i)]; });
  EXPECT_EQ(std::accumulate(runs.begin(), runs.end(), 0), 10000);
  EXPECT_EQ(*std::max_element(runs.begin(), runs.end()), 1);
}

TEST(ParallelFor, NestedLoopsSeeWhatTheOuterTaskWrote)
{
  std::vector<std::vector<int>> values(64);
  parallelFor(int(values.size()), {}, [&](int i) {
    auto& own = values[std::size_t(i)];
    own.assign(64, i);
    parallelFor(int(own.size()), {}, [&](int j) { own[std::size_t(j)] += j; });
  });
  for (int i = 0; i < 64; ++i)
  {
    EXPECT_EQ(std::accumulate(values[std::size_t(i)].begin(), values[std::size_t(i)].end(), 0), 64 * i + 63 * 32);
  }
}

TEST(ParallelFor, ProgressStopsIt)
{
  int told = 0; // progress comes from one thread at a time
  const Progress thrice = [&](double) { return ++told < 3; };
  EXPECT_THROW(parallelFor(100000, thrice, [](int) {}), Aborted);
  EXPECT_EQ(told, 3);
}

TEST(ParallelFor, AnErrorComesOut)
{
  EXPECT_THROW(parallelFor(100, {},
                           [](int i) {
                             if (i == 50)
                             {
                               throw Error("fifty");
                             }
                           }),
               Error);
}

} // namespace
} // namespace sono
