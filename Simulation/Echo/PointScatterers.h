#pragma once

#include "Core/Progress.h"
#include "Echo/BrickWalk.h"
#include "Echo/PointTable.h"
#include "Echo/ScattererView.h"
#include "Kernel/Vec.h"

#include <memory>
#include <optional>
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
  /// Throws Error naming the scatterer whose position is beyond 10^6 mm or not finite, or whose amplitude is not, and
  /// Aborted. Sorted on all cores; what comes out depends on the points alone.
  explicit PointScatterers(const std::vector<PointScatterer>& points, const Progress& progress = {});
  /// In bricks of this edge from this origin on, however many there are; `loudest` is at least the largest amplitude.
  PointScatterers(const std::vector<PointScatterer>& points, const Vec3d& originMm, double edgeMm, float loudest,
                  const Progress& progress = {});

  int count() const { return int(table_->x.size()); }
  /// The centroid where no other was given, where the scatterers' own coordinates are 0; their axes are the world's.
  /// Single precision about it carries them far from the world's origin.
  const Vec3d& originMm() const { return originMm_; }
  const BrickGrid& grid() const { return grid_; }
  std::shared_ptr<const PointTable> table() const { return table_; }
  /// All of them again, brick by brick; places to single precision about the centroid.
  std::vector<PointScatterer> all() const;
  /// The scatterers of a brick; none outside of the grid.
  ScattererView brick(const Vec3i& brick) const;

private:
  /// By bricks of this edge; without one, of as many as do.
  void sort(const std::vector<PointScatterer>& points, std::optional<double> edgeMm, float loudest,
            const Progress& progress);

  Vec3d originMm_{ 0.0 };
  BrickGrid grid_;
  std::shared_ptr<const PointTable> table_;
};

} // namespace sono
