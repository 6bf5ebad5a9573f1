#include "Scene/CoarseSurface.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace sono {
namespace {

/// Cosine of how much the normal may turn along an edge whose ends become one: what is rounder than three voxels, as
/// the rim of a leaflet, keeps its points.
constexpr float leastCosine = 0.95f;

Vec3f pointOf(const TriangleSurface& surface, int i)
{
  const std::array<float, 3>& p = surface.points[std::size_t(i)];
  return { p[0], p[1], p[2] };
}

Vec3f normalized(const Vec3f& v)
{
  return v / std::max(glm::length(v), std::numeric_limits<float>::min());
}

/// At the points, of the area around each.
std::vector<Vec3f> normalsOf(const TriangleSurface& surface)
{
  std::vector<Vec3f> normals(surface.points.size(), Vec3f(0.0f));
  for (const std::array<int, 3>& triangle : surface.triangles)
  {
    const Vec3f a = pointOf(surface, triangle[0]);
    const Vec3f area = glm::cross(pointOf(surface, triangle[1]) - a, pointOf(surface, triangle[2]) - a);
    for (int corner : triangle)
    {
      normals[std::size_t(corner)] += area;
    }
  }
  std::transform(normals.begin(), normals.end(), normals.begin(), normalized);
  return normals;
}

/// Things that are joined two by two.
class Groups
{
public:
  explicit Groups(std::size_t count)
    : above_(count)
  {
    std::iota(above_.begin(), above_.end(), 0);
  }
  /// One of its group, the same for all of them.
  int find(int i)
  {
    while (above_[std::size_t(i)] != i)
    {
      i = above_[std::size_t(i)] = above_[std::size_t(above_[std::size_t(i)])];
    }
    return i;
  }
  void join(int i, int j) { above_[std::size_t(find(i))] = find(j); }

private:
  std::vector<int> above_;
};

Groups groupsOf(const TriangleSurface& surface, const std::vector<Vec3f>& normals, double cubeMm)
{
  std::vector<Vec3i> cubes;
  cubes.reserve(surface.points.size());
  for (std::size_t i = 0; i < surface.points.size(); ++i)
  {
    cubes.emplace_back(glm::floor(pointOf(surface, int(i)) / float(cubeMm)));
  }
  Groups groups(surface.points.size());
  for (const std::array<int, 3>& triangle : surface.triangles)
  {
    for (int side = 0; side < 3; ++side)
    {
      const int i = triangle[std::size_t(side)];
      const int j = triangle[std::size_t(side + 1) % 3];
      if (cubes[std::size_t(i)] == cubes[std::size_t(j)] &&
          glm::dot(normals[std::size_t(i)], normals[std::size_t(j)]) > leastCosine)
      {
        groups.join(i, j);
      }
    }
  }
  return groups;
}

/// Of the points of a group.
struct Sums
{
  Vec3d places{ 0.0 };
  Vec3f normals{ 0.0f };
  int count = 0;
};

} // namespace

DrawnSurface coarseSurface(const TriangleSurface& surface, double cubeMm)
{
  const std::vector<Vec3f> normals = normalsOf(surface);
  Groups groups = groupsOf(surface, normals, cubeMm);
  std::vector<int> numbers(surface.points.size(), -1); // of the groups, at the one that stands for each
  std::vector<Sums> sums;
  for (int i = 0; i < int(numbers.size()); ++i)
  {
    int& number = numbers[std::size_t(groups.find(i))];
    if (number < 0)
    {
      number = int(sums.size());
      sums.emplace_back();
    }
    Sums& all = sums[std::size_t(number)];
    all.places += Vec3d(pointOf(surface, i));
    all.normals += normals[std::size_t(i)];
    ++all.count;
  }
  DrawnSurface coarse;
  coarse.points.reserve(sums.size());
  coarse.normals.reserve(sums.size());
  for (const Sums& all : sums)
  {
    const Vec3f place = all.places / double(all.count);
    const Vec3f normal = normalized(all.normals);
    coarse.points.push_back({ place.x, place.y, place.z });
    coarse.normals.push_back({ normal.x, normal.y, normal.z });
  }
  for (const auto& [first, second, third] : surface.triangles)
  {
    const int a = numbers[std::size_t(groups.find(first))];
    const int b = numbers[std::size_t(groups.find(second))];
    const int c = numbers[std::size_t(groups.find(third))];
    if (a != b && b != c && c != a)
    {
      coarse.triangles.push_back({ a, b, c });
    }
  }
  return coarse;
}

} // namespace sono
