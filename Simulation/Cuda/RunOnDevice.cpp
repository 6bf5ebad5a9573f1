#include "Cuda/RunOnDevice.h"

#include "Trace/TraceDevice.h"

namespace sono {

bool runsOnDevice(const TraceSettings& settings)
{
  return chooseDevice(settings).cuda;
}

} // namespace sono
