#include "Echo/TargetPieces.h"

#include "Echo/SurfacePhase.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr float brickEdgeMm = 4.0f;
constexpr float justOutsideMm = 1e-3f;
/// A blob is this many times as wide as its triangle: with three the sum over a regular net is even to 1e-4.
constexpr float blobPerTriangle = 3.0f;

/// Halves the longest edge until it is short enough, in a fixed order.
template<class Visit>
void cut(const Vec3d& a, const Vec3d& b, const Vec3d& c, double longestMm, const Visit& visit)
{
  const double ab = glm::distance(a, b);
  const double bc = glm::distance(b, c);
  const double ca = glm::distance(c, a);
  const double most = std::max({ ab, bc, ca });
  if (most <= longestMm)
  {
    visit(a, b, c);
  }
  else if (ab == most)
  {
    cut(a, 0.5 * (a + b), c, longestMm, visit);
    cut(0.5 * (a + b), b, c, longestMm, visit);
  }
  else if (bc == most)
  {
    cut(a, b, 0.5 * (b + c), longestMm, visit);
    cut(a, 0.5 * (b + c), c, longestMm, visit);
  }
  else
  {
    cut(a, b, 0.5 * (c + a), longestMm, visit);
    cut(0.5 * (c + a), b, c, longestMm, visit);
  }
}

} // namespace

TargetPieces::TargetPieces(const Scene& scene, const std::vector<TargetSurface>& targets, const std::vector<int>& which,
                           const SurfaceRows& rows, double longestMm, std::uint64_t seed)
{
  const Vec3i size = scene.placement().size;
  const Vec3f perMm = 1.0f / Vec3f(scene.placement().spacingMm);
  const int tissues = int(scene.tissues().size());
  const auto triangles = localTriangles(targets, scene.rotationToLocal(), scene.worldFromLocal(Vec3d(0.0)));
  grid_.edgeMm = brickEdgeMm;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const BvhTriangle& triangle = triangles[t];
    if (std::find(which.begin(), which.end(), triangle.target) == which.end())
    {
      continue;
    }
    const Vec3d a(triangle.a);
    const Vec3d b(triangle.b);
    const Vec3d c(triangle.c);
    const Vec3d across = glm::cross(b - a, c - a);
    const double twiceArea = glm::length(across);
    if (!(twiceArea > 0.0))
    {
      continue;
    }
    const Vec3f normal(across / twiceArea);
    std::uint32_t number = 0;
    cut(a, b, c, longestMm, [&](const Vec3d& p, const Vec3d& q, const Vec3d& r) {
      const Vec3f middle((p + q + r) / 3.0);
      const Vec3i voxel(glm::floor((middle + normal * justOutsideMm) * perMm));
      const std::uint32_t own = number++;
      if (glm::any(glm::lessThan(voxel, Vec3i(0))) || glm::any(glm::greaterThanEqual(voxel, size)))
      {
        return;
      }
      const std::uint8_t tissue =
        scene.tissueVoxels()[std::size_t(voxel.x) +
                             std::size_t(size.x) * (std::size_t(voxel.y) + std::size_t(size.y) * std::size_t(voxel.z))];
      const Vec3f e(q - p);
      const Vec3f f(r - p);
      // Of a triangle's own covariance (e e + f f - (e f + f e) / 2) / 18.
      const float scale = blobPerTriangle / std::sqrt(18.0f);
      SurfacePoint point;
      point.position = middle;
      point.normal = normal;
      point.tangentU = (e - 0.5f * f) * scale;
      point.tangentV = f * (std::sqrt(0.75f) * scale);
      point.areaMm2 = float(0.5 * glm::length(glm::cross(q - p, r - p)));
      point.row = rows.row(tissues + triangle.target, tissue);
      setPhase(seed, Vec3i(int(t), int(own >> 2), triangle.target), 3, own & 3u, point);
      bricks_[Vec3i(glm::floor(middle / brickEdgeMm))].push_back(point);
    });
  }
  if (!bricks_.empty())
  {
    Vec3i low = bricks_.begin()->first;
    Vec3i high = low;
    for (const auto& [brick, points] : bricks_)
    {
      low = glm::min(low, brick);
      high = glm::max(high, brick);
    }
    grid_.lowMm = Vec3f(low) * brickEdgeMm;
    grid_.highMm = Vec3f(high + 1) * brickEdgeMm;
  }
}

const std::vector<SurfacePoint>& TargetPieces::brick(const Vec3i& brick) const
{
  static const std::vector<SurfacePoint> none;
  const auto found = bricks_.find(brick);
  return found == bricks_.end() ? none : found->second;
}

} // namespace sono
