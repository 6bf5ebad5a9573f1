#include "KernelScene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

// What walls of a few voxels let through, against a ray that is followed by formulas through concentric spheres.

namespace sono::test {

/// Hears everything: paths end where they leave the volume.
struct AllBeam
{
};
inline float remainingLength(const TraceView&, const AllBeam&, const PathState&)
{
  return 1e4f;
}

namespace {

// Fat and pericardium.
constexpr double softImpedance = 1.38;
constexpr double softSpeed = 1450.0;
constexpr double wallImpedance = 1.832;
constexpr double wallSpeed = 1664.0;

/// Share of the intensity that goes on, for the sine of the angle of incidence; the fluid-fluid formula.
double transmitted(double z1, double c1, double z2, double c2, double sine)
{
  const double sine2 = c2 / c1 * sine;
  if (sine2 >= 1.0)
  {
    return 0.0;
  }
  const double cosine = std::sqrt(1.0 - sine * sine);
  const double cosine2 = std::sqrt(1.0 - sine2 * sine2);
  const double r = (z2 * cosine - z1 * cosine2) / (z2 * cosine + z1 * cosine2);
  return 1.0 - r * r;
}

/// What a ray that passes the centre at a distance loses in a spherical wall. By Snell's law its distance from the
/// centre within a medium is in proportion to the speed, and r is the same from either side.
double throughShell(double distance, double outer, double inner)
{
  const double into = transmitted(softImpedance, softSpeed, wallImpedance, wallSpeed, distance / outer);
  const double within = distance * wallSpeed / softSpeed;
  if (into == 0.0 || within >= inner)
  {
    return into * into;
  }
  const double outOf = transmitted(wallImpedance, wallSpeed, softImpedance, softSpeed, within / inner);
  return into * into * outOf * outOf;
}

/// Mean over rays, traced over true, in dB.
double shellErrorDb(double wallVoxels, const Vec3d& spacing, double& hitsPerRay)
{
  const double outer = 30.0 * std::cbrt(spacing.x * spacing.y * spacing.z);
  const double inner = outer * (1.0 - wallVoxels / 30.0);
  const Vec3i size(glm::ceil(Vec3d(2.0 * outer + 10.0) / spacing));
  const Vec3d centre = (Vec3d(size) * 0.5 + Vec3d(0.13, -0.21, 0.34)) * spacing;
  KernelScene scene(
    size, spacing,
    { makeMedium(float(softImpedance), float(softSpeed)), makeMedium(float(wallImpedance), float(wallSpeed)) },
    [&](const Vec3d& p) {
      const double level = glm::length(p - centre);
      return level < outer && level > inner ? 1 : 0;
    });
  scene.view.model = InterfaceModel::Acoustic;
  scene.view.waveNumberAtOne = float(2000.0 * M_PI * 2.5);
  scene.view.reverberates = false;
  scene.view.favoursReflections = false;

  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const auto anyWay = [&] { return glm::normalize(Vec3d(normal(random), normal(random), normal(random))); };
  NullSink sink;
  const auto space = scene.space();
  double traced = 0.0;
  double truly = 0.0;
  int hits = 0;
  constexpr int rays = 20000;
  for (int i = 0; i < rays; ++i)
  {
    const Vec3d d = anyWay();
    const Vec3d side = glm::normalize(glm::cross(d, anyWay()));
    const double distance = outer * std::sqrt(0.9 * uniform(random));
    const double back = std::sqrt((outer + 3.0) * (outer + 3.0) - distance * distance);
    PathState path;
    path.ray.position = Vec3f(centre + side * distance - d * back);
    path.ray.direction = Vec3f(d);
    path.ray.cell = space.cellAt(path.ray.position);
    PathBoundary boundary;
    for (int met = 0;
         met < 50 && path.intensity > 0.0f && advanceToBoundary(scene.view, space, AllBeam(), path, boundary, sink);
         ++met)
    {
      ++hits;
      leaveBoundary(scene.view, boundary, BounceSample{ 0.5f, 0.5f, 0.5f }, path);
    }
    traced += double(path.intensity);
    truly += throughShell(distance, outer, inner);
  }
  hitsPerRay = double(hits) / rays;
  return 10.0 * std::log10(traced / truly);
}

TEST(ThinWalls, LetThroughWhatAnalysisSays)
{
  const Vec3d cubes(1.0);
  const Vec3d slices(0.7, 0.7, 2.1);
  struct Wall
  {
    double voxels;
    Vec3d spacing;
  };
  for (const Wall& wall : { Wall{ 1.0, cubes }, Wall{ 1.4, cubes }, Wall{ 1.8, cubes }, Wall{ 2.5, cubes },
                            Wall{ 4.0, cubes }, Wall{ 1.4, slices }, Wall{ 1.8, slices }, Wall{ 4.0, slices } })
  {
    double hits = 0.0;
    EXPECT_NEAR(shellErrorDb(wall.voxels, wall.spacing, hits), 0.0, 0.5)
      << "wall of " << wall.voxels << " voxels, slices of " << wall.spacing.z << " mm";
    // Four a ray that passes, fewer where the wall reflects all: nothing is met twice.
    EXPECT_LT(hits, 4.0) << "wall of " << wall.voxels << " voxels, slices of " << wall.spacing.z << " mm";
  }
}

} // namespace
} // namespace sono::test
