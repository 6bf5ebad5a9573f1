#pragma once

#include "DataSets/DataSet.h"
#include "ImageSettings.h"
#include "Scene/Scene.h"

#include <cstdint>
#include <vector>

namespace sono {

/// A view's pose as a hand holds it: moved along and across the array, then tilted, rocked and turned, each about its
/// own axis. It may then be off the skin, and is not yet pressed in.
ProbePose jittered(const ProbePose& view, const PoseJitter& jitter);

/// How near an image of this pose will come to what the masks' groups ask for (MaskGroup::leastVisiblePercent): the
/// least, over the groups that ask and that the body has, of the share that lies in no shadow (ImageSight) over the one
/// that is asked for, at most 1, which is enough. 24 lines of 8 paths tell it,
/// or those of them that show enough. `groups` is the mask's value of each label id, 0 of none. Throws as trace().
double maskSufficiency(const Scene& scene, const std::vector<std::uint8_t>& groups, const std::vector<MaskGroup>& masks,
                       const ImageSettings& settings, const ProbePose& pose);

} // namespace sono
