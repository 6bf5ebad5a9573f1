#include "Echo/PointScatterers.h"

#include "Core/Progress.h"

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

int indexOf(const PointTable& table, const Vec3i& brick)
{
  const Vec3i at = brick - table.firstBrick;
  return at.x + table.bricks.x * (at.y + table.bricks.y * at.z);
}

} // namespace

PointScatterers::PointScatterers(const std::vector<PointScatterer>& points)
{
  requireValid(points);
  float loudest = 0.0f;
  for (const PointScatterer& p : points)
  {
    originMm_ += p.positionMm / double(points.size());
    loudest = std::max(loudest, std::fabs(p.amplitude));
  }
  sort(points, std::nullopt, loudest);
}

PointScatterers::PointScatterers(const std::vector<PointScatterer>& points, const Vec3d& originMm, double edgeMm,
                                 float loudest)
  : originMm_(originMm)
{
  requireValid(points);
  sort(points, edgeMm, loudest);
}

void PointScatterers::sort(const std::vector<PointScatterer>& points, std::optional<double> edgeMm, float loudest)
{
  auto table = std::make_shared<PointTable>();
  table->loudest = loudest;
  table_ = table;
  if (points.empty())
  {
    table->begin.assign(1, 0);
    return;
  }
  Vec3d low(std::numeric_limits<double>::max());
  Vec3d high(-std::numeric_limits<double>::max());
  for (const PointScatterer& p : points)
  {
    low = glm::min(low, p.positionMm - originMm_);
    high = glm::max(high, p.positionMm - originMm_);
  }
  grid_.edgeMm = table->edgeMm = float(edgeMm ? *edgeMm : brickEdge(high - low, points.size()));
  const double edge = grid_.edgeMm;
  table->firstBrick = Vec3i(glm::floor(low / edge));
  table->bricks = Vec3i(glm::floor(high / edge)) - table->firstBrick + 1;
  grid_.lowMm = Vec3f(table->firstBrick) * grid_.edgeMm;
  grid_.highMm = Vec3f(table->firstBrick + table->bricks) * grid_.edgeMm;

  // Counting sort by brick; inside a brick the points keep their order.
  const Vec3i size = table->bricks;
  std::vector<int>& begin = table->begin;
  begin.assign(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z) + 1, 0);
  std::vector<int> brickOf(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    brickOf[i] = indexOf(*table, Vec3i(glm::floor((points[i].positionMm - originMm_) / edge)));
    ++begin[std::size_t(brickOf[i]) + 1];
  }
  for (std::size_t b = 1; b < begin.size(); ++b)
  {
    begin[b] += begin[b - 1];
  }
  for (std::vector<float>* column : { &table->x, &table->y, &table->z, &table->amplitude })
  {
    column->resize(points.size());
  }
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const std::size_t to = std::size_t(next[std::size_t(brickOf[i])]++);
    const Vec3d p = points[i].positionMm - originMm_;
    table->x[to] = float(p.x);
    table->y[to] = float(p.y);
    table->z[to] = float(p.z);
    table->amplitude[to] = points[i].amplitude;
  }
}

std::vector<PointScatterer> PointScatterers::all() const
{
  const PointTable& t = *table_;
  std::vector<PointScatterer> points;
  for (std::size_t i = 0; i < t.x.size(); ++i)
  {
    points.push_back({ originMm_ + Vec3d(t.x[i], t.y[i], t.z[i]), t.amplitude[i] });
  }
  return points;
}

ScattererView PointScatterers::brick(const Vec3i& brick) const
{
  const PointTable& t = *table_;
  const Vec3i at = brick - t.firstBrick;
  if (glm::any(glm::lessThan(at, Vec3i(0))) || glm::any(glm::greaterThanEqual(at, t.bricks)))
  {
    return {};
  }
  const std::size_t b = std::size_t(indexOf(t, brick));
  const std::size_t from = std::size_t(t.begin[b]);
  return { t.x.data() + from, t.y.data() + from, t.z.data() + from, t.amplitude.data() + from,
           t.begin[b + 1] - t.begin[b] };
}

} // namespace sono
