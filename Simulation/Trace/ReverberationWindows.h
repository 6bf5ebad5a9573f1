#pragma once

#include "Kernel/TraceView.h"
#include "Trace/TracedReverberation.h"

#include <array>
#include <cstddef>
#include <vector>

namespace sono {

/// ReverberationAround of each of the TissueBins of lines, each of its sums side by side along a line.
class ReverberationRows
{
public:
  static constexpr int sums = 5; ///< in the order of ReverberationAround

  ReverberationRows() = default;
  ReverberationRows(int lines, int bins)
    : bins_(bins)
    , values_(std::size_t(lines) * sums * std::size_t(bins))
  {
  }
  int bins() const { return bins_; }
  int lines() const { return bins_ == 0 ? 0 : int(values_.size() / (sums * std::size_t(bins_))); }
  float* row(int line, int sum) { return values_.data() + first(line, sum); }
  const float* row(int line, int sum) const { return values_.data() + first(line, sum); }
  ReverberationAround at(int line, int bin) const
  {
    const float* of = row(line, 0) + bin;
    const std::size_t n = std::size_t(bins_);
    return { of[0], of[n], of[2 * n], of[3 * n], of[4 * n] };
  }
  void set(int line, int bin, const ReverberationAround& around)
  {
    float* of = row(line, 0) + bin;
    for (const float value : sumsOf(around))
    {
      *of = value;
      of += bins_;
    }
  }
  static std::array<float, sums> sumsOf(const ReverberationAround& around)
  {
    return { around.cellPower, around.power, around.chance, around.straightPower, around.straightWeight };
  }

private:
  std::size_t first(int line, int sum) const
  {
    return (std::size_t(line) * sums + std::size_t(sum)) * std::size_t(bins_);
  }

  int bins_ = 0;
  std::vector<float> values_;
};

// The windows of TracedReverberation.h for all bins of a line at once, in vectors: the same sums in the same order.

/// sumAlongLine: from line `from` of `inBin` to line `to` of `along`.
void sumAlongLine(const ReverberationRows& inBin, int from, float tissueBinMm, ReverberationRows& along, int to);
/// sumOverLines, of all lines.
void sumOverLines(const ReverberationRows& along, int line, ReverberationRows& around);
/// sumFurther, of all lines, into the one line of `further`.
void sumFurther(const ReverberationRows& around, int line, float tissueBinMm, ReverberationRows& further);
/// reverberationLevel of a line's bins; `own` and `levels` are the line's as well, `further` has one line.
void reverberationLevels(const TraceView& view, const TraceLine& axis, float tissueBinMm,
                         const ReverberationRows& around, int line, const ReverberationRows& further, const float* own,
                         float* levels);

} // namespace sono
