#pragma once

#include "Core/Progress.h"
#include "Echo/BeamSplat.h"
#include "Echo/BrickWalk.h"
#include "Echo/EchoSetup.h"
#include "Echo/NestedBricks.h"
#include "Echo/NestedScatterers.h"
#include "Echo/NestedShares.h"

#include <vector>

namespace sono {

/// What a group of lines is added in; nothing is left in it.
struct NestedRoom
{
  NestedBricks bricks;
  std::vector<NestedShares> shares; ///< of each line
  std::vector<int> wanted;
  NestedScatterers::Generated scatterers;
};

/// Adds what the setup's nested scatterers echo to the sums of a group of lines, parallel to `beams`: of the bricks of
/// each level those that a line takes. `yieldPoint` is called in each row of bricks, and may throw Aborted.
void addNested(const EchoSetup& setup, const std::vector<BeamReach>& beams, const YieldPoint& yieldPoint,
               NestedRoom& room, std::vector<LineSum>& sums);

} // namespace sono
