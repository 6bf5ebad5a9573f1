#pragma once

#include "BenchScenes.h"

namespace sono::study {

// Switches for this study alone: they change the tracer's cache of a scene, which trace() then finds and uses as long
// as the lines stay the same.

/// Forgets the smoothed surfaces: every boundary is a voxel face.
void removeSurfaces(const BenchScene& bench);

/// Forgets the cubes that hold one tissue: a march visits every voxel.
void removeSkips(const BenchScene& bench);

} // namespace sono::study
