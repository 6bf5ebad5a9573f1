#include "DataSets/BodyRegion.h"

#include "Trace/TraceSetup.h"

#include <optional>
#include <utility>

namespace sono {

namespace {

ImageSettings deepestOf(const DataSetPlan& plan)
{
  return plan.deepest().image(plan.set().pixelMm, Device::Cpu);
}

} // namespace

void shareBodyRegion(Scene& scene, const DataSetPlan& plan, const std::vector<ProbePose>& views,
                     std::weak_ptr<const RegionOnDemand> known)
{
  constexpr double marginMm = 15.0; // for a probe that is held elsewhere on the skin
  const ImageSettings deepest = deepestOf(plan);
  const Vec3i margin(glm::ceil(marginMm / scene.placement().spacingMm));
  std::optional<VoxelBox> all;
  for (const ProbePose& view : views)
  {
    const VoxelBox box = fanBox(scene, makeScanLines(deepest.geometry, view), deepest.tracing);
    all = all ? VoxelBox{ glm::min(all->first, box.first), glm::max(all->last, box.last) } : box;
  }
  if (all)
  {
    scene.shareRegion({ all->first - margin, all->last + margin }, std::move(known));
  }
}

std::shared_ptr<const RegionOnDemand> bakeBodyRecords(const Scene& scene, const DataSetPlan& plan,
                                                      const std::vector<ProbePose>& views, const Progress& progress)
{
  constexpr double besideMm = 8.0; // images that reach further, deep ones of a probe held far away, bake the rest
  const ImageSettings deepest = deepestOf(plan);
  std::vector<ScanLine> all;
  for (const ProbePose& view : views)
  {
    const std::vector<ScanLine> lines = makeScanLines(deepest.geometry, view);
    all.insert(all.end(), lines.begin(), lines.end());
  }
  if (all.empty())
  {
    return nullptr;
  }
  const auto region = scene.regionOnDemand(fanBox(scene, all, deepest.tracing), partOf(progress, 0.0, 0.1));
  region->bakeIn(fanReach(scene, all, deepest.tracing, besideMm), partOf(progress, 0.1, 1.0));
  return region;
}

} // namespace sono
