#pragma once

#include "KernelScene.h"

#include <cmath>
#include <random>

namespace sono::test {

/// Share of the paths that, mirrored at a rigid sphere of the given radius in voxels of 1 mm, meet the same sphere
/// again: a convex surface lets every mirrored ray go.
inline double falseRehitShare(double radiusVoxel, int reflections)
{
  const int edge = 2 * int(std::ceil(radiusVoxel)) + 12;
  const Vec3d centre(0.5 * edge + 0.13, 0.5 * edge - 0.21, 0.5 * edge + 0.37);
  KernelScene scene(Vec3i(edge), Vec3d(1.0), { makeMedium(1.5f, 1540.0f), makeMedium(5000.0f, 1540.0f) },
                    [&](const Vec3d& p) { return glm::length(p - centre) < radiusVoxel ? 1 : 0; });
  scene.view.deterministic = true; // the stronger branch, which is the mirrored one
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto onSphere = [&] {
    for (;;)
    {
      const Vec3d p(uniform(random), uniform(random), uniform(random));
      const double length = glm::length(p);
      if (length > 0.1 && length < 1.0)
      {
        return p / length;
      }
    }
  };
  NullSink sink;
  int again = 0;
  for (int done = 0; done < reflections;)
  {
    // From two voxels outside the sphere toward a point inside it.
    const Vec3d start = centre + onSphere() * (radiusVoxel + 2.0);
    const Vec3d aim = centre + onSphere() * (0.98 * radiusVoxel);
    PathState path;
    path.ray.position = Vec3f(start);
    path.ray.direction = Vec3f(glm::normalize(aim - start));
    path.ray.cell = scene.space().cellAt(path.ray.position);
    TraceLine line{ path.ray.position, path.ray.direction };
    PathBoundary boundary;
    if (!advanceToBoundary(scene.view, scene.space(), line, path, boundary, sink))
    {
      continue;
    }
    leaveBoundary(scene.view, boundary, BounceSample{ 0.5f, 0.5f, 0.5f }, path);
    ++done;
    // The way on is judged by the sphere alone, not by the line's slab.
    path.length = 0.0f;
    line = { path.ray.position, path.ray.direction };
    again += advanceToBoundary(scene.view, scene.space(), line, path, boundary, sink) ? 1 : 0;
  }
  return double(again) / reflections;
}

} // namespace sono::test
