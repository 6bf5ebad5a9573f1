#pragma once

#include "Labels/LabelVolume.h"

#include <vector>

namespace sono {

/// Blocks of voxels, each about 3 mm long.
struct CoarseGrid
{
  Vec3i factor{ 1, 1, 1 };
  Vec3i size{ 0, 0, 0 };
  Vec3d spacingMm{ 1.0, 1.0, 1.0 };

  explicit CoarseGrid(const GridPlacement& fine);
  std::size_t index(const Vec3i& c) const
  {
    return std::size_t(c.x) + std::size_t(size.x) * (std::size_t(c.y) + std::size_t(size.y) * c.z);
  }
  std::size_t count() const { return std::size_t(size.x) * size.y * size.z; }
};

/// Calls visit(block) for each, i fastest.
template<class Visit>
void forBlocks(const CoarseGrid& grid, const Visit& visit)
{
  for (int k = 0; k < grid.size.z; ++k)
  {
    for (int j = 0; j < grid.size.y; ++j)
    {
      for (int i = 0; i < grid.size.x; ++i)
      {
        visit(Vec3i(i, j, k));
      }
    }
  }
}

/// The connected blocks with wanted[i] != 0 around a seed; their marks are taken off. Blocks along `exceptAxis` are not
/// neighbours; -1: along all axes.
std::vector<Vec3i> takeComponent(const CoarseGrid& grid, std::vector<char>& wanted, const Vec3i& seed, int exceptAxis);

/// Marks what touches no border of its axial slice and is not inside.
void fillSliceHoles(const GridPlacement& fine, const CoarseGrid& grid, std::vector<char>& inside);

/// How a body is estimated from what is known to belong to it.
struct BodyEstimate
{
  double closingMm; ///< gaps up to twice as wide belong to it
  double wallMm;    ///< by so much it is larger
  /// Blocks that lie just below the skin of the front in everybody: before these, within 60 degrees of straight ahead,
  /// the closing is 8 mm at most. Empty: none.
  std::vector<char> shallow{};
};

/// How deep the voxels of a label map lie below the surface of a body.
class BodyDepth
{
public:
  /// `known`: the blocks that belong to it, closed by a ball of `closingMm` and grown by `wallMm`, without parts
  /// smaller than a twentieth of the largest, holes filled in each axial slice. Beyond the volume's border the
  /// outermost blocks go on.
  BodyDepth(const GridPlacement& fine, const std::vector<char>& known, const BodyEstimate& estimate);

  const CoarseGrid& grid() const { return grid_; }
  /// Of the blocks' centres, mm, negative outside; in holes that were filled a metre.
  const std::vector<float>& ofBlocks() const { return depthMm_; }
  /// Of a row of voxels along i, interpolated.
  void ofRow(int j, int k, std::vector<float>& depthMm) const;

private:
  void openBefore(const GridPlacement& fine, const std::vector<char>& known, const BodyEstimate& estimate);
  /// The block below a voxel's centre along an axis, and the share of the one above.
  struct Between
  {
    int low;
    int high;
    float share;
  };
  static std::vector<Between> interpolation(int fineSize, int factor, int coarseSize);

  CoarseGrid grid_;
  std::vector<float> depthMm_;
  std::vector<Between> alongX_, alongY_, alongZ_;
};

} // namespace sono
