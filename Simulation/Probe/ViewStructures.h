#pragma once

#include "Probe/ViewPlans.h"
#include "Scene/Scene.h"

#include <cstddef>
#include <vector>

namespace sono {

/// Which of the structures that a view has to show a place belongs to. Places are local (Scene.h).
class ViewStructures
{
public:
  ViewStructures(const Scene& scene, const ViewPlan& plan);

  std::size_t count() const { return withinMm_.size(); }
  int at(const Vec3d& local) const; ///< by its number among the plan's demands; -1: none

private:
  void findBox();

  const Scene& scene_;
  std::vector<int> demandOfLabel_;
  Vec3d boxLowMm_{ 0.0 }; ///< around all of them, local; the empty one where there is none
  Vec3d boxHighMm_{ 0.0 };
  std::vector<Vec3d> nearLocal_;
  std::vector<double> withinMm_;
};

/// What of these lies in a view's ideal plane.
struct IdealSection
{
  std::vector<double> areaMm2; ///< by demand
  Vec3d middle{ 0.0 };         ///< of the demands' middles, by their pull, local
};

IdealSection idealSection(const Scene& scene, const ViewPlan& plan, const ViewStructures& structures);

} // namespace sono
