#pragma once

#include "Labels/LabelVolume.h"

#include <openvdb/math/Transform.h>

namespace sono {

/// Index to world as OpenVDB writes it: row vectors, points multiplied from the left.
inline openvdb::math::Transform::Ptr worldTransform(const GridPlacement& placement)
{
  openvdb::Mat4R m = openvdb::Mat4R::identity();
  for (int axis = 0; axis < 3; ++axis)
  {
    const Vec3d step = placement.direction[axis] * placement.spacingMm[axis];
    for (int c = 0; c < 3; ++c)
    {
      m[axis][c] = step[c];
    }
    m[3][axis] = placement.originMm[axis];
  }
  return openvdb::math::Transform::createLinearTransform(m);
}

} // namespace sono
