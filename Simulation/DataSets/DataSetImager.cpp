#include "DataSets/DataSetImager.h"

#include "Core/Entrance.h"
#include "Core/MadeOnce.h"
#include "Core/ParallelFor.h"
#include "Cuda/DeviceImager.h"
#include "Cuda/RunOnDevice.h"
#include "DataSets/BodyRegion.h"
#include "DataSets/BodyViews.h"
#include "DataSets/DataSetInfo.h"
#include "DataSets/HoldProbe.h"
#include "DataSets/ImageChannels.h"
#include "DataSets/MaskGroups.h"
#include "Labels/PrepareBody.h"
#include "Labels/ReadLabelMap.h"
#include "Phantoms/DrawThorax.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Simulator.h"
#include "Trace/ProbeContact.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>

namespace sono {

namespace {

constexpr int mostAttempts = 32;
constexpr const char* fallbackTissue = "soft_tissue";

/// A body's landmarks, or a sentence why it has none.
struct FoundLandmarks
{
  std::optional<HeartLandmarks> heart;
  std::string refusal;
};

FoundLandmarks findLandmarks(const LabelVolume& volume)
{
  try
  {
    return { findHeartLandmarks(volume), {} };
  }
  catch (const Error& error)
  {
    return { {}, error.what() };
  }
}

/// Bodies that are prepared at a time: some by all cores, so that a device soon has the first ones, and has some while
/// others are prepared.
int preparedTogether()
{
  return std::max(1, int(std::thread::hardware_concurrency()) / 2);
}

} // namespace

/// A patient's labels with tissues, and skin around them; not augmented.
struct DataSetImager::Patient
{
  /// Patients are the same that do not differ but by augmentation.
  using Key = std::pair<int, std::optional<std::uint64_t>>;
  static Key keyOf(const PlannedBody& body) { return { body.patient, body.thoraxSeed }; }

