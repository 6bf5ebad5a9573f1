// Normals of label boundaries against closed forms: slanted planes, thin plates, edges, and tubes that are not to be
// flattened.
#include "KernelScene.h"

#include "Scene/BoundaryFits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace sono {
namespace {

using test::KernelScene;
using test::makeMedium;

double degreesBetween(const Vec3d& a, const Vec3d& b)
{
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / M_PI;
}

Vec3d tilted(double degrees, double azimuthDegrees)
{
  const double t = degrees * M_PI / 180.0;
  const double a = azimuthDegrees * M_PI / 180.0;
  return { std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t) };
}

/// A volume of so many mean voxels along each edge, of three media.
struct Block
{
  Vec3d spacing;
  double meanVoxel;
  Vec3d middle; ///< on no voxel's centre or face
  KernelScene scene;

  Block(const Vec3d& spacingMm, int edge, const std::function<int(const Vec3d& fromMiddleVoxels)>& labelAt)
    : spacing(spacingMm)
    , meanVoxel(std::cbrt(spacingMm.x * spacingMm.y * spacingMm.z))
    , middle((0.5 * glm::ceil(edge * meanVoxel / spacingMm) + Vec3d(0.21, 0.37, 0.11)) * spacingMm)
    , scene(Vec3i(glm::ceil(edge * meanVoxel / spacingMm)), spacingMm,
            { makeMedium(1.5f, 1500.0f), makeMedium(1.7f, 1600.0f), makeMedium(1.9f, 1600.0f) },
            [this, &labelAt](const Vec3d& p) { return labelAt((p - middle) / meanVoxel); })
  {
  }
};

struct Hit
{
  bool found = false;
  Vec3d place{ 0.0 }; ///< mean voxels from the middle
  Vec3d normal{ 0.0 };
  int from = 0;
  int to = 0;
};

/// The first boundary on the way from a place, mean voxels from the middle.
Hit firstHit(const Block& block, const Vec3d& from, const Vec3d& direction)
{
  const auto space = block.scene.space();
  const Vec3f start(block.middle + from * block.meanVoxel);
  const CellRay ray{ start, Vec3f(direction), space.cellAt(start) };
  Hit hit;
  if (!space.contains(ray.cell))
  {
    return hit;
  }
  hit.from = space.tissueAt(ray.cell);
  const CellHit cell = space.march(ray, hit.from, NoStairs(), 1e4f);
  if (cell.tissue < 0)
  {
    return hit;
  }
  const RefinedHit refined = refineBoundary(space.cells, ray, cell);
  return { true, from + direction * double(refined.t) / block.meanVoxel, Vec3d(refined.normal), hit.from, cell.tissue };
}

struct Errors
{
  double meanDegrees = 0.0;
  double mostDegrees = 0.0;
  double offset = 0.0; ///< mean, of the places, mean voxels
};

/// Of a plane through the middle, where rays of up to 30 degrees to its normal meet it.
Errors planeErrors(const Block& block, const Vec3d& normal, double reach)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto any = [&] { return Vec3d(uniform(random), uniform(random), uniform(random)); };
  Errors errors;
  constexpr int rays = 600;
  for (int n = 0; n < rays; ++n)
  {
    Vec3d p = any() * reach;
    p -= normal * glm::dot(p, normal);
    const Vec3d d = glm::normalize(normal + 0.4 * any());
    const Hit hit = firstHit(block, p - 6.0 * d, d);
    EXPECT_TRUE(hit.found);
    const double degrees = degreesBetween(hit.normal, normal);
    errors.meanDegrees += degrees / rays;
    errors.mostDegrees = std::max(errors.mostDegrees, degrees);
    errors.offset += std::fabs(glm::dot(hit.place, normal)) / rays;
  }
  return errors;
}

