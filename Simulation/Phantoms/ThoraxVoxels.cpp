#include "Core/ParallelFor.h"
#include "Phantoms/ThoraxBody.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int blockEdge = 4; // voxels

} // namespace

/// What is known of all points of a block of voxels.
struct ThoraxBody::Block
{
  DistanceBounds outsideMm; ///< of the heart at rest, where the points are now
  double leastToAortaMm;    ///< no more than any distance from it
};

/// A row of voxels, and room for what is looked up together: the heart at points by the vector.
struct ThoraxBody::Row
{
  /// A voxel where the heart or its vessel may be.
  struct Point
  {
    int voxel;
    ChestPlace place;
    Vec3d worldMm;
    Vec3d now, atRest; ///< in the heart's frame
    const Block* block;
  };

  Row(double x, double spacing, int count)
    : firstMm(x)
    , spacingMm(spacing)
    , depthMm(std::size_t(count))
    , side(std::size_t(count))
    , back(std::size_t(count))
  {
  }

  /// Looks a heart up at all that was asked for.
  void sample(const Heart& heart)
  {
    samples.resize(asked.size());
    heart.sampleEach(asked.data(), int(asked.size()), samples.data());
  }

  double firstMm;
  double spacingMm;
  double y = 0.0;
  std::vector<double> depthMm, side, back;
  std::vector<Point> points;
  std::vector<Vec3d> asked;
  std::vector<std::size_t> askedBy; ///< by which of the points
  std::vector<HeartSample> samples;
};

ThoraxBody::Block ThoraxBody::blockAt(const Vec3d& middle, double aroundMm) const
{
  return { beat_.heart().outsideMm(frame_.fromWorld(middle), aroundMm), aorta_.leastOutsideMm(middle) - aroundMm };
}

/// Labels the voxels without heart, and lists the others.
void ThoraxBody::placeRow(const ChestHeight& height, const double* diaphragmMm, const Block* blocks, Row& row,
                          std::uint16_t* voxels) const
{
  row.points.clear();
  const int count = int(row.depthMm.size());
  for (int i = 0; i < count; ++i)
  {
    const WallPoint wall{ row.depthMm[std::size_t(i)], row.side[std::size_t(i)], row.back[std::size_t(i)] };
    if (wall.depthMm < 0.0)
    {
      voxels[i] = Background;
      continue;
    }
    const Vec3d p(row.firstMm + row.spacingMm * i, row.y, height.zMm);
    const Vec3d now = frame_.fromWorld(p);
    const ChestPlace place = chestAt(p, wall, height, diaphragmMm[i], now, chest_);
    voxels[i] = place.label;
    const Block& block = blocks[i / blockEdge];
    // Where nothing moves, all is known where it is.
    const bool isFar =
      beat_.isAtRest(block.outsideMm) && block.outsideMm.leastMm > place.fatWithinMm && block.leastToAortaMm > 0.0;
    if (place.heartBefore != ChestPlace::Nothing && !isFar)
    {
      row.points.push_back({ i, place, p, now, now, &block });
    }
  }
}

/// Goes back to where the points' tissue stands at the end of diastole.
void ThoraxBody::carryRow(Row& row) const
{
  row.asked.clear();
  row.askedBy.clear();
  for (std::size_t n = 0; n < row.points.size(); ++n)
  {
    Row::Point& point = row.points[n];
    if (beat_.asksFor(point.now, point.block->outsideMm))
    {
      row.asked.push_back(point.now);
      row.askedBy.push_back(n);
    }
    else
    {
      point.atRest = beat_.restingPlaceMm(point.now, point.block->outsideMm);
    }
  }
  row.sample(beat_.heart());
  for (std::size_t n = 0; n < row.asked.size(); ++n)
  {
    const double outsideMm = row.samples[n].outsideMm;
    row.points[row.askedBy[n]].atRest = beat_.restingPlaceMm(row.asked[n], { outsideMm, outsideMm });
  }
}

