#pragma once

#include "Core/Progress.h"
#include "Kernel/SurfaceHit.h"
#include "Kernel/TissueCells.h"
#include "Scene/TraceRegion.h"
#include "Scene/VoxelBox.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace sono {

class RegionOnDemand;

/// A region's cells whose records are baked when they are first asked for.
struct CellsOnDemand : TissueCells
{
  const RegionOnDemand* region = nullptr;

  std::uint32_t recordOf(int x, int y, int z, std::uint32_t word) const;
};

/// In a volume's local mm.
struct LocalBall
{
  Vec3d middleMm;
  double mm; ///< radius
};

/// A region with lazy evaluation: a record is baked, with its block, when it is first read. Laying out the words takes
/// a tenth of the time, and the paths of a fan meet a small part of the records. A record is what buildTraceRegion
/// gives, to the bit, whichever thread reads it first; several may at the same time.
class RegionOnDemand
{
public:
  /// As buildTraceRegion. The voxels must outlive this. What `other`, a region of the same voxels, has baked is copied
  /// while that exists.
  RegionOnDemand(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm, const VoxelBox& box,
                 const Progress& progress = {}, std::weak_ptr<const RegionOnDemand> other = {});
  ~RegionOnDemand();
  RegionOnDemand(const RegionOnDemand&) = delete;
  RegionOnDemand& operator=(const RegionOnDemand&) = delete;

  /// Records that were not baked yet are 0.
  const TraceRegion& region() const { return region_; }
  CellsOnDemand view() const { return { region_.view(), this }; }

  void bakeAll(const Progress& progress = {}) const;
  /// Those that lie in a ball, and some around them.
  void bakeIn(const std::vector<LocalBall>& balls, const Progress& progress = {}) const;
  /// The blocks that `other`, a region of the same voxels, has baked by now, and those that touch them, one after the
  /// other on this thread, until `goesOn` says no.
  void bakeBeside(const RegionOnDemand& other, const std::function<bool()>& goesOn) const;
  /// Bakes the block around a voxel of the box that has a record, and gives that record.
  [[gnu::cold]] std::uint32_t bakeAt(const Vec3i& voxel) const;
  /// Blocks that were baked so far.
  int bakedBlocks() const;

  /// Moves the region out, once nothing reads from this any more.
  TraceRegion take() && { return std::move(region_); }

private:
  struct Baking;
  void bakeBlock(const Vec3i& block) const;
  template<class Wants>
  void bakeBlocks(const Wants& isWanted, const Progress& progress) const;
  std::uint32_t knownAt(const Vec3i& volumeVoxel) const;

  mutable TraceRegion region_; ///< of which the records change
  std::unique_ptr<Baking> baking_;
  std::weak_ptr<const RegionOnDemand> other_;
};

inline std::uint32_t CellsOnDemand::recordOf(int x, int y, int z, std::uint32_t word) const
{
  if ((word & 0x8000u) == 0u)
  {
    return 0u;
  }
  // A record says all in one word, so that it is there or not, whatever another thread does meanwhile.
  const std::uint32_t* at = record + firstRecord[offset(x, y, z) >> 5] + ((word >> 8) & 31u);
  const std::uint32_t bits = __atomic_load_n(at, __ATOMIC_RELAXED);
  return __builtin_expect(bits != 0u, 1) ? bits : region->bakeAt(Vec3i(x, y, z));
}

/// sumRecords, all eight at once.
inline RecordSum sumRecords(const CellsOnDemand& cells, const Vec3i& low, const Vec3f& share, int from, int to,
                            const SideWeights& weights)
{
  std::size_t at[8];
  std::int32_t word[8];
  cells.offsetsAround(low, at);
  for (int n = 0; n < 8; ++n)
  {
    word[n] = cells.cell[at[n]];
  }
  float side[8];
  std::uint32_t bits[8];
  std::uint32_t record[8];
  for (int n = 0; n < 8; ++n)
  {
    const int tissue = word[n] & 255;
    const float of = tissue == from ? weights.before : (tissue == to ? -weights.after : 0.0f);
    side[n] = (word[n] & 0x8000) != 0 ? of : 0.0f;
  }
  for (int n = 0; n < 8; ++n)
  {
    record[n] = cells.firstRecord[at[n] >> 5] + (std::uint32_t(word[n] >> 8) & 31u);
    record[n] = (word[n] & 0x8000) != 0 ? record[n] : 0u;
  }
  for (int n = 0; n < 8; ++n)
  {
    bits[n] = __atomic_load_n(cells.record + record[n], __ATOMIC_RELAXED);
    if (__builtin_expect(bits[n] == 0u && side[n] != 0.0f, 0))
    {
      bits[n] = cells.region->bakeAt({ low.x + (n & 1), low.y + ((n >> 1) & 1), low.z + (n >> 2) });
    }
  }
  const float sx = share.x, sy = share.y, sz = share.z;
  const float shareX[2] = { 1.0f - sx, sx };
  const float shareYZ[4] = { (1.0f - sy) * (1.0f - sz), sy * (1.0f - sz), (1.0f - sy) * sz, sy * sz };
  float x[8], y[8], z[8], w[8];
  for (int n = 0; n < 8; ++n)
  {
    w[n] = shareX[n & 1] * shareYZ[n >> 1];
  }
  for (int n = 0; n < 8; ++n)
  {
    const float weight = w[n] * decodeConfidence(bits[n]);
    const Vec3f normal = decodeOctahedral(bits[n]);
    const float of = weight * side[n];
    x[n] = normal.x * of;
    y[n] = normal.y * of;
    z[n] = normal.z * of;
    w[n] = std::fabs(of); // sides are 0, 1 and -1
  }
  for (int half = 4; half > 0; half /= 2)
  {
    for (int n = 0; n < half; ++n)
    {
      x[n] += x[n + half];
      y[n] += y[n + half];
      z[n] += z[n + half];
      w[n] += w[n + half];
    }
  }
  return { { x[0], y[0], z[0] }, w[0] };
}

} // namespace sono
