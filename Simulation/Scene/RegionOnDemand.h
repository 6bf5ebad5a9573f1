#pragma once

#include "Core/Progress.h"
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

} // namespace sono
