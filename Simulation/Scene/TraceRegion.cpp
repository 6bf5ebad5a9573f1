#include "Scene/TraceRegion.h"

#include "Core/LargeMemory.h"
#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Scene/RegionOnDemand.h"

#include <algorithm>
#include <utility>

namespace sono {

namespace {

constexpr int maxDistance = 64; // of the skip map

/// 1 where a voxel of the row has a face neighbour of another tissue. Neighbours outside the volume do not count.
SONO_SIMD_CLONES void markBoundaryRow(const std::uint8_t* row, const std::uint8_t* yBelow, const std::uint8_t* yAbove,
                                      const std::uint8_t* zBelow, const std::uint8_t* zAbove, int first, int count,
                                      int width, std::uint8_t* out)
{
  for (int i = 0; i < count; ++i)
  {
    const int x = first + i;
    out[i] = std::uint8_t((row[x] ^ yBelow[x]) | (row[x] ^ yAbove[x]) | (row[x] ^ zBelow[x]) | (row[x] ^ zAbove[x]));
  }
  for (int i = 0; i < count; ++i)
  {
    const int x = first + i;
    const int left = x > 0 ? x - 1 : 0;
    const int right = x + 1 < width ? x + 1 : x;
    out[i] = (out[i] | (row[x] ^ row[left]) | (row[x] ^ row[right])) != 0 ? 1 : 0;
  }
}

/// One row of a Chebyshev distance sweep: distance = min(distance, 1 + min over the given earlier rows at x-1..x+1).
SONO_SIMD_CLONES void sweepRow(std::uint8_t* row, const std::uint8_t* const* earlier, int rows, int count,
                               std::uint8_t* scratch)
{
  std::copy(earlier[0], earlier[0] + count, scratch + 1);
  for (int r = 1; r < rows; ++r)
  {
    const std::uint8_t* other = earlier[r];
    for (int i = 0; i < count; ++i)
    {
      scratch[i + 1] = std::min(scratch[i + 1], other[i]);
    }
  }
  scratch[0] = scratch[count + 1] = 255;
  for (int i = 0; i < count; ++i)
  {
    const std::uint8_t nearest = std::min(scratch[i + 1], std::min(scratch[i], scratch[i + 2]));
    row[i] = std::min(row[i], std::uint8_t(std::min(int(nearest), maxDistance) + 1));
  }
}

/// Chebyshev distance of every cell to the nearest marked one or the border of the box, by two chamfer sweeps. A row
/// needs the one before it and the three around it in the slice before: blocks of rows on a diagonal through both go at
/// the same time.
void chebyshevDistance(std::vector<std::uint8_t>& distance, const Vec3i& n, const Progress& progress)
{
  constexpr int blockRows = 32;
  const auto row = [&](int y, int z) {
    return distance.data() + std::size_t(n.x) * (std::size_t(y) + std::size_t(n.y) * z);
  };
  const auto sweepBlock = [&](int pass, int kk, int block) {
    std::vector<std::uint8_t> scratch(std::size_t(n.x) + 2);
    const int step = pass == 0 ? -1 : 1;
    const int k = pass == 0 ? kk : n.z - 1 - kk;
    for (int jj = 1 + block * blockRows; jj < std::min(1 + (block + 1) * blockRows, n.y - 1); ++jj)
    {
      const int j = pass == 0 ? jj : n.y - 1 - jj;
      const std::uint8_t* earlier[4] = { row(j + step, k), row(j - 1, k + step), row(j, k + step),
                                         row(j + 1, k + step) };
      std::uint8_t* out = row(j, k);
      sweepRow(out, earlier, 4, n.x, scratch.data());
      if (pass == 0)
      {
        for (int i = 1; i < n.x; ++i)
        {
          out[i] = std::min(out[i], std::uint8_t(out[i - 1] + 1));
        }
      }
      else
      {
        for (int i = n.x - 2; i >= 0; --i)
        {
          out[i] = std::min(out[i], std::uint8_t(out[i + 1] + 1));
        }
      }
    }
  };
  const int blocks = (n.y - 2 + blockRows - 1) / blockRows;
  const int slices = n.z - 2;
  const int diagonals = blocks > 0 && slices > 0 ? 2 * (slices - 1) + blocks : 0;
  for (int pass = 0; pass < 2; ++pass)
  {
    for (int d = 0; d < diagonals; ++d)
    {
      report(progress, 0.5 * (pass + double(d) / diagonals));
      const int first = std::max(0, (d - blocks + 2) / 2); // the least slice whose block on the diagonal is there
      const int last = std::min(slices - 1, d / 2);
      parallelFor(last - first + 1, {}, [&](int i) { sweepBlock(pass, 1 + first + i, d - 2 * (first + i)); });
    }
  }
}

/// Fills a region step by step.
class RegionBuilder
{
public:
  RegionBuilder(const std::uint8_t* tissues, const Vec3i& size, TraceRegion& region)
    : tissues_(tissues)
    , size_(size)
    , region_(region)
    , n_(region.box.size())
    , boundary_(largeVector<std::uint8_t>(std::size_t(n_.x) * n_.y * n_.z))
  {
  }