TEST(BoundaryFits, ASlantedPlaneHasItsNormal)
{
  // Slopes of 1:3, 1:2, 2:3, 3:4, 1:1 and what lies between; 25 is that of `measure time`'s diaphragm.
  for (const Vec3d& spacing : { Vec3d(1.0), Vec3d(0.5), Vec3d(0.7, 0.7, 2.1), Vec3d(2.1, 0.7, 0.7) })
  {
    for (const double degrees :
         { 5.0, 8.0, 12.0, 18.4349, 20.0, 25.0, 26.5651, 30.0, 33.6901, 36.8699, 40.0, 45.0, 51.0, 60.0, 75.0, 88.0 })
    {
      for (const double azimuth : { 0.0, 17.0 })
      {
        const Vec3d normal = tilted(degrees, azimuth);
        const Block block(spacing, 84, [&](const Vec3d& p) { return glm::dot(p, normal) > 0.0 ? 1 : 0; });
        const Errors errors = planeErrors(block, normal, 16.0);
        const auto where = testing::Message() << degrees << " degrees, azimuth " << azimuth << ", spacing " << spacing.x
                                              << " " << spacing.z;
        EXPECT_LT(errors.meanDegrees, 0.3) << where;
        EXPECT_LT(errors.mostDegrees, 1.0) << where;
        EXPECT_LT(errors.offset, 0.5 * std::max(spacing.x, spacing.z) / block.meanVoxel) << where;
      }
    }
  }
}

TEST(BoundaryFits, APlaneNearAnAxisIsNoStaircase)
{
  for (const double degrees : { 0.5, 1.0, 2.0, 3.0 })
  {
    const Vec3d normal = tilted(degrees, 17.0);
    const Block block(Vec3d(1.0), 160, [&](const Vec3d& p) { return glm::dot(p, normal) > 0.0 ? 1 : 0; });
    EXPECT_LT(planeErrors(block, normal, 30.0).meanDegrees, 0.3) << degrees;
  }
}

TEST(BoundaryFits, FacesOfAPlateOfTwoVoxelsHaveOppositeNormals)
{
  for (const Vec3d& spacing : { Vec3d(1.0), Vec3d(0.7, 0.7, 2.1) })
  {
    for (const double degrees : { 0.0, 14.0, 25.0, 40.0 })
    {
      const Vec3d normal = tilted(degrees, 17.0);
      // Two voxels along the normal, whatever their shape.
      const double half = glm::dot(glm::abs(normal), spacing) / std::cbrt(spacing.x * spacing.y * spacing.z);
      const Block block(spacing, 84, [&](const Vec3d& p) { return std::fabs(glm::dot(p, normal)) < half ? 1 : 0; });
      std::mt19937 random(5);
      std::uniform_real_distribution<double> uniform(-16.0, 16.0);
      // In thick voxels two voxels are too thin for the smoothed labels here and there: the voxel's face stands there.
      const double most = spacing.x == spacing.z ? 0.6 : 20.0;
      double sum = 0.0;
      constexpr int rays = 300;
      for (int n = 0; n < rays; ++n)
      {
        Vec3d p(uniform(random), uniform(random), uniform(random));
        p -= normal * glm::dot(p, normal);
        for (const double side : { 1.0, -1.0 })
        {
          const Hit in = firstHit(block, p - side * (half + 5.0) * normal, side * normal);
          const Hit out = firstHit(block, p, side * normal);
          EXPECT_EQ(in.to, 1);
          EXPECT_EQ(out.from, 1);
          EXPECT_LT(degreesBetween(in.normal, side * normal), most) << degrees << " " << spacing.z;
          EXPECT_LT(degreesBetween(out.normal, side * normal), most) << degrees << " " << spacing.z;
          sum += degreesBetween(in.normal, side * normal) + degreesBetween(out.normal, side * normal);
        }
      }
      EXPECT_LT(sum / (4 * rays), spacing.x == spacing.z ? 0.3 : 1.0) << degrees << " " << spacing.z;
    }
  }
}

/// Mean error of the normals of a tube, degrees.
double tubeError(const Vec3d& spacing, double radius, const Vec3d& axis)
{
  const auto across = [&](const Vec3d& p) { return p - axis * glm::dot(p, axis); };
  const Block block(spacing, 64, [&](const Vec3d& p) { return glm::length(across(p)) < radius ? 1 : 0; });
  std::mt19937 random(7);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> uniform(-12.0, 12.0);
  double sum = 0.0;
  constexpr int rays = 2000;
  for (int n = 0; n < rays; ++n)
  {
    const Vec3d outward = glm::normalize(across(Vec3d(gauss(random), gauss(random), gauss(random))));
    const Hit hit = firstHit(block, axis * uniform(random) + outward * (radius + 6.0), -outward);
    sum += degreesBetween(-hit.normal, outward) / rays;
  }
  return sum;
}

