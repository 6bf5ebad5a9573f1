#pragma once

#include "Trace/TraceSettings.h"

namespace sono {

/// Whether tracing with these settings runs on the process's GPU. Throws Error when it is asked to and cannot.
bool runsOnDevice(const TraceSettings& settings);

} // namespace sono
