#include "BackgroundImage.h"
#include "ErrorText.h"
#include "SmallImage.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;
using test::busyScene;

namespace {

constexpr int endless = 10'000'000; // paths, the most there may be

ImageInput inputAt(double lateralMm, int pathsPerLine = 64)
{
  ImageInput input = test::smallInput();
  input.pose.positionMm.x = lateralMm;
  input.settings.tracing.pathsPerLine = pathsPerLine;
  return input;
}

/// Grey levels and labels.
std::pair<std::vector<int>, std::vector<int>> pictureOf(Simulator& simulator, const ImageInput& input)
{
  const ScanPicture picture =
    simulator.picture(simulator.image(input), input.settings.geometry, input.pose, simulator.traced(input));
  return { { picture.grey.begin(), picture.grey.end() }, { picture.labels.begin(), picture.labels.end() } };
}

} // namespace

TEST(BackgroundImage, IsWhatTheSimulatorMakesByItselfWhileAnotherIsMade)
{
  Simulator here(busyScene());
  const ImageInput input = inputAt(33.0);
  BackgroundImage image(std::make_unique<Simulator>(busyScene()), input);
  const auto before = pictureOf(here, inputAt(31.0)); // at the same time
  const std::unique_ptr<Simulator> there = image.finish({});
  EXPECT_TRUE(image.hasEnded());

  const auto notAgain = [](double) { return false; }; // whoever begins to work asks
  const ImageResult made = there->image(input, notAgain);
  EXPECT_EQ(made.plane().host().value, here.image(input).plane().host().value);
  EXPECT_EQ(pictureOf(*there, input), pictureOf(here, input));
  EXPECT_NE(before, pictureOf(here, input));
}

TEST(BackgroundImage, StopsAndGivesTheSimulatorBack)
{
  BackgroundImage image(std::make_unique<Simulator>(busyScene()), inputAt(33.0, endless));
  std::this_thread::sleep_for(std::chrono::milliseconds(50)); // it has begun, or was refused
  EXPECT_FALSE(image.hasEnded());
  const std::unique_ptr<Simulator> there = image.stop();
  Simulator here(busyScene());
  EXPECT_EQ(pictureOf(*there, inputAt(33.0)), pictureOf(here, inputAt(33.0)));
}

TEST(BackgroundImage, WaitsNoLongerThanItIsToldTo)
{
  BackgroundImage image(std::make_unique<Simulator>(busyScene()), inputAt(33.0, endless));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_THROW(image.finish([](double) { return false; }), Aborted);
  EXPECT_FALSE(image.hasEnded());
}

TEST(BackgroundImage, WhatCannotBeMadeIsSaidByTheSimulatorWhenItIsAskedFor)
{
  ImageInput wrong = inputAt(33.0);
  wrong.pose.positionMm.x = 1e4;
  BackgroundImage image(std::make_unique<Simulator>(busyScene()), wrong);
  const std::unique_ptr<Simulator> there = image.finish({});
  expectContains(errorOf([&] { there->image(wrong); }), "does not reach the label map");
}
