#include "Echo/FieldSight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace sono {

namespace {

constexpr double leftOut = 2.5e-7; // of a depth's sum of squares

/// Classes of a weight in [0, 1]: four to an octave, from the bits of the number, over all exponents up to 0.
constexpr int classesAnOctaveLog2 = 2;
constexpr int classCount = 128 << classesAnOctaveLog2;

int classOf(float weight)
{
  std::uint32_t bits;
  std::memcpy(&bits, &weight, sizeof bits);
  return int(bits >> (23 - classesAnOctaveLog2));
}

/// How often a value of a mirrored axis counts in the whole beam.
double share(const FieldAxis& axis, int i)
{
  return axis.minMm == 0.0 && i > 0 ? 2.0 : 1.0;
}

/// Marks the values of a depth that count.
void markDepth(const FieldGrid& grid, const float* values, std::uint8_t* counts)
{
  std::array<double, classCount> energy{};
  double all = 0.0;
  for (int e = 0; e < grid.elevational.count; ++e)
  {
    for (int l = 0; l < grid.lateral.count; ++l)
    {
      const float w = values[e * grid.lateral.count + l];
      const double squared = share(grid.lateral, l) * share(grid.elevational, e) * double(w) * w;
      energy[std::size_t(classOf(w))] += squared;
      all += squared;
    }
  }
  int lowest = 0;
  for (double below = 0.0; lowest < classCount; ++lowest)
  {
    below += energy[std::size_t(lowest)];
    if (below > leftOut * all)
    {
      break;
    }
  }
  for (int n = 0; n < grid.lateral.count * grid.elevational.count; ++n)
  {
    counts[n] = values[n] > 0.0f && classOf(values[n]) >= lowest;
  }
}

/// Along one axis of a table [outer][count][inner]: each window's "any of them".
template<typename Window>
std::vector<std::uint8_t> anyInWindows(const std::vector<std::uint8_t>& in, std::size_t inner, std::size_t count,
                                       const std::vector<Window>& windows)
{
  const std::size_t outer = in.size() / (inner * count);
  std::vector<std::uint8_t> out(outer * windows.size() * inner, 0);
  for (std::size_t o = 0; o < outer; ++o)
  {
    for (std::size_t w = 0; w < windows.size(); ++w)
    {
      std::uint8_t* to = out.data() + (o * windows.size() + w) * inner;
      for (int i = windows[w].first; i <= windows[w].last; ++i)
      {
        const std::uint8_t* from = in.data() + (o * count + std::size_t(i)) * inner;
        std::transform(from, from + inner, to, to, [](std::uint8_t a, std::uint8_t b) { return std::uint8_t(a | b); });
      }
    }
  }
  return out;
}

} // namespace

FieldSight::FieldSight(const PulseEchoField& field, float brickEdgeMm)
  : brickMm_(brickEdgeMm)
  , marginMm_(0.5f * std::sqrt(3.0f) * brickEdgeMm)
{
  const FieldGrid& grid = field.grid();
  const std::size_t lateral = std::size_t(grid.lateral.count);
  const std::size_t plane = lateral * std::size_t(grid.elevational.count);
  seen_.resize(grid.size());
  for (std::size_t d = 0; d < std::size_t(grid.depth.count); ++d)
  {
    markDepth(grid, field.values().data() + d * plane, seen_.data() + d * plane);
  }
  lateral_ = makeBlocks(grid.lateral, false);
  elevational_ = makeBlocks(grid.elevational, false);
  depth_ = makeBlocks(grid.depth, true);
  seen_ = anyInWindows(seen_, plane, std::size_t(grid.depth.count), windows(grid.depth, depth_));
  seen_ = anyInWindows(seen_, lateral, std::size_t(grid.elevational.count), windows(grid.elevational, elevational_));
  seen_ = anyInWindows(seen_, 1, lateral, windows(grid.lateral, lateral_));
  measure();
}

void FieldSight::measure()
{
  for (std::size_t n = 0; n < seen_.size(); ++n)
  {
    if (seen_[n])
    {
      const int row = int(n / std::size_t(lateral_.count));
      lateralMm_ = std::max(lateralMm_, lateral_.furthest(int(n % std::size_t(lateral_.count))));
      elevationalMm_ = std::max(elevationalMm_, elevational_.furthest(row % elevational_.count));
    }
  }
}

SightBlocks FieldSight::makeBlocks(const FieldAxis& axis, bool isDepth) const
{
  const float slack = axis.count == 1 ? float(0.5 * axis.stepMm) : 0.0f;
  SightBlocks blocks{};
  blocks.mirrored = !isDepth && axis.minMm == 0.0;
  blocks.endless = isDepth;
  blocks.lowMm = blocks.mirrored ? 0.0f : float(axis.minMm) - slack - marginMm_;
  blocks.highMm = float(axis.maxMm()) + slack + (isDepth ? 0.0f : marginMm_);
  const float blockMm = std::max(0.5f * brickMm_, float(axis.stepMm));
  blocks.count = std::max(1, int(std::ceil((blocks.highMm - blocks.lowMm) / blockMm)));
  blocks.perMm = float(blocks.count) / (blocks.highMm - blocks.lowMm);
  return blocks;
}

/// A block's bricks reach beyond it by the margin, and their scatterers take values one step further.
std::vector<FieldSight::Window> FieldSight::windows(const FieldAxis& axis, const SightBlocks& blocks) const
{
  std::vector<Window> result;
  for (int b = 0; b < blocks.count; ++b)
  {
    const double low = blocks.lowMm + b / double(blocks.perMm) - marginMm_;
    const double high = blocks.lowMm + (b + 1) / double(blocks.perMm) + marginMm_;
    const double first = std::ceil((low - axis.minMm) / axis.stepMm - 1.001);
    const double last = std::floor((high - axis.minMm) / axis.stepMm + 1.001);
    result.push_back(
      { int(std::clamp(first, 0.0, double(axis.count - 1))), int(std::clamp(last, 0.0, double(axis.count - 1))) });
  }
  return result;
}

} // namespace sono
