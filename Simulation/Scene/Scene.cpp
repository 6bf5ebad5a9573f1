#include "Scene/Scene.h"

#include "Core/LargeMemory.h"
#include "Core/ParallelFor.h"
#include "Core/Policy.h"
#include "Core/WhenIdle.h"
#include "Kernel/DetailCode.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <map>
#include <new>
#include <utility>

namespace sono {

namespace {

std::uint64_t nextId()
{
  static std::atomic<std::uint64_t> last{ 0 };
  return ++last;
}

/// Whether this thread runs an observer of a scene's progress, or works for one.
thread_local bool isObserving = false;

/// Sets that for a while.
class Observing
{
public:
  explicit Observing(bool observes)
    : before_(std::exchange(isObserving, observes))
  {
  }
  ~Observing() { isObserving = before_; }
  Observing(const Observing&) = delete;
  Observing& operator=(const Observing&) = delete;

private:
  bool before_;
};

Progress observed(const Progress& progress)
{
  return progress ? Progress([progress](double fraction) {
    const Observing observing(true);
    return progress(fraction);
  })
                  : Progress{};
}

} // namespace

/// A region that is made in the background. Who waits for it holds it; when nobody holds it any more it stops.
struct Scene::Making
{
  Making(const Scene& scene, const VoxelBox& wanted, bool allRecords)
    : box(wanted)
    , region(std::async(std::launch::async,
                        [=, &scene, known = std::weak_ptr(scene.region_)] { return make(scene, allRecords, known); }))
  {
  }
  ~Making() { unwanted = true; }

  SharedRegion make(const Scene& scene, bool allRecords, const std::weak_ptr<const RegionOnDemand>& known)
  {
    const Progress progress = [this](double fraction) {
      done = fraction;
      return !unwanted;
    };
    try
    {
      const auto made = std::make_shared<RegionOnDemand>(scene.tissueVoxels().data(), scene.placement().size,
                                                         scene.placement().spacingMm, box,
                                                         partOf(progress, 0.0, allRecords ? 0.25 : 1.0), known);
      if (allRecords)
      {
        made->bakeAll(partOf(progress, 0.25, 1.0));
      }
      return made;
    }
    catch (const std::bad_alloc&)
    {
      return nullptr;
    }
  }

  VoxelBox box;
  std::atomic<double> done{ 0.0 };
  std::atomic<bool> unwanted{ false };
  std::shared_future<SharedRegion> region; ///< null where memory ran out; its end is waited for
};

/// What a moving probe will ask for, made in the background while the probe rests: the records of its first paths,
/// which are those that the resting one's have met, and beside them; and the pieces of surfaces around. Ends when it is
/// dropped.
struct Scene::Foreseeing
{
  Foreseeing(std::shared_ptr<const Making> making, SharedRegion met, const SurfacePieces& pieces)
    : done(std::async(std::launch::async, [this, making = std::move(making), met = std::move(met), &pieces] {
      while (making->region.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready)
      {
        if (unwanted)
        {
          return;
        }
      }
      if (const SharedRegion region = making->region.get())
      {
        region->bakeBeside(*met, [this] { return !unwanted; });
        const VoxelBox near = met->region().box;
        const Vec3i around(glm::ceil(foreseenMm / pieces.spacingMm()));
        runWhenIdle();
        pieces.fitCoarse(
          { glm::max(near.first - around, making->box.first), glm::min(near.last + around, making->box.last) },
          [this](double) { return !unwanted; });
      }
    }))
  {
  }
  ~Foreseeing() { unwanted = true; }

