#pragma once

#include "Echo/HeardSurfaces.h"
#include "Echo/SurfaceLists.h"

// What a brick's points add to a line, in vectors: Kernel/SurfaceEcho.h for many at once.

namespace sono {

/// addDiffuse and addCoherent of each point, to a line's sum.
void addDiffusePoints(const PointList& points, const HeardList& heard, const Beam& beam, const LineGrid& grid,
                      const SurfaceTable& table, float* iq);
void addCoherentPoints(const PointList& points, const HeardList& heard, const Beam& beam, const LineGrid& grid,
                       const SurfaceTable& table, float* iq);

} // namespace sono
