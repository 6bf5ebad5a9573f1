#include "Labels/BodyFill.h"

#include "Core/ParallelFor.h"
#include "Labels/DistanceField.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace sono {

namespace {

constexpr double coarseMm = 3.0;
constexpr float deepInside = 1e3f; // mm, for filled holes

/// Blocks of voxels, each about coarseMm long.
struct CoarseGrid
{
  Vec3i factor{ 1, 1, 1 };
  Vec3i size{ 0, 0, 0 };
  Vec3d spacingMm{ 1.0, 1.0, 1.0 };

  explicit CoarseGrid(const GridPlacement& fine)
    : factor(glm::max(Vec3i(glm::round(coarseMm / fine.spacingMm)), Vec3i(1)))
    , size((fine.size + factor - 1) / factor)
    , spacingMm(fine.spacingMm * Vec3d(factor))
  {
  }
  std::size_t index(const Vec3i& c) const
  {
    return std::size_t(c.x) + std::size_t(size.x) * (std::size_t(c.y) + std::size_t(size.y) * c.z);
  }
  std::size_t count() const { return std::size_t(size.x) * size.y * size.z; }
};

/// Blocks that are labelled for the most part: a speck of one voxel does not count.
std::vector<char> labelledBlocks(const LabelVolume& volume, const CoarseGrid& grid)
{
  std::vector<char> labelled(grid.count());
  const Vec3i n = volume.placement.size;
  parallelFor(grid.size.z, {}, [&](int ck) {
    std::vector<int> balance(std::size_t(grid.size.x) * grid.size.y, 0);
    for (int k = ck * grid.factor.z; k < std::min(n.z, (ck + 1) * grid.factor.z); ++k)
    {
      for (int j = 0; j < n.y; ++j)
      {
        const std::uint16_t* row = volume.voxels.data() + std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k);
        int* to = balance.data() + std::size_t(j / grid.factor.y) * grid.size.x;
        for (int i = 0; i < n.x; ++i)
        {
          to[i / grid.factor.x] += row[i] != 0 ? 1 : -1;
        }
      }
    }
    std::transform(balance.begin(), balance.end(), labelled.begin() + std::ptrdiff_t(balance.size()) * ck,
                   [](int b) { return b > 0 ? 1 : 0; });
  });
  return labelled;
}

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

/// The connected blocks with wanted[i] != 0 around a seed; their marks are taken off.
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