  std::atomic<bool> unwanted{ false };
  std::future<void> done; ///< its end is waited for
};

Scene::Scene(LabelVolume volume, const TissueTable& table, std::string outsideTissue, std::vector<std::uint8_t> detail,
             std::shared_ptr<const TissueMotion> motion)
  : id_(nextId())
  , anatomyId_(id_)
  , volume_(std::move(volume))
  , detail_(std::move(detail))
  , motion_(std::move(motion))
{
  for (std::size_t code = 0; code < detailFactors_.size(); ++code)
  {
    detailFactors_[code] = detailFactor(std::uint8_t(code));
  }
  volume_.placement.validate("the label map");
  if (volume_.voxels.size() != volume_.placement.voxelCount())
  {
    throw Error("the label map has " + std::to_string(volume_.voxels.size()) + " voxels where its size says " +
                std::to_string(volume_.placement.voxelCount()) + ": load it again");
  }
  if (!detail_.empty() && detail_.size() != volume_.voxels.size())
  {
    throw Error("the scan's detail has " + std::to_string(detail_.size()) + " voxels where the label map has " +
                std::to_string(volume_.voxels.size()) + ": make it for this label map");
  }
  std::map<std::string, int> indexOf;
  tissueOfLabel_.assign(65536, 0);
  for (const LabelInfo& label : volume_.labels)
  {
    const Tissue* tissue = table.find(label.tissue);
    if (!tissue)
    {
      throw Error("label " + std::to_string(label.id) + " ('" + label.name + "') has the tissue '" + label.tissue +
                  "', which the tissue table does not hold: add it there or map the label to another");
    }
    const auto [entry, isNew] = indexOf.emplace(tissue->name, int(tissues_.size()));
    if (isNew)
    {
      tissues_.push_back(*tissue);
    }
    if (tissues_.size() > 255)
    {
      throw Error("the label map uses more than 255 different tissues: map some labels to the same tissue");
    }
    tissueOfLabel_[std::size_t(label.id)] = std::uint8_t(entry->second);
  }
  const auto outside = indexOf.find(outsideTissue);
  outsideIndex_ = outside == indexOf.end() ? -1 : outside->second;

  tissueVoxels_ = largeVector<std::uint8_t>(volume_.voxels.size());
  const std::size_t slice = std::size_t(volume_.placement.size.x) * volume_.placement.size.y;
  parallelFor(volume_.placement.size.z, {}, [&](int k) {
    const std::uint16_t* from = volume_.voxels.data() + slice * k;
    std::transform(from, from + slice, tissueVoxels_.data() + slice * k,
                   [&](std::uint16_t id) { return tissueOfLabel_[id]; });
  });
  surfaces_.resize(volume_.labels.size());
  if (motion_)
  {
    stillDetail_ = detail_;
    stillDetail_.resize(volume_.voxels.size(), std::uint8_t(detailNone));
    parallelFor(volume_.placement.size.z, {}, [&](int k) {
      for (std::size_t v = slice * std::size_t(k); v < slice * std::size_t(k + 1); ++v)
      {
        if (motion_->moves(volume_.voxels[v]))
        {
          stillDetail_[v] = std::uint8_t(detailSilent);
        }
      }
    });
  }
  stillCodes_ = stillDetail().empty() ? nullptr : stillDetail().data();
}

Scene::~Scene() = default;

Vec3d Scene::localFromWorld(const Vec3d& world) const
{
  return (placement().indexFromWorld(world) + 0.5) * placement().spacingMm;
}

Vec3d Scene::worldFromLocal(const Vec3d& local) const
{
  return placement().worldFromIndex(local / placement().spacingMm - 0.5);
}

Mat3d Scene::rotationToLocal() const
{
  return glm::transpose(placement().direction);
}

/// What `find` gives, with the lock held, when it gives something; else `make` makes it, without the lock, and `keep`
/// puts it where `find` looks. While one makes a thing others wait for it. Not so an observer of progress, whom the
/// thing may be waiting for: that one makes it again, and what is there first is kept.
template<class Find, class Make, class Keep>
auto Scene::findOrMake(const void* thing, const Find& find, const Make& make, const Keep& keep) const
{
  std::unique_lock<std::mutex> lock(mutex_);
  made_.wait(lock, [&] { return isObserving || find() || making_.count(thing) == 0; });
  if (auto found = find())
  {
    return found;
  }
  const bool isFirst = making_.insert(thing).second;
  lock.unlock();
  const auto finish = [&] {
    lock.lock();
    if (isFirst)
    {
      making_.erase(thing);
    }
    made_.notify_all();
  };
  try
  {
    // Isolated: a thread that waits in one of its loops must not meanwhile take up a task of a loop around, which may
    // ask for the same thing and would wait for this very thread.
    auto made = tbb::this_task_arena::isolate(make);
    finish();
    if (!find())
    {
      keep(std::move(made));
    }
  }
  catch (...)
  {
    if (!lock.owns_lock())
    {
      finish();
    }
    throw;
  }
  return find();
}

const LabelGrid& Scene::labelGrid(const Progress& progress) const
{
  return *findOrMake(
    &labelGrid_, [&] { return labelGrid_.get(); },
    [&] { return std::make_unique<LabelGrid>(buildLabelGrid(volume_, observed(progress))); },
    [&](std::unique_ptr<LabelGrid> made) { labelGrid_ = std::move(made); });
}

const SurfaceField& Scene::surface(int labelId, const Progress& progress) const
{
  const LabelInfo* label = volume_.find(labelId);
  if (!label)
  {
    throw Error("label " + std::to_string(labelId) + " does not occur in the label map: choose one that does");
  }
  return surfaceAt(std::size_t(label - volume_.labels.data()), progress);
}

const std::vector<VoxelBox>& Scene::boxes() const
{
  using Boxes = std::vector<VoxelBox>;
  return *findOrMake(
    &boxes_, [&] { return boxes_.get(); }, [&] { return std::make_unique<Boxes>(labelBoxes(volume_)); },
    [&](std::unique_ptr<Boxes> made) { boxes_ = std::move(made); });
}

const SurfaceField& Scene::surfaceAt(std::size_t label, const Progress& progress) const
{
  const VoxelBox& box = boxes()[label];
  std::unique_ptr<SurfaceField>& surface = surfaces_[label];
  return *findOrMake(
    &surface, [&] { return surface.get(); },
    [&] {
      return std::make_unique<SurfaceField>(buildSurface(volume_, volume_.labels[label].id, box, observed(progress)));
    },
    [&](std::unique_ptr<SurfaceField> made) { surface = std::move(made); });
}

const SurfacePieces& Scene::surfacePieces() const
{
  return *findOrMake(
    &pieces_, [&] { return pieces_.get(); },
    [&] { return std::make_unique<SurfacePieces>(tissueVoxels_.data(), placement().size, placement().spacingMm); },
    [&](std::unique_ptr<SurfacePieces> made) { pieces_ = std::move(made); });
}

void Scene::buildAll(const Progress& progress) const
{
  labelGrid(partOf(progress, 0.0, 0.1));
  boxes(); // once, by all cores
  const Progress rest = observed(partOf(progress, 0.1, 1.0));
  tbb::this_task_arena::isolate([&, forObserver = isObserving] {
    parallelFor(int(surfaces_.size()), rest, [&](int label, const YieldPoint& yieldPoint) {
      const Observing observing(forObserver);
      const Progress ofLabel = [&](double) {
        yieldPoint();
        return true;
      };
      surfaceAt(std::size_t(label), ofLabel);
    });
  });
}

void Scene::adopt(LabelGrid labels, std::vector<SurfaceField> surfaces)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  labelGrid_ = std::make_unique<LabelGrid>(std::move(labels));
  for (SurfaceField& surface : surfaces)
  {
    if (const LabelInfo* label = volume_.find(surface.labelId))
    {
      surfaces_[std::size_t(label - volume_.labels.data())] = std::make_unique<SurfaceField>(std::move(surface));
    }
  }
}

