#include "Echo/TargetPieces.h"

#include "Echo/SurfacePhase.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr float brickEdgeMm = 4.0f;
/// Parts that bricks begin with: most lie in one.
constexpr double partMm = 1.0;
constexpr double justOutsideMm = 1e-3;
/// A blob is this many times as wide as its triangle: with three the sum over a regular net is even to 1e-4.
constexpr float blobPerTriangle = 3.0f;

Vec3i brickOf(const Vec3f& position)
{
  return Vec3i(glm::floor(position / brickEdgeMm));
}

/// Whether a triangle's box comes within a hair of a box.
bool meets(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& low, const Vec3d& high)
{
  constexpr double hairMm = 2.0 * justOutsideMm;
  return glm::all(glm::lessThan(glm::min(a, glm::min(b, c)), high + hairMm)) &&
         glm::all(glm::greaterThan(glm::max(a, glm::max(b, c)), low - hairMm));
}

} // namespace

/// Halves the longest edge until it is short enough, in a fixed order, where goes(part) says that it is worth it.
template<class Goes, class Visit>
void TargetPieces::halve(const Part& part, double longestMm, const Goes& goes, const Visit& visit)
{
  if (!goes(part))
  {
    return;
  }
  const auto square = [](const Vec3d& edge) { return glm::dot(edge, edge); };
  const double ab = square(part.b - part.a);
  const double bc = square(part.c - part.b);
  const double ca = square(part.a - part.c);
  const double most = std::max({ ab, bc, ca });
  if (most <= longestMm * longestMm)
  {
    visit(part);
    return;
  }
  Part one = part;
  Part other = part;
  one.half = 2u * part.half;
  other.half = one.half + 1u;
  if (ab == most)
  {
    one.b = other.a = 0.5 * (part.a + part.b);
  }
  else if (bc == most)
  {
    one.c = other.b = 0.5 * (part.b + part.c);
  }
  else
  {
    one.c = other.a = 0.5 * (part.c + part.a);
  }
  halve(one, longestMm, goes, visit);
  halve(other, longestMm, goes, visit);
}

TargetPieces::TargetPieces(const Scene& scene, const std::vector<TargetSurface>& targets, const std::vector<int>& which,
                           const SurfaceRows& rows, double longestMm, std::uint64_t seed)
  : scene_(scene)
  , rows_(rows)
  , longestMm_(longestMm)
  , seed_(seed)
{
  const auto triangles = localTriangles(targets, scene.rotationToLocal(), scene.worldFromLocal(Vec3d(0.0)));
  grid_.edgeMm = brickEdgeMm;
  const Vec3d volumeMm = Vec3d(scene.placement().size) * scene.placement().spacingMm;
  const auto meetsVolume = [&](const Part& part) { return meets(part.a, part.b, part.c, Vec3d(0.0), volumeMm); };
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const BvhTriangle& triangle = triangles[t];
    if (std::find(which.begin(), which.end(), triangle.target) == which.end())
    {
      continue;
    }
    const Part whole{ Vec3d(triangle.a), Vec3d(triangle.b), Vec3d(triangle.c), 1u, origins_.size() };
    const Vec3d across = glm::cross(whole.b - whole.a, whole.c - whole.a);
    const double twiceArea = glm::length(across);
    if (!(twiceArea > 0.0))
    {
      continue;
    }
    origins_.push_back({ int(t), triangle.target, Vec3f(across / twiceArea) });
    halve(whole, std::max(partMm, longestMm), meetsVolume, [&](const Part& part) {
      const Vec3i low = brickOf(Vec3f(glm::min(part.a, glm::min(part.b, part.c))));
      const Vec3i high = brickOf(Vec3f(glm::max(part.a, glm::max(part.b, part.c))));
      for (int k = low.z; k <= high.z; ++k)
      {
        for (int j = low.y; j <= high.y; ++j)
        {
          for (int i = low.x; i <= high.x; ++i)
          {
            bricks_[Vec3i(i, j, k)].push_back(part);
          }
        }
      }
    });
  }
  if (!bricks_.empty())
  {
    Vec3i low = bricks_.begin()->first;
    Vec3i high = low;
    for (const auto& [brick, parts] : bricks_)
    {
      low = glm::min(low, brick);
      high = glm::max(high, brick);
    }
    grid_.lowMm = Vec3f(low) * brickEdgeMm;
    grid_.highMm = Vec3f(high + 1) * brickEdgeMm;
  }
}

void TargetPieces::cutBrick(const Vec3i& brick, std::vector<SurfacePoint>& points) const
{
  points.clear();
  const auto found = bricks_.find(brick);
  if (found == bricks_.end())
  {
    return;
  }
  const Vec3d low = Vec3d(brick) * double(brickEdgeMm);
  const Vec3d high = low + double(brickEdgeMm);
  const auto meetsBrick = [&](const Part& part) { return meets(part.a, part.b, part.c, low, high); };
  for (const Part& each : found->second)
  {
    halve(each, longestMm_, meetsBrick, [&](const Part& part) { point(part, brick, points); });
  }
}

void TargetPieces::point(const Part& part, const Vec3i& brick, std::vector<SurfacePoint>& points) const
{
  const Origin& origin = origins_[part.origin];
  const Vec3i size = scene_.placement().size;
  const Vec3f perMm = 1.0f / Vec3f(scene_.placement().spacingMm);
  const Vec3f middle((part.a + part.b + part.c) / 3.0);
  const Vec3i voxel(glm::floor((middle + origin.normal * float(justOutsideMm)) * perMm));
  if (brickOf(middle) != brick || glm::any(glm::lessThan(voxel, Vec3i(0))) ||
      glm::any(glm::greaterThanEqual(voxel, size)))
  {
    return;
  }
  const std::size_t at =
    std::size_t(voxel.x) + std::size_t(size.x) * (std::size_t(voxel.y) + std::size_t(size.y) * std::size_t(voxel.z));
  const Vec3f e(part.b - part.a);
  const Vec3f f(part.c - part.a);
  // Of a triangle's own covariance (e e + f f - (e f + f e) / 2) / 18.
  const float scale = blobPerTriangle / std::sqrt(18.0f);
  SurfacePoint point;
  point.position = middle;
  point.normal = origin.normal;
  point.tangentU = (e - 0.5f * f) * scale;
  point.tangentV = f * (std::sqrt(0.75f) * scale);
  point.areaMm2 = 0.5f * glm::length(glm::cross(e, f));
  point.row = rows_.row(int(scene_.tissues().size()) + origin.target, scene_.tissueVoxels()[at]);
  setPhase(seed_, Vec3i(origin.triangle, int(part.half >> 2), origin.target), 3, part.half & 3u, point);
  points.push_back(point);
}

} // namespace sono
