#include "Trace/TargetBvh.h"

#include <algorithm>

namespace sono {

namespace {

constexpr std::int32_t leafSize = 4;

Vec3f centroid(const BvhTriangle& t)
{
  return (t.a + t.b + t.c) / 3.0f;
}

void split(TargetBvh& bvh, std::size_t index)
{
  const std::int32_t first = bvh.nodes[index].first;
  const std::int32_t count = bvh.nodes[index].count;
  Vec3f low(3e38f);
  Vec3f high(-3e38f);
  Vec3f centreLow(3e38f);
  Vec3f centreHigh(-3e38f);
  for (std::int32_t i = first; i < first + count; ++i)
  {
    const BvhTriangle& t = bvh.triangles[std::size_t(i)];
    low = glm::min(low, glm::min(t.a, glm::min(t.b, t.c)));
    high = glm::max(high, glm::max(t.a, glm::max(t.b, t.c)));
    centreLow = glm::min(centreLow, centroid(t));
    centreHigh = glm::max(centreHigh, centroid(t));
  }
  bvh.nodes[index].low = low;
  bvh.nodes[index].high = high;
  if (count <= leafSize)
  {
    return;
  }
  const Vec3f extent = centreHigh - centreLow;
  const int axis = extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
  const auto begin = bvh.triangles.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count, [axis](const BvhTriangle& a, const BvhTriangle& b) {
    return centroid(a)[axis] < centroid(b)[axis];
  });
  const auto children = std::int32_t(bvh.nodes.size());
  bvh.nodes.push_back({ Vec3f(0.0f), Vec3f(0.0f), first, count / 2 });
  bvh.nodes.push_back({ Vec3f(0.0f), Vec3f(0.0f), first + count / 2, count - count / 2 });
  bvh.nodes[index].first = children;
  bvh.nodes[index].count = 0;
  split(bvh, std::size_t(children));
  split(bvh, std::size_t(children) + 1);
}

} // namespace

TargetBvh buildTargetBvh(std::vector<BvhTriangle> triangles)
{
  TargetBvh bvh;
  bvh.triangles = std::move(triangles);
  if (!bvh.triangles.empty())
  {
    bvh.nodes.push_back({ Vec3f(0.0f), Vec3f(0.0f), 0, std::int32_t(bvh.triangles.size()) });
    split(bvh, 0);
  }
  return bvh;
}

} // namespace sono
