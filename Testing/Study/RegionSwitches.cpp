#include "RegionSwitches.h"

#include "Trace/TraceSetup.h"

#include <algorithm>

namespace sono::study {

namespace {

/// The cache that trace() will use. Nobody else holds it here.
TraceRegion& regionOf(const BenchScene& bench)
{
  const TraceSetup setup(*bench.scene, bench.lines, bench.tracing, {}, {});
  return const_cast<TraceRegion&>(*setup.region);
}

} // namespace

void removeSurfaces(const BenchScene& bench)
{
  std::vector<std::uint32_t>& records = regionOf(bench).record;
  std::fill(records.begin(), records.end(), 0u);
}

void removeSkips(const BenchScene& bench)
{
  for (std::uint16_t& word : regionOf(bench).cell)
  {
    const bool skips = (word & 0x8000u) == 0u && word != TissueCells::outsideWord;
    word = skips ? std::uint16_t(word & 255u) : word;
  }
}

} // namespace sono::study
