#include "DataSets/AugmentBody.h"

#include "DataSets/DataSet.h"
#include "Labels/AddFat.h"

#include <utility>

namespace sono {

namespace {

const Vec3d mirror(-1.0, 1.0, 1.0);

/// The linear map that stretches a grid along its own axes.
Mat3d stretchMap(const GridPlacement& grid, const Vec3d& stretch)
{
  Mat3d scaled = grid.direction;
  for (int axis = 0; axis < 3; ++axis)
  {
    scaled[axis] *= stretch[axis];
  }
  return scaled * glm::transpose(grid.direction);
}

SmoothWarp warpOf(const BodyAugmentation& augmentation)
{
  return { augmentation.warpAmplitudeMm, augmentation.warpWavelengthMm, augmentation.warpSeed };
}

} // namespace

LabelVolume augmented(LabelVolume volume, const BodyAugmentation& augmentation)
{
  GridPlacement& grid = volume.placement;
  grid.originMm = stretchMap(grid, augmentation.stretch) * grid.originMm;
  grid.spacingMm *= augmentation.stretch;
  addFat(volume, augmentation.extraFatMm, couplingTissue);
  if (augmentation.warpAmplitudeMm > 0.0)
  {
    volume = warped(volume, warpOf(augmentation));
  }
  if (augmentation.isMirrored)
  {
    volume.placement.originMm *= mirror;
    for (int axis = 0; axis < 3; ++axis)
    {
      volume.placement.direction[axis] *= mirror;
    }
  }
  return volume;
}

ProbePose augmented(const ProbePose& pose, const GridPlacement& grid, const BodyAugmentation& augmentation)
{
  const Mat3d stretch = stretchMap(grid, augmentation.stretch);
  ProbePose moved{ stretch * pose.positionMm, stretch * pose.axial, stretch * pose.lateral };
  if (augmentation.warpAmplitudeMm > 0.0)
  {
    const SmoothWarp warp = warpOf(augmentation);
    moved.positionMm = warp.placeMm(moved.positionMm);
    const Mat3d slope = glm::inverse(warp.originalSlope(moved.positionMm));
    moved.axial = slope * moved.axial;
    moved.lateral = slope * moved.lateral;
  }
  if (augmentation.isMirrored)
  {
    moved.positionMm *= mirror;
    moved.axial *= mirror;
    moved.lateral *= -mirror;
  }
  return moved.orthonormalized();
}

} // namespace sono
