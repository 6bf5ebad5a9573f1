#pragma once

#include "Echo/BrickWalk.h"
#include "Echo/SurfaceRows.h"
#include "Scene/Scene.h"
#include "Trace/Targets.h"

#include <cstdint>
#include <map>
#include <vector>

namespace sono {

/// The targets' surfaces as points, triangles cut until none is longer than a given length, sorted into bricks.
class TargetPieces
{
public:
  /// Of those targets whose numbers are `which`. Media of `rows` are the scene's tissues, then one for each target.
  /// Where a triangle lies outside of the volume it has no echo.
  TargetPieces(const Scene& scene, const std::vector<TargetSurface>& targets, const std::vector<int>& which,
               const SurfaceRows& rows, double longestMm, std::uint64_t seed);

  const BrickGrid& grid() const { return grid_; }
  const std::vector<SurfacePoint>& brick(const Vec3i& brick) const;

private:
  struct Before
  {
    bool operator()(const Vec3i& a, const Vec3i& b) const
    {
      return a.x != b.x ? a.x < b.x : (a.y != b.y ? a.y < b.y : a.z < b.z);
    }
  };

  BrickGrid grid_;
  std::map<Vec3i, std::vector<SurfacePoint>, Before> bricks_;
};

} // namespace sono
