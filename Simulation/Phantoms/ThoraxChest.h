#pragma once

#include "Kernel/Vec.h"
#include "Phantoms/ThoraxHeart.h"
#include "Phantoms/ThoraxLabels.h"

namespace sono {

/// Which chest.
struct ChestShape
{
  double scale = 1.0;           ///< of width and depth
  double extraFatMm = 0.0;      ///< under the skin, all around
  double ribSpacingMm = 29.0;   ///< from rib to rib
  double lungOverlapMm = 0.0;   ///< how far the lungs' edges come in over the heart
  double diaphragmDownMm = 0.0; ///< how much lower diaphragm, liver and stomach stand
  double lungAsideMm = 0.0;     ///< how far the left lung's front has gone to the left of the middle and off the heart
};

/// Box that holds the torso with a margin of air at its sides; above and below the torso goes on (world LPS mm).
Vec3d thoraxBoxLowMm(const ChestShape& chest);
Vec3d thoraxBoxHighMm(const ChestShape& chest);

/// The point of the skin's outer surface in the horizontal direction (towardsX, towardsY) from the torso's axis at
/// height z.
Vec3d skinPointMm(const ChestShape& chest, double towardsX, double towardsY, double z);

/// What stands at a point of the torso. `heart` is the heart at this point and `inHeartFrame` the point in the
/// heart's frame; bone goes before the heart, all else gives way to it.
ThoraxLabel sampleChest(const Vec3d& p, const HeartSample& heart, const Vec3d& inHeartFrame, const ChestShape& chest);

/// Depth of a point below the skin's outer surface, negative outside.
double skinDepthMm(const Vec3d& p, const ChestShape& chest);

} // namespace sono
