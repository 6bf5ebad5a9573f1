#pragma once

#include "Cuda/ImageJob.h"
#include "Simulate.h"

namespace sono {

struct TraceSetup;
struct EchoSetup;

// The stages on the process's GPU; as their twins on the CPU, which call these where the settings' device asks for it.

/// Whether tracing with these settings runs there. Throws Error when it is asked to and cannot.
bool runsOnDevice(const TraceSettings& settings);

TracedLines traceOnDevice(const TraceSetup& setup, const TraceSettings& settings, const Progress& progress);

RfLines formRfOnDevice(const EchoSetup& setup, const Progress& progress);

std::vector<PlaneImage> simulateOnDevice(const Scene& scene, const std::vector<ProbePose>& poses,
                                         const ImageSettings& settings, const Progress& progress,
                                         const std::vector<TargetSurface>& targets);

/// The whole job of simulateOnDevice. The scene must outlive it. Throws Error when the stages do not agree.
ImageJob makeImageJob(const Scene& scene, const std::vector<ProbePose>& poses, const ImageSettings& settings,
                      const Progress& progress, const std::vector<TargetSurface>& targets);

} // namespace sono
