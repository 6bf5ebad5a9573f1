#pragma once

#include "Kernel/Vec.h"

#include <cstddef>
#include <vector>

namespace sono {

/// Scatterers sorted by cubic brick, in columns; positions in mm from an origin of their own. Brick b fills
/// [b, b + 1) * edgeMm.
struct PointTable
{
  std::vector<float> x, y, z, amplitude;
  std::vector<int> begin; ///< of each brick, x fastest, and the end
  Vec3i firstBrick{ 0 };
  Vec3i bricks{ 0 }; ///< along x, y, z
  float edgeMm = 1.0f;
  float loudest = 0.0f; ///< no amplitude is larger

  std::size_t bytes() const { return 4 * x.size() * sizeof(float) + begin.size() * sizeof(int); }
};

} // namespace sono
