#pragma once

#include "Scene/Scene.h"

#include <memory>

namespace sono {

/// The bundled thorax with the repository's tissues. Throws Error when a label has no tissue of its own, since a
/// fallback would change what is measured.
std::unique_ptr<Scene> makePhantomScene(LabelVolume volume);

} // namespace sono
