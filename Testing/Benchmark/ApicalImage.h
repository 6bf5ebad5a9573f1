#pragma once

#include "ImageSettings.h"
#include "Scene/Scene.h"

#include <vector>

namespace sono {

/// A4C of the bundled thorax with the P4-2.
ImageSettings a4cWith(InterfaceModel model);
std::vector<ScanLine> a4cLines(const ImageSettings& settings);

/// What its image takes on the CPU, s.
struct ImageSeconds
{
  double trace;
  double echo;
  double image; ///< both, envelope, grey levels and scan conversion
};

/// Of an image after another of the same kind: the scene keeps one region, and who follows another fan pays for it.
ImageSeconds warmImageSeconds(const Scene& scene, const ImageSettings& work);

} // namespace sono
