#include "Cuda/RunOnDevice.h"

#include "Cuda/DeviceImager.h"
#include "Cuda/MakeImageJob.h"
#include "Echo/EchoSetup.h"
#include "Kernel/TracePath.h"
#include "Trace/TraceDevice.h"
#include "Trace/TraceSetup.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

void requireMatch(bool same, const char* what)
{
  if (!same)
  {
    throw Error(std::string("the stages disagree about ") + what + ": set it alike for tracing and image formation");
  }
}

/// Some line of each image, as each is asked for alone.
void requireEachMeets(const TraceSetup& setup, int images)
{
  const CellSpace<NoTargets> space{ setup.region->view(), {} };
  const std::size_t perImage = setup.lines.size() / std::size_t(images);
  for (int image = 0; image < images; ++image)
  {
    const auto first = setup.lines.begin() + std::ptrdiff_t(std::size_t(image) * perImage);
    PathState path;
    if (std::none_of(first, first + std::ptrdiff_t(perImage),
                     [&](const TraceLine& line) { return enterSpace(space, line, setup.view.depthMm, path); }))
    {
      throw Error("no scan line of pose " + std::to_string(image) +
                  " meets the label map: move the probe onto the skin or increase the depth");
    }
  }
}

bool near(double a, double b)
{
  return std::abs(a - b) <= 1e-9 * std::abs(b);
}

} // namespace

bool runsOnDevice(const TraceSettings& settings)
{
  return chooseDevice(settings).cuda;
}

TracedLines traceOnDevice(const TraceSetup& setup, const TraceSettings& settings, const Progress& progress)
{
  ImageJob job;
  job.trace = makeTraceJob(setup, settings);
  DeviceWants wants;
  wants.traced = true;
  DeviceResult result = DeviceImager::instance().run(job, wants, progress);
  TracedLines out;
  out.lineCount = job.lineCount();
  out.binMm = settings.radialBinMm;
  out.binCount = settings.binCount();
  out.echoSampleMm = settings.echoSampleMm;
  out.echoCount = settings.echoCount();
  out.intensity = std::move(result.intensity);
  out.standardError = std::move(result.standardError);
  out.boundaryEcho = std::move(result.boundaryEcho);
  out.segments = result.segments;
  return out;
}

RfLines formRfOnDevice(const EchoSetup& setup, const Progress& progress)
{
  ImageJob job;
  job.echo = makeEchoJob(setup);
  DeviceWants wants;
  wants.rf = true;
  RfLines out = setup.emptyRf();
  out.iq = DeviceImager::instance().run(job, wants, progress).iq;
  return out;
}

ImageJob makeImageJob(const Scene& scene, const std::vector<ProbePose>& poses, const ImageSettings& settings,
                      const Progress& progress, const std::vector<TargetSurface>& targets)
{
  requireMatch(near(settings.tracing.depthMm, settings.geometry.depthMm) &&
                 near(settings.echo.depthMm, settings.geometry.depthMm),
               "the depth");
  requireMatch(near(settings.tracing.frequencyMHz, settings.echo.centreFrequencyMHz), "the frequency");
  requireMatch(near(settings.tracing.echoSampleMm, settings.echo.sampleMm()), "the sampling of echoes");
  std::vector<ScanLine> lines;
  for (const ProbePose& pose : poses)
  {
    const auto more = makeScanLines(settings.geometry, pose);
    lines.insert(lines.end(), more.begin(), more.end());
  }
  ImageJob job;
  job.images = int(poses.size());
  const TraceSetup setup(scene, lines, settings.tracing, targets, progress);
  requireEachMeets(setup, job.images);
  job.scan = planeScan(settings.geometry, settings.echo.sampleCount(), settings.echo.sampleMm(), settings.pixelMm);
  job.trace = makeTraceJob(setup, settings.tracing);
  const EchoSources sources{ &scene, nullptr, nullptr };
  job.echo = makeEchoJob(EchoSetup(sources, lines, settings.echo));
  job.bmode = makeBModeJob(settings.bmode, settings.echo.sampleCount(), settings.echo.sampleMm());
  return job;
}

std::vector<PlaneImage> simulateOnDevice(const Scene& scene, const std::vector<ProbePose>& poses,
                                         const ImageSettings& settings, const Progress& progress,
                                         const std::vector<TargetSurface>& targets)
{
  const Progress preparing = partOf(progress, 0.0, 0.3);
  const Progress running = partOf(progress, 0.3, 1.0);
  const ImageJob job = makeImageJob(scene, poses, settings, preparing, targets);
  DeviceWants wants;
  wants.image = true;
  DeviceResult result = DeviceImager::instance().run(job, wants, running);
  std::vector<PlaneImage> images(poses.size(), planeImageLayout(settings.geometry, settings.pixelMm));
  for (std::size_t i = 0; i < images.size(); ++i)
  {
    images[i].value = std::move(result.pixels[i]);
    images[i].mask = result.mask;
  }
  return images;
}

} // namespace sono
