// The rough boundary's kernels: shares, facets, energy and reciprocity (Data/docs/physics.md section 10).
#include "ChiSquared.h"

#include "Kernel/RoughSurface.h"
#include "Kernel/TraceView.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace sono;
using namespace sono::test;

BounceSample sampleAt(int i, std::uint32_t stream)
{
  return independentSample(17, stream, 0, std::uint32_t(i), 0);
}

/// Travels down onto the surface at an angle to its normal.
Vec3f incidentAt(double cosine, double azimuth = 0.0)
{
  const double sine = std::sqrt(1.0 - cosine * cosine);
  return Vec3f(Vec3d(sine * std::cos(azimuth), sine * std::sin(azimuth), -cosine));
}

/// Beckmann's distribution of normals, and Smith's Lambda, in double precision.
double beckmann(double alpha, const Vec3d& m)
{
  const double c2 = m.z * m.z;
  return m.z <= 0.0 ? 0.0 : std::exp(-(1.0 - c2) / (c2 * alpha * alpha)) / (M_PI * alpha * alpha * c2 * c2);
}

double lambdaOf(double alpha, const Vec3d& w)
{
  const double tangent = std::sqrt(std::max(0.0, 1.0 - w.z * w.z)) / std::abs(w.z);
  const double a = 1.0 / std::max(1e-12, alpha * tangent);
  return a > 20.0 ? 0.0 : 0.5 * (std::exp(-a * a) / (a * std::sqrt(M_PI)) - std::erfc(a));
}

TEST(RoughSurface, CoherentSharesFollowTheirEquation)
{
  const double f = 2.5;
  const double h = 0.1;
  const double c1 = 1450.0;
  const double c2 = 1580.0;
  for (const double degrees : { 0.0, 20.0, 50.0 })
  {
    const double t1 = degrees * M_PI / 180.0;
    const double t2 = std::asin(std::sin(t1) * c2 / c1);
    const double k1 = 2000.0 * M_PI * f / c1;
    const double k2 = 2000.0 * M_PI * f / c2;
    const RoughBoundary rough{ float(h), 0.2f, float(k1), float(k2) };
    const double reflected = std::exp(-std::pow(2.0 * k1 * h * std::cos(t1), 2.0));
    const double transmitted = std::exp(-std::pow(h * (k1 * std::cos(t1) - k2 * std::cos(t2)), 2.0));
    EXPECT_NEAR(coherentShare(rough, float(std::cos(t1)), float(std::cos(t2)), true), reflected, 1e-5 * reflected);
    EXPECT_NEAR(coherentShare(rough, float(std::cos(t1)), float(std::cos(t2)), false), transmitted, 1e-6);
  }
}

TEST(RoughSurface, TheRougherSideCountsFromEitherSide)
{
  TraceView view;
  view.waveNumberAtOne = float(2000.0 * M_PI * 3.0);
  TraceMedium a;
  TraceMedium b;
  a.speed = 1500.0f;
  b.speed = 1600.0f;
  a.roughnessMm = 0.1f;
  a.correlationMm = 2.0f;
  b.roughnessMm = 0.1f;
  b.correlationMm = 1.0f;
  EXPECT_FLOAT_EQ(roughBoundary(view, a, b).alpha, 0.2f);
  EXPECT_FLOAT_EQ(roughBoundary(view, b, a).alpha, 0.2f);
  a.roughnessMm = 0.3f;
  EXPECT_FLOAT_EQ(roughBoundary(view, a, b).alpha, 0.3f);
  EXPECT_FLOAT_EQ(roughBoundary(view, b, a).heightMm, 0.3f);
  EXPECT_FLOAT_EQ(roughBoundary(view, a, b).waveNumber1, float(6000.0 * M_PI / 1500.0));
  EXPECT_FLOAT_EQ(roughBoundary(view, b, a).waveNumber1, float(6000.0 * M_PI / 1600.0));
}

