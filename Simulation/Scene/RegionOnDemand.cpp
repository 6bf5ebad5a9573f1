#include "Scene/RegionOnDemand.h"

#include "Core/ParallelFor.h"
#include "Scene/RecordBaker.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <utility>
#include <vector>

namespace sono {

namespace {

/// What a thread needs for a block.
struct Worker
{
  RecordBaker baker;
  std::vector<std::uint8_t> tissues; // that have boundary voxels in the block
  std::array<std::vector<Vec3i>, 256> voxels;
};

std::size_t recordIndex(const TissueCells& cells, const Vec3i& voxel)
{
  const std::size_t offset = cells.offset(voxel);
  return cells.firstRecord[offset >> 5] + ((cells.cell[offset] >> 8) & 31u);
}

} // namespace

struct RegionOnDemand::Baking
{
  Baking(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm, const VoxelBox& box)
    : workers([=] {
      return Worker{ RecordBaker(tissues, size, spacingMm), {}, {} };
    })
    , first(box.first / recordBlock)
    , blocks((box.last + (recordBlock - 1)) / recordBlock - first)
    , baked(std::size_t(blocks.x) * blocks.y * blocks.z)
  {
  }

  std::atomic<bool>& flag(const Vec3i& block)
  {
    return baked[std::size_t(block.x) +
                 std::size_t(blocks.x) * (std::size_t(block.y) + std::size_t(blocks.y) * block.z)];
  }

