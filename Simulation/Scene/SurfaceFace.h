#pragma once

#include "Kernel/Vec.h"

#include <cstdint>

namespace sono {

/// Where two voxels of different tissues part.
struct SurfaceFace
{
  Vec3i voxel;        ///< the one below
  Vec3f roughNormal;  ///< mostly within roughNormalRad of the piece's, from below to above; 0 where it is not known
  std::uint8_t axis;  ///< 0 to 2
  std::uint8_t below; ///< tissue index of the voxel and of the next one along the axis
  std::uint8_t above;
};
constexpr float roughNormalRad = 0.8f; // of 98 % of a body's pieces in voxels of 1.5 mm

/// Of the face above a voxel along an axis.
SONO_HD inline Vec3f faceMiddleMm(const Vec3i& voxel, int axis, const Vec3f& spacingMm)
{
  const Vec3f half = Vec3f(0.5f) * spacingMm;
  const Vec3f across(axis == 0 ? half.x : 0.0f, axis == 1 ? half.y : 0.0f, axis == 2 ? half.z : 0.0f);
  return (Vec3f(voxel) + Vec3f(0.5f)) * spacingMm + across;
}

} // namespace sono
