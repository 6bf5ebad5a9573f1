// How fast a core of this machine is, whether two do twice as much, and how quiet they are: what seconds are read
// beside.
#include "Core/Simd.h"
#include "Stage.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <thread>
#include <vector>

namespace sono {
namespace {

constexpr int chainSteps = 50'000'000;
constexpr int lanes = 64;
constexpr int vectorSteps = 4'000'000;
constexpr std::size_t copiedBytes = 256u << 20;
constexpr double watchedS = 2.0;
constexpr double pauseS = 50e-6; // longer than what a clock's own reading takes, or an interrupt

/// Each step waits for the one before: a clock frequency, nearly.
std::uint32_t hashChain()
{
  std::uint32_t h = 1u;
  for (int i = 0; i < chainSteps; ++i)
  {
    h ^= h >> 13;
    h *= 0x85ebca6bu;
  }
  return h;
}

/// Products and sums, none of which waits for more than one other.
SONO_SIMD_CLONES float manySums(float factor)
{
  std::array<float, lanes> sums{};
  for (int i = 0; i < vectorSteps; ++i)
  {
    for (float& sum : sums)
    {
      sum = sum * factor + 1.0f;
    }
  }
  float all = 0.0f;
  for (const float sum : sums)
  {
    all += sum;
  }
  return all;
}

volatile std::uint32_t keptHash;
volatile float keptSums[2] = { 0.5f, 0.5f }; // of either thread

void sumOnce(int thread)
{
  keptSums[thread] = manySums(0.5f + 0.0f * keptSums[thread]);
}

/// The longest time in which a thread that never waits did not run, and all such times, seconds.
struct Pauses
{
  double longest = 0.0;
  double all = 0.0;
};

Pauses watchPauses()
{
  using Clock = std::chrono::steady_clock;
  Pauses pauses;
  const Clock::time_point begin = Clock::now();
  Clock::time_point last = begin;
  while (std::chrono::duration<double>(last - begin).count() < watchedS)
  {
    const Clock::time_point now = Clock::now();
    const double gap = std::chrono::duration<double>(now - last).count();
    last = now;
    if (gap > pauseS)
    {
      pauses.longest = std::max(pauses.longest, gap);
      pauses.all += gap;
    }
  }
  return pauses;
}

void measureMachine()
{
  printFigure("machine_cores", double(std::thread::hardware_concurrency()), "");
  printFigure("machine_hash_steps", 1e-6 * chainSteps / medianSeconds([] { keptHash = hashChain(); }), "10^6/s");
  const double alone = medianSeconds([] { sumOnce(0); });
  printFigure("machine_core_gflops", 2e-9 * double(lanes) * vectorSteps / alone, "GFLOP/s");
  const double together = medianSeconds([] {
    std::thread other(sumOnce, 1);
    sumOnce(0);
    other.join();
  });
  printFigure("machine_two_threads", 2.0 * alone / together, "times one"); // less than 2 where they share a core
  std::vector<char> from(copiedBytes, 1);
  std::vector<char> to(copiedBytes, 2);
  const double copying = medianSeconds([&] { std::memcpy(to.data(), from.data(), copiedBytes); });
  printFigure("machine_copy_gb_per_s", 2e-9 * double(copiedBytes) / copying, "GB/s"); // read and written
  std::array<Pauses, 2> pauses;
  std::thread other([&] { pauses[1] = watchPauses(); });
  pauses[0] = watchPauses();
  other.join();
  printFigure("machine_longest_pause_ms", 1e3 * std::max(pauses[0].longest, pauses[1].longest), "ms");
  printFigure("machine_paused_share", 100.0 * 0.5 * (pauses[0].all + pauses[1].all) / watchedS, "%");
}

const Stage stage("machine", measureMachine);

} // namespace
} // namespace sono
