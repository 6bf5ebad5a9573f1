#include "Labels/BodyDepth.h"

#include "Core/ParallelFor.h"
#include "Labels/DistanceField.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double coarseMm = 3.0;
constexpr float deepInside = 1e3f;  // mm, for filled holes
constexpr double aheadCosine = 0.5; // of 60 degrees
constexpr double closingBeforeShallowMm = 8.0;
constexpr float halfBlockMm = float(0.5 * coarseMm); // from a block's centre to its face
constexpr std::size_t shallowSamples = 200;

/// Calls visit(neighbour) for the face neighbours of a block along the axes other than `except`.
template<class Visit>
void forNeighbours(const CoarseGrid& grid, const Vec3i& c, int except, const Visit& visit)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const int step : { -1, 1 })
    {
      Vec3i other = c;
      other[axis] += step;
      if (axis != except && other[axis] >= 0 && other[axis] < grid.size[axis])
      {
        visit(other);
      }
    }
  }
}

/// Turns what is no main part of the body to outside.
void dropSmallParts(const CoarseGrid& grid, std::vector<float>& depthMm)
{
  std::vector<char> inside(depthMm.size());
  std::transform(depthMm.begin(), depthMm.end(), inside.begin(), [](float d) { return d > 0.0f ? 1 : 0; });
  std::vector<std::vector<Vec3i>> parts;
  std::size_t largest = 0;
  forBlocks(grid, [&](const Vec3i& c) {
    if (inside[grid.index(c)])
    {
      parts.push_back(takeComponent(grid, inside, c, -1));
      largest = std::max(largest, parts.back().size());
    }
  });
  for (const std::vector<Vec3i>& part : parts)
  {
    for (const Vec3i& c : part)
    {
      float& depth = depthMm[grid.index(c)];
      depth = part.size() * 20 < largest ? -depth : depth;
    }
  }
}

/// Marks of blocks, continued beyond the border by the outermost ones.
std::vector<char> padded(const std::vector<char>& marks, const CoarseGrid& grid, const Vec3i& pad)
{
  const Vec3i wide = grid.size + pad + pad;
  std::vector<char> result;
  result.reserve(std::size_t(wide.x) * wide.y * wide.z);
  for (int k = 0; k < wide.z; ++k)
  {
    for (int j = 0; j < wide.y; ++j)
    {
      for (int i = 0; i < wide.x; ++i)
      {
        result.push_back(marks[grid.index(glm::clamp(Vec3i(i, j, k) - pad, Vec3i(0), grid.size - 1))]);
      }
    }
  }
  return result;
}

} // namespace

CoarseGrid::CoarseGrid(const GridPlacement& fine)
  : factor(glm::max(Vec3i(glm::round(coarseMm / fine.spacingMm)), Vec3i(1)))
  , size((fine.size + factor - 1) / factor)
  , spacingMm(fine.spacingMm * Vec3d(factor))
{
}

std::vector<Vec3i> takeComponent(const CoarseGrid& grid, std::vector<char>& wanted, const Vec3i& seed, int exceptAxis)
{
  std::vector<Vec3i> members{ seed };
  wanted[grid.index(seed)] = 0;
  for (std::size_t next = 0; next < members.size(); ++next)
  {
    forNeighbours(grid, Vec3i(members[next]), exceptAxis, [&](const Vec3i& other) {
      char& mark = wanted[grid.index(other)];
      if (mark)
      {
        mark = 0;
        members.push_back(other);
      }
    });
  }
  return members;
}

void fillSliceHoles(const GridPlacement& fine, const CoarseGrid& grid, std::vector<char>& inside)
{
  int axial = 0;
  for (int axis = 1; axis < 3; ++axis)
  {
    axial = std::abs(fine.direction[axis].z) > std::abs(fine.direction[axial].z) ? axis : axial;
  }
  std::vector<char> hole(inside.size());
  std::transform(inside.begin(), inside.end(), hole.begin(), [](char mark) { return mark ? 0 : 1; });
  forBlocks(grid, [&](const Vec3i& c) {
    bool border = false;
    for (int axis = 0; axis < 3; ++axis)
    {
      border = border || (axis != axial && (c[axis] == 0 || c[axis] == grid.size[axis] - 1));
    }
    if (border && hole[grid.index(c)])
    {
      takeComponent(grid, hole, c, axial);
    }
  });
  std::transform(hole.begin(), hole.end(), inside.begin(), inside.begin(), [](char h, char mark) { return h | mark; });
}

