#include "Probe/ViewStructures.h"

#include "Core/ParallelFor.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sono {
namespace {

constexpr double sectionStepMm = 1.5;
constexpr double sectionReachMm = 130.0;

} // namespace

ViewStructures::ViewStructures(const Scene& scene, const ViewPlan& plan)
  : scene_(scene)
  , demandOfLabel_(65536, -1)
  , voxels_(scene.volume().voxels.data())
  , perVoxelMm_(1.0 / scene.placement().spacingMm)
  , pitchY_(scene.placement().size.x)
  , pitchZ_(pitchY_ * scene.placement().size.y)
{
  for (std::size_t i = 0; i < plan.demands.size(); ++i)
  {
    const ViewDemand& demand = plan.demands[i];
    for (const int id : demand.labels)
    {
      demandOfLabel_[std::size_t(id)] = int(i);
    }
    nearLocal_.push_back(scene.localFromWorld(demand.nearMm));
    withinMm2_.push_back(demand.withinMm * demand.withinMm);
  }
  findBox();
}

void ViewStructures::findBox()
{
  const Vec3i n = scene_.placement().size;
  struct Box
  {
    Vec3i low{ std::numeric_limits<int>::max() };
    Vec3i high{ -1 };
  };
  std::vector<Box> ofLayer(std::size_t(n.z));
  parallelFor(n.z, {}, [&](int k) {
    Box& box = ofLayer[std::size_t(k)];
    for (int j = 0; j < n.y; ++j)
    {
      const std::uint16_t* row = scene_.volume().voxels.data() + (std::size_t(k) * n.y + j) * n.x;
      for (int i = 0; i < n.x; ++i)
      {
        if (demandOfLabel_[row[i]] >= 0)
        {
          box.low = glm::min(box.low, Vec3i(i, j, k));
          box.high = glm::max(box.high, Vec3i(i, j, k));
        }
      }
    }
  });
  Box all;
  for (const Box& box : ofLayer)
  {
    all.low = glm::min(all.low, box.low);
    all.high = glm::max(all.high, box.high);
  }
  const bool isEmpty = all.high.x < 0;
  boxLowMm_ = isEmpty ? Vec3d(0.0) : scene_.placement().spacingMm * Vec3d(all.low);
  // A little less, lest rounding lead beyond the volume.
  boxHighMm_ = isEmpty ? Vec3d(0.0) : (1.0 - 1e-12) * scene_.placement().spacingMm * Vec3d(all.high + 1);
}

IdealSection idealSection(const Scene& scene, const ViewPlan& plan, const ViewStructures& structures)
{
  const Vec3d middle = scene.localFromWorld(plan.middleMm);
  const Vec3d normal = scene.rotationToLocal() * plan.normal;
  const Vec3d u = glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.8 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
  const Vec3d v = glm::cross(normal, u);
  IdealSection section{ std::vector<double>(structures.count(), 0.0) };
  std::vector<Vec3d> sums(structures.count(), Vec3d(0.0));
  const int steps = int(sectionReachMm / sectionStepMm);
  for (int j = -steps; j <= steps; ++j)
  {
    for (int i = -steps; i <= steps; ++i)
    {
      const Vec3d at = middle + sectionStepMm * (double(i) * u + double(j) * v);
      const int demand = structures.at(at);
      if (demand >= 0)
      {
        section.areaMm2[std::size_t(demand)] += sectionStepMm * sectionStepMm;
        sums[std::size_t(demand)] += sectionStepMm * sectionStepMm * at;
      }
    }
  }
  double pull = 0.0;
  for (std::size_t i = 0; i < structures.count(); ++i)
  {
    section.middle += plan.demands[i].pull * sums[i] / std::max(1e-9, section.areaMm2[i]);
    pull += plan.demands[i].pull;
  }
  section.middle /= std::max(1e-9, pull);
  return section;
}

} // namespace sono
