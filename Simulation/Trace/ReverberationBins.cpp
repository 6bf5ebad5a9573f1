#include "Trace/ReverberationBins.h"

#include "Core/Simd.h"

namespace sono {

namespace {

/// With those behind the last, whose share is 0: a rest would be gone through one by one.
int countOf(const BinSpan& bins)
{
  return (bins.last - bins.first + binsTogether) / binsTogether * binsTogether;
}

} // namespace

SONO_SIMD_CLONES __attribute__((flatten)) void ownWayLevels(const TissueEcho& echo, const DepthSpan& span, float binMm,
                                                            const BinSpan& bins, std::uint32_t lineKey,
                                                            const float* cellMm, float* levels)
{
  const TissueEcho own = echo;
  const DepthSpan within = span;
  const int first = bins.first;
  const int count = countOf(bins);
#pragma GCC ivdep
  for (int i = 0; i < count; ++i)
  {
    const BinEcho inBin = echoInBin(own, within, first + i, binMm);
    levels[i] = signInBin(own, inBin, lineKey, first + i, cellMm[first + i]) * inBin.level * inBin.share;
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void straightBackLevels(const TissueEcho& echo, const DepthSpan& span,
                                                                  float binMm, const BinSpan& bins, float* levels,
                                                                  float* powers)
{
  const TissueEcho straight = echo;
  const DepthSpan within = span;
  const int first = bins.first;
  const int count = countOf(bins);
#pragma GCC ivdep
  for (int i = 0; i < count; ++i)
  {
    const BinEcho inBin = echoInBin(straight, within, first + i, binMm);
    const float heard = inBin.level * heardInBin(inBin);
    levels[i] = heard * inBin.share;
    powers[i] = levels[i] * heard;
  }
}

} // namespace sono
