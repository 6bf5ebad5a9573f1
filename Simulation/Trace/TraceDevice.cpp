#include "Trace/TraceDevice.h"

#include "Core/Error.h"

#include <string>

namespace sono {

DeviceChoice chooseDevice(const TraceSettings& settings)
{
  if (settings.march != March::NanoVDB)
  {
    return chooseDevice(settings.device);
  }
  const std::string what = "the march through the NanoVDB grid";
  if (settings.device == Device::Cuda)
  {
    throw Error(what + " runs on the CPU only: choose another, or the CPU");
  }
  DeviceChoice choice = chooseDevice(settings.device);
  if (choice.cuda)
  {
    choice = { false, "Tracing on the CPU beside a usable GPU, since " + what + " runs there only." };
  }
  return choice;
}

} // namespace sono
