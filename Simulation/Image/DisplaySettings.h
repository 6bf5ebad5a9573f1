#pragma once

#include "Core/Parameters.h"

namespace sono {

/// What a scanner does to finished images (Data/docs/physics.md section 6.1). All is off by default.
struct DisplaySettings
{
  double persistence = 0.0;
  int speckleReduction = 0;
  double speckleThreshold = 40.0;

  template<class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor(self.persistence,
            Parameter{ "persistence", "Persistence", between(0, 0.98),
                       "Share of the images of the time steps before in what is shown, 0 to 0.98, no unit. 0: none. It "
                       "begins anew where probe or settings change, and acts only where time goes on." });
    visitor(self.speckleReduction,
            Parameter{ "speckleReduction", "Speckle Reduction", between(0, 100),
                       "Iterations of the anisotropic diffusion that evens out speckle and spares edges, 0 to 100, no "
                       "unit. 0: none." });
    visitor(
      self.speckleThreshold,
      Parameter{ "speckleThreshold", "Speckle Threshold", aboveUpTo(0, 255),
                 "Step between neighbouring pixels from which on it is an edge, in grey levels (no unit), above 0 "
                 "up to 255." });
  }
};

} // namespace sono
