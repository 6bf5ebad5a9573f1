#pragma once

#include "Kernel/PlaneScan.h"
#include "Probe/ScanGeometry.h"

namespace sono {

/// Where an image in the probe's plane shows a place of the anatomy.
struct ShownPlace
{
  double lateralMm = 0.0; ///< as PlaneImage has its pixels
  double axialMm = 0.0;
  double offPlaneMm = 0.0; ///< of the place itself, towards axial x lateral
  bool inSector = false;   ///< whether the lines cover what is shown there
};

/// Of a place, world LPS mm, projected onto the plane: sliceLabels the other way round. On the line through it it is
/// shown as deep as the depth offsets say, lines x bins in mm on the samples of `scan` (see offsetScan); null: as deep
/// as it lies, but for the scale of what is shown. `pose` must be orthonormal.
ShownPlace shownPlace(const PlaneScan& scan, const float* offsetMm, const ProbePose& pose, const Vec3d& worldMm);

} // namespace sono
