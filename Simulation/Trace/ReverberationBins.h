#pragma once

#include "Kernel/Reverberation.h"

#include <cstdint>

namespace sono {

/// What an echo leaves in the bins that its span covers, by the formulas of Kernel/Reverberation.h, in vectors.
/// `levels` and `powers` begin with that of the first bin. Bins come so many at a time, the rest of which lie behind
/// the last: they are written, too, and of `cellMm` read.
constexpr int binsTogether = 8;

/// Of an own way: its level times the share of the bin that it covers, negative where its tissue's sign is.
/// `cellMm` is that of bin 0 and those behind.
void ownWayLevels(const TissueEcho& echo, const DepthSpan& span, float binMm, const BinSpan& bins,
                  std::uint32_t lineKey, const float* cellMm, float* levels);
/// Straight back: what is heard of its level times the share, and of its power.
void straightBackLevels(const TissueEcho& echo, const DepthSpan& span, float binMm, const BinSpan& bins, float* levels,
                        float* powers);

} // namespace sono
