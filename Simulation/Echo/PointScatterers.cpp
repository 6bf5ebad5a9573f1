#include "Echo/PointScatterers.h"

#include "Progress.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace sono {

namespace {

constexpr double pointsPerBrick = 64.0;
constexpr double minEdgeMm = 0.25;
constexpr double farthestMm = 1e6;

void requireValid(const std::vector<PointScatterer>& points)
{
  if (points.size() > std::size_t(std::numeric_limits<int>::max()))
  {
    throw Error("there are " + std::to_string(points.size()) + " scatterers: give at most 2147483647");
  }
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const Vec3d& p = points[i].positionMm;
    if (!glm::all(glm::lessThanEqual(glm::abs(p), Vec3d(farthestMm))) || !std::isfinite(points[i].amplitude))
    {
      throw Error(
        "scatterer " + std::to_string(i) +
        " has a position that is not within 10^6 mm or an amplitude that is not finite: correct or remove it");
    }
  }
}

/// Edge such that a brick holds about `pointsPerBrick` on average and the bricks are no more than the points.
double brickEdge(const Vec3d& extent, std::size_t count)
{
  const Vec3d filled = glm::max(extent, Vec3d(minEdgeMm));
  const double volume = filled.x * filled.y * filled.z;
  double edge = std::max(minEdgeMm, std::cbrt(volume * pointsPerBrick / double(count)));
  const auto bricks = [&] { return (extent.x / edge + 1.0) * (extent.y / edge + 1.0) * (extent.z / edge + 1.0); };
  while (bricks() > double(count) + 1e3)
  {
    edge *= 1.25;
  }
  return edge;
}

} // namespace

PointScatterers::PointScatterers(const std::vector<PointScatterer>& points)
{
  requireValid(points);
  if (points.empty())
  {
    begin_.assign(1, 0);
    return;
  }
  for (const PointScatterer& p : points)
  {
    originMm_ += p.positionMm / double(points.size());
  }
  Vec3d low(std::numeric_limits<double>::max());
  Vec3d high(-std::numeric_limits<double>::max());
  for (const PointScatterer& p : points)
  {
    low = glm::min(low, p.positionMm - originMm_);
    high = glm::max(high, p.positionMm - originMm_);
  }
  grid_.edgeMm = float(brickEdge(high - low, points.size()));
  const double edge = grid_.edgeMm;
  first_ = Vec3i(glm::floor(low / edge));
  size_ = Vec3i(glm::floor(high / edge)) - first_ + 1;
  grid_.lowMm = Vec3f(first_) * grid_.edgeMm;
  grid_.highMm = Vec3f(first_ + size_) * grid_.edgeMm;

  // Counting sort by brick; inside a brick the points keep their order.
  begin_.assign(std::size_t(size_.x) * std::size_t(size_.y) * std::size_t(size_.z) + 1, 0);
  std::vector<int> brickOf(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    brickOf[i] = indexOf(Vec3i(glm::floor((points[i].positionMm - originMm_) / edge)));
    ++begin_[std::size_t(brickOf[i]) + 1];
  }
  for (std::size_t b = 1; b < begin_.size(); ++b)
  {
    begin_[b] += begin_[b - 1];
  }
  for (std::vector<float>* column : { &x_, &y_, &z_, &amplitude_ })
  {
    column->resize(points.size());
  }
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const std::size_t to = std::size_t(next[std::size_t(brickOf[i])]++);
    const Vec3d p = points[i].positionMm - originMm_;
    x_[to] = float(p.x);
    y_[to] = float(p.y);
    z_[to] = float(p.z);
    amplitude_[to] = points[i].amplitude;
  }
}

int PointScatterers::indexOf(const Vec3i& brick) const
{
  const Vec3i at = brick - first_;
  return at.x + size_.x * (at.y + size_.y * at.z);
}

ScattererView PointScatterers::brick(const Vec3i& brick) const
{
  const Vec3i at = brick - first_;
  if (glm::any(glm::lessThan(at, Vec3i(0))) || glm::any(glm::greaterThanEqual(at, size_)))
  {
    return {};
  }
  const std::size_t b = std::size_t(indexOf(brick));
  const std::size_t from = std::size_t(begin_[b]);
  return { x_.data() + from, y_.data() + from, z_.data() + from, amplitude_.data() + from, begin_[b + 1] - begin_[b] };
}

} // namespace sono
