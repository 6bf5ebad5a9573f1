#include "SurfaceAccuracy.h"

#include "Kernel/SurfaceHit.h"
#include "Scene/TraceRegion.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace sono {

namespace {

/// An ellipsoid in local mm.
struct Ellipsoid
{
  Vec3d centre;
  Vec3d half;

  bool contains(const Vec3d& p) const { return glm::dot((p - centre) / half, (p - centre) / half) < 1.0; }
  /// Signed distance to first order, exact on the surface to second.
  double distance(const Vec3d& p) const
  {
    const Vec3d q = (p - centre) / half;
    const double level = glm::length(q);
    return (level - 1.0) * level / glm::length(q / half);
  }
  Vec3d normal(const Vec3d& p) const { return glm::normalize((p - centre) / (half * half)); }
};

struct Hits
{
  double offset = 0.0;
  std::vector<double> angle;
};

void meetOnce(const TissueCells& cells, const Ellipsoid& truth, const CellRay& ray, Hits& hits)
{
  const int from = cells.tissueAt(ray.cell);
  const CellHit hit = marchToBoundary(cells, ray, from, NoStairs(), 1e6f);
  if (hit.tissue < 0)
  {
    return;
  }
  const RefinedHit refined = refineBoundary(cells, ray, hit);
  const Vec3d point = Vec3d(ray.position) + Vec3d(ray.direction) * double(refined.t);
  const Vec3d outward = Vec3d(refined.normal) * (from == 0 ? -1.0 : 1.0);
  const double cosine = glm::dot(outward, truth.normal(point));
  hits.offset += std::abs(truth.distance(point));
  hits.angle.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / M_PI);
}

} // namespace

SurfaceAccuracy measureEllipsoid(const EllipsoidCase& shape)
{
  const Vec3d spacing(shape.spacingMm[0], shape.spacingMm[1], shape.spacingMm[2]);
  const double voxelMm = std::cbrt(spacing.x * spacing.y * spacing.z);
  const double smallest = std::min({ shape.axes[0], shape.axes[1], shape.axes[2] });
  Ellipsoid truth;
  truth.half = Vec3d(shape.axes[0], shape.axes[1], shape.axes[2]) * (shape.radiusVoxel * voxelMm / smallest);
  const Vec3i size = Vec3i(glm::ceil(2.0 * truth.half / spacing)) + 24;
  truth.centre = 0.5 * Vec3d(size) * spacing + Vec3d(0.21, 0.37, 0.11) * spacing;

  std::vector<std::uint8_t> tissues;
  for (int k = 0; k < size.z; ++k)
  {
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i)
      {
        tissues.push_back(truth.contains((Vec3d(i, j, k) + 0.5) * spacing) ? 1 : 0);
      }
    }
  }
  const TraceRegion region = buildTraceRegion(tissues.data(), size, spacing, { Vec3i(0), size });
  const TissueCells cells = region.view();

  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return glm::normalize(Vec3d(normal(random), normal(random), normal(random))); };
  Hits hits;
  for (int n = 0; n < 20000; ++n)
  {
    // A point inside, and a ray out of it; every other one is turned to come in from outside.
    const Vec3d inside = truth.centre + 0.6 * direction() * truth.half;
    const Vec3d d = direction();
    CellRay ray{ Vec3f(inside), Vec3f(d), cells.cellAt(Vec3f(inside)) };
    if (n % 2 == 1)
    {
      const CellHit exit = marchToBoundary(cells, ray, 1, NoStairs(), 1e6f);
      ray.position = Vec3f(inside + d * (double(exit.t) + 3.0 * voxelMm));
      ray.direction = -ray.direction;
      ray.cell = cells.cellAt(ray.position);
    }
    meetOnce(cells, truth, ray, hits);
  }

  SurfaceAccuracy accuracy;
  const std::size_t count = hits.angle.size();
  accuracy.offsetVoxel = hits.offset / double(count) / voxelMm;
  for (const double angle : hits.angle)
  {
    accuracy.normalMeanDeg += angle / double(count);
  }
  std::sort(hits.angle.begin(), hits.angle.end());
  accuracy.normalP95Deg = hits.angle[count * 95 / 100];
  return accuracy;
}

SurfaceAccuracy worstSurfaceAccuracy()
{
  SurfaceAccuracy worst;
  for (const double radius : { 15.0, 30.0 })
  {
    for (const Vec3d axes : { Vec3d(1.0), Vec3d(1.0, 1.3, 0.8), Vec3d(0.8, 1.0, 1.3) })
    {
      for (const double thickness : { 1.0, 3.0 })
      {
        const SurfaceAccuracy one = measureEllipsoid({ radius, { axes.x, axes.y, axes.z }, { 1.0, 1.0, thickness } });
        worst.offsetVoxel = std::max(worst.offsetVoxel, one.offsetVoxel);
        worst.normalMeanDeg = std::max(worst.normalMeanDeg, one.normalMeanDeg);
        worst.normalP95Deg = std::max(worst.normalP95Deg, one.normalP95Deg);
      }
    }
  }
  return worst;
}

} // namespace sono
