#include "Simulate.h"

#include "Cuda/RunOnDevice.h"

namespace sono {

namespace {

PlaneImage simulateOnCpu(const Scene& scene, const ProbePose& pose, const ImageSettings& settings,
                         const Progress& progress, const std::vector<TargetSurface>& targets)
{
  TraceSettings tracing = settings.tracing;
  EchoSettings echo = settings.echo;
  tracing.device = echo.device = Device::Cpu;
  const auto lines = makeScanLines(settings.geometry, pose);
  const TracedLines traced = trace(scene, lines, tracing, partOf(progress, 0.0, 0.8), targets);
  const RfLines rf = formRf(scene, lines, traced, echo, partOf(progress, 0.8, 1.0));
  const BModeLines bmode = makeBMode(rf.envelope(), rf.lineCount, rf.sampleCount, rf.sampleMm, settings.bmode);
  return scanConvert(settings.geometry, bmode.grey, bmode.sampleCount, bmode.sampleMm, settings.pixelMm);
}

} // namespace

void ImageSettings::matchStages()
{
  tracing.depthMm = geometry.depthMm;
  echo.depthMm = geometry.depthMm;
  tracing.frequencyMHz = echo.centreFrequencyMHz;
  tracing.echoSampleMm = echo.sampleMm();
}

std::vector<PlaneImage> simulateImages(const Scene& scene, const std::vector<ProbePose>& poses,
                                       const ImageSettings& settings, const Progress& progress,
                                       const std::vector<TargetSurface>& targets)
{
  if (poses.empty())
  {
    return {};
  }
  TraceSettings tracing = settings.tracing;
  tracing.device = settings.device;
  if (runsOnDevice(tracing))
  {
    return simulateOnDevice(scene, poses, settings, progress, targets);
  }
  std::vector<PlaneImage> images;
  for (const ProbePose& pose : poses)
  {
    const double done = double(images.size()) / double(poses.size());
    const double share = 1.0 / double(poses.size());
    images.push_back(simulateOnCpu(scene, pose, settings, partOf(progress, done, done + share), targets));
  }
  return images;
}

} // namespace sono
