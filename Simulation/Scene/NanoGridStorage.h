#pragma once

// What NanoGrid hides, for the .cpp files of Scene/ and for the march through the grid itself (Kernel/NanoSpace.h).
// NanoVDB is included here, there, and by the .cpp files that convert or store grids (NanoConvert, NanoFile).
#include "Scene/SurfaceField.h"

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/GridHandle.h>
#include <nanovdb/util/HostBuffer.h>

namespace sono {

struct NanoGrid::Storage
{
  nanovdb::GridHandle<nanovdb::HostBuffer> handle;
};

} // namespace sono
