#pragma once

#include "Channels/ChannelPlan.h"

namespace sono {

/// formChannels on the GPU: what elements hear at each frequency is summed there, the signals are made of it here.
/// Throws Error when the device cannot be used or fails, Aborted.
ChannelData formChannelsOnDevice(const ChannelPlan& plan, const ChannelPoints& points, const Progress& progress);

} // namespace sono
