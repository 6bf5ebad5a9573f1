// Images of a data set one after the other, against those that are asked for by their numbers.
#include "BallDataSet.h"
#include "ErrorText.h"
#include "NextImage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;
using sono::testing::next;

namespace {

class AStream : public sono::testing::BallDataSet
{
protected:
  std::vector<std::int64_t> expectWhole(ImageStream& stream)
  {
    DataSetImager alone(plan(), Device::Cpu);
    std::vector<std::int64_t> order;
    while (const auto taken = next(stream))
    {
      order.push_back(taken->index);
      const DataSetImage made = alone.make(taken->index);
      EXPECT_EQ(taken->image.grey, made.grey) << taken->index;
      EXPECT_EQ(taken->image.mask, made.mask) << taken->index;
      EXPECT_EQ(taken->image.info, made.info) << taken->index;
    }
    EXPECT_TRUE(stream.hasEnded());
    EXPECT_FALSE(next(stream));
    EXPECT_FALSE(stream.takeMade());
    return order;
  }
};

std::vector<std::int64_t> numbers(std::int64_t first, std::int64_t end)
{
  std::vector<std::int64_t> all;
  for (std::int64_t n = first; n < end; ++n)
  {
    all.push_back(n);
  }
  return all;
}

std::vector<std::int64_t> sorted(std::vector<std::int64_t> order)
{
  std::sort(order.begin(), order.end());
  return order;
}

} // namespace

TEST_F(AStream, GivesEachImageOnce)
{
  const DataSetImager imager(plan(), Device::Cpu);
  ImageStream inOrder(imager, {});
  EXPECT_EQ(expectWhole(inOrder), numbers(0, 12));
  for (const int workers : { 2, 5 })
  {
    ImageStream byMany(imager, {}, {}, workers);
    EXPECT_EQ(sorted(expectWhole(byMany)), numbers(0, 12));
  }
}

TEST_F(AStream, HoldsAShareOrWhatIsWanted)
{
  const DataSetImager imager(plan(), Device::Cpu);
  ImageStream share(imager, { 1, 3 });
  EXPECT_EQ(expectWhole(share), numbers(4, 8));
  ImageStream wanted(
    imager, {}, [&](std::int64_t index) { return imager.plan().splitOf(index) == Split::Test && index != 8; }, 3);
  EXPECT_EQ(sorted(expectWhole(wanted)), (std::vector<std::int64_t>{ 6, 7, 9, 10, 11 }));
  ImageStream none(imager, {}, [](std::int64_t) { return false; });
  EXPECT_EQ(expectWhole(none), numbers(0, 0));
  expectContains(errorOf([&] { ImageStream(imager, { 3, 3 }); }), "process 3 of 3");
}

/// It waits for the one who takes the images, and ends at once where nobody does any more.
TEST_F(AStream, IsAFewImagesAhead)
{
  json_["exams"] = 400;
  const DataSetImager imager(plan(), Device::Cpu);
  for (const int workers : { 1, 3 })
  {
    std::set<std::int64_t> begun;
    std::mutex mutex;
    const auto isBegun = [&](std::int64_t index) {
      const std::lock_guard<std::mutex> lock(mutex);
      begun.insert(index);
      return true;
    };
    ImageStream stream(imager, {}, isBegun, workers);
    while (!stream.takeMade()) // which does not wait
    {
      EXPECT_FALSE(stream.hasEnded());
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const auto countBegun = [&] {
      const std::lock_guard<std::mutex> lock(mutex);
      return int(begun.size());
    };
    while (countBegun() < 4 * workers)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(300)); // in which many more would be
    EXPECT_LE(countBegun(), 1 + (4 + 2) * workers);              // taken; waiting; of exams that are being made
  }
}

/// Those before it come; then what went wrong, once.
TEST_F(AStream, SaysWhatWentWrong)
{
  json_["patients"][1]["views"][0]["pose"]["positionMm"] = { 0, -500, 0 };
  for (const int workers : { 1, 2 })
  {
    const DataSetImager imager(plan(), Device::Cpu);
    ImageStream stream(imager, {}, {}, workers);
    int came = 0;
    const std::string said = errorOf([&] {
      while (next(stream))
      {
        ++came;
      }
    });
    expectContains(said, "of patient 'other': none of 32 poses");
    EXPECT_TRUE(workers > 1 || came == 6);
    EXPECT_LE(came, 6);
    EXPECT_TRUE(stream.hasEnded());
    EXPECT_FALSE(next(stream));
  }
}
