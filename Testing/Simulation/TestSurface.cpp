#include "FalseRehits.h"
#include "HollowHits.h"
#include "KernelScene.h"
#include "TestScenes.h"

#include "Scene/SurfaceField.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace sono;
using namespace sono::test;

/// An ellipsoid whose semi-axes are given in mean voxels, in a volume with some room around it.
struct Ellipsoid
{
  Vec3d spacing;
  double meanVoxel;
  Vec3d semiAxes; ///< mm
  Vec3i size;
  Vec3d centre; ///< on no voxel's centre or face

  Ellipsoid(const Vec3d& spacingMm, const Vec3d& semiAxesVoxels)
    : spacing(spacingMm)
    , meanVoxel(std::cbrt(spacingMm.x * spacingMm.y * spacingMm.z))
    , semiAxes(semiAxesVoxels * meanVoxel)
    , size(glm::ceil((semiAxes + 4.0 * meanVoxel) * 2.0 / spacing))
    , centre(Vec3d(size) * spacing * 0.5 + Vec3d(0.13, -0.21, 0.34) * spacing)
  {
  }
  double level(const Vec3d& p) const { return glm::length((p - centre) / semiAxes); }
  Vec3d normal(const Vec3d& p) const { return glm::normalize((p - centre) / (semiAxes * semiAxes)); }
  /// Signed distance to first order, which is exact to 1 % within a voxel of the surfaces here.
  double distance(const Vec3d& p) const
  {
    const double f = level(p);
    return (f - 1.0) * f / glm::length((p - centre) / (semiAxes * semiAxes));
  }
};

struct SurfaceError
{
  double meanOffset = 0.0; ///< mean voxels
  double meanDegrees = 0.0;
  double p95Degrees = 0.0;
};

Vec3d randomUnit(std::mt19937& random)
{
  std::normal_distribution<double> gauss;
  return glm::normalize(Vec3d(gauss(random), gauss(random), gauss(random)));
}

/// A ray from outside onto the ellipsoid's bounding sphere of `radius`, uniform over direction and cross-section.
CellRay randomRay(const KernelScene& scene, const Vec3d& centre, double radius, std::mt19937& random)
{
  std::uniform_real_distribution<double> uniform;
  const Vec3d d = randomUnit(random);
  const Vec3d s = glm::normalize(glm::cross(d, randomUnit(random)));
  const Vec3d start = centre + s * (radius * std::sqrt(uniform(random))) - d * (radius * 2.0);
  TraceLine line{ Vec3f(start), Vec3f(d) };
  PathState path;
  if (!enterSpace(scene.space(), line, 1e4f, path))
  {
    path.ray.cell = Vec3i(-1);
  }
  return path.ray;
}

SurfaceError measure(const Ellipsoid& shape, int rays)
{
  const KernelScene scene(shape.size, shape.spacing, { makeMedium(1.5f, 1500.0f), makeMedium(1.7f, 1600.0f) },
                          [&](const Vec3d& p) { return shape.level(p) < 1.0 ? 1 : 0; });
  const auto space = scene.space();
  std::mt19937 random(4);
  std::vector<double> degrees;
  SurfaceError error;
  while (int(degrees.size()) < rays)
  {
    const double reach = std::max(shape.semiAxes.x, std::max(shape.semiAxes.y, shape.semiAxes.z));
    const CellRay ray = randomRay(scene, shape.centre, reach, random);
    if (ray.cell.x < 0)
    {
      continue;
    }
    const CellHit hit = space.march(ray, 0, NoStairs(), 1e4f);
    if (hit.tissue != 1)
    {
      continue;
    }
    const RefinedHit surface = refineBoundary(space.cells, ray, hit);
    const Vec3d point(ray.position + ray.direction * surface.t);
    error.meanOffset += std::abs(shape.distance(point)) / shape.meanVoxel / rays;
    // The hit's normal points from the outside into the ellipsoid.
    const Vec3d n = -shape.normal(point);
    degrees.push_back(
      std::atan2(glm::length(glm::cross(n, Vec3d(surface.normal))), glm::dot(n, Vec3d(surface.normal))) * 180.0 / M_PI);
    error.meanDegrees += degrees.back() / rays;
  }
  std::sort(degrees.begin(), degrees.end());
  error.p95Degrees = degrees[degrees.size() * 95 / 100];
  return error;
}

