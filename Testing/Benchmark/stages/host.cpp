// What a body and an image of the data set `apical_views` cost the processor where a GPU traces: user time by stage.
#include "Cuda/MakeImageJob.h"
#include "DataSets/BodyRegion.h"
#include "DataSets/DataSetImager.h"
#include "DataSets/DataSetInfo.h"
#include "DataSets/HoldProbe.h"
#include "DataSets/ImageSight.h"
#include "DataSets/MaskGroups.h"
#include "Echo/ComputedBeam.h"
#include "Echo/EchoSetup.h"
#include "Folders.h"
#include "Image/LabelSlice.h"
#include "Image/PngFile.h"
#include "Labels/PrepareBody.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Probe/HeartLandmarks.h"
#include "Probe/StandardViews.h"
#include "Stage.h"
#include "Trace/ProbeContact.h"
#include "Trace/SecondHarmonic.h"
#include "Trace/TraceSetup.h"

#include <sys/resource.h>

#include <cstdlib>
#include <set>
#include <utility>

namespace sono {
namespace {

/// User time of all threads, by stage.
class Costs
{
public:
  template<class Do>
  auto of(const char* stage, const Do& work)
  {
    const double before = now();
    auto made = work();
    add(stage, now() - before);
    return made;
  }
  void print(const char* unit, double perUnit, double factor) const
  {
    double sum = 0.0;
    for (const auto& [stage, seconds] : stages_)
    {
      sum += seconds;
      printFigure("host_" + stage, factor * seconds / perUnit, unit);
    }
    printFigure(std::string("host_all"), factor * sum / perUnit, unit);
  }

private:
  static double now()
  {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_utime.tv_sec) + 1e-6 * double(usage.ru_utime.tv_usec);
  }
  void add(const char* stage, double seconds)
  {
    for (auto& [name, sum] : stages_)
    {
      if (name == stage)
      {
        sum += seconds;
        return;
      }
    }
    stages_.emplace_back(stage, seconds);
  }

