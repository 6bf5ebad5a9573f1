#include "TraceByMode.h"

#include "Cuda/DeviceImager.h"
#include "Cuda/MakeImageJob.h"
#include "Cuda/RunOnDevice.h"
#include "Trace/SecondHarmonic.h"
#include "Trace/TraceSetup.h"

#include <memory>
#include <utility>

namespace sono {

namespace {

void fetchTraced(const DeviceTraced& device, TracedLines& lines)
{
  FetchedTrace fetched = DeviceImager::instance().fetch(device);
  auto values = fetched.bins.begin();
  TracedLines::visitBins(lines, [&](std::vector<float>& array, const char*) { array = std::move(*values++); });
  lines.depthOffsetMm = std::move(*values++);
  lines.reverberation = std::move(*values++);
  lines.reverberationError = std::move(*values++);
  lines.reverberationNpPerMHz = std::move(*values);
  lines.boundaryEcho = std::move(fetched.boundaryEcho);
  lines.segments = fetched.segments;
}

TracedResult traceOnDevice(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                           const std::vector<TargetSurface>& targets, const Progress& progress)
{
  const TraceSetup setup(scene, lines, settings, targets, partOf(progress, 0.0, 0.3));
  TracedLines layout = tracedLayout(int(lines.size()), settings, targets);
  const auto job = std::make_shared<const TraceJob>(makeTraceJob(setup, settings, layout.lineCount));
  return { std::move(layout), DeviceImager::instance().trace(job, { 0, int(lines.size()) }, partOf(progress, 0.3, 1.0)),
           fetchTraced };
}

/// One frequency's, whatever the mode.
TracedResult traceTone(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                       const std::vector<TargetSurface>& targets, const Progress& progress)
{
  return runsOnDevice(settings) ? traceOnDevice(scene, lines, settings, targets, progress)
                                : TracedResult(sono::trace(scene, lines, settings, progress, targets));
}

/// Both tones' traces meet on the host.
TracedResult traceHarmonic(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                           const std::vector<TargetSurface>& targets, const Progress& progress)
{
  const TracedResult sent = traceTone(scene, lines, settings, targets, partOf(progress, 0.0, 0.5));
  const TracedResult doubled = traceTone(scene, lines, doubledTone(settings), targets, partOf(progress, 0.5, 1.0));
  return TracedResult(
    secondHarmonic(sent.host(), doubled.host(), harmonicSources(scene, lines, settings), sentGains(settings)));
}

} // namespace

TracedResult traceByMode(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                         const std::vector<TargetSurface>& targets, const Progress& progress)
{
  const auto make = settings.imagingMode == ImagingMode::Harmonic ? traceHarmonic : traceTone;
  return make(scene, lines, settings, targets, progress);
}

} // namespace sono
