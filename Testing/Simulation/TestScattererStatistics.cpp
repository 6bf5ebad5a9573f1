#include "Echo/TissueScatterers.h"
#include "TestScenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace {

using namespace sono;
using namespace sono::test;

constexpr double cellMm = 0.25;
constexpr int bricks = 30; // of one edge of the cube; 1 mm each

struct Statistics
{
  double count = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  double pairs = 0.0; ///< sum of products of one scatterer's amplitude and the next one's
  std::array<std::array<double, 16>, 3> histogram{}; ///< of the position inside the cell, along each axis

  double mean() const { return sum / count; }
  double variance() const { return squares / count - mean() * mean(); }
};

Statistics collect(double mean, double sigma, double probability, double scale, std::uint64_t seed)
{
  Tissue tissue = makeTissue("tissue", 1.6, 1540.0, 0.0);
  tissue.scattererMean = mean;
  tissue.scattererSigma = sigma;
  tissue.scattererProbability = probability;
  const auto scene = makeScene(Vec3i(bricks), Vec3d(1.0), { tissue }, [](const Vec3d&) { return 0; });
  const TissueScatterers scatterers(*scene, cellMm, scale, seed);
  Statistics out;
  TissueScatterers::Buffer buffer;
  double last = 0.0;
  for (int i = 0; i < bricks * bricks * bricks; ++i)
  {
    const ScattererView v = scatterers.generate({ i % bricks, (i / bricks) % bricks, i / (bricks * bricks) }, buffer);
    for (int n = 0; n < v.count; ++n)
    {
      const double a = v.amplitude[n];
      out.count += 1.0;
      out.sum += a;
      out.squares += a * a;
      out.pairs += (a - scale * mean) * (last - scale * mean);
      last = a;
      const Vec3d p = Vec3d(v.x[n], v.y[n], v.z[n]) / cellMm;
      for (int axis = 0; axis < 3; ++axis)
      {
        out.histogram[std::size_t(axis)][std::size_t((p[axis] - std::floor(p[axis])) * 16.0)] += 1.0;
      }
    }
  }
  return out;
}

TEST(ScattererStatistics, FollowTheTissue)
{
  const double cells = std::pow(bricks * 4, 3);
  struct Case
  {
    double mean, sigma, probability, scale;
  };
  for (const Case& c : { Case{ 0.25, 0.15, 0.7, 1.0 }, Case{ 0.0, 0.025, 0.7, 3.0 }, Case{ 1.0, 1.0, 0.01, 0.1 } })
  {
    const Statistics s = collect(c.mean, c.sigma, c.probability, c.scale, 5);
    const double present = (s.count - cells * c.probability) / std::sqrt(cells * c.probability * (1.0 - c.probability));
    EXPECT_LT(std::abs(present), 4.0) << "presence " << s.count / cells << " for " << c.probability;
    const double sigma = c.scale * c.sigma;
    EXPECT_LT(std::abs(s.mean() - c.scale * c.mean) / (sigma / std::sqrt(s.count)), 4.0) << "mean " << s.mean();
    EXPECT_LT(std::abs(s.variance() / (sigma * sigma) - 1.0) / std::sqrt(2.0 / s.count), 4.0)
      << "sigma " << std::sqrt(s.variance());
    EXPECT_LT(std::abs(s.pairs / (sigma * sigma)) / std::sqrt(s.count), 4.0) << "neighbours are correlated";
    for (const auto& histogram : s.histogram)
    {
      double chiSquared = 0.0;
      for (const double n : histogram)
      {
        chiSquared += std::pow(n - s.count / 16.0, 2) / (s.count / 16.0);
      }
      EXPECT_LT(chiSquared, 44.3) << "positions in the cell"; // 15 degrees of freedom, p = 1e-4
    }
  }
}

TEST(ScattererStatistics, ExtremesAreExact)
{
  const double cells = std::pow(bricks * 4, 3);
  const Statistics all = collect(0.5, 0.0, 1.0, 2.0, 5);
  EXPECT_EQ(all.count, cells);
  EXPECT_EQ(all.mean(), 1.0);
  EXPECT_EQ(all.variance(), 0.0);
  EXPECT_EQ(collect(0.5, 0.1, 0.0, 1.0, 5).count, 0.0);
  EXPECT_EQ(collect(0.0, 0.0, 1.0, 1.0, 5).count, 0.0);
}

TEST(ScattererStatistics, AnotherSeedGivesOtherScatterers)
{
  EXPECT_EQ(collect(0.2, 0.1, 0.5, 1.0, 5).sum, collect(0.2, 0.1, 0.5, 1.0, 5).sum);
  EXPECT_NE(collect(0.2, 0.1, 0.5, 1.0, 5).sum, collect(0.2, 0.1, 0.5, 1.0, 6).sum);
}

TEST(ScattererStatistics, BricksFollowTheKernelAndTheTissueOfTheVoxel)
{
  // The vector loop gives what one cell at a time gives, and a scatterer takes the tissue of the voxel that it is in.
  Tissue left = makeTissue("left", 1.6, 1540.0, 0.0);
  left.scattererMean = 0.5;
  left.scattererProbability = 0.6;
  Tissue right = left;
  right.name = "right";
  right.scattererMean = 0.25;
  const auto scene =
    makeScene({ 5, 10, 10 }, { 1.0, 0.5, 0.5 }, { left, right }, [](const Vec3d& p) { return p.x < 3.0 ? 0 : 1; });
  const TissueScatterers scatterers(*scene, 0.35, 1.0, 9);
  TissueScatterers::Buffer buffer;
  int compared = 0;
  for (int brick = 0; brick < 64; ++brick)
  {
    const Vec3i at(brick % 4, (brick / 4) % 4, brick / 16);
    const ScattererView v = scatterers.generate(at, buffer);
    int n = 0;
    for (int i = 0; i < 64; ++i)
    {
      const Vec3i cell = at * 4 + Vec3i(i % 4, (i / 4) % 4, i / 16);
      const ScattererSeed seed = scattererSeed(9, cell);
      const Vec3f p = (Vec3f(cell) + seed.fraction) * 0.35f;
      if (seed.presence >= 0.6f || glm::any(glm::greaterThanEqual(p, Vec3f(5.0f))))
      {
        continue;
      }
      ASSERT_LT(n, v.count);
      ASSERT_FLOAT_EQ(v.x[n], p.x);
      ASSERT_FLOAT_EQ(v.y[n], p.y);
      ASSERT_FLOAT_EQ(v.z[n], p.z);
      ASSERT_EQ(v.amplitude[n], p.x < 3.0f ? 0.5f : 0.25f);
      ++n;
      ++compared;
    }
    ASSERT_EQ(n, v.count);
  }
  EXPECT_GT(compared, 1000);
}

} // namespace
