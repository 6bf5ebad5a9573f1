#include "Scene/TraceRegion.h"

#include "Kernel/Lobe.h"
#include "ParallelFor.h"
#include "Scene/SmoothedMask.h"
#include "Simd.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace sono {

namespace {

constexpr int block = 8;        // edge of the blocks that are smoothed together, voxels
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

/// Bakes the records of one block of the box.
class RecordBaker
{
public:
  RecordBaker(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm)
    : smoother_(tissues, size)
    , spacing_(spacingMm)
    , sigma_(std::cbrt(spacingMm.x * spacingMm.y * spacingMm.z))
    , position_(makeGaussian(spacingMm, sigma_))
    , normalSigma_(std::clamp(1.35 * std::max({ spacingMm.x, spacingMm.y, spacingMm.z }), 2.0 * sigma_, 3.0 * sigma_))
    , normal_(makeGaussian(spacingMm, normalSigma_))
  {
  }

  /// `inBlock` lists the block's boundary voxels of one tissue, relative to `first`.
  template<class Store>
  void bake(std::uint8_t tissue, const Vec3i& first, const std::vector<Vec3i>& inBlock, const Store& store)
  {
    smoother_.smooth(tissue, first, Vec3i(block), position_, fine_.data());
    smoother_.smooth(tissue, first - 1, Vec3i(block + 2), normal_, coarse_.data());
    for (const Vec3i& v : inBlock)
    {
      store(v, encodeRecord(recordAt(v)));
    }
  }

private:
  BoundaryRecord recordAt(const Vec3i& v) const
  {
    const auto coarse = [&](int x, int y, int z)
    { return coarse_[std::size_t(v.x + 1 + x + (block + 2) * (v.y + 1 + y + (block + 2) * (v.z + 1 + z)))]; };
    const auto depth = [&](int x, int y, int z)
    { return normalFromUpperTail(std::clamp(coarse(x, y, z), 1e-6f, 1.0f - 1e-6f)); };
    // Of the occupancy for the confidence; of its probit for the direction, since that is linear across a plane and
    // a difference over a thick voxel therefore exact.
    const Vec3d gradient((coarse(1, 0, 0) - coarse(-1, 0, 0)) / (2.0 * spacing_.x),
                         (coarse(0, 1, 0) - coarse(0, -1, 0)) / (2.0 * spacing_.y),
                         (coarse(0, 0, 1) - coarse(0, 0, -1)) / (2.0 * spacing_.z));
    const Vec3d outward((depth(1, 0, 0) - depth(-1, 0, 0)) / spacing_.x,
                        (depth(0, 1, 0) - depth(0, -1, 0)) / spacing_.y,
                        (depth(0, 0, 1) - depth(0, 0, -1)) / spacing_.z);
    const double slope = glm::length(gradient);
    const double steepness = glm::length(outward);
    BoundaryRecord record;
    record.normal = steepness > 1e-9 ? Vec3f(outward / steepness) : Vec3f(0.0f, 0.0f, 1.0f);
    // A plane's smoothed occupancy has the slope 1 / (sigma sqrt(2 pi)).
    record.confidence = float(slope * normalSigma_ * 2.5066282746);
    const float share = fine_[std::size_t(v.x + block * (v.y + block * v.z))];
    // For a plane at distance d inside, occupancy = Phi(d / sigma).
    record.offset = -normalFromUpperTail(std::clamp(share, 1e-4f, 1.0f - 1e-4f));
    return record;
  }

  MaskSmoother<std::uint8_t> smoother_;
  Vec3d spacing_;
  double sigma_;
  GaussianAxes position_;
  double normalSigma_;
  GaussianAxes normal_;
  std::array<float, std::size_t(block) * block * block> fine_{};
  std::array<float, std::size_t(block + 2) * (block + 2) * (block + 2)> coarse_{};
};

} // namespace

TissueCells TraceRegion::view() const
{
  TissueCells cells;
  cells.cell = cell.data();
  cells.record = record.data();
  cells.size = box.size();
  cells.blocks = TissueCells::blocksFor(cells.size);
  cells.spacing = spacing;
  cells.meanSpacing = std::cbrt(spacing.x * spacing.y * spacing.z);
  return cells;
}

