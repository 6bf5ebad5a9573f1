#pragma once

#include "Kernel/Vec.h"
#include "Scene/StepStar.h"

#include <cstdint>
#include <vector>

namespace sono {

constexpr int recordBlock = 8; ///< edge of the blocks whose records are baked together

/// Planes and quadratics of the boundaries in one block: smoothing by a few voxels leaves the staircase's own waves
/// (moire, 1.2 degrees of a slanted plane's normal, more near an axis' planes), which only columns further away tell
/// from slopes. A fit serves all of the voxels that it agrees with. Where there is none, at edges, on thin or small
/// things, on rough labels, the smoothed labels' normal stands. Keeps its scratch memory: one object a thread.
class BoundaryFits
{
public:
  /// `tissues` are the tissue indices of `size` voxels, i fastest; they must outlive this. `smoothingMm` is the width
  /// of the Gaussian whose normals the fits are to be better than.
  BoundaryFits(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm, double smoothingMm);

  /// Fits the boundaries of the voxels from `first` on, of which the volume holds but a part at its rim.
  void find(const Vec3i& first);

  /// The unit normal out of the tissue of a voxel of the block that touches another one; false where no fit holds.
  bool normalAt(const Vec3i& voxel, Vec3f& outward) const;

private:
  /// Faces along one axis from one tissue to another.
  struct Kind
  {
    std::uint8_t axis;
    std::uint8_t below;
    std::uint8_t above;
    bool operator==(const Kind& o) const { return axis == o.axis && below == o.below && above == o.above; }
  };
  struct KindCount
  {
    Kind kind;
    int faces; ///< of the block
  };
  struct Face
  {
    Vec3i voxel; ///< the one below
    Kind kind;
  };
  struct Fit
  {
    Kind kind;
    Vec3i voxel;
    stepfit::StarFit star;
  };

  void findFaces(const Vec3i& first);
  void fitFaces(const Kind& kind);
  stepfit::StarFit fitAt(const Vec3i& voxel, int axis);
  bool holds(const Fit& fit, const Vec3i& voxel) const;
  bool findFace(const Kind& kind, bool isBelow, Vec3i& voxel) const;

  const std::uint8_t* tissues_;
  Vec3i size_;
  std::ptrdiff_t pitch_[3];
  Vec3f spacing_;
  float smoothing_;
  stepfit::StepStar star_;
  std::vector<Face> faces_;
  std::vector<KindCount> kinds_;
  std::vector<Vec3i> open_; ///< faces of a kind that no fit serves yet
  std::vector<Fit> fits_;
};

} // namespace sono
