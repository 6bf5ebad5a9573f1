#include "Core/MadeOnce.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace {

using namespace sono;

TEST(MadeOnce, SeveralThreadsShareWhatOneMakes)
{
  MadeOnce<int, int> things;
  std::atomic<int> made{ 0 };
  std::vector<std::shared_ptr<const int>> held(8);
  std::vector<std::thread> threads;
  for (std::size_t n = 0; n < held.size(); ++n)
  {
    threads.emplace_back([&, n] {
      held[n] = things.get(7, [&] {
        ++made;
        std::this_thread::sleep_for(std::chrono::milliseconds(20)); // for the others to come
        return std::make_shared<const int>(42);
      });
    });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(made, 1);
  for (const auto& each : held)
  {
    EXPECT_EQ(each, held.front());
    EXPECT_EQ(*each, 42);
  }
}

TEST(MadeOnce, WhatNobodyHoldsIsMadeAgain)
{
  MadeOnce<int, int> things;
  int made = 0;
  const auto make = [&] { return std::make_shared<const int>(++made); };
  EXPECT_EQ(*things.get(1, make), 1);
  const auto second = things.get(1, make);
  EXPECT_EQ(*second, 2);
  EXPECT_EQ(things.get(1, make), second);
  EXPECT_EQ(*things.get(2, make), 3); // another thing
}

TEST(MadeOnce, AFailureIsThrownAndTheNextTriesAgain)
{
  MadeOnce<int, int> things;
  EXPECT_THROW(things.get(1, []() -> std::shared_ptr<const int> { throw std::runtime_error("no"); }),
               std::runtime_error);
  EXPECT_EQ(*things.get(1, [] { return std::make_shared<const int>(5); }), 5);
}

} // namespace