TEST(SurfaceRefinement, SpheresAndEllipsoidsFromFifteenVoxelsOn)
{
  for (const Vec3d& spacing : { Vec3d(1.0), Vec3d(0.4), Vec3d(0.7, 0.7, 2.1), Vec3d(2.1, 0.7, 0.7), Vec3d(1, 3, 3) })
  {
    // The ellipsoids' smallest radius of curvature, shortest semi-axis squared over longest, is above 15 as well.
    for (const Vec3d& axes :
         { Vec3d(15.0), Vec3d(20.0), Vec3d(30.0), Vec3d(20.0, 23.0, 26.0), Vec3d(25.0, 20.0, 20.0) })
    {
      const SurfaceError error = measure(Ellipsoid(spacing, axes), 4000);
      EXPECT_LT(error.meanOffset, 0.15) << "spacing " << spacing.x << " " << spacing.z << " axes " << axes.x;
      EXPECT_LT(error.meanDegrees, 2.0) << "spacing " << spacing.x << " " << spacing.z << " axes " << axes.x;
      EXPECT_LT(error.p95Degrees, 5.0) << "spacing " << spacing.x << " " << spacing.z << " axes " << axes.x;
    }
  }
}

TEST(SurfaceRefinement, SphereOfEightVoxels)
{
  for (const Vec3d& spacing : { Vec3d(1.0), Vec3d(0.7, 0.7, 2.1) })
  {
    const SurfaceError error = measure(Ellipsoid(spacing, Vec3d(8.0)), 20000);
    EXPECT_LT(error.meanDegrees, 4.0) << spacing.z;
  }
}

TEST(SurfaceRefinement, AFlatWallIsExactAtAnySpacing)
{
  for (const Vec3d& spacing : { Vec3d(1.0), Vec3d(1.0, 1.0, 3.0), Vec3d(1.0, 1.0, 10.0), Vec3d(10.0, 1.0, 1.0) })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double wall = 10.0 * spacing[axis];
      const KernelScene scene(Vec3i(20), spacing, { makeMedium(1.5f, 1500.0f), makeMedium(1.7f, 1600.0f) },
                              [&](const Vec3d& p) { return p[axis] < wall ? 0 : 1; });
      Vec3d direction(0.3, 0.2, 0.25);
      direction[axis] = 1.0;
      CellRay ray{ Vec3f(Vec3d(8.3) * spacing), Vec3f(glm::normalize(direction)), Vec3i(8) };
      const CellHit hit = scene.space().march(ray, 0, NoStairs(), 1e4f);
      const RefinedHit surface = refineBoundary(scene.space().cells, ray, hit);
      EXPECT_NEAR((ray.position + ray.direction * surface.t)[axis], wall, 0.01 * scene.region.view().meanSpacing);
      EXPECT_NEAR(surface.normal[axis], 1.0f, 1e-4f);
    }
  }
}

TEST(SurfaceField, HoldsTheDistanceToASphere)
{
  for (const Vec3d& spacing : { Vec3d(1.0), Vec3d(0.7, 0.7, 2.1) })
  {
    for (const double radius : { 15.0, 25.0 })
    {
      const Ellipsoid sphere(spacing, Vec3d(radius));
      const auto scene =
        makeScene(sphere.size, spacing, { makeTissue("out", 1.5, 1500, 0.5), makeTissue("in", 1.7, 1600, 0.5) },
                  [&](const Vec3d& p) { return sphere.level(p) < 1.0 ? 1 : 0; });
      const SurfaceField& field = scene->surface(1);
      double sum = 0.0;
      int count = 0;
      for (int k = 0; k < sphere.size.z; ++k)
      {
        for (int j = 0; j < sphere.size.y; ++j)
        {
          for (int i = 0; i < sphere.size.x; ++i)
          {
            const double d = glm::length((Vec3d(i, j, k) + 0.5) * spacing - sphere.centre) - radius * sphere.meanVoxel;
            const double value = field.at(Vec3i(i, j, k));
            if (std::abs(d) < 1.5 * sphere.meanVoxel)
            {
              sum += std::abs(value - d) / sphere.meanVoxel;
              ++count;
            }
            else if (std::abs(d) > 4.0 * sphere.meanVoxel)
            {
              ASSERT_NEAR(value, std::copysign(field.bandMm, d), 1e-6);
            }
          }
        }
      }
      EXPECT_LT(sum / count, 0.15) << "radius " << radius << " spacing " << spacing.z;
    }
  }
}

