#pragma once

#include "Kernel/SurfacePiece.h"
#include "Kernel/Vec.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace sono {

/// The boundaries of a label map as smooth pieces. Voxels are a staircase, and its terraces would echo like a grating:
/// where steps of half a wavelength matter, no smoothing by a voxel or two suffices. So a piece's place comes from the
/// smoothest surface that the labels allow: a plane, a ball or a quadratic, fitted to the steps of the columns around
/// and to the edges between them, in the widest window, up to 24 voxels to each side, from which no step lies further
/// than its rounding. Windows and shapes give way to each other gradually, so that the surface has no steps of its own.
/// Small windows at rims and thin parts leave those as they are; a lone voxel keeps its faces.
///
/// Made brick by brick when first asked for, and kept. They depend on the labels alone. Several threads may ask.
class SurfacePieces
{
public:
  /// `tissues` are the tissue indices of `size` voxels, i fastest; they must outlive this.
  SurfacePieces(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm);
  ~SurfacePieces();
  SurfacePieces(const SurfacePieces&) = delete;
  SurfacePieces& operator=(const SurfacePieces&) = delete;

  /// Brick b holds the pieces of the voxels whose middle lies in [b, b + 1) * edgeMm; a piece is never more than a
  /// voxel outside.
  float edgeMm() const { return edgeMm_; }
  const Vec3f& sizeMm() const { return sizeMm_; }
  const Vec3f& spacingMm() const { return spacingMm_; }
  /// Bricks of the volume along each axis.
  const Vec3i& bricks() const { return bricks_; }
  /// Blocks of bricks, for whoever takes many at once.
  static constexpr int blockBricks = 4; ///< along an edge
  int blockCount() const { return blocks_.x * blocks_.y * blocks_.z; }
  /// The block of a brick; -1: outside of the volume.
  int blockOf(const Vec3i& brick) const;
  /// Visits the pieces of a block, brick by brick, those bricks that have any.
  void forBricksOf(int block, const std::function<void(const std::vector<SurfacePiece>&)>& visit) const;
  /// None outside of the volume. Stays where it is while this lives.
  const std::vector<SurfacePiece>& brick(const Vec3i& brick) const;

private:
  using Bricks = std::vector<std::atomic<const std::vector<SurfacePiece>*>>;

  std::vector<SurfacePiece> make(const Vec3i& brick) const;

  const std::uint8_t* tissues_;
  Vec3i size_;
  Vec3f spacingMm_;
  Vec3f sizeMm_;
  float edgeMm_;
  Vec3i bricks_;
  Vec3i blocks_;
  mutable Bricks made_;
};

} // namespace sono
