#pragma once

#include "Probe/WindowTarget.h"
#include "Scene/Scene.h"

#include <cstdint>
#include <vector>

namespace sono {

/// The anatomy on cells of about 2.5 mm, each as the voxel in its middle: quick to look through for windows. Places are
/// local (Scene.h).
class WindowGrid
{
public:
  WindowGrid(const Scene& scene, const WindowTarget& target);

  const Scene& scene() const { return scene_; }
  Vec3d cellMm() const { return cellMm_; }
  Vec3d boxMm() const { return boxMm_; }
  double stepMm() const { return stepMm_; }
  Vec3d centre(const Vec3i& cell) const { return (Vec3d(cell) + 0.5) * cellMm_; }
  bool isInside(const Vec3d& local) const
  {
    return glm::all(glm::greaterThanEqual(local, Vec3d(0.0))) && glm::all(glm::lessThan(local, boxMm_));
  }
  /// Of a place inside the box.
  std::size_t at(const Vec3d& local) const { return index(glm::min(Vec3i(local / cellMm_), size_ - 1)); }
  /// Places on the way along `axis` from a place, at `count` distances, and the cells they lie in; -1 beyond the box.
  void cellsAlong(const Vec3d& from, const Vec3d& axis, const double* rMm, int count, double* x, double* y, double* z,
                  int* cell) const;
  /// Where on that way it enters and leaves a box, mm; the second is less where it misses it.
  static Vec2d rangeWithin(const Vec3d& from, const Vec3d& axis, const Vec3d& lowMm, const Vec3d& highMm);
  int tissue(std::size_t cell) const { return tissue_[cell]; }
  bool isTarget(std::size_t cell) const { return target_[cell] != 0; }
  /// Air around the body.
  bool isOuter(std::size_t cell) const { return outer_[cell] != 0; }
  const std::vector<Vec3d>& targetCentres() const { return targetCentres_; } ///< of its cells
  Vec3d targetMiddle() const { return targetMiddle_; }
  /// Area of the largest section through the target's middle, mm^2.
  double targetAreaMm2() const { return targetAreaMm2_; }

  /// Where a probe might stand: places on the body's outer surface, some 8 mm apart.
  struct SkinPlace
  {
    Vec3d localMm;
    Vec3d outward; ///< normal
  };
  std::vector<SkinPlace> skinPlaces() const;
  /// Of the body's surface at a place: away from where the body is; zero where that is all around.
  Vec3d outwardNormal(const Vec3d& local) const;
  /// Whether there is skin at a place on the surface, in a map that has any. A cut face has none, even one that lies
  /// askew in the box.
  bool isCovered(const Vec3d& local, const Vec3d& outward) const;
  /// Where a way along `axis` (unit) through a place on the surface enters the body, by the voxels themselves.
  Vec3d entry(const Vec3d& local, const Vec3d& axis) const;
  /// Whether the air before a place on the surface is known: of a cut body whose skin is an estimate, the way out
  /// (along `outward`) must stay in the box for 40 mm. What was cut away may have been there.
  bool isOpen(const Vec3d& local, const Vec3d& outward) const;

private:
  std::size_t index(const Vec3i& c) const
  {
    return std::size_t(c.x) + std::size_t(size_.x) * (std::size_t(c.y) + std::size_t(size_.y) * c.z);
  }
  void sample(const WindowTarget& target);
  void markTargetPoint(const Vec3d& pointMm);
  void findOuter();
  void measureTarget();
  bool isSurface(const Vec3i& cell) const;
  bool meetsBorder() const;
  int voxelTissue(const Vec3d& local) const; ///< -1 beyond the box
  double voxelStepMm() const;

  const Scene& scene_;
  Vec3i factor_;
  Vec3i size_;
  Vec3d cellMm_;
  Vec3d perCellMm_; ///< 1 / cellMm_
  Vec3d boxMm_;
  Vec3d borderMm_{ 0.0 }; ///< where along each axis no surface counts
  double stepMm_;
  int skinTissue_ = -1;        ///< none in this map
  bool isCutEstimate_ = false; ///< whether skin is a body fill's, of a body that goes on beyond the box
  std::vector<std::uint8_t> tissue_;
  std::vector<char> target_;
  std::vector<char> outer_;
  std::vector<Vec3d> targetCentres_;
  Vec3d targetMiddle_{ 0.0 };
  double targetAreaMm2_ = 0.0;
};

/// The i-th of `count` directions that spread evenly over the sphere (a Fibonacci lattice).
Vec3d evenDirection(int i, int count);

} // namespace sono
