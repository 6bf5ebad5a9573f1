#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sono {

/// Voxels of a volume (i fastest) that follow one another.
struct VoxelRun
{
  std::uint32_t begin = 0;
  std::uint32_t count = 0;
};

/// The voxels of one structure: a thousandth of the memory of its mask.
struct VoxelRuns
{
  std::vector<VoxelRun> runs; ///< ascending; none touches the next
  std::uint64_t voxels = 0;   ///< in all of them

  /// Adds voxels behind those that are there.
  void add(std::size_t begin, std::size_t count)
  {
    voxels += count;
    if (!runs.empty() && std::size_t(runs.back().begin) + runs.back().count == begin)
    {
      runs.back().count += std::uint32_t(count);
      return;
    }
    runs.push_back({ std::uint32_t(begin), std::uint32_t(count) });
  }
};

/// A structure with the label that its voxels get, 1 to 65535.
struct Structure
{
  std::uint16_t label = 0;
  std::string name;
  VoxelRuns voxels;
};

/// Structures that were made one by one, in one label map.
struct FlattenedStructures
{
  std::vector<std::uint16_t> voxels; ///< 0 where there is none
  std::string overlap;               ///< a sentence on structures of `what` that overlap; empty: none do
};

/// Where structures overlap the one with fewer voxels wins: a vessel or a lesion within an organ is what is meant
/// there; of two of one size the later one. `voxelCount`: of the whole volume.
FlattenedStructures flattenStructures(const std::vector<Structure>& structures, std::size_t voxelCount,
                                      const std::string& what);

} // namespace sono
