#pragma once

#include "Probe/ViewPlans.h"
#include "Scene/Scene.h"

#include <glm/vector_relational.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sono {

/// Which of the structures that a view has to show a place belongs to. Places are local (Scene.h).
class ViewStructures
{
public:
  ViewStructures(const Scene& scene, const ViewPlan& plan);

  const Vec3d& boxLowMm() const { return boxLowMm_; } ///< of a box that holds them, local
  const Vec3d& boxHighMm() const { return boxHighMm_; }
  std::size_t count() const { return withinMm2_.size(); }
  /// By its number among the plan's demands; -1: none.
  int at(const Vec3d& local) const
  {
    if (glm::any(glm::lessThan(local, boxLowMm_)) || glm::any(glm::greaterThanEqual(local, boxHighMm_)))
    {
      return -1; // most of a body
    }
    const Vec3i v(local * perVoxelMm_);
    const int demand = demandOfLabel_[voxels_[v.x + pitchY_ * v.y + pitchZ_ * v.z]];
    if (demand < 0)
    {
      return -1;
    }
    const Vec3d from = local - nearLocal_[std::size_t(demand)];
    return glm::dot(from, from) < withinMm2_[std::size_t(demand)] ? demand : -1;
  }

private:
  void findBox();

  const Scene& scene_;
  std::vector<int> demandOfLabel_;
  Vec3d boxLowMm_{ 0.0 }; ///< around all of them, local, in the volume; the empty one where there is none
  Vec3d boxHighMm_{ 0.0 };
  std::vector<Vec3d> nearLocal_;
  std::vector<double> withinMm2_;
  const std::uint16_t* voxels_;
  Vec3d perVoxelMm_;
  std::ptrdiff_t pitchY_, pitchZ_;
};

/// What of these lies in a view's ideal plane.
struct IdealSection
{
  std::vector<double> areaMm2; ///< by demand
  Vec3d middle{ 0.0 };         ///< of the demands' middles, by their pull, local
};

IdealSection idealSection(const Scene& scene, const ViewPlan& plan, const ViewStructures& structures);

} // namespace sono
