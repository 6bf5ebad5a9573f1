#include "Image/Calipers.h"

#include "Core/Error.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace sono {
namespace {

constexpr double pi = 3.14159265358979323846;

Vec2d turned(const Vec2d& v)
{
  return { -v.y, v.x };
}

double crossed(const Vec2d& a, const Vec2d& b)
{
  return a.x * b.y - a.y * b.x;
}

} // namespace

double distanceMm(const Vec3d& a, const Vec3d& b)
{
  return glm::length(b - a);
}

Vec3d ellipseHalfAxis(const Vec3d& a, const Vec3d& b, const Vec3d& side)
{
  const Vec3d axis = b - a;
  const double square = glm::dot(axis, axis);
  const Vec3d to = side - a;
  return square > 0.0 ? to - glm::dot(to, axis) / square * axis : to;
}

double ellipseAreaMm2(const Vec3d& a, const Vec3d& b, const Vec3d& side)
{
  return pi / 2.0 * distanceMm(a, b) * glm::length(ellipseHalfAxis(a, b, side));
}

double angleDeg(const Vec3d& vertex, const Vec3d& a, const Vec3d& b)
{
  const Vec3d one = a - vertex;
  const Vec3d other = b - vertex;
  return std::atan2(glm::length(glm::cross(one, other)), glm::dot(one, other)) * 180.0 / pi;
}

TracedVentricle tracedVentricle(const std::vector<Vec2d>& contour)
{
  TracedVentricle ventricle;
  ventricle.contour = contour;
  if (!contour.empty())
  {
    ventricle.base = 0.5 * (contour.front() + contour.back());
    ventricle.apex = *std::max_element(contour.begin(), contour.end(), [&](const Vec2d& a, const Vec2d& b) {
      return glm::length(a - ventricle.base) < glm::length(b - ventricle.base);
    });
  }
  return ventricle;
}

std::vector<std::pair<Vec2d, Vec2d>> discEnds(const TracedVentricle& ventricle, int count)
{
  const Vec2d axis = ventricle.apex - ventricle.base;
  const double length = glm::length(axis);
  if (ventricle.contour.size() < 3 || !(length > 0.0) || count < 1)
  {
    throw Error(
      "A ventricle's volume needs contours of at least 3 points, each with a long axis from the middle of the "
      "annulus to the apex, and at least one disc; trace them again.");
  }
  const Vec2d along = axis / length;
  const Vec2d across = turned(along);
  std::vector<std::pair<Vec2d, Vec2d>> ends;
  for (int disc = 0; disc < count; ++disc)
  {
    const double heightMm = (disc + 0.5) / count * length;
    double first = std::numeric_limits<double>::infinity();
    double last = -first;
    for (std::size_t i = 0; i < ventricle.contour.size(); ++i)
    {
      const Vec2d from = ventricle.contour[i] - ventricle.base;
      const Vec2d to = ventricle.contour[(i + 1) % ventricle.contour.size()] - ventricle.base;
      const double fromMm = glm::dot(from, along) - heightMm;
      const double toMm = glm::dot(to, along) - heightMm;
      if ((fromMm < 0.0) != (toMm < 0.0))
      {
        const double at = glm::dot(from + fromMm / (fromMm - toMm) * (to - from), across);
        first = std::min(first, at);
        last = std::max(last, at);
      }
    }
    const Vec2d middle = ventricle.base + heightMm * along;
    const bool isMet = last >= first;
    ends.emplace_back(middle + (isMet ? first : 0.0) * across, middle + (isMet ? last : 0.0) * across);
  }
  return ends;
}

std::vector<double> discDiametersMm(const TracedVentricle& ventricle, int count)
{
  std::vector<double> diameters;
  for (const auto& [first, last] : discEnds(ventricle, count))
  {
    diameters.push_back(glm::length(last - first));
  }
  return diameters;
}