/// Labels the points with the heart and its vessel.
void ThoraxBody::takeHeart(Row& row, std::uint16_t* voxels) const
{
  row.asked.clear();
  row.askedBy.clear();
  for (std::size_t n = 0; n < row.points.size(); ++n)
  {
    // At another phase some walls are further apart, which moves no point nearer to the heart.
    const Row::Point& point = row.points[n];
    const DistanceBounds& outside = point.block->outsideMm;
    const bool isFar = point.atRest == point.now ? outside.leastMm > point.place.fatWithinMm
                                                 : outside.mostMm > 0.0 && heart_.outsideMm(point.atRest, 0.0).leastMm >
                                                                             point.place.fatWithinMm;
    if (!isFar && heart_.isNear(point.atRest))
    {
      row.asked.push_back(point.atRest);
      row.askedBy.push_back(n);
    }
  }
  row.sample(heart_);
  std::size_t next = 0;
  for (std::size_t n = 0; n < row.points.size(); ++n)
  {
    const Row::Point& point = row.points[n];
    HeartSample heart;
    if (next < row.askedBy.size() && row.askedBy[next] == n)
    {
      heart = row.samples[next++];
    }
    const bool isMoved = point.atRest != point.now;
    if (!(point.block->leastToAortaMm > (isMoved ? glm::distance(point.atRest, point.now) : 0.0)))
    {
      if (const ThoraxLabel vessel = aorta_.sample(isMoved ? frame_.toWorld(point.atRest) : point.worldMm))
      {
        heart.label = vessel;
      }
    }
    voxels[point.voxel] = point.place.with(heart);
  }
}

std::vector<std::uint16_t> ThoraxBody::labels(const GridPlacement& grid) const
{
  const Vec3i size = grid.size;
  const Vec3i blocks = (size + blockEdge - 1) / blockEdge;
  std::vector<std::uint16_t> voxels(grid.voxelCount());
  const auto placeOf = [&](const Vec3d& voxel) { return grid.originMm + grid.spacingMm * voxel; };
  std::vector<double> diaphragm(std::size_t(size.x) * std::size_t(size.y));
  parallelFor(size.y, {}, [&](int j) {
    for (int i = 0; i < size.x; ++i)
    {
      const Vec3d p = placeOf(Vec3d(i, j, 0));
      diaphragm[std::size_t(i) + std::size_t(size.x) * std::size_t(j)] = diaphragmMm(p.x, p.y);
    }
  });
  const double half = 0.5 * (blockEdge - 1);
  const double aroundMm = glm::length(half * grid.spacingMm);
  parallelFor(blocks.z, {}, [&](int layer) {
    std::vector<Block> known;
    known.reserve(std::size_t(blocks.x) * std::size_t(blocks.y));
    for (int n = 0; n < blocks.x * blocks.y; ++n)
    {
      const Vec3i first = blockEdge * Vec3i(n % blocks.x, n / blocks.x, layer);
      known.push_back(blockAt(placeOf(Vec3d(first) + half), aroundMm));
    }
    Row row(grid.originMm.x, grid.spacingMm.x, size.x);
    for (int k = blockEdge * layer; k < std::min(blockEdge * (layer + 1), size.z); ++k)
    {
      const ChestHeight height = chestHeight(placeOf(Vec3d(0, 0, k)).z, chest_);
      for (int j = 0; j < size.y; ++j)
      {
        const std::size_t inSlice = std::size_t(size.x) * std::size_t(j);
        std::uint16_t* to = voxels.data() + std::size_t(size.x) * std::size_t(size.y) * std::size_t(k) + inSlice;
        row.y = placeOf(Vec3d(0, j, 0)).y;
        wallRow(row.firstMm, row.spacingMm, row.y, height.halfWidthMm, height.halfDepthMm, size.x, row.depthMm.data(),
                row.side.data(), row.back.data());
        placeRow(height, diaphragm.data() + inSlice, known.data() + std::size_t(blocks.x) * std::size_t(j / blockEdge),
                 row, to);
        carryRow(row);
        takeHeart(row, to);
      }
    }
  });
  return voxels;
}

} // namespace sono
