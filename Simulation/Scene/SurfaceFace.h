#pragma once

#include "Kernel/Vec.h"

#include <cstdint>

namespace sono {

/// Where two voxels of different tissues part.
struct SurfaceFace
{
  Vec3i voxel;        ///< the one below
  Vec3f roughNormal;  ///< within roughNormalRad of the piece's, from below to above; 0 where it is not known
  std::uint8_t axis;  ///< 0 to 2
  std::uint8_t below; ///< tissue index of the voxel and of the next one along the axis
  std::uint8_t above;
};
constexpr float roughNormalRad = 0.4f;

} // namespace sono
