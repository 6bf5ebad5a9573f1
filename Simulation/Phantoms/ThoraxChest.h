#pragma once

#include "Kernel/Vec.h"
#include "Phantoms/ThoraxHeart.h"
#include "Phantoms/ThoraxLabels.h"

namespace sono {

/// Box that holds the torso with a margin of air at its sides; above and below the torso goes on (world LPS mm).
Vec3d thoraxBoxLowMm();
Vec3d thoraxBoxHighMm();

/// The point of the skin's outer surface in the horizontal direction (towardsX, towardsY) from the torso's axis at
/// height z.
Vec3d skinPointMm(double towardsX, double towardsY, double z);

/// What stands at a point of the torso. `heart` is the heart at this point and `inHeartFrame` the point in the
/// heart's frame; bone goes before the heart, all else gives way to it.
ThoraxLabel sampleChest(const Vec3d& p, const HeartSample& heart, const Vec3d& inHeartFrame);

} // namespace sono