template<class Visit>
void forBlocks(const CoarseGrid& grid, const Visit& visit)
{
  for (int k = 0; k < grid.size.z; ++k)
  {
    for (int j = 0; j < grid.size.y; ++j)
    {
      for (int i = 0; i < grid.size.x; ++i)
      {
        visit(Vec3i(i, j, k));
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

/// Turns outside that touches no border of its slice to inside.
void fillSliceHoles(const CoarseGrid& grid, int axialAxis, std::vector<float>& depthMm)
{
  std::vector<char> outside(depthMm.size());
  std::transform(depthMm.begin(), depthMm.end(), outside.begin(), [](float d) { return d > 0.0f ? 0 : 1; });
  forBlocks(grid, [&](const Vec3i& c) {
    bool border = false;
    for (int axis = 0; axis < 3; ++axis)
    {
      border = border || (axis != axialAxis && (c[axis] == 0 || c[axis] == grid.size[axis] - 1));
    }
    if (border && outside[grid.index(c)])
    {
      takeComponent(grid, outside, c, axialAxis);
    }
  });
  for (std::size_t n = 0; n < depthMm.size(); ++n)
  {
    depthMm[n] = outside[n] ? deepInside : depthMm[n];
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

/// Depth below the body's estimated surface at the blocks' centres, negative outside.
std::vector<float> bodyDepth(const LabelVolume& volume, const CoarseGrid& grid, const BodyFillSettings& settings)
{
  // Grown by closing and wall, then shrunk by the closing, with room for it on all sides. That distances are between
  // blocks' centres, not faces, cancels out: half a block too far both ways.
  const double grownMm = settings.closingMm + settings.wallMm;
  const Vec3i pad = Vec3i(glm::ceil(grownMm / grid.spacingMm)) + 2;
  const Vec3i wide = grid.size + pad + pad;
  const std::vector<float> toLabels = distanceTo(padded(labelledBlocks(volume, grid), grid, pad), wide, grid.spacingMm);
  std::vector<char> beyond(toLabels.size());
  std::transform(toLabels.begin(), toLabels.end(), beyond.begin(),
                 [&](float d) { return double(d) > grownMm ? 1 : 0; });
  const std::vector<float> fromBeyond = distanceTo(beyond, wide, grid.spacingMm);
  std::vector<float> depth(grid.count());
  forBlocks(grid, [&](const Vec3i& c) {
    const Vec3i w = c + pad;
    const std::size_t at = std::size_t(w.x) + std::size_t(wide.x) * (std::size_t(w.y) + std::size_t(wide.y) * w.z);
    depth[grid.index(c)] = fromBeyond[at] - float(settings.closingMm);
  });
  dropSmallParts(grid, depth);
  int axial = 0;
  for (int axis = 1; axis < 3; ++axis)
  {
    const Mat3d& direction = volume.placement.direction;
    axial = std::abs(direction[axis].z) > std::abs(direction[axial].z) ? axis : axial;
  }
  fillSliceHoles(grid, axial, depth);
  return depth;
}

/// Linear interpolation weights of one axis: the block below a voxel's centre and the share of the one above.
struct Between
{
  int low;
  int high;
  float share;
};

std::vector<Between> interpolation(int fineSize, int factor, int coarseSize)
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

/// Two ids that no label has, the smallest above all others where there are such.
std::pair<int, int> freeIds(const LabelVolume& volume)
{
  std::vector<int> ids;
  const int highest = volume.labels.back().id;
  for (int id = highest + 1; id <= 65535 && ids.size() < 2; ++id)
  {
    ids.push_back(id);
  }
  for (int id = 1; id <= highest && ids.size() < 2; ++id)
  {
    if (!volume.find(id))
    {
      ids.push_back(id);
    }
  }
  if (ids.size() < 2)
  {
    throw Error("body fill: the label map uses all ids; merge some labels.");
  }
  return { ids[0], ids[1] };
}

void nameLabel(LabelVolume& volume, int id, const std::string& name, const std::array<float, 3>& color)
{
  LabelInfo label;
  label.id = id;
  label.name = name;
  label.color = color;
  label.hasColor = true;
  volume.labels.push_back(std::move(label));
}

} // namespace

BodyFill fillBody(LabelVolume& volume, const BodyFillSettings& settings, const Progress& progress)
{
  requireInRange(settings);
  volume.collectLabels();
  if (volume.labels.empty() || volume.labels.back().id == 0)
  {
    throw Error("body fill: the label map holds nothing but 0; choose a segmentation.");
  }
  BodyFill fill;
  std::tie(fill.skinId, fill.softTissueId) = freeIds(volume);

  const CoarseGrid grid(volume.placement);
  const std::vector<float> depth = bodyDepth(volume, grid, settings);
  report(progress, 0.5);

  const Vec3i n = volume.placement.size;
  const auto alongX = interpolation(n.x, grid.factor.x, grid.size.x);
  const auto alongY = interpolation(n.y, grid.factor.y, grid.size.y);
  const auto alongZ = interpolation(n.z, grid.factor.z, grid.size.z);
  std::atomic<std::size_t> skin{ 0 };
  std::atomic<std::size_t> soft{ 0 };
  const Progress filling = partOf(progress, 0.5, 1.0);
  LabelVolume filled = volume; // so that a stop leaves the volume as it was
  parallelFor(n.z, filling, [&](int k) {
    std::vector<float> row(std::size_t(grid.size.x));
    std::size_t skinHere = 0;
    std::size_t softHere = 0;
    const Between& z = alongZ[std::size_t(k)];
    for (int j = 0; j < n.y; ++j)
    {
      const Between& y = alongY[std::size_t(j)];
      for (int i = 0; i < grid.size.x; ++i)
      {
        const auto at = [&](int cj, int ck) { return depth[grid.index({ i, cj, ck })]; };
        const float below = at(y.low, z.low) + y.share * (at(y.high, z.low) - at(y.low, z.low));
        const float above = at(y.low, z.high) + y.share * (at(y.high, z.high) - at(y.low, z.high));
        row[std::size_t(i)] = below + z.share * (above - below);
      }
      std::uint16_t* voxel = filled.voxels.data() + std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k);
      for (int i = 0; i < n.x; ++i)
      {
        const Between& x = alongX[std::size_t(i)];
        const float low = row[std::size_t(x.low)];
        const float here = low + x.share * (row[std::size_t(x.high)] - low);
        if (voxel[i] == 0 && here > 0.0f)
        {
          const bool isSkin = double(here) <= settings.skinMm;
          voxel[i] = std::uint16_t(isSkin ? fill.skinId : fill.softTissueId);
          ++(isSkin ? skinHere : softHere);
        }
      }
    }
    skin += skinHere;
    soft += softHere;
  });
  fill.skinVoxels = skin;
  fill.softTissueVoxels = soft;
  nameLabel(filled, fill.skinId, "skin", { 0.87f, 0.68f, 0.55f });
  nameLabel(filled, fill.softTissueId, "soft_tissue", { 0.78f, 0.5f, 0.45f });
  filled.collectLabels();
  volume = std::move(filled);
  return fill;
}

} // namespace sono
