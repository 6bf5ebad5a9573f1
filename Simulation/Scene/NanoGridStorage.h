#pragma once

// The one place that includes NanoVDB.
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
