// The loop that all others run through: every index once, the first error out, a stop on demand.
#include "Core/Error.h"
#include "Core/ParallelFor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <set>
#include <thread>
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

/// In order, on the thread that asks, until it says otherwise.
TEST(ParallelFor, RunsOnTheThreadsOwnCore)
{
  const auto threadsOf = [](int count) {
    std::vector<std::thread::id> threads;
    threads.resize(std::size_t(count));
    parallelFor(count, {}, [&](int i) {
      threads[std::size_t(i)] = std::this_thread::get_id();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
    return std::set<std::thread::id>(threads.begin(), threads.end());
  };
  const LoopsOn own(LoopCores::Own);
  EXPECT_EQ(threadsOf(100), std::set<std::thread::id>{ std::this_thread::get_id() });
  {
    const LoopsOn all(LoopCores::All);
    if (std::thread::hardware_concurrency() > 1)
    {
      EXPECT_GT(threadsOf(100).size(), 1u);
    }
  }
  std::vector<int> order;
  parallelFor(5, {}, [&](int i) { order.push_back(i); });
  EXPECT_EQ(order, (std::vector<int>{ 0, 1, 2, 3, 4 }));
  EXPECT_THROW(parallelFor(
                 3, [](double) { return false; }, [](int) {}),
               Aborted);
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
