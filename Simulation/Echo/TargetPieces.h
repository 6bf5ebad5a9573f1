#pragma once

#include "Echo/BrickWalk.h"
#include "Echo/SurfaceRows.h"
#include "Scene/Scene.h"
#include "Trace/Targets.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace sono {

/// The targets' surfaces as points, triangles cut until none is longer than a given length, by bricks. Points are cut
/// where they are asked for: a phantom's targets have millions, of which a fan meets some.
class TargetPieces
{
public:
  /// Of those targets whose numbers are `which`. Media of `rows` are the scene's tissues, then one for each target.
  /// Where a triangle lies outside of the volume it has no echo. Scene and rows must outlive this.
  TargetPieces(const Scene& scene, const std::vector<TargetSurface>& targets, const std::vector<int>& which,
               const SurfaceRows& rows, double longestMm, std::uint64_t seed);

  const BrickGrid& grid() const { return grid_; }
  /// Replaces `points` by those whose triangles have their middles in a brick. Threads may ask together.
  void cutBrick(const Vec3i& brick, std::vector<SurfacePoint>& points) const;

private:
  /// A triangle, or what halving leaves of it.
  struct Part
  {
    Vec3d a;
    Vec3d b;
    Vec3d c;
    std::uint32_t half; ///< 1: the triangle; of halving n come 2 n and 2 n + 1
    std::size_t origin; ///< number of its triangle's
  };
  /// A part's triangle.
  struct Origin
  {
    int triangle;
    int target;
    Vec3f normal;
  };
  struct Before
  {
    bool operator()(const Vec3i& a, const Vec3i& b) const
    {
      return a.x != b.x ? a.x < b.x : (a.y != b.y ? a.y < b.y : a.z < b.z);
    }
  };

  template<class Goes, class Visit>
  static void halve(const Part& part, double longestMm, const Goes& goes, const Visit& visit);
  void point(const Part& part, const Vec3i& brick, std::vector<SurfacePoint>& points) const;

  const Scene& scene_;
  const SurfaceRows& rows_;
  double longestMm_;
  std::uint64_t seed_;
  BrickGrid grid_;
  std::vector<Origin> origins_;
  std::map<Vec3i, std::vector<Part>, Before> bricks_; ///< those that a part's box meets
};

} // namespace sono
