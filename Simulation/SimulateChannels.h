#pragma once

#include "Channels/ChannelPlan.h"

namespace sono {

/// Channel data on the device that the plan's settings want. Those of the GPU differ from the CPU's by 1e-3 (root mean
/// square) at most. Throws Error when the GPU is wanted and cannot be used or fails, Aborted.
ChannelData simulateChannels(const ChannelPlan& plan, const ChannelPoints& points, const Progress& progress = {});

} // namespace sono
