#pragma once

#include "Labels/LabelVolume.h"
#include "Labels/SmoothWarp.h"
#include "Probe/ScanGeometry.h"

#include <cstdint>

namespace sono {

/// How a body differs from the label map that it is made of, whatever that shows. In this order:
struct BodyAugmentation
{
  Vec3d stretch{ 1.0 };          ///< along the grid's axes, about the world's origin
  double extraFatMm = 0.0;       ///< see addFat
  double warpAmplitudeMm = 0.0;  ///< see SmoothWarp
  double warpWavelengthMm = 1.0; ///< the same
  std::uint64_t warpSeed = 0;    ///< the same
  bool isMirrored = false;       ///< at the world's plane x = 0, left for right; labels keep their names
};

/// The body, of a volume whose labels have their tissues (prepareBody). Throws Error as addFat and SmoothWarp do.
LabelVolume augmented(LabelVolume volume, const BodyAugmentation& augmentation);

/// Where the augmentation brings a probe that is held on the label map, whose grid is `grid`; with more fat it is still
/// to be put onto the skin (poseOnSkin). On a mirrored body the probe is turned round by 180 degrees: so its pictures
/// are the mirror images of those of the body itself, and not the same again.
ProbePose augmented(const ProbePose& pose, const GridPlacement& grid, const BodyAugmentation& augmentation);

} // namespace sono
