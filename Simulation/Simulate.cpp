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
  const auto part = [&](double from, double share) {
    return progress ? Progress([&progress, from, share](double f) { return progress(from + share * f); }) : Progress{};
  };
  const auto lines = makeScanLines(settings.geometry, pose);
  const TracedLines traced = trace(scene, lines, tracing, part(0.0, 0.8), targets);
  const RfLines rf = formRf(scene, lines, traced, echo, part(0.8, 0.2));
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
    const Progress part = progress ? Progress([&](double f) { return progress(done + share * f); }) : Progress{};
    images.push_back(simulateOnCpu(scene, pose, settings, part, targets));
  }
  return images;
}

} // namespace sono
