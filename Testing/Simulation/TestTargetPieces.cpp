#include "Echo/TargetPieces.h"
#include "SurfaceFigures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>
#include <vector>

// Points of targets, cut brick by brick, against the triangles that they are made of.

namespace sono::test {
namespace {

/// Of surfaces: area, and its first moments.
struct Moments
{
  double areaMm2 = 0.0;
  Vec3d mm3{ 0.0 };
};

Moments ofTriangles(const std::vector<TargetSurface>& targets)
{
  Moments sum;
  for (const TargetSurface& target : targets)
  {
    for (const auto& corners : target.triangles)
    {
      const Vec3d a = target.pointsMm[std::size_t(corners[0])];
      const Vec3d b = target.pointsMm[std::size_t(corners[1])];
      const Vec3d c = target.pointsMm[std::size_t(corners[2])];
      const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
      sum.areaMm2 += area;
      sum.mm3 += area * (a + b + c) / 3.0;
    }
  }
  return sum;
}

class TargetPiecesOf : public testing::TestWithParam<double>
{
};

TEST_P(TargetPiecesOf, EachTriangleIsInTheBricksOnce)
{
  const double longestMm = GetParam();
  const Tissue tissue = surfaceTissue("steel", behind, 0.0);
  // Two of its faces lie where bricks part.
  TargetSurface box = makeBox("box", tissue, { -8, -4, 0 }, { 8, 4, 9 });
  for (Vec3d& p : box.pointsMm)
  {
    p = Vec3d(16.0 + 0.95 * p.x - 0.3 * p.z, 12.0 + p.y, 24.0 + 0.3 * p.x + 0.95 * p.z);
  }
  const std::vector<TargetSurface> targets{ box, ball(tissue, { 16, 12, 8 }, 7.0, 9) };
  const auto made =
    makeScene(targetVolume, Vec3d(1.0), { surfaceTissue("water", inMedium, 0.0) }, [](const Vec3d&) { return 0; });
  const Scene& scene = *made;
  const EchoSettings settings = surfaceSettings();
  const BeamModel beams(settings, InterfaceModel::Acoustic);
  const SurfaceRows rows({ { scene.tissues()[0], tissue, tissue }, 1, -1 }, settings, beamExtent(beams), 0.2, 0.6);
  const TargetPieces both(scene, targets, { 0, 1 }, rows, longestMm, 5);
  const TargetPieces one(scene, targets, { 1 }, rows, longestMm, 5);

  Moments sum;
  std::set<std::tuple<float, float, float>> places;
  std::size_t count = 0;
  std::size_t unlike = 0;
  std::vector<SurfacePoint> points;
  std::vector<SurfacePoint> ofOne;
  const float edge = both.grid().edgeMm;
  const Vec3i low(glm::round(both.grid().lowMm / edge));
  const Vec3i high(glm::round(both.grid().highMm / edge));
  for (int k = low.z - 1; k <= high.z; ++k)
  {
    for (int j = low.y - 1; j <= high.y; ++j)
    {
      for (int i = low.x - 1; i <= high.x; ++i)
      {
        const Vec3i brick(i, j, k);
        both.cutBrick(brick, points);
        one.cutBrick(brick, ofOne);
        std::size_t own = 0;
        for (const SurfacePoint& point : points)
        {
          ASSERT_EQ(Vec3i(glm::floor(point.position / edge)), brick);
          ASSERT_LE(double(point.areaMm2), 0.4331 * longestMm * longestMm);
          sum.areaMm2 += double(point.areaMm2);
          sum.mm3 += double(point.areaMm2) * Vec3d(point.position);
          places.emplace(point.position.x, point.position.y, point.position.z);
          if (point.row == rows.row(2, 0))
          {
            ASSERT_LT(own, ofOne.size());
            unlike += point.phaseRe != ofOne[own].phaseRe || point.position != ofOne[own].position ? 1 : 0;
            ++own;
          }
        }
        count += points.size();
        EXPECT_EQ(own, ofOne.size());
      }
    }
  }
  const Moments wanted = ofTriangles(targets);
  EXPECT_NEAR(sum.areaMm2, wanted.areaMm2, 1e-6 * wanted.areaMm2);
  EXPECT_LT(glm::length(sum.mm3 - wanted.mm3), 1e-6 * glm::length(wanted.mm3));
  EXPECT_EQ(places.size(), count);
  EXPECT_GT(double(count), wanted.areaMm2 / (0.4331 * longestMm * longestMm));
  EXPECT_GT(count, std::size_t(100));
  EXPECT_EQ(unlike, std::size_t(0));
}

// Shorter than the parts that bricks begin with, longer, and longer than a brick.
INSTANTIATE_TEST_SUITE_P(Lengths, TargetPiecesOf, testing::Values(0.21, 1.7, 6.0));

} // namespace
} // namespace sono::test
