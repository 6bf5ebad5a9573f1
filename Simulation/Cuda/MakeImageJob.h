#pragma once

#include "Cuda/ImageJob.h"
#include "Echo/FormRf.h"
#include "Image/BMode.h"
#include "Image/ScanConvert.h"
#include "Trace/Trace.h"

#include <vector>

namespace sono {

struct TraceSetup;
struct EchoSetup;

// From the simulator's own arguments to the numbers that a device works on. A scene must outlive its
// jobs.

/// The setup has checked that some line meets the volume.
TraceJob makeTraceJob(const TraceSetup& setup, const TraceSettings& settings, int linesPerImage);

/// The job once the setup it was made of has been tuned to these settings.
void tuneTraceJob(const TraceSetup& setup, const TraceSettings& settings, TraceJob& job);

/// `traced` is what the setup was given, or nothing when the job traces too.
EchoJob makeEchoJob(const EchoSetup& setup, int linesPerImage);

/// The scene's own labels in an image of this layout, for each pose.
LabelJob makeLabelJob(const Scene& scene, const ProbePose* poses, int poseCount, const PlaneImage& layout);

/// Of images of that many lines.
BModeJob makeBModeJob(const BModeSettings& settings, int lineCount, int sampleCount, double sampleMm);

} // namespace sono
