#pragma once

#include "DataSets/DataSetPlan.h"
#include "DataSets/ImageLandmarks.h"
#include "Probe/StandardViews.h"
#include "Scene/Scene.h"

#include <string>
#include <vector>

namespace sono {

/// What a program can ask of an image without looking at it.
struct DataSetFlags
{
  bool faceOnSkin = false;
  double shareInsideVolume = 0.0; ///< of the image's area, see shareInsideVolume
  double shareShadowed = 0.0;     ///< see ImageSight
};

/// What an image has of a mask group.
struct GroupFacts
{
  std::size_t pixels = 0;
  bool isThere = false;      ///< whether the patient has a label of it
  double visibleShare = 0.0; ///< of these pixels, see ImageSight
};

/// What is to be said of an image.
struct DataSetFacts
{
  PlannedImage image;
  DataSetSettings settings;
  bool onGpu = false;
  ProbePose pose;
  PoseJitter jitter; ///< less pressMm than was drawn where a rib is in the way
  DataSetFlags flags;
  const StandardView* found = nullptr; ///< of a view that was looked for by landmarks; null: it was not
  std::vector<ImageLandmark> landmarks;
  std::string noLandmarks;        ///< why there are none; empty: there are
  std::vector<GroupFacts> groups; ///< of each mask group
  int width = 0;
  int height = 0;
  double lateralMinMm = 0.0;
  double axialMinMm = 0.0;
};

/// As JSON, the same text for the same facts.
std::string describeImage(const DataSetPlan& plan, const Scene& scene, const DataSetFacts& facts);

} // namespace sono
