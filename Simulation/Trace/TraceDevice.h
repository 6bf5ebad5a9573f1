#pragma once

#include "Core/Device.h"
#include "Trace/TraceSettings.h"

namespace sono {

/// Where tracing with these settings runs: the march through the NanoVDB grid is the CPU's alone. Where Auto leaves a
/// usable GPU aside for it, the note says so. Throws Error when the GPU is wanted and cannot be
/// used.
DeviceChoice chooseDevice(const TraceSettings& settings);

} // namespace sono
