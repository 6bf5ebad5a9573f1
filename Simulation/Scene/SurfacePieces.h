#pragma once

#include "Core/Progress.h"
#include "Kernel/SurfacePiece.h"
#include "Kernel/Vec.h"
#include "Scene/SurfaceFace.h"
#include "Scene/VoxelBox.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace sono {

/// The boundaries of a label map as smooth pieces. Voxels are a staircase, and its terraces would echo like a grating:
/// where steps of half a wavelength matter, no smoothing by a voxel or two suffices. So a piece's place comes from the
/// smoothest surface that the labels allow: a plane, a ball or a quadratic, in the middle of what the steps of the
/// columns around leave free, in the widest window, up to 40 voxels to each side, from which no step lies further than
/// its rounding. Windows and shapes give way to each other gradually, so that the surface has no steps of its own.
/// Small windows at rims and thin parts leave those as they are; a lone voxel keeps its faces.
///
/// Faces between voxels of different tissues are looked up brick by brick, pieces are fitted one by one, when first
/// asked for, and kept: most surfaces are seen too slantingly to echo. They depend on the labels alone. Several threads
/// may ask.
class SurfacePieces
{
public:
  /// `tissues` are the tissue indices of `size` voxels, i fastest; they must outlive this.
  SurfacePieces(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm);
  ~SurfacePieces();
  SurfacePieces(const SurfacePieces&) = delete;
  SurfacePieces& operator=(const SurfacePieces&) = delete;

  /// Of these alone, in this process.
  std::uint64_t id() const { return id_; }

  using Face = SurfaceFace;

  /// Brick b holds the faces of the voxels whose middle lies in [b, b + 1) * edgeMm; their pieces are never more than a
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
  /// The first brick of a block.
  Vec3i firstBrick(int block) const;
  /// None outside of the volume. Stays where it is while this lives.
  const std::vector<Face>& faces(const Vec3i& brick) const;
  /// Asks the memory for a brick's first faces, if they are known.
  void prefetch(const Vec3i& brick) const;
  /// So many of a brick's faces, which come first, stand for all where a probe is being moved (Policy.h): every so many
  /// columns along each of two axes, coarseApart() voxels from one to the next.
  std::size_t coarseCount(const Vec3i& brick) const;
  const Vec3i& coarseApart() const { return coarseApart_; }
  /// The piece of a face of that brick; null where columns of another axis stand for it. It stays as well.
  const SurfacePiece* piece(const Vec3i& brick, std::size_t face) const;
  /// Makes those of the coarse faces of the bricks between two voxels, for a probe that will be moved. Ends early,
  /// without an exception, where `progress` says so.
  void fitCoarse(const VoxelBox& box, const Progress& progress) const;

private:
  struct Brick
  {
    std::vector<Face> faces;
    std::size_t coarseCount = 0;
    std::unique_ptr<std::atomic<const SurfacePiece*>[]> pieces; ///< parallel to the faces; null: not yet made

    ~Brick();
  };

  std::atomic<const Brick*>* placeOf(const Vec3i& brick) const;
  const Brick* at(const Vec3i& brick) const;
  std::vector<Face> findFaces(const Vec3i& brick) const;
  bool isCoarse(const Face& face) const;

  std::uint64_t id_;
  const std::uint8_t* tissues_;
  Vec3i size_;
  Vec3f spacingMm_;
  Vec3i coarseApart_;
  Vec3f sizeMm_;
  float edgeMm_;
  Vec3i bricks_;
  Vec3i blocks_;
  mutable std::vector<std::atomic<const Brick*>> made_;
};

} // namespace sono
