#include "Phantoms/ThoraxPhantom.h"
#include "Scene/CoarseSurface.h"
#include "TestScenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

using namespace sono;
using namespace sono::test;

namespace {

Vec3d cornerOf(const TriangleSurface& surface, int i)
{
  const std::array<float, 3>& p = surface.points[std::size_t(i)];
  return { p[0], p[1], p[2] };
}

/// From a point to a triangle: to its plane where the foot lies within, else to the nearest of its edges.
double distance(const Vec3d& p, const std::array<Vec3d, 3>& corners)
{
  const Vec3d normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  bool isWithin = true;
  double nearest = 1e300;
  for (int i = 0; i < 3; ++i)
  {
    const Vec3d a = corners[i];
    const Vec3d edge = corners[(i + 1) % 3] - a;
    isWithin = isWithin && glm::dot(glm::cross(normal, edge), p - a) >= 0.0;
    const double along = std::clamp(glm::dot(p - a, edge) / glm::dot(edge, edge), 0.0, 1.0);
    nearest = std::min(nearest, glm::length(p - a - edge * along));
  }
  return isWithin ? std::abs(glm::dot(glm::normalize(normal), p - corners[0])) : nearest;
}

} // namespace

TEST(CoarseSurface, BothSidesOfAThinShellStayWhereTheyAre)
{
  // A wall as thin as the cubes that points are gathered in: means over a cube would lie in its middle.
  const Vec3d centre(30.0);
  constexpr double outerMm = 22.0;
  constexpr double wallMm = 2.5;
  const auto scene = makeScene(
    Vec3i(60), Vec3d(1.0), { makeTissue("a", 1.5, 1500, 0.5), makeTissue("b", 1.7, 1600, 0.5) }, [&](const Vec3d& p) {
      const double r = glm::length(p - centre);
      return r < outerMm && r > outerMm - wallMm ? 1 : 0;
    });
  const TriangleSurface full = meshSurface(scene->volume(), scene->surface(1));
  const DrawnSurface coarse = coarseSurface(full, 2.5);
  EXPECT_LT(coarse.triangles.size() * 5, full.triangles.size());
  double areaMm2 = 0.0;
  std::map<std::pair<int, int>, int> edges;
  for (const std::array<int, 3>& triangle : coarse.triangles)
  {
    const std::array<Vec3d, 3> corners{ cornerOf(coarse, triangle[0]), cornerOf(coarse, triangle[1]),
                                        cornerOf(coarse, triangle[2]) };
    areaMm2 += 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    for (int i = 0; i < 3; ++i)
    {
      for (double along : { 0.0, 0.5 }) // a chord's middle lies deepest
      {
        const double r = glm::length(glm::mix(corners[i], corners[(i + 1) % 3], along) - centre);
        EXPECT_LT(std::min(std::abs(r - outerMm), std::abs(r - (outerMm - wallMm))), 0.5);
      }
      ++edges[{ triangle[i], triangle[(i + 1) % 3] }];
      --edges[{ triangle[(i + 1) % 3], triangle[i] }];
    }
  }
  for (std::size_t i = 0; i < coarse.points.size(); ++i)
  {
    // Into the label, as meshSurface's triangles face.
    const Vec3d outward = glm::normalize(cornerOf(coarse, int(i)) - centre);
    const Vec3d normal(coarse.normals[i][0], coarse.normals[i][1], coarse.normals[i][2]);
    const bool isOuter = glm::length(cornerOf(coarse, int(i)) - centre) > outerMm - 0.5 * wallMm;
    EXPECT_GT(glm::dot(normal, outward) * (isOuter ? -1.0 : 1.0), 0.98);
  }
  // Of two closed surfaces each edge is run along once in either direction.
  EXPECT_TRUE(std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 0; }));
  const double wantedMm2 = 4.0 * M_PI * (outerMm * outerMm + (outerMm - wallMm) * (outerMm - wallMm));
  EXPECT_NEAR(areaMm2 / wantedMm2, 1.0, 0.02);
}

TEST(CoarseSurface, TheThoraxStaysWithinHalfAVoxel)
{
  constexpr double spacingMm = 2.0;
  const LabelVolume volume = makeThoraxPhantom(spacingMm);
  const std::vector<VoxelBox> boxes = labelBoxes(volume);
  std::size_t fullCount = 0;
  std::size_t coarseCount = 0;
  std::size_t next = 0; // point to be looked at, of the labels one after another
  int looked = 0;
  int beyondHalf = 0;
  double sum = 0.0;
  for (std::size_t label = 0; label < boxes.size(); ++label)
  {
    if (volume.labels[label].id == 0)
    {
      continue;
    }
    const TriangleSurface full = meshSurface(volume, buildSurface(volume, volume.labels[label].id, boxes[label]));
    const DrawnSurface coarse = coarseSurface(full, 2.5 * spacingMm);
    fullCount += full.triangles.size();
    coarseCount += coarse.triangles.size();
    for (; next < full.points.size(); next += 1277)
    {
      const Vec3d p = cornerOf(full, int(next));
      double nearest = 1e300;
      for (const std::array<int, 3>& t : coarse.triangles)
      {
        const Vec3d first = cornerOf(coarse, t[0]);
        if (glm::length(first - p) < nearest + 6.0 * spacingMm) // no edge is longer
        {
          nearest = std::min(nearest, distance(p, { first, cornerOf(coarse, t[1]), cornerOf(coarse, t[2]) }));
        }
      }
      ++looked;
      beyondHalf += nearest > 0.5 * spacingMm ? 1 : 0;
      sum += nearest / spacingMm;
    }
    next -= full.points.size();
  }
  EXPECT_LT(coarseCount * 5, fullCount);
  EXPECT_GT(looked, 400);
  EXPECT_LT(beyondHalf, 0.02 * looked); // finer voxels, less: 0.3 % at 1 mm
  EXPECT_LT(sum / looked, 0.1);
}
