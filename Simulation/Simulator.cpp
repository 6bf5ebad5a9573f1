#include "Simulator.h"

#include "BackgroundTrace.h"
#include "Cuda/DeviceImager.h"
#include "Cuda/MakeImageJob.h"
#include "Cuda/RunOnDevice.h"
#include "Echo/ComputedBeam.h"
#include "Echo/EchoSetup.h"
#include "Image/ErrorMap.h"
#include "Image/GreyBytes.h"
#include "Image/LabelSlice.h"
#include "KeptMoving.h"
#include "LastResults.h"
#include "Trace/TraceSetup.h"
#include "TraceByMode.h"

#include <chrono>
#include <optional>
#include <utility>

namespace sono {

namespace {

// What begin() takes on.
constexpr double bouncesBegun = 2e7;
constexpr std::chrono::milliseconds longestBegun(20);

/// Never destroyed: simulators that outlive the program's globals still ask it.
KeptMoving& keptMoving()
{
  static KeptMoving& kept = *new KeptMoving;
  return kept;
}

DepthOffsets offsetsOf(const TracedLines& traced)
{
  return { &traced.depthOffsetMm, traced.binCount, traced.binMm };
}

void fetchRf(const DeviceRf& device, RfLines& lines)
{
  lines.iq = DeviceImager::instance().fetchIq(device);
}

void fetchGrey(const DeviceGrey& device, BModeLines& lines)
{
  std::vector<double> reference;
  lines.grey = DeviceImager::instance().fetch(device, reference);
  lines.referenceAmplitude = reference.front();
}

void fetchPlane(const DevicePicture& device, PlaneImage& image)
{
  image.value = DeviceImager::instance().fetchLevels(device);
  const SharedSpan<std::uint8_t> mask = DeviceImager::instance().maskOf(device);
  image.mask.assign(mask.begin(), mask.end());
}

/// The map of nothing, as large as the layout.
template<class Image>
Image unknown(Image layout, std::size_t count)
{
  layout.value.assign(count, 0.0f);
  layout.mask.assign(count, 0);
  return layout;
}

} // namespace

/// Where labels are looked up.
struct Simulator::LabelsWanted
{
  ScanGeometry geometry;
  ProbePose pose;
  TracedResult traced;

  bool same(const LabelsWanted& o) const
  {
    return traced == o.traced && sono::same(geometry, o.geometry) && sono::same(pose, o.pose);
  }
};

struct Simulator::Last
{
  struct PictureFrom
  {
    ImageResult image;
    std::optional<LabelsWanted> labels;

    bool same(const PictureFrom& o) const
    {
      // Without labels a picture lies nowhere.
      return image == o.image && labels.has_value() == o.labels.has_value() && (!labels || labels->same(*o.labels));
    }
  };

  /// Labels lie where the mask does, however bright the image is.
  struct LabelsFrom
  {
    LabelsWanted wanted;
    std::vector<std::uint8_t> mask;

    bool same(const LabelsFrom& o) const { return mask == o.mask && wanted.same(o.wanted); }
  };

  LastResult<FieldFrom, std::shared_ptr<const ArrayField>> arrayField;
  LastResult<TraceFrom, TracedResult> traced;
  std::unique_ptr<BackgroundTrace> rounds; ///< of what was traced last; null: all of them are made
  LastResult<EchoJobFrom, std::shared_ptr<const EchoJob>> echoJob;
  LastResult<RfFrom, RfResult> rf;
  LastResult<BModeJobFrom, std::shared_ptr<const BModeJob>> bmodeJob;
  LastResult<BModeFrom, BModeResult> bmode;
  LastResult<ImageFrom, ImageResult> image;
  LastResult<PictureFrom, ScanPicture> picture;
  LastResult<LabelsFrom, SharedSpan<std::uint16_t>> labels;
  LastResult<ErrorFrom, ImageResult> errorMap;
  LastResult<PathsFrom, std::shared_ptr<const std::vector<RecordedPath>>> paths;