BodyDepth::BodyDepth(const GridPlacement& fine, const std::vector<char>& known, const BodyEstimate& estimate)
  : grid_(fine)
{
  // Grown by closing and wall, then shrunk by the closing, with room for it on all sides. That distances are between
  // blocks' centres, not faces, cancels out: half a block too far both ways.
  const double grownMm = estimate.closingMm + estimate.wallMm;
  const Vec3i pad = Vec3i(glm::ceil(grownMm / grid_.spacingMm)) + 2;
  const Vec3i wide = grid_.size + pad + pad;
  const std::vector<float> toLabels = distanceTo(padded(known, grid_, pad), wide, grid_.spacingMm);
  std::vector<char> beyond(toLabels.size());
  std::transform(toLabels.begin(), toLabels.end(), beyond.begin(),
                 [&](float d) { return double(d) > grownMm ? 1 : 0; });
  const std::vector<float> fromBeyond = distanceTo(beyond, wide, grid_.spacingMm);
  depthMm_.resize(grid_.count());
  forBlocks(grid_, [&](const Vec3i& c) {
    const Vec3i w = c + pad;
    const std::size_t at = std::size_t(w.x) + std::size_t(wide.x) * (std::size_t(w.y) + std::size_t(wide.y) * w.z);
    depthMm_[grid_.index(c)] = fromBeyond[at] - float(estimate.closingMm);
  });
  dropSmallParts(grid_, depthMm_);
  std::vector<char> inside(depthMm_.size());
  std::transform(depthMm_.begin(), depthMm_.end(), inside.begin(), [](float d) { return d > 0.0f ? 1 : 0; });
  fillSliceHoles(fine, grid_, inside);
  for (std::size_t n = 0; n < depthMm_.size(); ++n)
  {
    depthMm_[n] = inside[n] && !(depthMm_[n] > 0.0f) ? deepInside : depthMm_[n];
  }
  openBefore(fine, known, estimate);
  alongX_ = interpolation(fine.size.x, grid_.factor.x, grid_.size.x);
  alongY_ = interpolation(fine.size.y, grid_.factor.y, grid_.size.y);
  alongZ_ = interpolation(fine.size.z, grid_.factor.z, grid_.size.z);
}

/// Takes off what a wide closing bridged before the shallow blocks.
void BodyDepth::openBefore(const GridPlacement& fine, const std::vector<char>& known, const BodyEstimate& estimate)
{
  std::vector<Vec3d> places;
  for (std::size_t n = 0; n < estimate.shallow.size(); ++n)
  {
    if (estimate.shallow[n])
    {
      const std::size_t row = n / std::size_t(grid_.size.x);
      places.push_back(grid_.spacingMm *
                       Vec3d(n % std::size_t(grid_.size.x), row % std::size_t(grid_.size.y), row / grid_.size.y));
    }
  }
  if (places.empty())
  {
    return;
  }
  const std::size_t every = (places.size() + shallowSamples - 1) / shallowSamples;
  const Vec3d ahead = glm::transpose(fine.direction) * Vec3d(0.0, -1.0, 0.0);
  const BodyDepth tight(fine, known, { std::min(estimate.closingMm, closingBeforeShallowMm), estimate.wallMm });
  std::vector<char> open(depthMm_.size(), 0);
  parallelFor(grid_.size.z, {}, [&](int k) {
    for (int j = 0; j < grid_.size.y; ++j)
    {
      for (int i = 0; i < grid_.size.x; ++i)
      {
        const std::size_t at = grid_.index({ i, j, k });
        const bool isBridge = depthMm_[at] > 0.0f && !(tight.depthMm_[at] > 0.0f);
        for (std::size_t n = 0; isBridge && n < places.size() && !open[at]; n += every)
        {
          const Vec3d way = grid_.spacingMm * Vec3d(i, j, k) - places[n];
          open[at] = glm::dot(way, ahead) > aheadCosine * glm::length(way) ? 1 : 0;
        }
      }
    }
  });
  const std::vector<float> toOpen = distanceTo(open, grid_.size, grid_.spacingMm);
  for (std::size_t n = 0; n < depthMm_.size(); ++n)
  {
    depthMm_[n] = open[n] ? std::min(tight.depthMm_[n], 0.0f) : std::min(depthMm_[n], toOpen[n] - halfBlockMm);
  }
}

std::vector<BodyDepth::Between> BodyDepth::interpolation(int fineSize, int factor, int coarseSize)
{
  std::vector<Between> list;
  for (int i = 0; i < fineSize; ++i)
  {
    const double at = (i + 0.5) / factor - 0.5;
    const double clamped = std::clamp(at, 0.0, double(coarseSize - 1));
    const int low = std::min(int(clamped), std::max(0, coarseSize - 2));
    list.push_back({ low, std::min(low + 1, coarseSize - 1), float(clamped - low) });
  }
  return list;
}

void BodyDepth::ofRow(int j, int k, std::vector<float>& depthMm) const
{
  const Between& y = alongY_[std::size_t(j)];
  const Between& z = alongZ_[std::size_t(k)];
  std::vector<float> row(std::size_t(grid_.size.x));
  for (int i = 0; i < grid_.size.x; ++i)
  {
    const auto at = [&](int cj, int ck) { return depthMm_[grid_.index({ i, cj, ck })]; };
    const float below = at(y.low, z.low) + y.share * (at(y.high, z.low) - at(y.low, z.low));
    const float above = at(y.low, z.high) + y.share * (at(y.high, z.high) - at(y.low, z.high));
    row[std::size_t(i)] = below + z.share * (above - below);
  }
  depthMm.resize(alongX_.size());
  for (std::size_t i = 0; i < alongX_.size(); ++i)
  {
    const Between& x = alongX_[i];
    const float low = row[std::size_t(x.low)];
    depthMm[i] = low + x.share * (row[std::size_t(x.high)] - low);
  }
}

} // namespace sono
