#pragma once

#include "Scene/SurfaceField.h"

#include "Scene/OpenGrids.h"

namespace sono {

/// Conversions between OpenVDB and NanoVDB; a file of their own because they compile for most of a minute.
NanoGrid nanoFromOpen(openvdb::Int32Grid& grid);
NanoGrid nanoFromOpen(openvdb::MaskGrid& grid);
NanoGrid compactNanoFromOpen(openvdb::FloatGrid& grid); ///< Fp8
/// Of any of these.
openvdb::GridBase::Ptr openFromNano(const NanoGrid& grid);

} // namespace sono