  tbb::enumerable_thread_specific<Worker> workers;
  Vec3i first; ///< block of the volume: what is baked does not depend on the box
  Vec3i blocks;
  std::vector<std::atomic<bool>> baked;
  std::atomic<bool> all = false; ///< of them; to look through them takes as long as a part of an image
};

RegionOnDemand::RegionOnDemand(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm,
                               const VoxelBox& box, const Progress& progress, std::weak_ptr<const RegionOnDemand> other)
  : region_(layOutRegion(tissues, size, spacingMm, box, progress))
  , baking_(std::make_unique<Baking>(tissues, size, spacingMm, box))
  , other_(std::move(other))
{
}

RegionOnDemand::~RegionOnDemand() = default;

void RegionOnDemand::bakeBlock(const Vec3i& block) const
{
  const TissueCells cells = region_.view();
  Worker& worker = baking_->workers.local();
  const Vec3i first = (baking_->first + block) * recordBlock;
  const Vec3i corner = first - region_.box.first; // of the block, of which the box may hold a part
  const Vec3i begin = glm::max(corner, Vec3i(0));
  const Vec3i end = glm::min(corner + recordBlock, cells.size);
  for (int k = begin.z; k < end.z; ++k)
  {
    for (int j = begin.y; j < end.y; ++j)
    {
      for (int i = begin.x; i < end.x; ++i)
      {
        const std::uint32_t word = cells.wordAt(i, j, k);
        if ((word & 0x8000u) != 0u)
        {
          std::vector<Vec3i>& voxels = worker.voxels[word & 255u];
          if (voxels.empty())
          {
            worker.tissues.push_back(std::uint8_t(word & 255u));
          }
          voxels.push_back(Vec3i(i, j, k) - corner);
        }
      }
    }
  }
  // Two threads that bake the same block at a time write the same.
  const auto store = [&](const Vec3i& v, std::uint32_t bits) {
    __atomic_store_n(&region_.record[recordIndex(cells, corner + v)], bits, __ATOMIC_RELAXED);
  };
  const auto other = other_.lock();
  bool begun = false;
  for (const std::uint8_t tissue : worker.tissues)
  {
    std::vector<Vec3i>& voxels = worker.voxels[tissue];
    const bool known = other && std::all_of(voxels.begin(), voxels.end(), [&](const Vec3i& v) {
                         const std::uint32_t bits = other->knownAt(first + v);
                         if (bits != 0u)
                         {
                           store(v, bits);
                         }
                         return bits != 0u;
                       });
    if (!known)
    {
      if (!begun)
      {
        worker.baker.begin(first);
        begun = true;
      }
      worker.baker.bake(tissue, voxels, store);
    }
    voxels.clear();
  }
  worker.tissues.clear();
  baking_->flag(block).store(true, std::memory_order_release);
}

std::uint32_t RegionOnDemand::bakeAt(const Vec3i& voxel) const
{
  const Vec3i block = (region_.box.first + voxel) / recordBlock - baking_->first;
  if (!baking_->flag(block).load(std::memory_order_acquire))
  {
    bakeBlock(block);
  }
  const TissueCells cells = region_.view();
  return __atomic_load_n(cells.record + recordIndex(cells, voxel), __ATOMIC_RELAXED);
}

/// Of a voxel that has a record; 0 where it is not in the box or not baked.
std::uint32_t RegionOnDemand::knownAt(const Vec3i& volumeVoxel) const
{
  const TissueCells cells = region_.view();
  const Vec3i voxel = volumeVoxel - region_.box.first;
  return cells.contains(voxel) ? __atomic_load_n(cells.record + recordIndex(cells, voxel), __ATOMIC_RELAXED) : 0u;
}

/// Those that are not there yet.
template<class Wants>
void RegionOnDemand::bakeBlocks(const Wants& isWanted, const Progress& progress) const
{
  const Vec3i blocks = baking_->blocks;
  parallelFor(blocks.y * blocks.z, progress, [&](int row) {
    for (int x = 0; x < blocks.x; ++x)
    {
      const Vec3i block(x, row % blocks.y, row / blocks.y);
      if (isWanted(block) && !baking_->flag(block).load(std::memory_order_acquire))
      {
        bakeBlock(block);
      }
    }
  });
}

void RegionOnDemand::bakeAll(const Progress& progress) const
{
  if (baking_->all.load(std::memory_order_acquire))
  {
    return report(progress, 1.0);
  }
  bakeBlocks([](const Vec3i&) { return true; }, progress);
  baking_->all.store(true, std::memory_order_release);
}

void RegionOnDemand::bakeIn(const std::vector<LocalBall>& balls, const Progress& progress) const
{
  if (baking_->all.load(std::memory_order_acquire))
  {
    return report(progress, 1.0);
  }
  const Vec3d blockMm = double(recordBlock) * Vec3d(region_.spacing);
  const auto isNear = [&](const Vec3i& block) {
    const Vec3d lowMm = Vec3d(baking_->first + block) * blockMm;
    return std::any_of(balls.begin(), balls.end(), [&](const LocalBall& ball) {
      const Vec3d away = ball.middleMm - glm::clamp(ball.middleMm, lowMm, lowMm + blockMm);
      return glm::dot(away, away) <= ball.mm * ball.mm;
    });
  };
  bakeBlocks(isNear, progress);
}

void RegionOnDemand::bakeBeside(const RegionOnDemand& other, const std::function<bool()>& goesOn) const
{
  const Vec3i theirs = other.baking_->blocks;
  const auto bake = [&](const Vec3i& volumeBlock) {
    const Vec3i block = volumeBlock - baking_->first;
    const bool isMine =
      glm::all(glm::greaterThanEqual(block, Vec3i(0))) && glm::all(glm::lessThan(block, baking_->blocks));
    if (isMine && !baking_->flag(block).load(std::memory_order_acquire))
    {
      bakeBlock(block);
    }
  };
  for (const int away : { 0, 1 }) // what is there first, which is copied
  {
    for (int i = 0; i < theirs.x * theirs.y * theirs.z; ++i)
    {
      const Vec3i block(i % theirs.x, i / theirs.x % theirs.y, i / theirs.x / theirs.y);
      if (!other.baking_->flag(block).load(std::memory_order_acquire))
      {
        continue;
      }
      for (int n = 0; n < 27; ++n)
      {
        const Vec3i step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        if (std::max({ std::abs(step.x), std::abs(step.y), std::abs(step.z) }) != away)
        {
          continue;
        }
        if (!goesOn())
        {
          return;
        }
        bake(other.baking_->first + block + step);
      }
    }
  }
}

int RegionOnDemand::bakedBlocks() const
{
  int count = 0;
  for (const std::atomic<bool>& baked : baking_->baked)
  {
    count += baked.load(std::memory_order_relaxed) ? 1 : 0;
  }
  return count;
}

} // namespace sono
