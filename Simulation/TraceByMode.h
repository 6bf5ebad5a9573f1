#pragma once

#include "Core/Progress.h"
#include "ImageResult.h"
#include "Scene/Scene.h"
#include "Trace/Targets.h"

#include <vector>

namespace sono {

/// The traced lines of the settings' imaging mode, on the device that they name: of the harmonic from two traces, which
/// meet on the host. Throws as trace().
TracedResult traceByMode(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                         const std::vector<TargetSurface>& targets, const Progress& progress);

} // namespace sono