TEST(RoughSurface, BranchesAndCoherenceHaveTheirShares)
{
  // Four outcomes: mirrored or refracted exactly, or by facets of either branch.
  const Vec3f n(0.0f, 0.0f, 1.0f);
  const Vec3f d(0.6f, 0.0f, 0.8f);
  const Reflection r = reflectionAt(InterfaceModel::Acoustic, 1.5f, 3.0f, 1500.0f, 1750.0f, d.z);
  const RoughBoundary rough{ 0.05f, 0.2f, 8.0f, 7.0f };
  const double coherent[2] = { std::exp(-std::pow(0.05 * (8.0 * 0.8 - 7.0 * r.cosRefracted), 2.0)),
                               std::exp(-std::pow(0.05 * 16.0 * 0.8, 2.0)) };
  std::vector<double> observed(4, 0.0);
  for (int i = 0; i < 100000; ++i)
  {
    const Scattered s = scatterRough(rough, d, n, d.z, r, r.reflectance, sampleAt(i, 1));
    EXPECT_EQ(s.throughput, 1.0f);
    EXPECT_NEAR(glm::length(s.direction), 1.0f, 1e-6f);
    EXPECT_EQ(s.direction.z < 0.0f, s.reflected);
    const bool exact = glm::length(s.direction - branchDirection(d, n, d.z, r, s.reflected)) < 1e-6f;
    observed[(s.reflected ? 2 : 0) + (exact ? 0 : 1)] += 1.0;
  }
  const double share = r.reflectance;
  EXPECT_GT(chiSquaredPValue(observed, { (1.0 - share) * coherent[0], (1.0 - share) * (1.0 - coherent[0]),
                                         share * coherent[1], share * (1.0 - coherent[1]) }),
            0.001);
}

TEST(RoughSurface, VisibleNormalsFollowTheirDensity)
{
  // Cells in slope space, mean normal z; D(m) max(0, wi . m) / (cos_i (1 + Lambda)), summed over a fine grid.
  constexpr int cells = 16;
  constexpr int fine = 24;
  struct Case
  {
    double alpha;
    double degrees;
  };
  const std::vector<Case> cases = { { 0.05, 0.0 }, { 0.05, 60.0 }, { 0.2, 0.0 },  { 0.2, 30.0 }, { 0.2, 75.0 },
                                    { 0.2, 88.0 }, { 0.7, 45.0 },  { 0.7, 80.0 }, { 2.0, 10.0 }, { 2.0, 70.0 } };
  for (std::size_t c = 0; c < cases.size(); ++c)
  {
    const double alpha = cases[c].alpha;
    const Vec3f towards = -incidentAt(std::cos(cases[c].degrees * M_PI / 180.0), 0.7);
    const double range = 3.0; // slopes in widths
    std::vector<double> observed(cells * cells + 1, 0.0);
    std::vector<double> probability(observed.size(), 0.0);
    for (int i = 0; i < 100000; ++i)
    {
      const BounceSample u = sampleAt(i, std::uint32_t(100 + c));
      const Vec3f m = visibleNormal(float(alpha), towards, u.polar, u.azimuth);
      const int x = int(std::floor((m.x / m.z / alpha / range + 1.0) * 0.5 * cells));
      const int y = int(std::floor((m.y / m.z / alpha / range + 1.0) * 0.5 * cells));
      const bool inside = x >= 0 && x < cells && y >= 0 && y < cells;
      observed[inside ? std::size_t(y * cells + x) : std::size_t(cells * cells)] += 1.0;
    }
    const double step = 2.0 * range / (cells * fine);
    double total = 0.0;
    for (int j = 0; j < cells * fine; ++j)
    {
      for (int i = 0; i < cells * fine; ++i)
      {
        const double sx = (i + 0.5) * step - range;
        const double sy = (j + 0.5) * step - range;
        // Slopes have the density exp(-s^2) / pi; a facet of slope p shows cos_i + p . (tangential part).
        const double seen = double(towards.z) + alpha * (sx * towards.x + sy * towards.y);
        const double p = std::exp(-sx * sx - sy * sy) / M_PI * std::max(0.0, seen) /
                         (double(towards.z) * (1.0 + lambdaOf(alpha, Vec3d(towards)))) * step * step;
        probability[std::size_t(j / fine * cells + i / fine)] += p;
        total += p;
      }
    }
    EXPECT_LT(total, 1.0 + 1e-4);
    probability.back() = std::max(0.0, 1.0 - total);
    EXPECT_GT(chiSquaredPValue(observed, probability), significanceOfEach(int(cases.size())))
      << alpha << " " << cases[c].degrees;
  }
}

