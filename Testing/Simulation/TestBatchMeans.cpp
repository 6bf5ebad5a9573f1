#include "Trace/BatchMeans.h"

#include <gtest/gtest.h>

#include <random>

// All bins of a line at once against one after the other, as the GPU has them.

namespace sono::test {
namespace {

constexpr int bins = 37; // no whole vectors
constexpr double frequencyMHz = 2.5;

/// Of random batches, one bin of which nothing reaches.
struct RandomBatches
{
  std::mt19937 random{ 5 };
  std::uniform_real_distribution<double> uniform{ 0.0, 1.0 };
  std::vector<BinSums<double>> shared{ std::size_t(bins) };
  std::vector<std::vector<BinSums<double>>> sums;
  std::vector<std::vector<ReverberationSums>> reverberation;

  explicit RandomBatches(int batches)
  {
    const auto fill = [&](std::vector<BinSums<double>>& of) {
      of.resize(std::size_t(bins));
      for (int b = 1; b < bins; ++b)
      {
        of[std::size_t(b)] = { { uniform(random), 10.0 * uniform(random) } };
      }
    };
    fill(shared);
    sums.resize(std::size_t(batches));
    reverberation.resize(std::size_t(batches));
    for (std::size_t batch = 0; batch < sums.size(); ++batch)
    {
      fill(sums[batch]);
      if (batch == 2) // nothing reverberates in it
      {
        continue;
      }
      reverberation[batch].resize(std::size_t(bins));
      for (int b = 1; b < bins; ++b)
      {
        reverberation[batch][std::size_t(b)] = { { uniform(random), uniform(random), uniform(random) } };
      }
    }
  }
};

class BatchMeansOf : public testing::TestWithParam<int>
{
protected:
  RandomBatches batches_{ GetParam() };
};

TEST_P(BatchMeansOf, BinsAreThoseOfOneBin)
{
  for (const int sums : { 1, int(binSumCount) })
  {
    std::vector<float> intensity(bins), error(bins), attenuation(bins);
    finishBins(batches_.shared, batches_.sums, sums, frequencyMHz,
               { intensity.data(), error.data(), attenuation.data() });
    for (std::size_t b = 0; b < std::size_t(bins); ++b)
    {
      const auto meanOf = [&](int batch) { return batches_.sums[std::size_t(batch)][b]; };
      const BinArrays expected = finishBin(batches_.shared[b], GetParam(), meanOf, sums, frequencyMHz);
      EXPECT_NEAR(intensity[b], expected.of[intensityArray], 1e-6) << b;
      EXPECT_NEAR(error[b], expected.of[standardErrorArray], 1e-6) << b;
      EXPECT_NEAR(attenuation[b], expected.of[attenuationArray], 1e-5) << b;
    }
    EXPECT_EQ(attenuation[0], 0.0f);
    EXPECT_EQ(attenuation[1] > 0.0f, sums > 1);
  }
}

TEST_P(BatchMeansOf, ReverberationIsThatOfOneBin)
{
  const ReverberationLine line = reverberationOf(batches_.reverberation, bins);
  for (int b = 0; b < bins; ++b)
  {
    const ReverberationMeans expected = reverberationMeans(GetParam(), [&](int batch) {
      const auto& sums = batches_.reverberation[std::size_t(batch)];
      return sums.empty() ? ReverberationSums() : sums[std::size_t(b)];
    });
    const ReverberationAround around = aroundOf(expected);
    const ReverberationAround found = line.around.at(0, b);
    EXPECT_NEAR(line.ownLevel[std::size_t(b)], expected.ownLevel, 1e-6) << b;
    EXPECT_NEAR(line.error[std::size_t(b)], expected.error, 1e-6) << b;
    EXPECT_NEAR(found.cellPower, around.cellPower, 1e-6) << b;
    EXPECT_NEAR(found.power, around.power, 1e-6) << b;
    EXPECT_NEAR(found.chance, around.chance, 1e-6) << b;
    EXPECT_NEAR(found.straightPower, around.straightPower, 1e-6) << b;
    EXPECT_EQ(found.straightWeight, 1.0f) << b;
  }
}

INSTANTIATE_TEST_SUITE_P(All, BatchMeansOf, testing::Values(1, 2, 3, 8));

} // namespace
} // namespace sono::test
