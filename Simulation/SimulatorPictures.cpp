#include "Core/Policy.h"
#include "Cuda/DeviceImager.h"
#include "Cuda/MakeImageJob.h"
#include "Cuda/RunOnDevice.h"
#include "Echo/EchoSetup.h"
#include "Image/LabelSlice.h"
#include "ImageGroup.h"
#include "SameSettings.h"
#include "Simulator.h"
#include "Trace/TraceSetup.h"
#include "TraceByMode.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace sono {
namespace {
using Inputs = std::vector<const ImageInput*>;

/// Whether a GPU can take them together with others.
bool canGoTogether(const Scene& scene, const ImageInput& input)
{
  const ImageSettings& settings = input.settings;
  // One that prepares a region of its own would have others share it, and be rounded otherwise than alone.
  return runsOnDevice(settings.tracing) && chooseDevice(settings.echo.device).cuda && !settings.tracing.refines() &&
         input.targets.empty() && !input.points &&
         scene.sharesRegion(fanBox(scene, makeScanLines(settings.geometry, input.pose), settings.tracing));
}

std::vector<ProbePose> posesOf(const Inputs& inputs)
{
  std::vector<ProbePose> poses;
  std::transform(inputs.begin(), inputs.end(), std::back_inserter(poses),
                 [](const ImageInput* input) { return input->pose; });
  return poses;
}

/// But for what each image of a group may have to itself.
bool sameStages(ImageSettings a, const ImageSettings& b)
{
  a.tracing.seed = b.tracing.seed;
  return same(a.tracing, b.tracing) && same(a.echo, b.echo) && same(a.geometry, b.geometry) && a.pixelMm == b.pixelMm;
}

/// The values of one of so many images.
template<class T>
SharedSpan<T> imageOf(const SharedSpan<T>& all, std::size_t image, std::size_t images)
{
  const std::size_t count = all.size / images;
  return { std::shared_ptr<const T>(all.data, all.data.get() + image * count), count };
}

std::vector<float> imageOf(const std::vector<float>& all, std::size_t image, std::size_t images)
{
  const std::size_t count = all.size() / images;
  const auto from = all.begin() + std::ptrdiff_t(image * count);
  return { from, from + std::ptrdiff_t(count) };
}

/// Of a group that fits the device, whose settings are those of `echo` and else the first one's.
std::vector<SeenPicture> picturesOnDevice(const Scene& scene, const Inputs& group, const EchoSettings& echo,
                                          const PointScatterers* points, const Progress& progress)
{
  const ImageSettings& settings = group.front()->settings;
  const int perImage = settings.geometry.totalLineCount();
  const auto count = int(group.size());
  const std::vector<ProbePose> poses = posesOf(group);
  std::vector<std::uint64_t> seeds;
  for (const ImageInput* input : group)
  {
    seeds.push_back(input->settings.tracing.seed);
  }
  const std::vector<ScanLine> lines = makeScanLines(settings.geometry, poses);
  const RfLines rfOfOne = rfLayout(perImage, echo);
  DeviceImager& imager = DeviceImager::instance();
  const EchoSources sources{ &scene, nullptr, points, settings.tracing.model, nullptr };
  const EchoSetup setup(sources, lines, echo, perImage);
  const auto echoJob = std::make_shared<const EchoJob>(makeEchoJob(setup, perImage));
  imager.prepare(echoJob);
  const auto traced = traceOnDevice(scene, lines, settings.tracing, {}, perImage, seeds, partOf(progress, 0.0, 0.5));
  const auto rf = imager.formRf(echoJob, { 0, int(lines.size()) }, traced.get(), false);
  std::vector<std::shared_ptr<const BModeJob>> bmodeJobs;
  for (const ImageInput* input : group)
  {
    bmodeJobs.push_back(std::make_shared<const BModeJob>(
      makeBModeJob(input->settings.bmode, perImage, rfOfOne.sampleCount, rfOfOne.sampleMm)));
  }
  const auto picture =
    imager.convert(planeScan(settings.geometry, rfOfOne.sampleCount, rfOfOne.sampleMm, settings.pixelMm),
                   imager.compress(bmodeJobs, *rf));
  TracedLines layout = tracedLayout(perImage, settings.tracing);
  LabelJob labels = makeLabelJob(scene, poses.data(), count, planeImageLayout(settings.geometry, settings.pixelMm));
  labels.scan = offsetScan(settings.geometry, layout.binCount, layout.binMm, settings.pixelMm);
  const auto download = imager.beginDownload(picture, imager.slice(labels, *picture, traced.get()));

  const FetchedArrivals arrivals = imager.fetchArrivals(*traced);
  const PictureCopy copy = imager.wait(download);
  std::vector<SeenPicture> made;
  for (std::size_t i = 0; i < group.size(); ++i)
  {
    const auto arrived = std::make_shared<TracedLines>(layout);
    arrived->intensity = imageOf(arrivals.intensity, i, group.size());
    arrived->depthOffsetMm = imageOf(arrivals.depthOffsetMm, i, group.size());
    made.push_back({ { imageOf(copy.bytes, i, group.size()), copy.mask, imageOf(copy.labels, i, group.size()) },
                     arrived,
                     picture,
                     int(i) });
  }
  return made;
}

} // namespace

std::vector<SeenPicture> Simulator::pictures(const std::vector<ImageInput>& inputs, const Progress& progress)
{
  std::vector<SeenPicture> made(inputs.size());
  std::vector<bool> canJoin;
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < inputs.size(); ++i)
  {
    inputs[i].settings.requireMatch();
    planeImageLayout(inputs[i].settings.geometry, inputs[i].settings.pixelMm); // throws for a matrix
    canJoin.push_back(inputs.size() > 1 && canGoTogether(needScene(), inputs[i]));
    left.push_back(i);
  }
  while (!left.empty())
  {
    const Progress ofGroup = partOf(progress, 1.0 - double(left.size()) / double(inputs.size()), 1.0);
    const ImageInput& first = inputs[left.front()];
    std::vector<std::size_t> group{ left.front() };
    std::vector<std::size_t> others;
    const int most = canJoin[left.front()] ? std::min(imagesTogether, imagesThatFit(first.settings)) : 1;
    for (auto i = left.begin() + 1; i != left.end(); ++i)
    {
      const bool joins = int(group.size()) < most && canJoin[*i] && sameStages(inputs[*i].settings, first.settings);
      (joins ? group : others).push_back(*i);
    }
    if (group.size() > 1)
    {
      Inputs ofGroupInputs;
      std::transform(group.begin(), group.end(), std::back_inserter(ofGroupInputs),
                     [&](std::size_t i) { return &inputs[i]; });
      const EchoSettings echo = withBeam(first.settings.echo);
      const auto lines = [&] { return makeScanLines(first.settings.geometry, posesOf(ofGroupInputs)); };
      const auto moving = withMoving(nullptr, lines, echo, first.settings.tracing.model);
      std::vector<SeenPicture> ofThese = picturesOnDevice(needScene(), ofGroupInputs, echo, moving.get(), ofGroup);
      for (std::size_t i = 0; i < group.size(); ++i)
      {
        made[group[i]] = std::move(ofThese[i]);
      }
    }
    else
    {
      const ImageResult result = image(first, ofGroup);
      const TracedResult lines = traced(first);
      made[group.front()] = { picture(result, first.settings.geometry, first.pose, lines), arrivals(lines),
                              result.plane().onDevice(), 0 };
    }
    left = std::move(others);
  }
  return made;
}

} // namespace sono
