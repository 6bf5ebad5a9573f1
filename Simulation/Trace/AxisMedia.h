#pragma once

#include "Kernel/TissueCells.h"
#include "Kernel/TraceView.h"

#include <vector>

namespace sono {

/// mediumAt (Kernel/TimeOfFlight.h) at `count` multiples of a step along a line's axis, from its origin on.
std::vector<int> mediaOnAxis(const TraceView& view, const TissueCells& cells, const TraceLine& line, float stepMm,
                             int count);

} // namespace sono
