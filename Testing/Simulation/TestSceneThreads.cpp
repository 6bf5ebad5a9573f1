// Several tasks and threads may ask one scene for what it builds on first need.
#include "TestScenes.h"

#include "Core/ParallelFor.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <functional>
#include <future>
#include <memory>
#include <random>
#include <thread>

namespace sono {
namespace {

using namespace std::chrono_literals;

/// Noise of two tissues: every voxel has a record, and every piece of a surface takes a while.
std::unique_ptr<Scene> makeNoise(const Vec3i& size)
{
  std::mt19937 random(5);
  return test::makeScene(size, Vec3d(1.0),
                         { test::makeTissue("a", 1.5, 1540, 0.4), test::makeTissue("b", 2.4, 1700, 0.6) },
                         [&](const Vec3d&) { return int(random() % 2); });
}

/// ctest's time limit ends it where the flag never rises.
void waitFor(const std::atomic<bool>& flag)
{
  while (!flag)
  {
    std::this_thread::sleep_for(1ms);
  }
}

/// Has one thread build by `ask`, and others meanwhile begin a loop whose every task asks the same, on the same arena.
/// Another thread holds up a piece of the building, so that the builder must wait for it. If it took up a task of the
/// loop then it would wait for itself, for good: ctest's time limit fails the test.
void askWhileItIsBuilt(const std::function<void(const Scene&, const Progress&)>& ask)
{
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 4);
  tbb::task_arena arena(4, 2);
  std::unique_ptr<Scene> scene;
  std::atomic<bool> isHeldUp{ false };
  std::atomic<bool> isHeldUpOrOver{ false };
  std::atomic<bool> loopRuns{ false };
  std::thread loop([&] {
    waitFor(isHeldUpOrOver);
    if (isHeldUp)
    {
      arena.execute([&] {
        parallelFor(32, {}, [&](int) {
          loopRuns = true;
          ask(*scene, {});
        });
      });
    }
  });
  for (int attempt = 0; attempt < 200 && !isHeldUp; ++attempt) // whether others take part is up to chance
  {
    scene = makeNoise(Vec3i(96));
    int told = 0;
    arena.execute([&] {
      ask(*scene, [&, builder = std::this_thread::get_id()](double) {
        if (std::this_thread::get_id() == builder)
        {
          std::this_thread::sleep_for(++told < 5 ? 1ms : 0ms); // until others are awake
        }
        else if (!isHeldUp.exchange(true))
        {
          isHeldUpOrOver = true;
          waitFor(loopRuns);
          std::this_thread::sleep_for(100ms);
        }
        return true;
      });
    });
  }
  isHeldUpOrOver = true;
  loop.join();
  EXPECT_TRUE(loopRuns);
}

TEST(SceneThreads, WhoBuildsARegionDoesNotWaitForItself)
{
  askWhileItIsBuilt([](const Scene& scene, const Progress& progress) {
    scene.regionOnDemand({ Vec3i(0), scene.placement().size }, progress);
  });
}

TEST(SceneThreads, WhoBuildsASurfaceDoesNotWaitForItself)
{
  askWhileItIsBuilt([](const Scene& scene, const Progress& progress) { scene.surface(1, progress); });
}

TEST(SceneThreads, WhoBuildsAllDoesNotWaitForItself)
{
  askWhileItIsBuilt([](const Scene& scene, const Progress& progress) { scene.buildAll(progress); });
}

/// Where one waits for itself, ctest's time limit fails the test.
TEST(SceneThreads, WhoObservesTheMakingOfAThingMayAskForAnyOther)
{
  const std::vector<std::function<void(const Scene&, const Progress&)>> makings{
    [](const Scene& scene, const Progress& progress) { scene.labelGrid(progress); },
    [](const Scene& scene, const Progress& progress) { scene.surface(0, progress); },
    [](const Scene& scene, const Progress& progress) { scene.buildAll(progress); },
    [](const Scene& scene, const Progress& progress) {
      scene.regionOnDemand({ Vec3i(0), scene.placement().size }, progress);
    }
  };
  for (const auto& make : makings)
  {
    const std::shared_ptr<const Scene> scene = makeNoise(Vec3i(48));
    std::atomic<int> told{ 0 };
    const SurfaceField* surface = nullptr;
    make(*scene, [&](double) {
      if (told++ == 0)
      {
        scene->buildAll();
        surface = &scene->surface(0);
        EXPECT_EQ(scene->regionOnDemand({ Vec3i(0), Vec3i(9) })->region().box.last.x, 9);
      }
      return true;
    });
    EXPECT_GT(told, 0);
    EXPECT_EQ(&scene->surface(0), surface); // the first one stays
  }
}

const Vec3i longSize(32, 32, 1024);
const VoxelBox firstHalf{ Vec3i(0), Vec3i(32, 32, 500) };
const VoxelBox secondHalf{ Vec3i(0, 0, 520), Vec3i(32, 32, 1000) };

/// Counted in processor time, whatever else the machine does: a box that is left takes no more of it. Its end is waited
/// for, so that all that it took is counted.
TEST(InteractiveProbe, GivesUpTheBoxThatItLeaves)
{
  std::clock_t whole = 0;
  std::clock_t crossing = 0;
  for (const bool crosses : { false, true })
  {
    const auto scene = makeNoise(longSize);
    const std::clock_t start = std::clock();
    scene->beginInteractiveRegion(firstHalf, true);
    if (crosses)
    {
      std::this_thread::sleep_for(10ms);
      EXPECT_EQ(scene->interactiveRegion(secondHalf)->region().box.first.z, 512);
    }
    else
    {
      scene->interactiveRegion(firstHalf);
    }
    (crosses ? crossing : whole) = std::clock() - start;
  }
  EXPECT_LT(crossing, whole / 3);
}

TEST(InteractiveProbe, WhoWaitsForABoxGetsItThoughAnotherLeavesIt)
{
  const auto scene = makeNoise(longSize);
  scene->beginInteractiveRegion(firstHalf, true);
  std::atomic<bool> waits{ false };
  auto waiting = std::async(std::launch::async, [&] {
    return scene->interactiveRegion(firstHalf, [&](double) {
      waits = true;
      return true;
    });
  });
  waitFor(waits);
  scene->beginInteractiveRegion(secondHalf, false);
  const auto region = waiting.get();
  ASSERT_NE(region, nullptr);
  EXPECT_EQ(region->region().box.last.z, 512);
}

TEST(InteractiveProbe, WaitingCanBeStopped)
{
  const auto scene = makeNoise(longSize);
  scene->beginInteractiveRegion(firstHalf, true);
  std::vector<double> fractions;
  EXPECT_THROW(scene->interactiveRegion(firstHalf,
                                        [&](double fraction) {
                                          fractions.push_back(fraction);
                                          return fractions.size() < 3;
                                        }),
               Aborted);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(scene->interactiveRegion(secondHalf)->region().box.first.z, 512);
}

} // namespace
} // namespace sono
