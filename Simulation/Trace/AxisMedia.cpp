#include "Trace/AxisMedia.h"

#include "Core/Simd.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace sono {

namespace {

/// Where the words of places along an axis lie: the block, and the word in it; outside of the region -1.
SONO_SIMD_CLONES void findWords(const TissueCells& in, const Vec3f& from, const Vec3f& along, float stepMm, int count,
                                std::int32_t* block, std::int32_t* word)
{
  const Vec3f origin = from;
  const Vec3f axis = along;
  const Vec3f spacing = in.spacing;
  const Vec3i size = in.size;
  const Vec3i blocks = in.blocks;
  const int whole = inWholeVectors(count);
#pragma GCC ivdep
  for (int s = 0; s < whole; ++s)
  {
    const float depthMm = float(s) * stepMm;
    const std::int32_t x = std::int32_t(std::floor((origin.x + axis.x * depthMm) / spacing.x));
    const std::int32_t y = std::int32_t(std::floor((origin.y + axis.y * depthMm) / spacing.y));
    const std::int32_t z = std::int32_t(std::floor((origin.z + axis.z * depthMm) / spacing.z));
    const bool isInside = (x >= 0) & (x < size.x) & (y >= 0) & (y < size.y) & (z >= 0) & (z < size.z);
    const std::int32_t i = x + 1;
    const std::int32_t j = y + 1;
    const std::int32_t k = z + 1;
    const std::int32_t at = (i >> 2) + blocks.x * ((j >> 2) + blocks.y * (k >> 1));
    block[s] = isInside ? at : -1;
    word[s] = (i & 3) | ((j & 3) << 2) | ((k & 1) << 4);
  }
}

} // namespace

std::vector<int> mediaOnAxis(const TraceView& view, const TissueCells& cells, const TraceLine& line, float stepMm,
                             int count)
{
  const std::size_t room = std::size_t(inWholeVectors(count));
  std::vector<std::int32_t> block(room);
  std::vector<std::int32_t> word(room);
  findWords(cells, line.origin, line.axis, stepMm, count, block.data(), word.data());
  std::vector<int> media(static_cast<std::size_t>(count));
  for (std::size_t s = 0; s < media.size(); ++s)
  {
    const std::size_t at = block[s] < 0 ? 0 : (std::size_t(block[s]) << 5) | std::size_t(word[s]);
    const int tissue = int(cells.cell[at] & 255u);
    media[s] = block[s] < 0 || tissue == view.outsideTissue ? -1 : tissue;
  }
  return media;
}

} // namespace sono