  const std::shared_ptr<const BModeJob>& bmodeJobFor(const BModeSettings& settings, const RfLines& rf)
  {
    return bmodeJob.get({ settings, rf.lineCount, rf.sampleCount, rf.sampleMm }, [&] {
      return std::make_shared<const BModeJob>(makeBModeJob(settings, rf.lineCount, rf.sampleCount, rf.sampleMm));
    });
  }
};

Simulator::Simulator(std::shared_ptr<const Scene> scene)
  : scene_(std::move(scene))
  , last_(std::make_unique<Last>())
{
}

Simulator::~Simulator()
{
  scene_.reset();
  keptMoving().dropDead();
}

void Simulator::setScene(std::shared_ptr<const Scene> scene)
{
  if (scene != scene_)
  {
    last_ = std::make_unique<Last>();
    scene_ = std::move(scene);
  }
}

const Scene& Simulator::needScene() const
{
  if (!scene_)
  {
    throw Error("there is no scene to trace: give the simulator one");
  }
  return *scene_;
}

TracedResult Simulator::trace(const std::vector<ScanLine>& lines, const TraceSettings& settings,
                              const std::vector<TargetSurface>& targets, const Progress& progress)
{
  const TracedResult now = last_->traced.get({ lines, settings, targets }, [&] {
    const Scene& scene = needScene();
    last_->rounds = nullptr;
    if (!settings.refines())
    {
      return traceByMode(scene, lines, settings, targets, progress);
    }
    if (progressive_ && !runsOnDevice(settings))
    {
      last_->rounds = std::make_unique<BackgroundTrace>(scene_, lines, settings, targets, progress);
      return last_->rounds->best();
    }
    RefinedTrace rounds(scene, lines, settings, targets, progress);
    while (rounds.refine(progress))
    {
    }
    return rounds.result();
  });
  if (progressive_ || !last_->rounds)
  {
    return now;
  }
  last_->traced.from.reset(); // stays so when it is stopped
  const TracedResult best = std::exchange(last_->rounds, nullptr)->finish(progress);
  return last_->traced.get({ lines, settings, targets }, [&] { return best; });
}

std::shared_ptr<const TracedLines> Simulator::arrivals(const TracedResult& traced)
{
  if (!traced.onDevice())
  {
    const auto held = std::make_shared<const TracedResult>(traced);
    return { held, &held->host() };
  }
  auto lines = std::make_shared<TracedLines>(traced.layout());
  FetchedArrivals fetched = DeviceImager::instance().fetchArrivals(*traced.onDevice());
  lines->intensity = std::move(fetched.intensity);
  lines->depthOffsetMm = std::move(fetched.depthOffsetMm);
  return lines;
}

bool Simulator::isRefining() const
{
  return last_->rounds && last_->rounds->isRunning();
}

bool Simulator::hasBetter() const
{
  return last_->rounds && !(last_->rounds->best() == last_->traced.result);
}

bool Simulator::improve()
{
  const bool isBetter = hasBetter();
  if (isBetter)
  {
    last_->traced.result = last_->rounds->best();
  }
  return isBetter;
}

std::shared_ptr<const std::vector<RecordedPath>> Simulator::paths(const std::vector<ScanLine>& lines,
                                                                  const TraceSettings& settings, int count,
                                                                  const std::vector<TargetSurface>& targets,
                                                                  const Progress& progress)
{
  return last_->paths.get({ { lines, settings, targets }, count }, [&] {
    return std::make_shared<const std::vector<RecordedPath>>(
      recordPaths(needScene(), lines, settings, count, targets, progress));
  });
}

EchoSettings Simulator::withBeam(EchoSettings settings, const Progress& progress)
{
  if (settings.beam == BeamForm::Computed && !settings.arrayField && !settings.field)
  {
    const FieldFrom from{ elementsOf(settings), settings.depthMm };
    settings.arrayField = last_->arrayField.get(
      from, [&] { return std::make_shared<const ArrayField>(from.aperture, from.depthMm, progress); });
  }
  return settings;
}

std::shared_ptr<const PointScatterers> Simulator::withMoving(const std::shared_ptr<const PointScatterers>& points,
                                                             const std::function<std::vector<ScanLine>()>& lines,
                                                             const EchoSettings& settings, InterfaceModel model,
                                                             const Progress& progress)
{
  if (!scene_ || !scene_->motion())
  {
    return points;
  }
  const MovingStatistics statistics = movingStatistics(*scene_, settings, model);
  const MovingPart part = movingPart(*scene_, statistics, lines(), settings, model);
  return keptMoving().get(scene_, { statistics, part, points }, [&] {
    std::vector<PointScatterer> all = movingScatterers(*scene_, statistics, part, partOf(progress, 0.0, 0.6));
    if (points)
    {
      const std::vector<PointScatterer> own = points->all();
      all.insert(all.end(), own.begin(), own.end());
    }
    return std::make_shared<const PointScatterers>(
      sortedMoving(*scene_, statistics, part, all, partOf(progress, 0.6, 1.0)));
  });
}

RfResult Simulator::formRf(const std::vector<ScanLine>& lines, const TracedResult& traced,
                           const EchoSettings& wantedSettings, const std::shared_ptr<const PointScatterers>& userPoints,
                           const Progress& wholeProgress)
{
  const EchoSettings settings = withBeam(wantedSettings, partOf(wholeProgress, 0.0, 0.1));
  const Progress progress = partOf(wholeProgress, 0.2, 1.0);
  const InterfaceModel model = traced ? traced.layout().model : InterfaceModel::Acoustic;
  const auto points = withMoving(
    userPoints, [&] { return lines; }, settings, model, partOf(wholeProgress, 0.1, 0.2));
  const EchoJobFrom from{ lines, settings, points, model, traced ? traced.layout().targets : nullptr };
  return last_->rf.get({ from, traced }, [&] {
    EchoSources sources{ scene_.get(), nullptr, points.get(), model, from.targets.get() };
    const bool onDevice = chooseDevice(settings.device).cuda;
    // Echoes on other samples are brought onto the RF's on the host.
    const bool takesDevices =
      onDevice &&
      (!traced || (traced.onDevice() && traced.layout().lineCount == int(lines.size()) &&
                   (traced.layout().echoCount == 0 || agree(traced.layout().echoSampleMm, settings.sampleMm()))));
    if (traced && !takesDevices)
    {
      sources.traced = &traced.host();
    }
    if (!onDevice)
    {
      return RfResult(sono::formRf(sources, lines, settings, progress));
    }
    const auto makeJob = [&] {
      const EchoSetup setup(sources, lines, settings);
      return std::make_shared<const EchoJob>(makeEchoJob(setup, int(lines.size())));
    };
    const std::shared_ptr<const EchoJob> job = takesDevices ? last_->echoJob.get(from, makeJob) : makeJob();
    report(progress, 0.5);
    RfLines layout = rfLayout(int(lines.size()), settings);
    return RfResult(std::move(layout),
                    DeviceImager::instance().formRf(job, { 0, int(lines.size()) },
                                                    traced && takesDevices ? traced.onDevice().get() : nullptr, true),
                    fetchRf);
  });
}

BModeResult Simulator::makeBMode(const RfResult& rf, const BModeSettings& settings)
{
  return last_->bmode.get({ rf, settings }, [&] {
    const RfLines& layout = rf.layout();
    if (!rf.onDevice())
    {
      return BModeResult(
        sono::makeBMode(layout.envelope(), layout.lineCount, layout.sampleCount, layout.sampleMm, settings));
    }
    return BModeResult({ layout.lineCount, layout.sampleCount, layout.sampleMm, 0.0, {} },
                       DeviceImager::instance().compress(last_->bmodeJobFor(settings, layout), *rf.onDevice(), 1),
                       fetchGrey);
  });
}

ImageResult Simulator::scanConvert(const ScanGeometry& geometry, const BModeResult& bmode, double pixelMm,
                                   const Progress& progress)
{
  return last_->image.get({ geometry, bmode, pixelMm }, [&] {
    const BModeLines& layout = bmode.layout();
    if (geometry.isVolume())
    {
      return ImageResult(
        scanConvertVolume(geometry, bmode.host().grey, layout.sampleCount, layout.sampleMm, pixelMm, progress));
    }
    if (!bmode.onDevice() || layout.lineCount != geometry.totalLineCount())
    {
      return ImageResult(
        PlaneResult(sono::scanConvert(geometry, bmode.host().grey, layout.sampleCount, layout.sampleMm, pixelMm)));
    }
    const PlaneScan scan = planeScan(geometry, layout.sampleCount, layout.sampleMm, pixelMm);
    return ImageResult(PlaneResult(planeImageLayout(geometry, pixelMm),
                                   DeviceImager::instance().convert(scan, bmode.onDevice()), fetchPlane));
  });
}

ScanPicture Simulator::picture(const ImageResult& image)
{
  return last_->picture.get({ image, std::nullopt }, [&] { return makePicture(image, nullptr); });
}

ScanPicture Simulator::picture(const ImageResult& image, const ScanGeometry& geometry, const ProbePose& pose,
                               const TracedResult& traced)
{
  const LabelsWanted wanted{ geometry, pose, traced };
  return last_->picture.get({ image, wanted }, [&] { return makePicture(image, &wanted); });
}

ScanPicture Simulator::makePicture(const ImageResult& image, const LabelsWanted* wanted)
{
  const auto onHost = [&](const auto& made) {
    ScanPicture picture{ SharedSpan<std::uint8_t>(greyBytes(made.value, made.mask)),
                         SharedSpan<std::uint8_t>(made.mask),
                         {} };
    if (wanted)
    {
      picture.labels = last_->labels.get({ *wanted, made.mask }, [&] {
        return SharedSpan<std::uint16_t>(
          sliceLabels(needScene().volume(), wanted->geometry, wanted->pose, made,
                      wanted->traced ? offsetsOf(wanted->traced.host()) : DepthOffsets{}));
      });
    }
    return picture;
  };
  if (image.isVolume())
  {
    return onHost(image.volume());
  }
  const auto& picture = image.plane().onDevice();
  if (!picture)
  {
    return onHost(image.plane().host());
  }
  DeviceImager& imager = DeviceImager::instance();
  std::shared_ptr<const DeviceLabelSlice> labels;
  if (wanted)
  {
    const TracedResult& traced = wanted->traced;
    const auto& onDevice = traced ? traced.onDevice() : nullptr;
    const DepthOffsets given = traced && !onDevice ? offsetsOf(traced.host()) : DepthOffsets{};
    LabelJob job = makeLabelJob(needScene(), &wanted->pose, 1, image.plane().layout());
    job.scan = offsetScan(wanted->geometry, traced ? traced.layout().binCount : 0, traced ? traced.layout().binMm : 0.0,
                          image.plane().layout().pixelMm);
    job.offsetMm = given.any() ? given.mm : nullptr;
    labels = imager.slice(job, *picture, onDevice.get());
  }
  const PictureCopy copy = imager.wait(imager.beginDownload(picture, labels));
  return ScanPicture{ copy.bytes, copy.mask, copy.labels };
}

ImageResult Simulator::errorMap(const ScanGeometry& geometry, const TracedResult& traced, bool interactive,
                                double pixelMm, const Progress& progress)
{
  return last_->errorMap.get({ geometry, traced, interactive, pixelMm }, [&] {
    const bool isVolume = geometry.isVolume();
    if (interactive && isVolume)
    {
      const VolumeImage layout = volumeImageLayout(geometry, pixelMm);
      return ImageResult(unknown(layout, layout.voxelCount()));
    }
    if (interactive)
    {
      const PlaneImage layout = planeImageLayout(geometry, pixelMm);
      return ImageResult(PlaneResult(unknown(layout, std::size_t(layout.width) * layout.height)));
    }
    const TracedLines& lines = traced.host();
    if (isVolume)
    {
      return ImageResult(errorVolume(geometry, lines, pixelMm, progress));
    }
    return ImageResult(PlaneResult(errorPlane(geometry, lines, pixelMm)));
  });
}

TracedResult Simulator::traced(const ImageInput& input, const Progress& progress)
{
  input.settings.requireMatch();
  return trace(makeScanLines(input.settings.geometry, input.pose), input.settings.tracing, input.targets, progress);
}

void Simulator::begin(const ImageInput& input, bool wholeImage)
{
  const TraceSettings& tracing = input.settings.tracing;
  const auto& before = last_->traced.from;
  const int lineCount = input.settings.geometry.totalLineCount();
  if (!scene_ || !before || !runsOnDevice(tracing) || tracing.imagingMode == ImagingMode::Harmonic ||
      tracing.refines() || double(tracing.pathsPerLine) * tracing.maxCollisions * lineCount > bouncesBegun)
  {
    return;
  }
  const std::vector<ScanLine> lines = makeScanLines(input.settings.geometry, input.pose);
  const auto box = [&](const std::vector<ScanLine>& of, const TraceSettings& s) { return fanBox(*scene_, of, s); };
  // A moving probe's region is wider than its fan.
  if (tracing.interactive != before->settings.interactive ||
      (!tracing.interactive && !(box(lines, tracing) == box(before->lines, before->settings))))
  {
    return;
  }
  try
  {
    const auto end = std::chrono::steady_clock::now() + longestBegun;
    input.settings.requireMatch();
    trace(lines, tracing, input.targets, [end](double) { return std::chrono::steady_clock::now() < end; });
    if (wholeImage && !input.settings.geometry.isVolume() && chooseDevice(input.settings.echo.device).cuda)
    {
      image(input);
    }
  }
  catch (const Aborted&) // left to traced(), which can be stopped
  {
  }
}

RfResult Simulator::rf(const ImageInput& input, const Progress& progress)
{
  const TracedResult before = traced(input, partOf(progress, 0.0, 0.8));
  return formRf(makeScanLines(input.settings.geometry, input.pose), before, input.settings.echo, input.points,
                partOf(progress, 0.8, 1.0));
}

BModeResult Simulator::bmode(const ImageInput& input, const Progress& progress)
{
  return makeBMode(rf(input, progress), input.settings.bmode);
}

ImageResult Simulator::image(const ImageInput& input, const Progress& progress)
{
  return scanConvert(input.settings.geometry, bmode(input, partOf(progress, 0.0, 0.95)), input.settings.pixelMm,
                     partOf(progress, 0.95, 1.0));
}

void Simulator::prepareInteractive(const std::vector<ScanLine>& lines, const TraceSettings& settings)
{
  const Scene& scene = needScene();
  scene.beginInteractiveRegion(fanBox(scene, lines, settings), runsOnDevice(settings));
}

} // namespace sono
