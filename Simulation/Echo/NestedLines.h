#pragma once

#include "Core/Progress.h"
#include "Echo/BeamSplat.h"
#include "Echo/BrickWalk.h"
#include "Echo/EchoSetup.h"

#include <vector>

namespace sono {

/// Adds what the setup's nested scatterers echo to the sums of a group of lines, parallel to `beams`: of the bricks of
/// each level those that a line takes. `yieldPoint` is called in each row of bricks, and may throw Aborted.
void addNested(const EchoSetup& setup, const std::vector<BeamReach>& beams, const YieldPoint& yieldPoint,
               std::vector<LineSum>& sums);

} // namespace sono
