#pragma once

#include "Kernel/TargetBvh.h"
#include "Labels/TissueTable.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace sono {

/// A closed triangle surface in the scene, filled with a tissue of its own: a needle, a wire, a catheter, a test
/// sphere. Inside it the label map does not count. World LPS mm; the triangles may be oriented either way, but all
/// alike.
struct TargetSurface
{
  std::string name;
  Tissue tissue;
  std::vector<Vec3d> pointsMm;
  std::vector<std::array<int, 3>> triangles;
  double rodDiameterMm = 0.0; ///< of a solid round rod, which rings (Echo/RodRing.h) where it is hard; 0: any shape
};

/// The targets' triangles in the tracer's local coordinates, turned to run counter-clockwise seen from outside;
/// `target` is the index into `targets`. `toLocal` maps world directions to the region's axes; local = toLocal * (world
/// - cornerWorldMm). Throws Error naming the target when it has no triangles, an index or coordinate is bad, or the
/// surface is not closed.
std::vector<BvhTriangle> localTriangles(const std::vector<TargetSurface>& targets, const Mat3d& toLocal,
                                        const Vec3d& cornerWorldMm);

/// The targets of a scene in Embree's acceleration structure.
class TargetScene
{
public:
  /// Takes what localTriangles gave.
  explicit TargetScene(std::vector<BvhTriangle> triangles);
  ~TargetScene();
  TargetScene(const TargetScene&) = delete;
  TargetScene& operator=(const TargetScene&) = delete;

  bool empty() const { return triangles_.empty(); }
  const std::vector<BvhTriangle>& triangles() const { return triangles_; }
  /// See CellSpace.
  TargetHit nearest(const Vec3f& position, const Vec3f& direction, float tMax, bool inside) const;

private:
  struct Embree;
  std::vector<BvhTriangle> triangles_;
  std::unique_ptr<Embree> embree_;
};

/// What CellSpace asks of its targets, on the CPU.
struct EmbreeTargets
{
  const TargetScene* scene;
  bool some;

  bool any() const { return some; }
  TargetHit nearest(const Vec3f& position, const Vec3f& direction, float tMax, bool inside) const
  {
    return scene->nearest(position, direction, tMax, inside);
  }
};

} // namespace sono
