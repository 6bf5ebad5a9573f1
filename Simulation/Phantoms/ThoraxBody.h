#pragma once

#include "Labels/LabelVolume.h"
#include "Phantoms/BeatingHeart.h"
#include "Phantoms/ThoraxAorta.h"
#include "Phantoms/ThoraxChest.h"
#include "Phantoms/ThoraxHeart.h"
#include "Phantoms/ThoraxParameters.h"

#include <cstdint>
#include <vector>

namespace sono {

/// The heart's frame in the world: its origin in front of the apex, columns lateral, elevation, axial.
struct HeartFrame
{
  Vec3d originMm;
  Mat3d axes;

  Vec3d fromWorld(const Vec3d& p) const { return glm::transpose(axes) * (p - originMm); }
  Vec3d toWorld(const Vec3d& q) const { return originMm + axes * q; }
};

ChestShape chestShape(const ThoraxParameters& parameters);
HeartFrame heartFrame(const ThoraxParameters& parameters);

/// One body of the family: all that does not change from voxel to voxel.
class ThoraxBody
{
public:
  /// Throws Error for a parameter outside its range, or for chambers that do not fit one another.
  explicit ThoraxBody(const ThoraxParameters& parameters);

  /// What stands at a point, world LPS mm.
  ThoraxLabel sample(const Vec3d& p) const;
  /// The same at all voxels of a grid whose axes are the world's, i fastest, ten times as quickly: what a row, a slice
  /// or a column of it shares is worked out once, and shapes that are too far away are left out.
  std::vector<std::uint16_t> labels(const GridPlacement& grid) const;

  /// Where what the heart's motion brings to a place of this phase stands at the end of diastole, world mm. The chest
  /// wall, lungs and abdomen are drawn where they are all the same.
  Vec3d restingPlaceMm(const Vec3d& world) const;
  /// The reverse.
  Vec3d placeMm(const Vec3d& resting) const;

  const HeartFrame& frame() const { return frame_; }
  /// At the end of diastole, with the valves of this phase.
  const HeartShape& heart() const { return heart_.shape(); }
  const ChestShape& chest() const { return chest_; }

private:
  struct Block;
  struct Row;
  Block blockAt(const Vec3d& middle, double aroundMm) const;
  void placeRow(const ChestHeight& height, const double* diaphragmMm, const Block* blocks, Row& row,
                std::uint16_t* voxels) const;
  void carryRow(Row& row) const;
  void takeHeart(Row& row, std::uint16_t* voxels) const;

  ChestShape chest_;
  HeartFrame frame_;
  HeartBeat beat_;
  Heart heart_;
  ThoraxAorta aorta_;
};

} // namespace sono
