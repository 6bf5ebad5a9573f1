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

/// What the rows of a slice share, and room for one.
struct ThoraxBody::Slice
{
  double x; ///< of the first voxel
  double spacingMm;
  ChestHeight height;
  std::vector<double> depthMm, side, back;
};

ThoraxBody::Block ThoraxBody::blockAt(const Vec3d& middle, double aroundMm) const
{
  return { beat_.heart().outsideMm(frame_.fromWorld(middle), aroundMm), aorta_.leastOutsideMm(middle) - aroundMm };
}

/// The heart at a point, where it or its vessel is; its distance where that is less than `withinMm`, 0 or more.
HeartSample ThoraxBody::heartAt(const Vec3d& p, const Vec3d& inHeartFrame, double withinMm, const Block& block) const
{
  // At another phase some walls are further apart, which moves no point nearer to the heart.
  const Vec3d q = beat_.restingPlaceMm(inHeartFrame, block.outsideMm);
  const bool isMoved = q != inHeartFrame;
  HeartSample heart;
  const bool isFar = isMoved ? block.outsideMm.mostMm > 0.0 && heart_.outsideMm(q, 0.0).leastMm > withinMm
                             : block.outsideMm.leastMm > withinMm;
  if (!isFar && heart_.isNear(q))
  {
    heart = heart_.sample(q);
  }
  if (!(block.leastToAortaMm > (isMoved ? glm::distance(q, inHeartFrame) : 0.0)))
  {
    if (const ThoraxLabel vessel = aorta_.sample(isMoved ? frame_.toWorld(q) : p))
    {
      heart.label = vessel;
    }
  }
  return heart;
}

void ThoraxBody::fillRow(const Slice& slice, double y, const double* diaphragmMm, const Block* blocks,
                         std::uint16_t* row) const
{
  const int count = int(slice.depthMm.size());
  for (int i = 0; i < count; ++i)
  {
    const WallPoint wall{ slice.depthMm[std::size_t(i)], slice.side[std::size_t(i)], slice.back[std::size_t(i)] };
    if (wall.depthMm < 0.0)
    {
      row[i] = Background;
      continue;
    }
    const Vec3d p(slice.x + slice.spacingMm * i, y, slice.height.zMm);
    const Vec3d inHeartFrame = frame_.fromWorld(p);
    const ChestPlace place = chestAt(p, wall, slice.height, diaphragmMm[i], inHeartFrame, chest_);
    row[i] = place.heartBefore == ChestPlace::Nothing
               ? place.label
               : place.with(heartAt(p, inHeartFrame, place.fatWithinMm, blocks[i / blockEdge]));
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
    Slice slice{ grid.originMm.x, grid.spacingMm.x, {}, {}, {}, {} };
    for (std::vector<double>* room : { &slice.depthMm, &slice.side, &slice.back })
    {
      room->resize(std::size_t(size.x));
    }
    for (int k = blockEdge * layer; k < std::min(blockEdge * (layer + 1), size.z); ++k)
    {
      slice.height = chestHeight(placeOf(Vec3d(0, 0, k)).z, chest_);
      for (int j = 0; j < size.y; ++j)
      {
        const double y = placeOf(Vec3d(0, j, 0)).y;
        const std::size_t row = std::size_t(size.x) * (std::size_t(j) + std::size_t(size.y) * std::size_t(k));
        wallRow(slice.x, slice.spacingMm, y, slice.height.halfWidthMm, slice.height.halfDepthMm, size.x,
                slice.depthMm.data(), slice.side.data(), slice.back.data());
        fillRow(slice, y, diaphragm.data() + std::size_t(size.x) * std::size_t(j),
                known.data() + std::size_t(blocks.x) * std::size_t(j / blockEdge), voxels.data() + row);
      }
    }
  });
  return voxels;
}

} // namespace sono
