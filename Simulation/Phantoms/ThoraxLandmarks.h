#pragma once

#include "Phantoms/ThoraxBody.h"
#include "Probe/HeartLandmarks.h"

namespace sono {

/// The true landmarks of a body at its phase, from its shapes and their beat alone, not from voxels. Chambers' centres
/// are those of their ellipsoids, without what the valves and the septum cut off: some millimetres from a centroid. The
/// planes of standard views follow from them (planHeartViews).
HeartLandmarks thoraxLandmarks(const ThoraxBody& body);

} // namespace sono
