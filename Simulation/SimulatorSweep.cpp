#include "Core/Policy.h"
#include "Cuda/DeviceImager.h"
#include "Cuda/MakeImageJob.h"
#include "Cuda/RunOnDevice.h"
#include "Echo/EchoSetup.h"
#include "Image/LabelSlice.h"
#include "ImageGroup.h"
#include "Simulator.h"
#include "Trace/TraceSetup.h"

#include <algorithm>
#include <string>

namespace sono {

namespace {

void sweepOneByOne(const std::shared_ptr<const Scene>& scene, const std::vector<ProbePose>& poses,
                   const ImageSettings& settings, bool withLabels, const SweepSink& sink, const Progress& progress,
                   const std::vector<TargetSurface>& targets)
{
  Simulator each(scene); // whose results go with the sweep
  ImageInput input{ {}, settings, targets, nullptr };
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    const double done = double(i) / double(poses.size());
    input.pose = poses[i];
    ScanPicture picture;
    try
    {
      const ImageResult image = each.image(input, partOf(progress, done, done + 1.0 / double(poses.size())));
      picture =
        withLabels ? each.picture(image, settings.geometry, input.pose, each.traced(input)) : each.picture(image);
    }
    catch (const Error& error)
    {
      throw Error("pose " + std::to_string(i) + ": " + error.what());
    }
    sink({ int(i), 1, picture.grey.data.get(), picture.labels.data.get(), picture.mask.data.get() });
  }
}

/// A group of poses at a time.
void sweepOnDevice(const Scene& scene, const std::vector<ProbePose>& poses, const ImageSettings& settings,
                   bool withLabels, const SweepSink& sink, const Progress& progress,
                   const std::vector<TargetSurface>& targets, const PointScatterers* points)
{
  const int perImage = settings.geometry.totalLineCount();
  const std::vector<ScanLine> lines = makeScanLines(settings.geometry, poses);
  const TracedLines tracedOfOne = tracedLayout(perImage, settings.tracing);
  const RfLines rfOfOne = rfLayout(perImage, settings.echo);
  const PlaneImage layout = planeImageLayout(settings.geometry, settings.pixelMm);
  const PlaneScan scan = planeScan(settings.geometry, rfOfOne.sampleCount, rfOfOne.sampleMm, settings.pixelMm);
  const PlaneScan offsets = offsetScan(settings.geometry, tracedOfOne.binCount, tracedOfOne.binMm, settings.pixelMm);
  std::shared_ptr<const TraceJob> traceJob;
  {
    const TraceSetup setup(scene, lines, settings.tracing, targets, partOf(progress, 0.0, 0.3));
    requireEachMeets(setup, poses.size());
    traceJob = std::make_shared<const TraceJob>(makeTraceJob(setup, settings.tracing, perImage));
  }
  const Progress running = partOf(progress, 0.3, 1.0);
  DeviceImager& imager = DeviceImager::instance();
  const int together = std::min(imagesTogether, imagesThatFit(settings));
  const EchoSources sources{ &scene, nullptr, points, settings.tracing.model, &targets };
  std::shared_ptr<const BModeJob> bmodeJob; // made while the first lines are traced
  SweptPictures before;
  std::shared_ptr<DeviceImager::Download> download;
  const auto deliver = [&] {
    const PictureCopy copy = imager.wait(download);
    before.grey = copy.bytes.data.get();
    before.labels = copy.labels.data.get();
    before.mask = copy.mask.data.get();
    sink(before);
    report(running, double(before.firstPose + before.count) / double(poses.size()));
  };
  for (int first = 0; first < int(poses.size()); first += together)
  {
    const int count = std::min(together, int(poses.size()) - first);
    const LineRange range{ first * perImage, count * perImage };
    // For the lines of one group at a time: the device has work while the next one's is made.
    const auto firstLine = lines.begin() + range.first;
    const std::vector<ScanLine> groupLines(firstLine, firstLine + range.count);
    const EchoSetup setup(sources, groupLines, settings.echo, perImage);
    const auto echoJob = std::make_shared<const EchoJob>(makeEchoJob(setup, perImage));
    imager.prepare(echoJob);
    const auto traced = imager.trace(traceJob, range);
    if (!bmodeJob)
    {
      bmodeJob =
        std::make_shared<const BModeJob>(makeBModeJob(settings.bmode, perImage, rfOfOne.sampleCount, rfOfOne.sampleMm));
    }
    const auto rf = imager.formRf(echoJob, { 0, range.count }, traced.get(), false);
    const auto picture = imager.convert(scan, imager.compress(bmodeJob, *rf, count));
    std::shared_ptr<const DeviceLabelSlice> labels;
    if (withLabels)
    {
      LabelJob job = makeLabelJob(scene, poses.data() + first, count, layout);
      job.scan = offsets;
      labels = imager.slice(job, *picture, traced.get());
    }
    auto next = imager.beginDownload(picture, labels);
    if (download)
    {
      deliver();
    }
    download = std::move(next);
    before = { first, count, nullptr, nullptr, nullptr };
  }
  deliver();
}

} // namespace

void Simulator::sweep(const std::vector<ProbePose>& poses, const ImageSettings& settings, bool withLabels,
                      const SweepSink& sink, const Progress& progress, const std::vector<TargetSurface>& targets)
{
  settings.requireMatch();
  planeImageLayout(settings.geometry, settings.pixelMm); // throws for a matrix
  if (poses.empty())
  {
    return;
  }
  const bool onDevice = runsOnDevice(settings.tracing) && chooseDevice(settings.echo.device).cuda;
  ImageSettings wanted = settings;
  if (onDevice && settings.tracing.imagingMode == ImagingMode::Fundamental && !settings.tracing.refines())
  {
    wanted.echo = withBeam(settings.echo, partOf(progress, 0.0, 0.1));
    const auto moving = withMoving(
      nullptr, [&] { return makeScanLines(settings.geometry, poses); }, wanted.echo, settings.tracing.model,
      partOf(progress, 0.1, 0.2));
    sweepOnDevice(needScene(), poses, wanted, withLabels, sink, partOf(progress, 0.2, 1.0), targets, moving.get());
  }
  else
  {
    wanted.setDevice(onDevice ? Device::Cuda : Device::Cpu);
    sweepOneByOne(scene_, poses, wanted, withLabels, sink, progress, targets);
  }
}

} // namespace sono
