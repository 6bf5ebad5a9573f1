#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

class vtkDataArray;
class vtkImageData;

namespace sono {

class Scene;
class TissueTable;

/// A scene, what it was built with, and what there was to say of it.
struct SharedAnatomy
{
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const TissueTable> tissues;
  std::vector<std::string> warnings;
};

/// The scene that another filter of this process holds, built of the same arrays of an image by the same settings
/// (vtkSonoSceneBuilder::SettingsKey), if there is one: a window is looked for, and a picture made, in one scene.
std::optional<SharedAnatomy> findAnatomy(vtkImageData* image, vtkDataArray* labels, const std::string& settings);
/// Lets others find it as long as somebody holds the scene.
void shareAnatomy(vtkImageData* image, vtkDataArray* labels, const std::string& settings, const SharedAnatomy& anatomy);

} // namespace sono
