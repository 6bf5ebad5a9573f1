#include "Scene/TraceRegion.h"

#include "ParallelFor.h"
#include "Scene/RecordBaker.h"
#include "Simd.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>

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

/// Chebyshev distance of every cell to the nearest marked one or the border of the box, by two chamfer sweeps.
void chebyshevDistance(std::vector<std::uint8_t>& distance, const Vec3i& n)
{
  std::vector<std::uint8_t> scratch(std::size_t(n.x) + 2);
  const auto row = [&](int y, int z) {
    return distance.data() + std::size_t(n.x) * (std::size_t(y) + std::size_t(n.y) * z);
  };
  for (int pass = 0; pass < 2; ++pass)
  {
    const int step = pass == 0 ? -1 : 1;
    for (int kk = 1; kk + 1 < n.z; ++kk)
    {
      const int k = pass == 0 ? kk : n.z - 1 - kk;
      for (int jj = 1; jj + 1 < n.y; ++jj)
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
    }
  }
}

/// Fills a region step by step.
class RegionBuilder
{
public:
  RegionBuilder(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm, TraceRegion& region)
    : tissues_(tissues)
    , size_(size)
    , spacingMm_(spacingMm)
    , region_(region)
    , n_(region.box.size())
    , boundary_(std::size_t(n_.x) * n_.y * n_.z)
  {
  }

  void markBoundaries()
  {
    parallelFor(n_.z, {}, [&](int k) {
      for (int j = 0; j < n_.y; ++j)
      {
        markBoundaryRow(source(j, k), source(j - 1, k), source(j + 1, k), source(j, k - 1), source(j, k + 1),
                        region_.box.first.x, n_.x, size_.x, boundary_.data() + linear(0, j, k));
      }
    });
  }

  /// Half-width of the uniform cube around every voxel: one less than the Chebyshev distance to the nearest voxel that
  /// touches another tissue, or to the border.
  std::vector<std::uint8_t> distances() const
  {
    std::vector<std::uint8_t> distance(boundary_.size(), std::uint8_t(maxDistance));
    for (int k = 0; k < n_.z; ++k)
    {
      for (int j = 0; j < n_.y; ++j)
      {
        std::uint8_t* row = distance.data() + linear(0, j, k);
        const std::uint8_t* marked = boundary_.data() + linear(0, j, k);
        const bool border = k == 0 || j == 0 || k == n_.z - 1 || j == n_.y - 1;
        std::transform(marked, marked + n_.x, row,
                       [&](std::uint8_t m) { return std::uint8_t(m != 0 || border ? 0 : maxDistance); });
        row[0] = row[n_.x - 1] = 0;
      }
    }
    chebyshevDistance(distance, n_);
    return distance;
  }

  void writeWords(const std::vector<std::uint8_t>& distance)
  {
    const Vec3i blocks = TissueCells::blocksFor(n_);
    const std::size_t count = std::size_t(blocks.x) * blocks.y * blocks.z;
    region_.cell.assign(count * 32, TissueCells::outsideWord);
    region_.firstRecord.assign(count, 0);
    const TissueCells layout = region_.view();
    parallelFor(blocks.z, {}, [&](int layer) {
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
    region_.record.assign(total, 0u);
  }

  void bakeRecords(const Progress& progress)
  {
    const TissueCells layout = region_.view();
    tbb::enumerable_thread_specific<Worker> workers([&] {
      return Worker{ RecordBaker(tissues_, size_, spacingMm_), {}, {} };
    });
    const Vec3i blocks = (n_ + (recordBlock - 1)) / recordBlock;
    parallelFor(blocks.y * blocks.z, progress, [&](int row) {
      Worker& worker = workers.local();
      for (int x = 0; x < blocks.x; ++x)
      {
        const Vec3i corner = Vec3i(x, row % blocks.y, row / blocks.y) * recordBlock;
        collect(corner, worker);
        for (const std::uint8_t tissue : worker.tissues)
        {
          worker.baker.bake(tissue, region_.box.first + corner, worker.voxels[tissue],
                            [&](const Vec3i& v, std::uint32_t bits) {
                              const std::size_t offset = layout.offset(corner + v);
                              const std::uint32_t rank = (region_.cell[offset] >> 8) & 31u;
                              region_.record[region_.firstRecord[offset >> 5] + rank] = bits;
                            });
          worker.voxels[tissue].clear();
        }
        worker.tissues.clear();
      }
    });
  }

private:
  struct Worker
  {
    RecordBaker baker;
    std::vector<std::uint8_t> tissues; // that have boundary voxels in the block
    std::array<std::vector<Vec3i>, 256> voxels;
  };

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

  /// The boundary voxels of a block by tissue, relative to its corner.
  void collect(const Vec3i& corner, Worker& worker) const
  {
    const Vec3i end = glm::min(corner + recordBlock, n_);
    for (int k = corner.z; k < end.z; ++k)
    {
      for (int j = corner.y; j < end.y; ++j)
      {
        const std::uint8_t* row = source(j, k) + region_.box.first.x;
        for (int i = corner.x; i < end.x; ++i)
        {
          if (boundary_[linear(i, j, k)])
          {
            std::vector<Vec3i>& voxels = worker.voxels[row[i]];
            if (voxels.empty())
            {
              worker.tissues.push_back(row[i]);
            }
            voxels.push_back(Vec3i(i, j, k) - corner);
          }
        }
      }
    }
  }

  const std::uint8_t* tissues_;
  Vec3i size_;
  Vec3d spacingMm_;
  TraceRegion& region_;
  Vec3i n_;
  std::vector<std::uint8_t> boundary_; // 1 where a voxel touches another tissue
};

} // namespace

TraceRegion buildTraceRegion(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm,
                             const VoxelBox& box, const Progress& progress)
{
  TraceRegion region;
  region.box = box;
  region.spacing = Vec3f(spacingMm);
  RegionBuilder builder(tissues, size, spacingMm, region);
  builder.markBoundaries();
  report(progress, 0.1);
  builder.writeWords(builder.distances());
  report(progress, 0.25);
  builder.bakeRecords(progress ? Progress([&](double f) { return progress(0.25 + 0.75 * f); }) : Progress{});
  return region;
}

} // namespace sono
