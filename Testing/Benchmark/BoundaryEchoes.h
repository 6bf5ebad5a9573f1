#pragma once

#include "Echo/FormRf.h"
#include "Scene/Scene.h"
#include "Trace/Trace.h"

#include <string>
#include <vector>

namespace sono {

/// How far the echoes of one kind of boundary change with the number of paths.
struct BoundaryDrift
{
  std::string tissues; ///< of both sides
  int crossings = 0;
  std::vector<double> medianDb; ///< of the envelope, parallel to the numbers of paths
  double driftDb = 0.0;         ///< largest less least
};

/// For each pair of tissues that touch along the lines at no more than 25 degrees from the perpendicular, in at least
/// `leastCrossings` places: the median of the envelope within 0.5 mm of where these places are shown, for each number
/// of paths. Coupling has no boundaries.
std::vector<BoundaryDrift> boundaryDrifts(const Scene& scene, const std::vector<ScanLine>& lines, TraceSettings tracing,
                                          const EchoSettings& echo, const std::vector<int>& pathsPerLine,
                                          int leastCrossings);

} // namespace sono
