#pragma once

#include "Trace/Trace.h"

#include <string>
#include <vector>

namespace sono {

/// What a person should know where `maxCollisions` ends paths of settings that reverberate while they could still be
/// heard: one sentence with the way out, or nothing. 512 of the paths that trace() follows tell it: it counts where
/// those that are ended carry more than a tenth of the sound (chosen). Throws as trace().
std::string collisionLimitWarning(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                                  const std::vector<TargetSurface>& targets = {});

} // namespace sono