/// The labels that a path runs through when every boundary lets it pass, by the tracer's own steps.
std::vector<int> labelsAlong(const KernelScene& scene, const CellRay& ray)
{
  PathState path;
  path.ray = ray;
  path.tissue = scene.space().tissueAt(ray.cell);
  const TraceLine line{ ray.position, ray.direction };
  std::vector<int> labels{ path.tissue };
  PathBoundary boundary;
  NullSink sink;
  while (labels.size() < 50 && advanceToBoundary(scene.view, scene.space(), line, path, boundary, sink))
  {
    leaveBoundary(scene.view, boundary, BounceSample{ 0.9999f, 0.5f, 0.5f }, path);
    labels.push_back(path.tissue);
  }
  return labels;
}

/// Rays through a ball inside the shells, so that each meets every surface well away from grazing; at most the given
/// share of them may see another sequence.
template<class Label>
void expectSequence(const Vec3d& spacing, double coreVoxels, const std::vector<int>& expected, double wrongShare,
                    const Label& label)
{
  const Vec3i size(Vec3d(48.0) / spacing);
  const Vec3d centre = Vec3d(size) * spacing * 0.5 + 0.17;
  const std::vector<TraceMedium> media{ makeMedium(1.5f, 1540.0f), makeMedium(1.6f, 1540.0f),
                                        makeMedium(1.7f, 1540.0f) };
  const KernelScene scene(size, spacing, media, [&](const Vec3d& p) { return label(p - centre); });
  std::mt19937 random(6);
  int wrong = 0;
  constexpr int rays = 20000;
  for (int i = 0; i < rays; ++i)
  {
    const CellRay ray = randomRay(scene, centre, coreVoxels, random);
    if (ray.cell.x >= 0 && scene.space().tissueAt(ray.cell) == 0)
    {
      wrong += labelsAlong(scene, ray) != expected;
    }
  }
  EXPECT_LE(wrong, wrongShare * rays) << "of " << rays << ", spacing " << spacing.z;
}

TEST(SurfaceTopology, AOneVoxelShellKeepsBothItsSurfaces)
{
  for (const Vec3d& spacing : { Vec3d(1.0), Vec3d(0.8, 0.8, 2.4) })
  {
    const double radius = 16.0;
    // The voxels of the ball that have a face on the outside: one voxel thick, and closed against the core.
    const auto label = [&](const Vec3d& p) {
      if (glm::length(p) >= radius)
      {
        return 0;
      }
      for (int a = 0; a < 3; ++a)
      {
        Vec3d step(0.0);
        step[a] = spacing[a];
        if (glm::length(p + step) >= radius || glm::length(p - step) >= radius)
        {
          return 1;
        }
      }
      return 2;
    };
    // Thrice as thick as wide, one voxel has no room for the staircases of both its sides: some rays meet one twice.
    const double wrongShare = spacing.x == spacing.z ? 0.0 : 0.01;
    expectSequence(spacing, 12.0, { 0, 1, 2, 1, 0 }, wrongShare, label);
    // The same shell around a cavity of what is outside.
    expectSequence(spacing, 12.0, { 0, 1, 0, 1, 0 }, wrongShare, [&](const Vec3d& p) { return label(p) == 1 ? 1 : 0; });
  }
}

TEST(SurfaceTopology, AHollowShellKeepsItsCavity)
{
  for (const Vec3d& spacing : { Vec3d(1.0), Vec3d(0.8, 0.8, 2.4) })
  {
    expectSequence(spacing, 9.0, { 0, 1, 0, 1, 0 }, 0.0, [](const Vec3d& p) {
      const double r = glm::length(p);
      return r < 18.0 && r > 13.0 ? 1 : 0;
    });
  }
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int roundHits = 4000;
#else
constexpr int roundHits = 100000;
#endif

TEST(SurfaceRestart, NoHitIsOffAndNoWayLeadsThroughAnotherTissue)
{
  for (const RoundBody& body : roundBodies())
  {
    int away = 0;
    int again = 0;
    for (const Turning& turning : allTurnings())
    {
      const RoundHits found = meetRoundBody(body, turning, roundHits);
      const std::string what =
        body.name + " lobe " + std::to_string(turning.lobeDegrees) + " rough " + std::to_string(turning.roughness);
      EXPECT_EQ(found.off, 0) << "of " << found.hits << ", worst " << found.worst << " voxels, " << what;
      EXPECT_EQ(found.through, 0) << "of " << found.hits << ", " << what;
      away += found.away;
      again += found.again;
    }
    EXPECT_LE(again, 0.002 * away) << "of " << away << ", " << body.name;
  }
}

TEST(SurfaceRestart, AMirroredPathDoesNotMeetTheSameSphereAgain)
{
  for (const double radius : { 30.0, 90.0 })
  {
    EXPECT_LT(falseRehitShare(radius, 100000), 0.001) << "radius " << radius;
  }
}

} // namespace
