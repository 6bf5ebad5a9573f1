#include "Trace/ReverberationBins.h"

#include "Core/Simd.h"

namespace sono {

namespace {

/// Calls visit(i, bin, echo) for the bins and those behind the last, whose share is 0: a rest would be gone through one
/// by one.
template<class Visit>
__attribute__((always_inline)) inline void forBins(const TissueEcho& echo, const DepthSpan& span, float binMm,
                                                   const BinSpan& bins, const Visit& visit)
{
  const TissueEcho own = echo;
  const DepthSpan within = span;
  const int first = bins.first;
  const int count = (bins.last - bins.first + binsTogether) / binsTogether * binsTogether;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i)
  {
    visit(i, first + i, echoInBin(own, within, first + i, binMm));
  }
}

} // namespace

SONO_SIMD_CLONES __attribute__((flatten)) void ownWayLevels(const TissueEcho& echo, const DepthSpan& span, float binMm,
                                                            const BinSpan& bins, std::uint32_t lineKey,
                                                            const float* cellMm, float* levels)
{
  const TissueEcho own = echo;
  forBins(own, span, binMm, bins, [=](int i, int bin, const BinEcho& inBin) {
    levels[i] = signInBin(own, inBin, lineKey, bin, cellMm[bin]) * inBin.level * inBin.share;
  });
}

SONO_SIMD_CLONES __attribute__((flatten)) void straightBackLevels(const TissueEcho& echo, const DepthSpan& span,
                                                                  float binMm, const BinSpan& bins, float* levels,
                                                                  float* powers)
{
  forBins(echo, span, binMm, bins, [=](int i, int, const BinEcho& inBin) {
    const float heard = inBin.level * heardInBin(inBin);
    levels[i] = heard * inBin.share;
    powers[i] = levels[i] * heard;
  });
}

} // namespace sono
