#include "Core/Entrance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace {

using namespace sono;

TEST(Entrance, LetsInSoManyAtATimeAndAllInTheEnd)
{
  Entrance entrance(3);
  std::mutex mutex;
  int within = 0;
  int most = 0;
  int all = 0;
  std::vector<std::thread> threads;
  for (int n = 0; n < 16; ++n)
  {
    threads.emplace_back([&] {
      const Entrance::Stay stay(entrance);
      {
        const std::lock_guard<std::mutex> lock(mutex);
        most = std::max(most, ++within);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5)); // for the others to come
      const std::lock_guard<std::mutex> lock(mutex);
      --within;
      ++all;
    });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(most, 3);
  EXPECT_EQ(all, 16);
}

TEST(Entrance, WhoThrowsLeaves)
{
  Entrance entrance(1);
  const auto fail = [&] {
    const Entrance::Stay stay(entrance);
    throw std::runtime_error("no");
  };
  EXPECT_THROW(fail(), std::runtime_error);
  EXPECT_THROW(fail(), std::runtime_error); // or it would wait for good
}

} // namespace
