#include "Scene/Scene.h"

#include "Core/ParallelFor.h"

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

constexpr int interactiveEdge = 512; // voxels: their words take 270 MB

std::uint64_t nextId()
{
  static std::atomic<std::uint64_t> last{ 0 };
  return ++last;
}

/// Runs `build` with the lock held. Isolated: a thread that waits in one of its loops must not meanwhile take up a task
/// of a loop around, which may ask the same scene and would lock again.
template<class Build>
auto locked(std::mutex& mutex, const Build& build)
{
  return tbb::this_task_arena::isolate([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return build();
  });
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

Scene::Scene(LabelVolume volume, const TissueTable& table, std::string outsideTissue)
  : id_(nextId())
  , volume_(std::move(volume))
{
  volume_.placement.validate("the label map");
  if (volume_.voxels.size() != volume_.placement.voxelCount())
  {
    throw Error("the label map has " + std::to_string(volume_.voxels.size()) + " voxels where its size says " +
                std::to_string(volume_.placement.voxelCount()) + ": load it again");
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

  tissueVoxels_.resize(volume_.voxels.size());
  const std::size_t slice = std::size_t(volume_.placement.size.x) * volume_.placement.size.y;
  parallelFor(volume_.placement.size.z, {}, [&](int k) {
    const std::uint16_t* from = volume_.voxels.data() + slice * k;
    std::transform(from, from + slice, tissueVoxels_.data() + slice * k,
                   [&](std::uint16_t id) { return tissueOfLabel_[id]; });
  });
  surfaces_.resize(volume_.labels.size());
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

const LabelGrid& Scene::labelGrid(const Progress& progress) const
{
  return *locked(mutex_, [&] {
    if (!labelGrid_)
    {
      labelGrid_ = std::make_unique<LabelGrid>(buildLabelGrid(volume_, progress));
    }
    return labelGrid_.get();
  });
}

const SurfaceField& Scene::surface(int labelId, const Progress& progress) const
{
  const LabelInfo* label = volume_.find(labelId);
  if (!label)
  {
    throw Error("label " + std::to_string(labelId) + " does not occur in the label map: choose one that does");
  }
  const auto index = std::size_t(label - volume_.labels.data());
  return *locked(mutex_, [&] {
    buildSurfaceAt(index, progress);
    return surfaces_[index].get();
  });
}

void Scene::buildSurfaceAt(std::size_t label, const Progress& progress) const
{
  if (boxes_.empty())
  {
    boxes_ = labelBoxes(volume_);
  }
  if (!surfaces_[label])
  {
    surfaces_[label] =
      std::make_unique<SurfaceField>(buildSurface(volume_, volume_.labels[label].id, boxes_[label], progress));
  }
}

void Scene::buildAll(const Progress& progress) const
{
  labelGrid(partOf(progress, 0.0, 0.1));
  const Progress rest = partOf(progress, 0.1, 1.0);
  locked(mutex_, [&] {
    if (!surfaces_.empty())
    {
      buildSurfaceAt(0, {}); // the boxes as well
    }
    parallelFor(int(surfaces_.size()), rest, [&](int label, const YieldPoint& yieldPoint) {
      const Progress ofLabel = [&](double) {
        yieldPoint();
        return true;
      };
      buildSurfaceAt(std::size_t(label), ofLabel);
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

VoxelBox Scene::clipped(const VoxelBox& box) const
{
  const VoxelBox inside{ glm::max(box.first, Vec3i(0)), glm::min(box.last, placement().size) };
  if (inside.empty())
  {
    throw Error("the probe's fan does not reach the label map: move the probe onto the skin or increase the depth");
  }
  return inside;
}

std::shared_ptr<const RegionOnDemand> Scene::regionOnDemand(const VoxelBox& box, const Progress& progress) const
{
  const VoxelBox wanted = clipped(box);
  return locked(mutex_, [&] {
    if (!region_ || !(region_->region().box == wanted))
    {
      const bool isThere =
        interactive_ && interactive_->region.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
      region_ = std::make_shared<RegionOnDemand>(tissueVoxels_.data(), placement().size, placement().spacingMm, wanted,
                                                 progress, isThere ? interactive_->region.get() : nullptr);
    }
    return region_;
  });
}

std::shared_ptr<const RegionOnDemand> Scene::interactiveRegion(const VoxelBox& box, const Progress& progress) const
{
  const auto making = makingInteractive(box, false);
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
  makingInteractive(box, allRecords);
}

std::shared_ptr<const Scene::Making> Scene::makingInteractive(const VoxelBox& box, bool allRecords) const
{
  const VoxelBox inside = clipped(box);
  const VoxelBox wanted = clipped({ inside.first / interactiveEdge * interactiveEdge,
                                    (inside.last + (interactiveEdge - 1)) / interactiveEdge * interactiveEdge });
  std::shared_ptr<const Making> before; // goes after the lock, since its end is waited for
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!interactive_ || !(interactive_->box == wanted))
  {
    before = std::exchange(interactive_, std::make_shared<Making>(*this, wanted, allRecords));
  }
  return interactive_;
}

} // namespace sono
