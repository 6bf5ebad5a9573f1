#pragma once

#include "Core/Progress.h"
#include "DataSets/AugmentBody.h"
#include "DataSets/DataSet.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Probe/ScanGeometry.h"
#include "Probe/StandardViews.h"
#include "Scene/Scene.h"

#include <optional>
#include <vector>

namespace sono {

/// One of a patient's views.
struct BodyView
{
  std::optional<ProbePose> pose;     ///< none: not obtainable
  std::optional<StandardView> found; ///< how it was found by landmarks; none: it was not looked for
};

/// Where the probe stands for each of a patient's views in a body of theirs, whose labels lie on `grid` before they are
/// augmented. Throws Error where none is obtainable, or a name is no standard view's; Aborted.
std::vector<BodyView> findBodyViews(const Scene& scene, const DataSetPatient& patient, const ThoraxParameters& thorax,
                                    const ProbeSettings& probe, const GridPlacement& grid,
                                    const BodyAugmentation& augmentation, const Progress& progress);

} // namespace sono
