#pragma once

#include "Kernel/Vec.h"
#include "Phantoms/ThoraxLabels.h"

#include <array>

namespace sono {

/// The aorta behind its valve: ascending part and arch, then down beside the spine (world LPS mm).
class ThoraxAorta
{
public:
  /// @param valveMm centre of the aortic valve
  /// @param axis unit direction of flow through it
  ThoraxAorta(const Vec3d& valveMm, const Vec3d& axis);

  /// AortaLumen, AortaWall, AorticValve, or Background where there is no aorta.
  ThoraxLabel sample(const Vec3d& p) const;

private:
  static constexpr int segments_ = 24;
  std::array<Vec3d, segments_ + 1> points_; ///< centre line from the valve to the end of the arch
  Vec3d lowMm_{ 0.0 };                      ///< box around the arch with its wall
  Vec3d highMm_{ 0.0 };
};

} // namespace sono
