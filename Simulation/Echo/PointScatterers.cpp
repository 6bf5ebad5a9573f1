#include "Echo/PointScatterers.h"

#include "Core/ParallelFor.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace sono {

namespace {

constexpr double pointsPerBrick = 64.0;
constexpr double minEdgeMm = 0.25;
constexpr double farthestMm = 1e6;
constexpr std::size_t pointsPerChunk = 1 << 16; // some milliseconds
constexpr std::size_t mostShares = 16;          // of a sort; each reads all bricks' numbers

std::size_t chunksOf(std::size_t count)
{
  return (count + pointsPerChunk - 1) / pointsPerChunk;
}

/// Calls body(chunk, from, to) for the points in chunks, whose borders do not depend on how many cores there are.
void forChunks(std::size_t count, const Progress& progress,
               const std::function<void(std::size_t, std::size_t, std::size_t)>& body)
{
  parallelFor(int(chunksOf(count)), progress, [&](int chunk) {
    const std::size_t from = std::size_t(chunk) * pointsPerChunk;
    body(std::size_t(chunk), from, std::min(count, from + pointsPerChunk));
  });
}

/// What all points of a chunk, or of some, have in common.
struct Summary
{
  std::size_t firstWrong = std::numeric_limits<std::size_t>::max();
  Vec3d part{ 0.0 }; ///< of the centroid
  float loudest = 0.0f;
};

/// Throws Error where a point is wrong.
Summary summaryOf(const std::vector<PointScatterer>& points, const Progress& progress)
{
  if (points.size() > std::size_t(std::numeric_limits<int>::max()))
  {
    throw Error("there are " + std::to_string(points.size()) + " scatterers: give at most 2147483647");
  }
  std::vector<Summary> chunks(chunksOf(points.size()));
  forChunks(points.size(), progress, [&](std::size_t chunk, std::size_t from, std::size_t to) {
    Summary of;
    for (std::size_t i = from; i < to; ++i)
    {
      const PointScatterer& p = points[i];
      if (!glm::all(glm::lessThanEqual(glm::abs(p.positionMm), Vec3d(farthestMm))) || !std::isfinite(p.amplitude))
      {
        of.firstWrong = std::min(of.firstWrong, i);
      }
      of.part += p.positionMm / double(points.size());
      of.loudest = std::max(of.loudest, std::fabs(p.amplitude));
    }
    chunks[chunk] = of;
  });
  Summary all;
  for (const Summary& of : chunks)
  {
    all.firstWrong = std::min(all.firstWrong, of.firstWrong);
    all.part += of.part;
    all.loudest = std::max(all.loudest, of.loudest);
  }
  if (all.firstWrong < points.size())
  {
    throw Error("scatterer " + std::to_string(all.firstWrong) +
                " has a position that is not within 10^6 mm or an amplitude that is not finite: correct or remove it");
  }
  return all;
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

struct Box
{
  Vec3d low{ std::numeric_limits<double>::max() };
  Vec3d high{ -std::numeric_limits<double>::max() };

  void add(const Vec3d& p)
  {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

/// Calls body(point, brick) for all points, those of a brick by one thread in their order.
template<typename Body>
void forShares(const std::vector<int>& brickOf, std::size_t brickCount, const Progress& progress, const Body& body)
{
  const std::size_t shares = std::min({ chunksOf(brickOf.size()), brickCount, mostShares });
  parallelFor(int(shares), progress, [&](int share, const YieldPoint& yieldPoint) {
    const std::size_t first = brickCount * std::size_t(share) / shares;
    const std::size_t end = brickCount * std::size_t(share + 1) / shares;
    for (std::size_t i = 0; i < brickOf.size(); ++i)
    {
      if (i % pointsPerChunk == 0)
      {
        yieldPoint();
      }
      const std::size_t brick = std::size_t(brickOf[i]);
      if (brick >= first && brick < end)
      {
        body(i, brick);
      }
    }
  });
}

} // namespace

PointScatterers::PointScatterers(const std::vector<PointScatterer>& points, const Progress& progress)
{
  const Summary of = summaryOf(points, partOf(progress, 0.0, 0.2));
  originMm_ = of.part;
  sort(points, std::nullopt, of.loudest, partOf(progress, 0.2, 1.0));
}

PointScatterers::PointScatterers(const std::vector<PointScatterer>& points, const Vec3d& originMm, double edgeMm,
                                 float loudest, const Progress& progress)
  : originMm_(originMm)
{
  summaryOf(points, partOf(progress, 0.0, 0.2));
  sort(points, edgeMm, loudest, partOf(progress, 0.2, 1.0));
}

void PointScatterers::sort(const std::vector<PointScatterer>& points, std::optional<double> edgeMm, float loudest,
                           const Progress& progress)
{
  auto table = std::make_shared<PointTable>();
  table->loudest = loudest;
  table_ = table;
  if (points.empty())
  {
    table->begin.assign(1, 0);
    return;
  }
  std::vector<Box> boxes(chunksOf(points.size()));
  forChunks(points.size(), partOf(progress, 0.0, 0.2), [&](std::size_t chunk, std::size_t from, std::size_t to) {
    Box box;
    for (std::size_t i = from; i < to; ++i)
    {
      box.add(points[i].positionMm - originMm_);
    }
    boxes[chunk] = box;
  });
  Box whole;
  for (const Box& box : boxes)
  {
    whole.add(box.low);
    whole.add(box.high);
  }
  grid_.edgeMm = table->edgeMm = float(edgeMm ? *edgeMm : brickEdge(whole.high - whole.low, points.size()));
  const double edge = grid_.edgeMm;
  table->firstBrick = Vec3i(glm::floor(whole.low / edge));
  table->bricks = Vec3i(glm::floor(whole.high / edge)) - table->firstBrick + 1;
  grid_.lowMm = Vec3f(table->firstBrick) * grid_.edgeMm;
  grid_.highMm = Vec3f(table->firstBrick + table->bricks) * grid_.edgeMm;

  std::vector<int> brickOf(points.size());
  forChunks(points.size(), partOf(progress, 0.2, 0.4), [&](std::size_t, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
    {
      brickOf[i] = indexOf(*table, Vec3i(glm::floor((points[i].positionMm - originMm_) / edge)));
    }
  });

  // Counting sort by brick; inside a brick the points keep their order, for each brick is one share's, and a share
  // looks through all points in turn.
  const Vec3i size = table->bricks;
  const std::size_t brickCount = std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
  std::vector<int>& begin = table->begin;
  begin.assign(brickCount + 1, 0);
  forShares(brickOf, brickCount, partOf(progress, 0.4, 0.6),
            [&](std::size_t, std::size_t brick) { ++begin[brick + 1]; });
  for (std::size_t b = 1; b < begin.size(); ++b)
  {
    begin[b] += begin[b - 1];
  }
  double done = 0.6;
  for (std::vector<float>* column :
       { &table->x, &table->y, &table->z, &table->amplitude }) // memory takes its time, too
  {
    column->resize(points.size());
    report(progress, done += 0.025);
  }
  std::vector<int> next(begin.begin(), begin.end() - 1);
  forShares(brickOf, brickCount, partOf(progress, 0.7, 1.0), [&](std::size_t i, std::size_t brick) {
    const std::size_t to = std::size_t(next[brick]++);
    const Vec3d p = points[i].positionMm - originMm_;
    table->x[to] = float(p.x);
    table->y[to] = float(p.y);
    table->z[to] = float(p.z);
    table->amplitude[to] = points[i].amplitude;
  });
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