/// Share and directions of what leaves mirrors after one facet, against D G2 / (4 cos_i); 10.3 has the table.
TEST(RoughSurface, SingleMirroringFollowsTheMicrofacetDensity)
{
  struct Case
  {
    double alpha;
    double degrees;
    double leaves; ///< after one facet, as physics.md has it
  };
  const std::vector<Case> cases = { { 0.1, 0.0, 1.000 },  { 0.1, 75.0, 0.975 }, { 0.1, 85.0, 0.913 },
                                    { 0.2, 30.0, 1.000 }, { 0.2, 60.0, 0.972 }, { 0.2, 75.0, 0.914 },
                                    { 0.4, 0.0, 0.990 },  { 0.4, 30.0, 0.957 }, { 0.4, 60.0, 0.890 },
                                    { 0.7, 0.0, 0.749 },  { 0.7, 60.0, 0.837 }, { 0.7, 85.0, 0.963 } };
  constexpr int rows = 10;
  constexpr int columns = 16;
  constexpr int fine = 24;
  constexpr int samples = 200000;
  for (std::size_t c = 0; c < cases.size(); ++c)
  {
    const double alpha = cases[c].alpha;
    const double cosine = std::cos(cases[c].degrees * M_PI / 180.0);
    const Vec3f incident = incidentAt(cosine);
    std::vector<double> observed(rows * columns + 1, 0.0);
    std::vector<double> probability(observed.size(), 0.0);
    double single = 0.0;
    for (int i = 0; i < samples; ++i)
    {
      const BounceSample u = sampleAt(i, std::uint32_t(200 + c));
      const FacetPath out = walkFacets(float(alpha), incident, 0.0f, u);
      ASSERT_FALSE(out.behind);
      ASSERT_GT(out.direction.z, 0.0f);
      ASSERT_NEAR(glm::length(out.direction), 1.0f, 1e-5f);
      const Vec3f m = visibleNormal(float(alpha), -incident, u.polar, u.azimuth);
      const Vec3f once = incident - m * (2.0f * glm::dot(incident, m));
      std::size_t cell = rows * columns;
      if (glm::length(once - out.direction) < 1e-5f)
      {
        single += 1.0;
        const double azimuth = std::atan2(once.y, once.x) / (2.0 * M_PI) + 0.5;
        const double sineSquared = 1.0 - double(once.z) * once.z;
        cell = std::size_t(std::min(rows - 1, int(sineSquared * rows))) * columns +
               std::size_t(std::min(columns - 1, int(azimuth * columns)));
      }
      observed[cell] += 1.0;
    }
    double total = 0.0;
    const Vec3d wi(-Vec3d(incident));
    for (int i = 0; i < rows * fine * 4; ++i)
    {
      for (int j = 0; j < columns * fine; ++j)
      {
        const double sineSquared = (i + 0.5) / (rows * fine * 4);
        const double azimuth = 2.0 * M_PI * ((j + 0.5) / (columns * fine) - 0.5);
        const double z = std::sqrt(1.0 - sineSquared);
        const Vec3d wo(std::sqrt(sineSquared) * std::cos(azimuth), std::sqrt(sineSquared) * std::sin(azimuth), z);
        const double masking = 1.0 / (1.0 + lambdaOf(alpha, wi) + lambdaOf(alpha, wo));
        const double density = beckmann(alpha, glm::normalize(wi + wo)) * masking / (4.0 * cosine);
        // Solid angle: d(sin^2) / (2 cos) d(azimuth).
        const double p = density / (2.0 * z) * (1.0 / (rows * fine * 4)) * (2.0 * M_PI / (columns * fine));
        probability[std::size_t(i / (fine * 4) * columns + j / fine)] += p;
        total += p;
      }
    }
    EXPECT_NEAR(total, cases[c].leaves, 1.2e-3) << alpha << " " << cases[c].degrees;
    EXPECT_NEAR(single / samples, cases[c].leaves, 5e-4 + 4.0 * std::sqrt(0.25 / samples));
    probability.back() = std::max(1.0 - total, 0.0);
    EXPECT_GT(chiSquaredPValue(observed, probability), significanceOfEach(int(cases.size())))
      << alpha << " " << cases[c].degrees;
  }
}

