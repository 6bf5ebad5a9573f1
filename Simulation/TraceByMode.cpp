#include "TraceByMode.h"

#include "Cuda/DeviceImager.h"
#include "Cuda/MakeImageJob.h"
#include "Cuda/RunOnDevice.h"
#include "ImageGroup.h"
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

/// Both tones' traces meet where they are made.
TracedResult traceHarmonic(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                           const std::vector<TargetSurface>& targets, const Progress& progress)
{
  const TracedLines sent = sono::trace(scene, lines, sentTone(settings), partOf(progress, 0.0, 0.5), targets);
  TracedLines doubled = sono::trace(scene, lines, doubledTone(settings), partOf(progress, 0.5, 1.0), targets);
  return TracedResult(
    secondHarmonic(sent, std::move(doubled), harmonicSources(scene, lines, settings), sentGains(settings)));
}

/// With what is known of its error.
TracedResult withError(const TracedResult& traced, double errorDb)
{
  TracedLines layout = traced.layout();
  layout.errorDb = errorDb;
  return traced.onDevice() ? TracedResult(std::move(layout), traced.onDevice(), fetchTraced)
                           : TracedResult(std::move(layout));
}

/// Each round anew.
PathRounds deviceRounds(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                        const std::vector<TargetSurface>& targets)
{
  return [&scene, lines, settings, targets](int paths, bool, const ErrorOf& errorOf, const Progress& progress) {
    TraceSettings some = settings;
    some.pathsPerLine = paths;
    const TracedResult traced = traceByMode(scene, lines, some, targets, progress);
    return withError(traced, errorOf(traced.host()));
  };
}

PathRounds toneRounds(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                      const std::vector<TargetSurface>& targets, const Progress& progress)
{
  const auto rounds = std::make_shared<TraceRounds>(scene, lines, settings, targets, progress);
  return [rounds](int paths, bool more, const ErrorOf& errorOf, const Progress& inRound) {
    rounds->traceTo(paths, more, inRound);
    TracedLines traced = rounds->traced();
    traced.errorDb = errorOf(traced);
    return TracedResult(std::move(traced));
  };
}

PathRounds harmonicRounds(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                          const std::vector<TargetSurface>& targets, const Progress& progress)
{
  const auto sent =
    std::make_shared<TraceRounds>(scene, lines, sentTone(settings), targets, partOf(progress, 0.0, 0.5));
  const auto doubled =
    std::make_shared<TraceRounds>(scene, lines, doubledTone(settings), targets, partOf(progress, 0.5, 1.0));
  return [=, sources = harmonicSources(scene, lines, settings),
          gains = sentGains(settings)](int paths, bool more, const ErrorOf& errorOf, const Progress& inRound) {
    sent->traceTo(paths, more, partOf(inRound, 0.0, 0.5));
    doubled->traceTo(paths, more, partOf(inRound, 0.5, 1.0));
    TracedLines traced = secondHarmonic(sent->traced(), doubled->traced(), sources, gains);
    traced.errorDb = errorOf(traced);
    return TracedResult(std::move(traced));
  };
}

} // namespace

std::shared_ptr<const DeviceTraced> traceOnDevice(const Scene& scene, const std::vector<ScanLine>& lines,
                                                  const TraceSettings& settings,
                                                  const std::vector<TargetSurface>& targets, int linesPerImage,
                                                  const std::vector<std::uint64_t>& seeds, const Progress& progress)
{
  const std::size_t images = lines.size() / std::size_t(linesPerImage);
  const bool isHarmonic = settings.imagingMode == ImagingMode::Harmonic;
  const TraceSettings first = isHarmonic ? sentTone(settings) : settings;
  TraceSetup setup(scene, lines, first, targets, partOf(progress, 0.0, 0.3));
  if (images > 1)
  {
    requireEachMeets(setup, images);
  }
  TraceJob job = makeTraceJob(setup, first, linesPerImage);
  job.seeds = seeds.empty() ? job.seeds : seeds;
  DeviceImager& imager = DeviceImager::instance();
  const Progress tracing = partOf(progress, 0.3, 1.0);
  if (!isHarmonic)
  {
    return imager.trace(std::make_shared<const TraceJob>(std::move(job)), { 0, int(lines.size()) }, tracing);
  }
  const auto sent = std::make_shared<const TraceJob>(job);
  const TraceSettings twice = doubledTone(settings);
  setup.tune(scene, twice, targets);
  tuneTraceJob(setup, twice, job);
  const HarmonicJob harmonic{ harmonicSources(scene, lines, settings), sentGains(settings) };
  return imager.traceHarmonic(sent, std::make_shared<const TraceJob>(std::move(job)), harmonic, tracing);
}

PathRounds roundsByMode(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                        const std::vector<TargetSurface>& targets, const Progress& progress)
{
  if (runsOnDevice(settings))
  {
    return deviceRounds(scene, lines, settings, targets);
  }
  const auto make = settings.imagingMode == ImagingMode::Harmonic ? harmonicRounds : toneRounds;
  return make(scene, lines, settings, targets, progress);
}

TracedResult traceByMode(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                         const std::vector<TargetSurface>& targets, const Progress& progress)
{
  if (runsOnDevice(settings))
  {
    return TracedResult(tracedLayout(int(lines.size()), settings, targets),
                        traceOnDevice(scene, lines, settings, targets, int(lines.size()), {}, progress), fetchTraced);
  }
  return settings.imagingMode == ImagingMode::Harmonic
           ? traceHarmonic(scene, lines, settings, targets, progress)
           : TracedResult(sono::trace(scene, lines, settings, progress, targets));
}

} // namespace sono
