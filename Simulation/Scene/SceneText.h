#pragma once

#include "Scene/Scene.h"

#include <string>
#include <vector>

namespace sono {

/// What a scene file says about a scene beside its grids.
struct SceneText
{
  GridPlacement placement;
  std::vector<LabelInfo> labels;
  std::vector<VoxelBox> boxes; ///< parallel to `labels`
  TissueTable tissues;
  std::string outsideTissue;
  double bandMm = 0.0;      ///< of all surfaces
  double smoothingMm = 0.0; ///< of all surfaces
};

/// As JSON. The scene must have built its surfaces.
std::string sceneText(const Scene& scene);

/// Throws Error naming the file for a newer format, and for a text that is none of ours.
SceneText parseSceneText(const std::string& path, const std::string& text);

} // namespace sono