/// Counts of paths from cells of directions on one side to cells on another, with incident directions uniform in
/// projected solid angle: what goes from a to b is then the integral of f cos cos over both.
class Exchange
{
public:
  static constexpr int rows = 5;    // of sin^2, on either side
  static constexpr int columns = 6; // of the azimuth between the two, which mirror images share

  /// What enters from side `from` and leaves on side `to`.
  double& at(int from, int rowIn, int to, int rowOut, int column)
  {
    return counts_[std::size_t((((from * rows + rowIn) * 2 + to) * rows + rowOut) * columns + column)];
  }

  template<class Walk>
  void enter(int from, int paths, const Walk& walk)
  {
    for (int i = 0; i < paths; ++i)
    {
      const BounceSample place = sampleAt(i, 300u + std::uint32_t(from));
      const double sineSquared = place.choice;
      const Vec3f incident = incidentAt(std::sqrt(1.0 - sineSquared));
      const FacetPath out = walk(incident, sampleAt(i, 400u + std::uint32_t(from)));
      const int to = out.behind ? 1 - from : from;
      const double outSquared = 1.0 - double(out.direction.z) * out.direction.z;
      const double azimuth = std::abs(std::atan2(out.direction.y, out.direction.x)) / M_PI;
      at(from, row(sineSquared), to, row(outSquared), std::min(columns - 1, int(azimuth * columns))) += 1.0;
    }
  }

  /// p-value of the counts there being those back, from the side a to b.
  double symmetry(int a, int b)
  {
    double statistic = 0.0;
    int freedom = 0;
    for (int i = 0; i < rows; ++i)
    {
      for (int j = a == b ? i + 1 : 0; j < rows; ++j)
      {
        for (int k = 0; k < columns; ++k)
        {
          const double there = at(a, i, b, j, k);
          const double back = at(b, j, a, i, k);
          if (there + back >= 20.0)
          {
            statistic += (there - back) * (there - back) / (there + back);
            ++freedom;
          }
        }
      }
    }
    return freedom > 0 ? chiSquaredTail(statistic, freedom) : 1.0;
  }

private:
  static int row(double sineSquared) { return std::min(rows - 1, int(sineSquared * rows)); }
  std::vector<double> counts_ = std::vector<double>(std::size_t(rows * rows * columns * 4), 0.0);
};

