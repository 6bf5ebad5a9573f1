#include "SimulateChannels.h"

#include "Cuda/DeviceChannels.h"

namespace sono {

ChannelData simulateChannels(const ChannelPlan& plan, const ChannelPoints& points, const Progress& progress)
{
  return chooseDevice(plan.settings.device).cuda ? formChannelsOnDevice(plan, points, progress)
                                                 : formChannels(plan, points, progress);
}

} // namespace sono
