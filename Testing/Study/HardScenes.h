#pragma once

#include "BenchScenes.h"

#include <functional>
#include <string>
#include <vector>

namespace sono::study {

/// A way to make things hard, by the hazard that Data/docs/physics.md section 8 names.
struct HardScene
{
  std::string hazard;
  std::string name;
  std::function<BenchScene()> make; ///< throws Error where the scene is to be refused
};

/// The bench scenes by several settings, and a plain box, whose hazard is "none"; then every hazard.
const std::vector<HardScene>& hardScenes();

} // namespace sono::study
