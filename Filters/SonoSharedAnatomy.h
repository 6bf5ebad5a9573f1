#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

class vtkDataArray;
class vtkImageData;
class vtkMultiBlockDataSet;

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

/// The scene that another filter of this process holds, or that was kept of a phase (SonoPlayed.h), built of the same
/// voxels and fields of an image by the same settings (vtkSonoSceneBuilder::SettingsKey), if there is one: a window is
/// looked for, and a picture made, in one scene, and a heart that is played again has its phases.
std::optional<SharedAnatomy> findAnatomy(vtkImageData* image, vtkDataArray* labels, const std::string& settings);
/// Lets others find it as long as somebody holds the scene; that of a phase is kept for `owner`.
void shareAnatomy(vtkImageData* image, vtkDataArray* labels, const std::string& settings, const SharedAnatomy& anatomy,
                  const void* owner);

/// The blocks that were made of a scene, if it is a phase's and they are kept; false: they are to be made.
bool takePlayedBlocks(const Scene& scene, bool surfaces, vtkMultiBlockDataSet* blocks);
void keepPlayedBlocks(vtkImageData* image, const Scene& scene, bool surfaces, vtkMultiBlockDataSet* blocks,
                      const void* owner);

} // namespace sono