void Scene::setTissues(const TissueTable& table)
{
  std::vector<Tissue> tissues;
  bool sameFibres = true;
  for (const Tissue& before : tissues_)
  {
    const Tissue* tissue = table.find(before.name);
    if (!tissue)
    {
      throw Error("the tissue table does not hold '" + before.name + "', which the label map uses: add it there");
    }
    sameFibres = sameFibres && (tissue->fibreAnisotropyDb > 0.0) == (before.fibreAnisotropyDb > 0.0);
    tissues.push_back(*tissue);
  }
  tissues_ = std::move(tissues);
  id_ = nextId();
  if (!sameFibres)
  {
    fibres_ = nullptr;
    anatomyId_ = id_;
  }
}

const FibreField* Scene::fibres() const
{
  std::vector<bool> isMuscle(256, false);
  std::vector<bool> isBlood(256, false);
  for (std::size_t t = 0; t < tissues_.size(); ++t)
  {
    isMuscle[t] = tissues_[t].fibreAnisotropyDb > 0.0;
    isBlood[t] = tissues_[t].name == "blood";
  }
  if (std::find(isMuscle.begin(), isMuscle.end(), true) == isMuscle.end())
  {
    return nullptr;
  }
  return findOrMake(
    &fibres_, [&] { return fibres_.get(); },
    [&] { return std::make_unique<FibreField>(buildFibreField(volume_, tissueVoxels_, isMuscle, isBlood)); },
    [&](std::unique_ptr<FibreField> made) { fibres_ = std::move(made); });
}