TEST(RoughSurface, MirroringFacetsAreReciprocal)
{
  const std::vector<double> alphas = { 0.2, 0.5, 1.0 };
  for (const double alpha : alphas)
  {
    Exchange exchange;
    exchange.enter(0, 1000000, [=](const Vec3f& incident, const BounceSample& u) {
      return walkFacets(float(alpha), incident, 0.0f, u);
    });
    EXPECT_GT(exchange.symmetry(0, 0), significanceOfEach(int(alphas.size()))) << alpha;
  }
  // One facet, and a wrong side mirrored, keeps the energy but is not reciprocal: the test must see that.
  Exchange single;
  single.enter(0, 1000000, [](const Vec3f& incident, const BounceSample& u) {
    const Vec3f m = visibleNormal(0.5f, -incident, u.polar, u.azimuth);
    Vec3f w = incident - m * (2.0f * glm::dot(incident, m));
    w.z = std::abs(w.z);
    return FacetPath{ w, false };
  });
  EXPECT_LT(single.symmetry(0, 0), 1e-6);
}

TEST(RoughSurface, RefractingFacetsAreReciprocal)
{
  // c2^2 f(1 -> 2) = c1^2 f(2 -> 1): with c2^2 / c1^2 times as many paths from 1 the counts must be alike.
  struct Case
  {
    double alpha;
    double ratio; ///< c2 / c1
  };
  const std::vector<Case> cases = { { 0.2, 1.1 }, { 0.5, 1.3 }, { 0.3, 2.6 }, { 1.0, 1.3 } };
  for (const Case& c : cases)
  {
    Exchange exchange;
    constexpr int paths = 400000;
    exchange.enter(0, int(std::lround(paths * c.ratio * c.ratio)), [&](const Vec3f& incident, const BounceSample& u) {
      return walkFacets(float(c.alpha), incident, float(c.ratio), u);
    });
    exchange.enter(1, paths, [&](const Vec3f& incident, const BounceSample& u) {
      return walkFacets(float(c.alpha), incident, float(1.0 / c.ratio), u);
    });
    const double significance = significanceOfEach(3 * int(cases.size()));
    EXPECT_GT(exchange.symmetry(0, 1), significance) << c.alpha << " " << c.ratio;
    EXPECT_GT(exchange.symmetry(0, 0), significance) << c.alpha << " " << c.ratio;
    EXPECT_GT(exchange.symmetry(1, 1), significance) << c.alpha << " " << c.ratio;
  }
}

TEST(RoughSurface, StaysOnItsSideAndOfUnitLengthAtTheLimits)
{
  const Vec3f n = glm::normalize(Vec3f(0.3f, -0.5f, 0.8f));
  const Vec3f across = glm::normalize(glm::cross(n, Vec3f(1.0f, 0.0f, 0.0f)));
  for (const float alpha : { 1e-6f, 1e-3f, 0.2f, steepestAlpha })
  {
    for (const float cosine : { 1.0f, 0.999999f, 0.3f, 1e-3f, 1e-6f })
    {
      for (const float speed : { 30.0f, 1499.999f, 1500.0f, 1600.0f, 30000.0f })
      {
        const Vec3f d = glm::normalize(n * cosine + across * std::sqrt(1.0f - cosine * cosine));
        const Reflection r = reflectionAt(InterfaceModel::Acoustic, 1.5f, 1.9f, 1500.0f, speed, cosine);
        const RoughBoundary rough{ 10.0f, alpha, 60.0f, 60.0f * 1500.0f / speed };
        for (int i = 0; i < 300; ++i)
        {
          BounceSample u = sampleAt(i, 500);
          u.polar = i == 0 ? 0.99999994f : (i == 1 ? 5.96e-8f : u.polar);
          u.azimuth = i == 0 ? 0.99999994f : (i == 1 ? 5.96e-8f : u.azimuth);
          const Scattered s = scatterRough(rough, d, n, cosine, r, r.reflectance, u);
          const float side = glm::dot(s.direction, n);
          ASSERT_NEAR(glm::length(s.direction), 1.0f, 1e-5f) << alpha << " " << cosine << " " << speed;
          ASSERT_TRUE(s.reflected ? side < 1e-6f : side > -1e-6f) << alpha << " " << cosine << " " << speed;
        }
      }
    }
  }
}

} // namespace
