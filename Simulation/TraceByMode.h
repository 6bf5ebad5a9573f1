#pragma once

#include "Core/Progress.h"
#include "ImageResult.h"
#include "Scene/Scene.h"
#include "Trace/Targets.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace sono {

struct DeviceTraced;

/// The traced lines of the settings' imaging mode, on the device that they name: of the harmonic from two traces, which
/// meet where they are made. Throws as trace().
TracedResult traceByMode(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                         const std::vector<TargetSurface>& targets, const Progress& progress);

/// The same on a GPU, of images side by side, each of so many lines and with paths of its own seed, or where there are
/// no seeds the settings'. Throws Error naming the first of several images of which no line meets the label map.
std::shared_ptr<const DeviceTraced> traceOnDevice(const Scene& scene, const std::vector<ScanLine>& lines,
                                                  const TraceSettings& settings,
                                                  const std::vector<TargetSurface>& targets, int linesPerImage,
                                                  const std::vector<std::uint64_t>& seeds, const Progress& progress);

/// How exact a picture of these lines is, dB.
using ErrorOf = std::function<double(const TracedLines&)>;

/// Traces on until each line has had `paths`, more than the time before; `more` may follow. The result says what
/// `errorOf` says of it. Throws Aborted when asked to stop; then it may not be called again.
using PathRounds = std::function<TracedResult(int paths, bool more, const ErrorOf& errorOf, const Progress& progress)>;

/// The same in rounds. On a GPU each of them traces from the first path on. The scene must live as long.
PathRounds roundsByMode(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                        const std::vector<TargetSurface>& targets, const Progress& progress);

} // namespace sono
