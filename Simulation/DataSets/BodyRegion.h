#pragma once

#include "Core/Progress.h"
#include "DataSets/DataSetPlan.h"
#include "Scene/Scene.h"

#include <memory>
#include <vector>

namespace sono {

/// Images of a body share what is prepared of what its views, held and set otherwise, may reach. Whoever reaches
/// further prepares it anew, so that no image depends on others. `known`, of a scene of the same body, may have some of
/// it.
void shareBodyRegion(Scene& scene, const DataSetPlan& plan, const std::vector<ProbePose>& views,
                     std::weak_ptr<const RegionOnDemand> known = {});

/// The records of nearly all of that, for images that a GPU makes, which bakes none; null where no view is.
std::shared_ptr<const RegionOnDemand> bakeBodyRecords(const Scene& scene, const DataSetPlan& plan,
                                                      const std::vector<ProbePose>& views,
                                                      const Progress& progress = {});

} // namespace sono