  std::vector<std::pair<std::string, double>> stages_; // in their order
};

struct MadeBody
{
  std::unique_ptr<Scene> scene;
  std::vector<std::uint8_t> groups;
  std::vector<StandardView> views;
  HeartLandmarks landmarks;
};

MadeBody makeBody(const DataSetPlan& plan, int number, Costs& costs)
{
  const DataSet& set = plan.set();
  const DataSetPatient& patient = plan.patientOf(number);
  const PlannedBody& planned = plan.bodies()[std::size_t(number)];
  LabelVolume volume = costs.of("labels", [&] { return makeThoraxPhantom(patient.spacingMm, thoraxOf(planned)); });
  costs.of("prepare", [&] {
    return prepareBody(volume, LabelTissueMap::read(set.labelTissues), set.tissues, "soft_tissue", BodyFillMode::Auto);
  });
  volume = costs.of("augment", [&] { return augmented(volume, planned.augmentation); });
  MadeBody body;
  body.groups = costs.of("groups", [&] { return groupsOf(volume.labels, set.masks); });
  body.scene =
    costs.of("scene", [&] { return std::make_unique<Scene>(std::move(volume), set.tissues, couplingTissue); });
  std::set<std::string> names;
  for (const DataSetView& view : patient.views)
  {
    names.insert(view.name);
  }
  body.views = costs.of("views", [&] {
    std::vector<StandardView> found;
    for (const StandardView& view : findStandardViews(
           *body.scene, [&](const std::string&) { return set.probe; }, {}, names))
    {
      if (names.count(view.name) == 1)
      {
        found.push_back(view);
      }
    }
    return found;
  });
  costs.of("fibres", [&] { return body.scene->fibres() != nullptr; });
  body.landmarks = costs.of("landmarks", [&] { return findHeartLandmarks(body.scene->volume()); });
  std::vector<ProbePose> poses;
  for (const StandardView& view : body.views)
  {
    if (view.refusal.empty())
    {
      poses.push_back(view.pose);
    }
  }
  shareBodyRegion(*body.scene, plan, poses);
  const ImageSettings deepest = plan.deepest().image(set.pixelMm, Device::Cpu);
  const VoxelBox box = fanBox(*body.scene, makeScanLines(deepest.geometry, poses.front()), deepest.tracing);
  costs.of("words", [&] { return body.scene->regionOnDemand(box); });
  costs.of("records", [&] { return bakeBodyRecords(*body.scene, plan, poses); });
  return body;
}

/// What is made of a picture that came from the device: masks, flags, the description and the files.
void finishImage(const DataSetPlan& plan, const PlannedImage& planned, const ImageSettings& settings,
                 const ProbePose& pose, const TracedLines& traced, const MadeBody& body, Costs& costs)
{
  const DataSet& set = plan.set();
  PlaneImage layout = plan.layout(planned);
  layout.mask.assign(std::size_t(layout.width) * std::size_t(layout.height), 1);
  const std::vector<std::uint16_t> labels = sliceLabels(body.scene->volume(), settings.geometry, pose, layout, {});
  std::vector<std::uint8_t> mask(labels.size());
  std::vector<std::uint8_t> grey(labels.size());
  for (std::size_t i = 0; i < grey.size(); ++i)
  {
    mask[i] = body.groups[labels[i]];
    // Packed, half as large as it is: as a picture's speckle.
    grey[i] = std::uint8_t(40u * mask[i] + drawSeed(1, DrawScope::Image, std::int64_t(i), 0) % 12);
  }
  DataSetFacts facts;
  facts.image = planned;
  facts.settings = plan.settings(planned);
  facts.found = &body.views[std::size_t(planned.view)];
  const std::vector<ScanLine> lines = makeScanLines(settings.geometry, pose);
  costs.of("sight", [&] {
    const ImageSight sight(settings, pose, layout, traced);
    facts.landmarks = landmarksInImage(body.landmarks, pose, sight);
    facts.flags.shareInsideVolume = shareInsideVolume(*body.scene, settings.geometry, pose);
    facts.flags.shareShadowed = sight.shareShadowed(lines);
    for (const double share : sight.visibleShares(mask, set.masks.size()))
    {
      facts.groups.push_back({ 1, true, share });
    }
    return 0;
  });
  const std::string info = costs.of("info", [&] { return describeImage(plan, *body.scene, facts); });
  costs.of("png", [&] {
    return pngBytes(grey.data(), layout.width, layout.height, layout.pixelMm).size() +
           pngBytes(mask.data(), layout.width, layout.height, layout.pixelMm).size();
  });
}

/// Sends a picture through what the host does of it.
void makeImage(const DataSetPlan& plan, std::int64_t index, const MadeBody& body, Costs& costs)
{
  const DataSet& set = plan.set();
  const PlannedImage planned = plan.image(index);
  const StandardView& view = body.views[std::size_t(planned.view)];
  if (!view.refusal.empty())
  {
    return;
  }
  const ImageSettings settings =
    costs.of("settings", [&] { return plan.settings(planned).image(set.pixelMm, Device::Cpu); });
  ProbePose pose = view.pose;
  costs.of("pose", [&] {
    const PoseJitter jitter = plan.jitter(index, 0);
    pose = poseOnSkin(*body.scene, jittered(pose, jitter)).value_or(pose);
    pose = pressedIn(*body.scene, pose, settings.tracing.aperture, jitter.pressMm);
    return probeContactWarning(*body.scene, makeScanLines(settings.geometry, pose)) +
           probePlaceWarning(*body.scene, settings.geometry, pose);
  });
  costs.of("look", [&] { return maskSufficiency(*body.scene, body.groups, set.masks, settings, pose); });
  const std::vector<ScanLine> lines = makeScanLines(settings.geometry, pose);
  costs.of("trace_tables", [&] {
    const TraceSettings tone = sentTone(settings.tracing);
    TraceSetup setup(*body.scene, lines, tone, {}, {});
    TraceJob job = makeTraceJob(setup, tone, int(lines.size()));
    const TraceJob sent = job;
    const TraceSettings doubled = doubledTone(settings.tracing);
    setup.tune(*body.scene, doubled, {});
    tuneTraceJob(setup, doubled, job);
    return job.binCount + sent.binCount;
  });
  TracedLines traced = tracedLayout(int(lines.size()), settings.tracing, {});
  const std::size_t bins = lines.size() * std::size_t(traced.binCount);
  traced.intensity.assign(bins, 0.01f);
  traced.depthOffsetMm.assign(bins, 0.0f);
  costs.of("harmonic_tables", [&] {
    const HarmonicJob job{ harmonicSources(*body.scene, lines, settings.tracing), sentGains(settings.tracing) };
    return job.gains.size();
  });
  costs.of("echo_tables", [&] {
    const EchoSources sources{ body.scene.get(), nullptr, nullptr, settings.tracing.model, nullptr };
    const EchoSetup setup(sources, lines, settings.echo);
    return makeEchoJob(setup, int(lines.size())).lineCount;
  });
  finishImage(plan, planned, settings, pose, traced, body, costs);
  costs.of("display_tables", [&] {
    const RfLines rf = rfLayout(int(lines.size()), settings.echo);
    return makeBModeJob(settings.bmode, rf.lineCount, rf.sampleCount, rf.sampleMm).noiseSeed;
  });
}

void measureHost()
{
  DataSet set = readDataSet(dataFile("datasets/apical_views.json"), dataFolder());
  const DataSetPlan plan(set);
  constexpr int bodies = 4;
  constexpr int images = 8; // of each
  Costs ofBodies;
  Costs ofImages;
  for (int number = 0; number < bodies; ++number)
  {
    const MadeBody body = makeBody(plan, number, ofBodies);
    const std::int64_t perBody = plan.imageCount() / std::int64_t(plan.bodies().size());
    for (int n = 0; n < images; ++n)
    {
      makeImage(plan, number * perBody + n, body, ofImages);
    }
  }
  ofBodies.print("s/body", bodies, 1.0);
  ofImages.print("ms/image", bodies * images, 1e3);
}

const Stage stage("host", measureHost);

} // namespace
} // namespace sono