TEST(BoundaryFits, AWireIsNotFlattened)
{
  const Vec3d axis = glm::normalize(Vec3d(0.3, 1.0, 0.2));
  struct Case
  {
    double radius;
    double degrees; ///< by smoothing alone, rounded up
    double degreesThick;
  };
  for (const Case& tube : { Case{ 2.0, 2.7, 8.7 }, Case{ 4.0, 0.72, 2.95 }, Case{ 8.0, 0.86, 1.43 } })
  {
    EXPECT_LT(tubeError(Vec3d(1.0), tube.radius, axis), tube.degrees) << tube.radius;
    EXPECT_LT(tubeError(Vec3d(0.7, 0.7, 2.1), tube.radius, axis), tube.degreesThick) << tube.radius;
  }
}

TEST(BoundaryFits, AThinShellBehindAWedgeKeepsItsNormal)
{
  // A sac of two voxels around a ball, and a wall that it touches: what lies between them ends in a wedge all around,
  // whose smoothed surface faces along it. Beyond the critical angle no sound would enter the sac.
  for (const double radius : { 30.0, 45.0 })
  {
    const Vec3d up = tilted(33.0, 20.0);
    const Block block(Vec3d(1.0), int(2.0 * radius) + 24, [&](const Vec3d& p) {
      const double r = glm::length(p);
      const bool isBehind = glm::dot(p, up) > radius + 1.0 || r < radius - 3.5;
      return r < radius && r > radius - 2.0 ? 1 : (isBehind ? 2 : 0);
    });
    const Vec3d side = glm::normalize(glm::cross(up, Vec3d(0.3, 0.2, 0.9)));
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    constexpr int rays = 2000;
    double mean = 0.0;
    int far = 0;
    for (int n = 0; n < rays; ++n)
    {
      const double gap = 2.5 + 3.0 * uniform(random); // of the wedge, voxels; where it is narrower it may still lead
      const double angle = std::acos((radius + 1.0 - gap) / radius);
      const double around = 2.0 * M_PI * uniform(random);
      const Vec3d across = std::cos(around) * side + std::sin(around) * glm::cross(up, side);
      const Vec3d outward = std::cos(angle) * up + std::sin(angle) * across;
      const Hit hit = firstHit(block, (radius + 1.2) * outward, -outward);
      ASSERT_TRUE(hit.found && hit.from == 0 && hit.to == 1);
      const double degrees = degreesBetween(-hit.normal, outward);
      mean += degrees / rays;
      far += degrees > 20.0 ? 1 : 0;
    }
    EXPECT_LT(mean, 3.0) << radius;
    EXPECT_LE(far, rays / 100) << radius;
  }
}

TEST(BoundaryFits, AnEdgeEndsItsFaces)
{
  // A step of two slanted planes at right angles: two voxels off the edge each has its own normal.
  const Vec3d one = tilted(20.0, 17.0);
  const Vec3d edge = glm::normalize(glm::cross(one, Vec3d(0.2, 1.0, 0.1)));
  const Vec3d other = glm::cross(edge, one);
  const Block block(Vec3d(1.0), 140,
                    [&](const Vec3d& p) { return glm::dot(p, one) > 0.0 && glm::dot(p, other) > 0.0 ? 1 : 0; });
  for (double along = -12.0; along < 12.0; along += 0.37)
  {
    for (const double off : { 30.0, 36.0 })
    {
      EXPECT_LT(degreesBetween(firstHit(block, edge * along + other * off - 6.0 * one, one).normal, one), 0.5);
      EXPECT_LT(degreesBetween(firstHit(block, edge * along + one * off - 6.0 * other, other).normal, other), 0.5);
    }
    for (const double off : { 3.0, 6.0, 12.0 })
    {
      EXPECT_LT(degreesBetween(firstHit(block, edge * along + other * off - 6.0 * one, one).normal, one), 9.0) << off;
    }
  }
}

} // namespace
} // namespace sono