double biplaneVolumeMl(const TracedVentricle& fourChamber, const TracedVentricle& twoChamber, int count)
{
  constexpr double mm3PerMl = 1000.0;
  const std::vector<double> a = discDiametersMm(fourChamber, count);
  const std::vector<double> b = discDiametersMm(twoChamber, count);
  double sum = 0.0;
  for (int i = 0; i < count; ++i)
  {
    sum += a[i] * b[i];
  }
  const double lengthMm =
    std::max(glm::length(fourChamber.apex - fourChamber.base), glm::length(twoChamber.apex - twoChamber.base));
  return pi / 4.0 * lengthMm / count * sum / mm3PerMl;
}

double singlePlaneVolumeMl(const TracedVentricle& view, int count)
{
  return biplaneVolumeMl(view, view, count);
}

std::vector<Vec2d> outlineOf(int width, int height, const std::function<bool(int, int)>& isInside)
{
  using Corner = std::pair<int, int>;
  std::multimap<Corner, Corner> edges; // from corner to corner, what is inside on one and the same side
  const auto at = [&](int x, int y) { return x >= 0 && y >= 0 && x < width && y < height && isInside(x, y); };
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      if (!at(x, y))
      {
        continue;
      }
      const std::array<std::pair<bool, std::pair<Corner, Corner>>, 4> sides{
        { { at(x, y - 1), { { x, y }, { x + 1, y } } },
          { at(x + 1, y), { { x + 1, y }, { x + 1, y + 1 } } },
          { at(x, y + 1), { { x + 1, y + 1 }, { x, y + 1 } } },
          { at(x - 1, y), { { x, y + 1 }, { x, y } } } }
      };
      for (const auto& [isCovered, side] : sides)
      {
        if (!isCovered)
        {
          edges.insert(side);
        }
      }
    }
  }
  std::vector<Vec2d> longest;
  while (!edges.empty())
  {
    std::vector<Vec2d> loop;
    for (auto edge = edges.begin(); edge != edges.end();)
    {
      loop.emplace_back(edge->first.first - 0.5, edge->first.second - 0.5);
      const Corner next = edge->second;
      edges.erase(edge);
      edge = edges.find(next);
    }
    longest = loop.size() > longest.size() ? loop : longest;
  }
  return longest;
}

std::vector<Vec2d> convexContour(const std::vector<Vec2d>& outline, const Vec2d& atrium)
{
  std::vector<Vec2d> sorted = outline;
  std::sort(sorted.begin(), sorted.end(),
            [](const Vec2d& a, const Vec2d& b) { return std::make_pair(a.x, a.y) < std::make_pair(b.x, b.y); });
  if (sorted.size() < 3)
  {
    return {};
  }
  // Andrew's monotone chain: the lower half from left to right, the upper one back.
  std::vector<Vec2d> hull;
  const auto add = [&](const Vec2d& p, std::size_t from) {
    while (hull.size() >= from + 2 && crossed(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0)
    {
      hull.pop_back();
    }
    hull.push_back(p);
  };
  std::for_each(sorted.begin(), sorted.end(), [&](const Vec2d& p) { add(p, 0); });
  const std::size_t lower = hull.size() - 1;
  std::for_each(sorted.rbegin() + 1, sorted.rend(), [&](const Vec2d& p) { add(p, lower); });
  hull.pop_back(); // the first once more
  Vec2d middle(0.0);
  for (const Vec2d& p : hull)
  {
    middle += p / double(hull.size());
  }
  const Vec2d sight = atrium - middle;
  for (std::size_t i = 0; i < hull.size(); ++i)
  {
    const std::size_t next = (i + 1) % hull.size();
    const bool isFaced = crossed(sight, hull[i] - middle) <= 0.0 && crossed(sight, hull[next] - middle) > 0.0;
    if (isFaced)
    {
      std::rotate(hull.begin(), hull.begin() + long(next), hull.end());
      return hull;
    }
  }
  return {};
}

} // namespace sono
