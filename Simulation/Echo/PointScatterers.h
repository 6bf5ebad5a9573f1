#pragma once

#include "Echo/BrickWalk.h"
#include "Echo/ScattererView.h"
#include "Kernel/Vec.h"

#include <vector>

namespace sono {

/// A scatterer that the user gives, for calibration or with an anatomy of his own.
struct PointScatterer
{
  Vec3d positionMm; ///< world LPS
  float amplitude;  ///< echo on the axis of a beam, at intensity 1
};

/// Explicit scatterers, sorted once by place so that a beam visits only those near it.
class PointScatterers
{
public:
  /// Throws Error naming the scatterer whose position is beyond 10^6 mm or not finite, or whose amplitude is not.
  explicit PointScatterers(const std::vector<PointScatterer>& points);

  int count() const { return int(x_.size()); }
  /// The centroid, where the scatterers' own coordinates are 0; their axes are the world's. Single precision carries
  /// them far from the world's origin.
  const Vec3d& originMm() const { return originMm_; }
  const BrickGrid& grid() const { return grid_; }
  /// The scatterers of a brick; none outside of the grid.
  ScattererView brick(const Vec3i& brick) const;

private:
  int indexOf(const Vec3i& brick) const;

  Vec3d originMm_{ 0.0 };
  BrickGrid grid_;
  Vec3i first_{ 0 };       // the grid's lowest brick
  Vec3i size_{ 0 };        // bricks along x, y, z
  std::vector<int> begin_; // of each brick, x fastest, and the end
  std::vector<float> x_, y_, z_, amplitude_;
};

} // namespace sono