  void markBoundaries(const Progress& progress)
  {
    parallelFor(n_.z, progress, [&](int k) {
      for (int j = 0; j < n_.y; ++j)
      {
        markBoundaryRow(source(j, k), source(j - 1, k), source(j + 1, k), source(j, k - 1), source(j, k + 1),
                        region_.box.first.x, n_.x, size_.x, boundary_.data() + linear(0, j, k));
      }
    });
  }

  /// Half-width of the uniform cube around every voxel: one less than the Chebyshev distance to the nearest voxel that
  /// touches another tissue, or to the border.
  std::vector<std::uint8_t> distances(const Progress& progress) const
  {
    auto distance = largeVector<std::uint8_t>(boundary_.size());
    parallelFor(n_.z, {}, [&](int k) {
      for (int j = 0; j < n_.y; ++j)
      {
        std::uint8_t* row = distance.data() + linear(0, j, k);
        const std::uint8_t* marked = boundary_.data() + linear(0, j, k);
        const bool border = k == 0 || j == 0 || k == n_.z - 1 || j == n_.y - 1;
        std::transform(marked, marked + n_.x, row,
                       [&](std::uint8_t m) { return std::uint8_t(m != 0 || border ? 0 : maxDistance); });
        row[0] = row[n_.x - 1] = 0;
      }
    });
    chebyshevDistance(distance, n_, progress);
    return distance;
  }

  void writeWords(const std::vector<std::uint8_t>& distance, const Progress& progress)
  {
    const Vec3i blocks = TissueCells::blocksFor(n_);
    const std::size_t count = std::size_t(blocks.x) * blocks.y * blocks.z;
    region_.cell = largeVector(count * 32, TissueCells::outsideWord);
    region_.firstRecord = largeVector<std::uint32_t>(count);
    const TissueCells layout = region_.view();
    parallelFor(blocks.z, progress, [&](int layer) {
      // A layer of blocks holds the border and the voxels 2 layer - 1 and 2 layer.
      for (int k = std::max(0, 2 * layer - 1); k < std::min(2 * layer + 1, n_.z); ++k)
      {
        for (int j = 0; j < n_.y; ++j)
        {
          const std::uint8_t* row = source(j, k) + region_.box.first.x;
          const std::size_t at = linear(0, j, k);
          for (int i = 0; i < n_.x; ++i)
          {
            const std::size_t offset = layout.offset(i, j, k);
            // In its block's order of visits a boundary voxel gets the next rank.
            const int high = boundary_[at + i] ? 128 + int(region_.firstRecord[offset >> 5]++)
                                               : std::max(0, int(distance[at + i]) - 1);
            region_.cell[offset] = std::uint16_t(row[i] | (high << 8));
          }
        }
      }
    });
    std::uint32_t total = 0;
    for (std::uint32_t& first : region_.firstRecord)
    {
      const std::uint32_t own = first;
      first = total;
      total += own;
    }
    region_.record = largeVector<std::uint32_t>(total);
  }

private:
  /// Row of the volume at (j, k) of the box; beyond the volume its border goes on.
  const std::uint8_t* source(int j, int k) const
  {
    const int y = std::clamp(region_.box.first.y + j, 0, size_.y - 1);
    const int z = std::clamp(region_.box.first.z + k, 0, size_.z - 1);
    return tissues_ + std::size_t(size_.x) * (std::size_t(y) + std::size_t(size_.y) * z);
  }
  std::size_t linear(int i, int j, int k) const
  {
    return std::size_t(i) + std::size_t(n_.x) * (std::size_t(j) + std::size_t(n_.y) * k);
  }

  const std::uint8_t* tissues_;
  Vec3i size_;
  TraceRegion& region_;
  Vec3i n_;
  std::vector<std::uint8_t> boundary_; // 1 where a voxel touches another tissue
};

} // namespace

TraceRegion layOutRegion(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm, const VoxelBox& box,
                         const Progress& progress)
{
  TraceRegion region;
  region.box = box;
  region.spacing = Vec3f(spacingMm);
  RegionBuilder builder(tissues, size, region);
  builder.markBoundaries(partOf(progress, 0.0, 0.2));
  builder.writeWords(builder.distances(partOf(progress, 0.2, 0.5)), partOf(progress, 0.5, 1.0));
  return region;
}

TraceRegion buildTraceRegion(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm,
                             const VoxelBox& box, const Progress& progress)
{
  RegionOnDemand region(tissues, size, spacingMm, box, partOf(progress, 0.0, 0.25));
  region.bakeAll(partOf(progress, 0.25, 1.0));
  return std::move(region).take();
}

} // namespace sono
