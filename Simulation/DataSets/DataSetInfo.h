#pragma once

#include "DataSets/DataSetPlan.h"
#include "Scene/Scene.h"
#include "Trace/Trace.h"

#include <string>
#include <vector>

namespace sono {

/// What a program can ask of an image without looking at it.
struct DataSetFlags
{
  bool faceOnSkin = false;
  double shareInsideVolume = 0.0; ///< of the image's area, see shareInsideVolume
  double shareShadowed = 0.0;     ///< see shareShadowed
};

/// Share of the scanned area where what arrives would echo at less than -20 dB of what a soft tissue of 0.5 dB/(cm MHz)
/// lets through to there: bone, lung and gas lie in front, or no contact.
double shareShadowed(const std::vector<ScanLine>& lines, const ImageSettings& settings, const TracedLines& traced);

/// What is to be said of an image.
struct DataSetFacts
{
  PlannedImage image;
  DataSetSettings settings;
  bool onGpu = false;
  ProbePose pose;
  PoseJitter jitter;
  DataSetFlags flags;
  std::vector<std::size_t> groupPixels; ///< of each mask group
  std::vector<bool> groupIsThere;       ///< whether the patient has a label of it
  int width = 0;
  int height = 0;
  double lateralMinMm = 0.0;
  double axialMinMm = 0.0;
};

/// As JSON, the same text for the same facts.
std::string describeImage(const DataSetPlan& plan, const Scene& scene, const DataSetFacts& facts);

} // namespace sono
