#pragma once

#include "DataSets/ImageSight.h"
#include "Probe/HeartLandmarks.h"

#include <optional>
#include <string>
#include <vector>

namespace sono {

/// A landmark of a heart where an image shows it.
struct ImageLandmark
{
  std::string name;            ///< "apex", "mitralAnnulus", "tricuspidAnnulus", "aorticAnnulus"
  ImagePoint point;            ///< of an annulus its centre
  std::optional<Annulus> ring; ///< the annulus
  /// Where the annulus crosses the image's plane: two points, the one with the lesser column first, or none where it
  /// does not, or lies in the plane.
  std::vector<ImagePoint> hinges;
};

/// Those that the body has.
std::vector<ImageLandmark> landmarksInImage(const HeartLandmarks& heart, const ProbePose& pose,
                                            const ImageSight& sight);

/// Where a circle crosses the plane of a pose, world LPS mm: two places, or none.
std::vector<Vec3d> crossings(const Annulus& ring, const ProbePose& pose);

} // namespace sono