  Key key;
  ThoraxParameters thorax;
  LabelVolume volume;
  std::vector<bool> groupIsThere;
};

/// What of a body is the same for all who make images of it.
struct DataSetImager::Found
{
  std::vector<BodyView> views; ///< of the patient's
  FoundLandmarks landmarks;
  std::weak_ptr<const RegionOnDemand> region; ///< of the one who found them
};

/// Imagers of several threads share the patients that they hold, and what was found of bodies.
struct DataSetImager::Shared
{
  MadeOnce<Patient::Key, Patient> patients;
  MadeOnce<int, Found> found;
  Entrance preparing{ preparedTogether() };
};

/// One of the patient's bodies, in the last exam.
struct DataSetImager::Body
{
  int number = 0;
  std::int64_t exam = -1;
  std::shared_ptr<Scene> scene;
  Simulator simulator;
  std::shared_ptr<const Found> found;
  std::vector<std::uint8_t> groups; ///< the mask's value of each label id
  std::vector<bool> isMitralValve;  ///< by label id; empty where no line divides the masks
};

/// An image before it is made; its view is one that is obtainable.
struct DataSetImager::PlacedImage
{
  ImageInput input;
  DataSetFacts facts;
};

DataSetImager::DataSetImager(std::shared_ptr<const DataSetPlan> plan, Device device)
  : plan_(std::move(plan))
  , device_(device)
  , shared_(std::make_shared<Shared>())
{
}

DataSetImager DataSetImager::another() const
{
  DataSetImager imager(plan_, device_);
  imager.keepsOnGpu_ = keepsOnGpu_;
  imager.shared_ = shared_;
  return imager;
}

DataSetImager::DataSetImager(DataSetImager&&) noexcept = default;

DataSetImager::~DataSetImager() = default;

bool DataSetImager::runsOnGpu() const
{
  return runsOnDevice(plan_->settings(plan_->image(0)).image(plan_->set().pixelMm, device_).tracing);
}

void DataSetImager::keepOnGpu()
{
  if (!runsOnGpu())
  {
    throw Error("the images cannot stay on a GPU, since none makes them: " + cudaStatus().what +
                "; take them from the host.");
  }
  keepsOnGpu_ = true;
}

std::shared_ptr<const DataSetImager::Patient> DataSetImager::makePatient(const PlannedBody& body,
                                                                         const Progress& progress) const
{
  const DataSet& set = plan_->set();
  const DataSetPatient& patient = set.patients[std::size_t(body.patient)];
  auto made = std::make_shared<Patient>();
  made->key = Patient::keyOf(body);
  made->thorax = thoraxOf(body);
  made->volume = patient.labels.empty() ? makeThoraxPhantom(patient.spacingMm, made->thorax)
                                        : readLabelMap(patient.labels, 0, progress);
  if (!patient.names.empty())
  {
    readLabelTable(patient.names, made->volume);
  }
  sono::prepareBody(made->volume, LabelTissueMap::read(set.labelTissues), set.tissues, fallbackTissue,
                    BodyFillMode::Auto);
  made->groupIsThere.assign(set.masks.size(), false);
  for (const std::uint8_t value : groupsOf(made->volume.labels, set.masks))
  {
    if (value > 0)
    {
      made->groupIsThere[value - 1u] = true;
    }
  }
  if (std::find(made->groupIsThere.begin(), made->groupIsThere.end(), true) == made->groupIsThere.end())
  {
    throw Error("patient '" + patient.id + "' has no label of any group of 'masks'; correct their 'labels'.");
  }
  return made;
}

void DataSetImager::prepareBody(int number, const Progress& progress)
{
  if (body_ && body_->number == number)
  {
    return;
  }
  const DataSet& set = plan_->set();
  const PlannedBody& planned = plan_->bodies()[std::size_t(number)];
  const Patient::Key key = Patient::keyOf(planned);
  body_ = nullptr; // before the next one takes as much memory
  const Entrance::Stay stay(shared_->preparing);
  const LoopsOn allCores(LoopCores::All); // others wait for a body, too
  report(progress, 0.0);
  if (!patient_ || patient_->key != key)
  {
    patient_ = nullptr;
    patient_ = shared_->patients.get(key, [&] { return makePatient(planned, progress); });
  }
  const BodyAugmentation& augmentation = planned.augmentation;
  LabelVolume volume = augmented(patient_->volume, augmentation);
  auto body = std::make_unique<Body>();
  body->groups = groupsOf(volume.labels, set.masks); // fat may be new
  if (set.mitralLine)
  {
    body->isMitralValve = labelsOf(volume.labels, set.mitralLine->valve);
  }
  body->number = number;
  body->scene = std::make_shared<Scene>(std::move(volume), set.tissues, couplingTissue);
  const auto prepareRegion = [&](const std::vector<BodyView>& views, const std::weak_ptr<const RegionOnDemand>& known) {
    std::vector<ProbePose> poses;
    for (const BodyView& view : views)
    {
      if (view.pose)
      {
        poses.push_back(*view.pose);
      }
    }
    shareBodyRegion(*body->scene, *plan_, poses, known);
    if (!runsOnGpu())
    {
      return std::shared_ptr<const RegionOnDemand>();
    }
    body->scene->fibres();
    return bakeBodyRecords(*body->scene, *plan_, poses, progress);
  };
  bool isFirst = false;
  body->found = shared_->found.get(number, [&] {
    auto found = std::make_shared<Found>();
    found->views = findBodyViews(*body->scene, plan_->patientOf(number), patient_->thorax, set.probe,
                                 patient_->volume.placement, augmentation, progress);
    found->landmarks = findLandmarks(body->scene->volume());
    found->region = prepareRegion(found->views, {});
    isFirst = true;
    return std::shared_ptr<const Found>(found);
  });
  if (!isFirst)
  {
    prepareRegion(body->found->views, body->found->region);
  }
  body_ = std::move(body);
}

void DataSetImager::prepareExam(const PlannedImage& image, const Progress& progress)
{
  prepareBody(image.body, progress);
  if (body_->exam != image.exam)
  {
    body_->simulator.setScene(nullptr); // its results are of other tissues
    body_->scene->setTissues(plan_->tissues(image.exam));
    body_->simulator.setScene(body_->scene);
    body_->exam = image.exam;
  }
}

DataSetImager::PlacedImage DataSetImager::place(const PlannedImage& image)
{
  PlacedImage placed;
  placed.facts.image = image;
  placed.facts.settings = plan_->settings(image);
  placed.input.settings = placed.facts.settings.image(plan_->set().pixelMm, device_);
  placed.facts.onGpu = runsOnDevice(placed.input.settings.tracing);
  const ScanGeometry& geometry = placed.input.settings.geometry;
  if (geometry.isVolume())
  {
    throw Error("a matrix makes volumes; choose a probe with lines in a plane.");
  }
  // Views of the body follow, where this one is not obtainable or shows too little.
  const int count = int(body_->found->views.size());
  double best = -1.0;
  for (int i = 0; i < count && best < 1.0; ++i)
  {
    const int view = (image.view + i) % count;
    if (body_->found->views[std::size_t(view)].pose)
    {
      hold(placed, view, best);
    }
  }
  return placed;
}

/// Holds the probe for a view, in a better way than the best one until now if there is any, 1 being good enough.
void DataSetImager::hold(PlacedImage& placed, int view, double& best)
{
  const Scene& scene = *body_->scene;
  const ScanGeometry& geometry = placed.input.settings.geometry;
  const bool isCatheter = geometry.lineOrigin() == LineOrigin::Catheter;
  std::string why = "No surface of the body lies there.";
  bool isHeld = false;
  for (int attempt = 0; attempt < mostAttempts && best < 1.0; ++attempt)
  {
    PoseJitter jitter = plan_->jitter(placed.facts.image.index, attempt);
    ProbePose pose = jittered(*body_->found->views[std::size_t(view)].pose, jitter);
    if (!isCatheter)
    {
      const std::optional<ProbePose> onSkin = poseOnSkin(scene, pose);
      if (!onSkin)
      {
        continue;
      }
      pose = *onSkin;
    }
    why = probeContactWarning(scene, makeScanLines(geometry, pose));
    why = why.empty() ? probePlaceWarning(scene, geometry, pose) : why;
    if (!why.empty())
    {
      continue;
    }
    isHeld = true;
    if (!isCatheter)
    {
      const ProbePose pressed = pressedIn(scene, pose, placed.input.settings.tracing.aperture, jitter.pressMm);
      jitter.pressMm = glm::distance(pressed.positionMm, pose.positionMm);
      pose = pressed;
    }
    const double sufficiency = maskSufficiency(scene, body_->groups, plan_->set().masks, placed.input.settings, pose);
    if (sufficiency > best)
    {
      best = sufficiency;
      placed.facts.image.view = view;
      placed.facts.jitter = jitter;
      placed.input.pose = placed.facts.pose = pose;
    }
  }
  if (!isHeld)
  {
    throw Error("none of " + std::to_string(mostAttempts) + " poses drawn for view '" +
                plan_->patientOf(body_->number).views[std::size_t(view)].name +
                "' stands on the skin; narrow 'jitter' or correct the view. " + why);
  }
}

DataSetImage DataSetImager::make(std::int64_t index, const Progress& progress)
{
  DataSetImage made;
  makeEach(
    { index }, [&](std::int64_t, DataSetImage image) { made = std::move(image); }, progress);
  return made;
}

void DataSetImager::makeEach(const std::vector<std::int64_t>& indices, const DataSetSink& sink,
                             const Progress& progress)
{
  std::vector<PlacedImage> images;
  for (const std::int64_t index : indices)
  {
    plan_->requireImage(index);
    const PlannedImage planned = plan_->image(index);
    named(planned, [&] {
      prepareExam(planned, partOf(progress, 0.0, 0.2));
      images.push_back(place(planned));
    });
  }
  // Channels ask the stages for more of one image than those of several keep.
  const std::size_t together = plan_->set().channels.empty() && runsOnGpu() ? images.size() : 1;
  for (std::size_t i = 0; i < images.size(); i += together)
  {
    const double done = 0.2 + 0.8 * double(i) / double(images.size());
    std::vector<ImageInput> inputs;
    for (std::size_t n = i; n < i + together; ++n)
    {
      inputs.push_back(images[n].input);
    }
    named(images[i].facts.image, [&] {
      const std::vector<SeenPicture> pictures = body_->simulator.pictures(
        inputs, partOf(progress, done, done + 0.8 * double(together) / double(images.size())));
      for (std::size_t n = 0; n < together; ++n)
      {
        sink(images[i + n].facts.image.index, finish(images[i + n], pictures[n]));
      }
    });
  }
}

/// What goes wrong is told with the data set and the image.
template<class Do>
void DataSetImager::named(const PlannedImage& image, const Do& work) const
{
  try
  {
    work();
  }
  catch (const Error& error)
  {
    throw Error("'" + plan_->set().path + "': image " + std::to_string(image.index) + " of patient '" +
                plan_->patientOf(image.body).id + "': " + error.what());
  }
}

DataSetImage DataSetImager::finish(const PlacedImage& placed, const SeenPicture& seen)
{
  const ImageInput& input = placed.input;
  DataSetFacts facts = placed.facts;
  const PlaneImage layout = plan_->layout(facts.image);
  DataSetImage made{
    layout.width, layout.height, layout.pixelMm, layout.lateralMinMm, layout.axialMinMm, {}, {}, {}, {}, {}, {}, {}, {}
  };
  made.grey.assign(seen.picture.grey.begin(), seen.picture.grey.end());
  made.mask.resize(made.grey.size());
  std::transform(seen.picture.labels.begin(), seen.picture.labels.end(), made.mask.begin(),
                 [&](std::uint16_t label) { return body_->groups[label]; });
  const ImageSight sight(input.settings, input.pose, layout, *seen.arrivals);
  if (body_->found->landmarks.heart)
  {
    facts.landmarks = landmarksInImage(*body_->found->landmarks.heart, input.pose, sight);
  }
  if (plan_->set().mitralLine)
  {
    divideAtAnnulus(plan_->set(), body_->isMitralValve, facts.landmarks, seen.picture.labels.begin(), layout.width,
                    made.mask);
  }
  const std::vector<ImageChannel>& channels = plan_->set().channels;
  if (!channels.empty())
  {
    made.channels = pixelChannels(channels, input, body_->simulator, seen.picture, made.mask);
    made.beam = beamChannels(channels, input, body_->simulator);
  }
  if (keepsOnGpu_)
  {
    DeviceImager& imager = DeviceImager::instance();
    made.greyOnGpu = std::make_shared<const DeviceBytes>(
      seen.onDevice ? imager.bytesOf(seen.onDevice, seen.numberOnDevice) : imager.upload(made.grey));
    made.maskOnGpu = std::make_shared<const DeviceBytes>(imager.upload(made.mask));
  }
  const std::vector<MaskGroup>& groups = plan_->set().masks;
  const std::vector<double> visible = sight.visibleShares(made.mask, groups.size());
  for (std::size_t group = 0; group < groups.size(); ++group)
  {
    made.groups.push_back(groups[group].name);
    facts.groups.push_back({ std::size_t(std::count(made.mask.begin(), made.mask.end(), std::uint8_t(group + 1))),
                             patient_->groupIsThere[group], visible[group] });
  }
  const BodyView& view = body_->found->views[std::size_t(facts.image.view)];
  facts.found = view.found ? &*view.found : nullptr;
  facts.noLandmarks = body_->found->landmarks.refusal;
  facts.width = layout.width;
  facts.height = layout.height;
  facts.lateralMinMm = layout.lateralMinMm;
  facts.axialMinMm = layout.axialMinMm;
  const std::vector<ScanLine> lines = makeScanLines(input.settings.geometry, input.pose);
  facts.flags = { probeContactWarning(*body_->scene, lines).empty(),
                  shareInsideVolume(*body_->scene, input.settings.geometry, input.pose), sight.shareShadowed(lines) };
  made.info = describeImage(*plan_, *body_->scene, facts);
  return made;
}

} // namespace sono