TraceRegion buildTraceRegion(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm,
                             const VoxelBox& box, const Progress& progress)
{
  TraceRegion region;
  region.box = box;
  region.spacing = Vec3f(spacingMm);
  const Vec3i n = box.size();
  const std::size_t count = std::size_t(n.x) * n.y * n.z;
  const Vec3i blocked = TissueCells::blocksFor(n);
  const std::size_t stored = std::size_t(blocked.x) * blocked.y * blocked.z * 32;
  region.cell.assign(stored, 0);
  region.record.assign(stored, 0u);
  const TissueCells layout = region.view();
  std::vector<std::uint8_t> boundary(count);

  const auto source = [&](int y, int z) {
    return tissues + std::size_t(size.x) *
                       (std::size_t(std::clamp(y, 0, size.y - 1)) + std::size_t(size.y) * std::clamp(z, 0, size.z - 1));
  };
  parallelFor(n.z, {}, [&](int k) {
    const int z = box.first.z + k;
    for (int j = 0; j < n.y; ++j)
    {
      const int y = box.first.y + j;
      markBoundaryRow(source(y, z), source(y - 1, z), source(y + 1, z), source(y, z - 1), source(y, z + 1), box.first.x,
                      n.x, size.x, boundary.data() + std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k));
    }
  });
  report(progress, 0.1);

  struct Worker
  {
    RecordBaker baker;
    std::vector<Vec3i> voxels;
  };
  tbb::enumerable_thread_specific<Worker> workers([&] { return Worker{ RecordBaker(tissues, size, spacingMm), {} }; });
  const Vec3i blocks = (n + (block - 1)) / block;
  std::atomic<std::size_t> boundaryVoxels{ 0 };
  const Progress baking = progress ? Progress([&](double f) { return progress(0.1 + 0.7 * f); }) : Progress{};
  parallelFor(blocks.y * blocks.z, baking, [&](int slab) {
    Worker& worker = workers.local();
    std::array<bool, 256> present{};
    for (int bx = 0; bx < blocks.x; ++bx)
    {
      const Vec3i corner(bx * block, (slab % blocks.y) * block, (slab / blocks.y) * block);
      const Vec3i extent = glm::min(Vec3i(block), n - corner);
      std::vector<std::uint8_t> found;
      const auto forBoundary = [&](auto&& visit) {
        for (int z = 0; z < extent.z; ++z)
        {
          for (int y = 0; y < extent.y; ++y)
          {
            const std::size_t at = std::size_t(corner.x) +
                                   std::size_t(n.x) * (std::size_t(corner.y + y) + std::size_t(n.y) * (corner.z + z));
            const std::uint8_t* row =
              source(box.first.y + corner.y + y, box.first.z + corner.z + z) + box.first.x + corner.x;
            for (int x = 0; x < extent.x; ++x)
            {
              if (boundary[at + x])
              {
                visit(row[x], Vec3i(x, y, z));
              }
            }
          }
        }
      };
      forBoundary([&](std::uint8_t tissue, const Vec3i&) {
        if (!present[tissue])
        {
          present[tissue] = true;
          found.push_back(tissue);
        }
      });
      for (std::uint8_t tissue : found)
      {
        present[tissue] = false;
        worker.voxels.clear();
        forBoundary([&](std::uint8_t t, const Vec3i& v) {
          if (t == tissue)
          {
            worker.voxels.push_back(v);
          }
        });
        boundaryVoxels += worker.voxels.size();
        worker.baker.bake(tissue, box.first + corner, worker.voxels,
                          [&](const Vec3i& v, std::uint32_t bits) { region.record[layout.offset(corner + v)] = bits; });
      }
    }
  });
  region.boundaryVoxels = boundaryVoxels;

  // Distances to the nearest voxel that touches another tissue, or to the border; one less is a uniform cube.
  std::vector<std::uint8_t> distance(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    distance[i] = boundary[i] ? 0 : maxDistance;
  }
  for (int k = 0; k < n.z; ++k)
  {
    for (int j = 0; j < n.y; ++j)
    {
      std::uint8_t* row = distance.data() + std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k);
      if (k == 0 || j == 0 || k == n.z - 1 || j == n.y - 1)
      {
        std::fill(row, row + n.x, std::uint8_t(0));
      }
      row[0] = row[n.x - 1] = 0;
    }
  }
  chebyshevDistance(distance, n);
  report(progress, 0.95);
  parallelFor(n.z, {}, [&](int k) {
    for (int j = 0; j < n.y; ++j)
    {
      const std::size_t at = std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k);
      const std::uint8_t* row = source(box.first.y + j, box.first.z + k) + box.first.x;
      for (int i = 0; i < n.x; ++i)
      {
        const int skip = std::max(0, int(distance[at + i]) - 1);
        region.cell[layout.offset(i, j, k)] = std::uint16_t(row[i] | (skip << 8));
      }
    }
  });
  report(progress, 1.0);
  return region;
}

} // namespace sono
