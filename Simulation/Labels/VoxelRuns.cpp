#include "Labels/VoxelRuns.h"

#include "Core/LargeMemory.h"

#include <algorithm>
#include <numeric>

namespace sono {

namespace {

const std::string& nameOf(const std::vector<Structure>& structures, std::uint16_t label)
{
  return std::find_if(structures.begin(), structures.end(), [&](const Structure& s) { return s.label == label; })->name;
}

} // namespace

FlattenedStructures flattenStructures(const std::vector<Structure>& structures, std::size_t voxelCount,
                                      const std::string& what)
{
  std::vector<std::size_t> largestFirst(structures.size());
  std::iota(largestFirst.begin(), largestFirst.end(), std::size_t(0));
  std::stable_sort(largestFirst.begin(), largestFirst.end(), [&](std::size_t a, std::size_t b) {
    return structures[a].voxels.voxels > structures[b].voxels.voxels;
  });

  FlattenedStructures flat;
  flat.voxels = largeVector<std::uint16_t>(voxelCount);
  std::size_t covered = 0;
  std::uint16_t below = 0; // of the first overlap
  std::uint16_t above = 0;
  for (const std::size_t n : largestFirst)
  {
    for (const VoxelRun& run : structures[n].voxels.runs)
    {
      const auto first = flat.voxels.begin() + std::ptrdiff_t(run.begin);
      const auto last = first + std::ptrdiff_t(run.count);
      const std::size_t here = run.count - std::size_t(std::count(first, last, std::uint16_t(0)));
      if (here > 0 && covered == 0)
      {
        below = *std::find_if(first, last, [](std::uint16_t label) { return label != 0; });
        above = structures[n].label;
      }
      covered += here;
      std::fill(first, last, structures[n].label);
    }
  }
  if (covered > 0)
  {
    flat.overlap = "Structures of " + what + " overlap in " + std::to_string(covered) + " voxels (as '" +
                   nameOf(structures, below) + "' and '" + nameOf(structures, above) +
                   "' do); there the one with fewer voxels counts.";
  }
  return flat;
}

} // namespace sono