VoxelBox Scene::clipped(const VoxelBox& box) const
{
  const VoxelBox inside{ glm::max(box.first, Vec3i(0)), glm::min(box.last, placement().size) };
  if (inside.empty())
  {
    throw Error("the probe's fan does not reach the label map: move the probe onto the skin or increase the depth");
  }
  return inside;
}

void Scene::shareRegion(const VoxelBox& box, std::weak_ptr<const RegionOnDemand> known)
{
  sharedBox_ = clipped(box);
  known_ = std::move(known);
}

bool Scene::sharesRegion(const VoxelBox& box) const
{
  return glm::all(glm::lessThanEqual(sharedBox_.first, box.first)) &&
         glm::all(glm::lessThanEqual(box.last, sharedBox_.last));
}

std::shared_ptr<const RegionOnDemand> Scene::regionOnDemand(const VoxelBox& box, const Progress& progress) const
{
  const VoxelBox inside = clipped(box);
  const VoxelBox wanted = sharesRegion(inside) ? sharedBox_ : inside;
  return findOrMake(
    &region_, [&] { return region_ && region_->region().box == wanted ? region_ : nullptr; },
    [&]() -> SharedRegion {
      return std::make_shared<RegionOnDemand>(tissueVoxels_.data(), placement().size, placement().spacingMm, wanted,
                                              observed(progress), known_.expired() ? finishedInteractive() : known_);
    },
    [&](SharedRegion made) { region_ = std::move(made); });
}

Scene::SharedRegion Scene::finishedInteractive() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool isThere =
    interactive_ && interactive_->region.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  return isThere ? interactive_->region.get() : nullptr;
}

std::shared_ptr<const RegionOnDemand> Scene::interactiveRegion(const VoxelBox& box, const Progress& progress) const
{
  const auto making = makingInteractive(box, false);
  foresee(nullptr); // all cores for what is asked for
  while (making->region.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready)
  {
    report(progress, making->done);
  }
  if (!making->region.get())
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (interactive_ == making)
    {
      interactive_ = nullptr; // there may be more memory next time
    }
    throw std::bad_alloc();
  }
  return making->region.get();
}

void Scene::beginInteractiveRegion(const VoxelBox& box, bool allRecords) const
{
  const auto making = makingInteractive(box, allRecords);
  if (!allRecords)
  {
    foresee(making);
  }
}

/// From now on with what the last region has baked, or, for null, no longer.
void Scene::foresee(std::shared_ptr<const Making> making) const
{
  const SurfacePieces* pieces = making ? &surfacePieces() : nullptr; // before the lock, which it takes
  std::unique_ptr<Foreseeing> before;                                // ends after the lock
  const std::lock_guard<std::mutex> lock(mutex_);
  before = std::exchange(
    foreseeing_, making && region_ ? std::make_unique<Foreseeing>(std::move(making), region_, *pieces) : nullptr);
}

bool Scene::hasInteractiveRegion() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return interactive_ != nullptr;
}

std::shared_ptr<const Scene::Making> Scene::makingInteractive(const VoxelBox& box, bool allRecords) const
{
  const VoxelBox inside = clipped(box);
  const VoxelBox wanted =
    clipped({ inside.first / interactiveEdgeVoxels * interactiveEdgeVoxels,
              (inside.last + (interactiveEdgeVoxels - 1)) / interactiveEdgeVoxels * interactiveEdgeVoxels });
  std::shared_ptr<const Making> before; // goes after the lock, since its end is waited for
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!interactive_ || !(interactive_->box == wanted))
  {
    before = std::exchange(interactive_, std::make_shared<Making>(*this, wanted, allRecords));
  }
  return interactive_;
}

} // namespace sono
