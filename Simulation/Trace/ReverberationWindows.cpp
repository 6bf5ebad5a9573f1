#include "Trace/ReverberationWindows.h"

#include "Core/Simd.h"

#include <algorithm>

namespace sono {

namespace {

/// to[b] += by from[b + ahead], as far as there is such a bin.
SONO_SIMD_CLONES void addAhead(const float* values, int count, int ahead, float by, float* sums)
{
  const int last = std::min(count, count - ahead);
  const float* from = values;
  float* to = sums;
#pragma GCC ivdep
  for (int b = std::max(0, -ahead); b < last; ++b)
  {
    to[b] += by * from[b + ahead];
  }
}

/// Adds a line's bins so far ahead to those of another.
void addLine(const ReverberationRows& from, int line, int ahead, float by, float byStraight, ReverberationRows& to,
             int toLine)
{
  ReverberationAround ofOnes;
  ofOnes.add({ 1.0f, 1.0f, 1.0f, 1.0f, 1.0f }, by, byStraight);
  const auto weights = ReverberationRows::sumsOf(ofOnes);
  for (int sum = 0; sum < ReverberationRows::sums; ++sum)
  {
    const float weight = weights[std::size_t(sum)];
    if (weight > 0.0f)
    {
      addAhead(from.row(line, sum), from.bins(), ahead, weight, to.row(toLine, sum));
    }
  }
}

} // namespace

void sumAlongLine(const ReverberationRows& inBin, int from, float tissueBinMm, ReverberationRows& along, int to)
{
  const WindowAlong window(tissueBinMm);
  for (int ahead = -window.reach; ahead <= window.reach; ++ahead)
  {
    addLine(inBin, from, ahead, weightAround(ahead, window.reach), weightAround(ahead, window.straightReach), along,
            to);
  }
}

void sumOverLines(const ReverberationRows& along, int line, ReverberationRows& around)
{
  for (int l = std::max(0, line - linesAround); l < along.lines() && l <= line + linesAround; ++l)
  {
    const float weight = weightAround(l - line, linesAround);
    addLine(along, l, 0, weight, weight, around, line);
  }
}

void sumFurther(const ReverberationRows& around, int line, float tissueBinMm, ReverberationRows& further)
{
  const WindowsFurther windows(tissueBinMm);
  for (int l = line - windows.lines; l <= line + windows.lines; l += linesAround)
  {
    for (int ahead = -windows.bins; ahead <= windows.bins && l >= 0 && l < around.lines(); ahead += windows.step)
    {
      addLine(around, l, ahead, 1.0f, 1.0f, further, 0);
    }
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void reverberationLevels(const TraceView& view, const TraceLine& axis,
                                                                   float tissueBinMm, const ReverberationRows& around,
                                                                   int line, const ReverberationRows& further,
                                                                   const float* own, float* levels)
{
  const float* const ownLevel = own;
  float* const level = levels;
  const int count = around.bins();
#pragma GCC ivdep
  for (int b = 0; b < count; ++b)
  {
    const float unspread = resolutionCell(view, axis, (float(b) + 0.5f) * tissueBinMm).unspread;
    level[b] = reverberationLevel(around.at(line, b), further.at(0, b), unspread, ownLevel[b]);
  }
}

} // namespace sono
