#include "Probe/WindowGrid.h"

#include "Core/Error.h"
#include "Core/ParallelFor.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace sono {
namespace {

constexpr double wantedCellMm = 2.5;
constexpr double borderMm = 6.0;          // a surface so close to the border may be that of a cut
constexpr double estimateBorderMm = 15.0; // beside a cut a body fill guesses
constexpr double mostOfBox = 0.2;
constexpr double wayOutMm = 40.0; // as much too deep may a part of a body have its skin
constexpr double placesMm = 8.0;
constexpr double skinDepthMm = 5.0;
constexpr double normalRadiiMm[] = { 6.0, 12.0 };
constexpr int normalDirections = 200;
constexpr double pointRadiusMm = 15.0; // of what is around a point
constexpr int sectionDirections = 64;

} // namespace

Vec3d evenDirection(int i, int count)
{
  const double z = 1.0 - (2.0 * i + 1.0) / count;
  const double turn = i * 3.14159265358979323846 * (3.0 - std::sqrt(5.0));
  const double r = std::sqrt(1.0 - z * z);
  return { r * std::cos(turn), r * std::sin(turn), z };
}

WindowGrid::WindowGrid(const Scene& scene, const WindowTarget& target)
  : scene_(scene)
  , factor_(glm::max(Vec3i(glm::round(wantedCellMm / scene.placement().spacingMm)), Vec3i(1)))
  , size_((scene.placement().size + factor_ - 1) / factor_)
  , cellMm_(scene.placement().spacingMm * Vec3d(factor_))
  , perCellMm_(1.0 / cellMm_)
  , boxMm_(scene.placement().spacingMm * Vec3d(scene.placement().size))
  , stepMm_(0.7 * std::min({ cellMm_.x, cellMm_.y, cellMm_.z }))
{
  const auto has = [&](const char* name) {
    const auto& labels = scene.volume().labels;
    return std::any_of(labels.begin(), labels.end(), [&](const LabelInfo& label) { return label.name == name; });
  };
  const bool isEstimate = has("skin") && has("soft_tissue"); // the names that fillBody gives
  borderMm_ = isEstimate ? glm::clamp(mostOfBox * boxMm_, borderMm, estimateBorderMm) : Vec3d(borderMm);
  sample(target);
  if (target.pointMm)
  {
    markTargetPoint(*target.pointMm);
  }
  findOuter();
  isCutEstimate_ = isEstimate && meetsBorder();
  measureTarget();
  if (target.pointMm)
  {
    targetMiddle_ = scene.localFromWorld(*target.pointMm);
  }
}

void WindowGrid::sample(const WindowTarget& target)
{
  std::vector<char> wanted(65536, 0);
  for (const int id : target.labels)
  {
    wanted[std::size_t(id)] = 1;
  }
  const auto& tissues = scene_.tissues();
  const auto skin = std::find_if(tissues.begin(), tissues.end(), [](const Tissue& t) { return t.name == "skin"; });
  skinTissue_ = skin == tissues.end() ? -1 : int(skin - tissues.begin());
  const Vec3i n = scene_.placement().size;
  const std::size_t count = std::size_t(size_.x) * size_.y * size_.z;
  tissue_.resize(count);
  target_.resize(count);
  parallelFor(size_.z, {}, [&](int k) {
    for (int j = 0; j < size_.y; ++j)
    {
      for (int i = 0; i < size_.x; ++i)
      {
        const Vec3i v = glm::min(Vec3i(i, j, k) * factor_ + factor_ / 2, n - 1);
        const std::size_t voxel = (std::size_t(v.z) * n.y + v.y) * n.x + v.x;
        const std::size_t cell = index({ i, j, k });
        tissue_[cell] = scene_.tissueVoxels()[voxel];
        target_[cell] = wanted[scene_.volume().voxels[voxel]];
      }
    }
  });
}

Vec2d WindowGrid::rangeWithin(const Vec3d& from, const Vec3d& axis, const Vec3d& lowMm, const Vec3d& highMm)
{
  Vec2d range(0.0, 1e6);
  for (int a = 0; a < 3; ++a)
  {
    if (axis[a] == 0.0)
    {
      range.y = from[a] < lowMm[a] || from[a] > highMm[a] ? -1e6 : range.y;
      continue;
    }
    const double one = (lowMm[a] - from[a]) / axis[a];
    const double other = (highMm[a] - from[a]) / axis[a];
    range = { std::max(range.x, std::min(one, other)), std::min(range.y, std::max(one, other)) };
  }
  return range;
}

void WindowGrid::markTargetPoint(const Vec3d& pointMm)
{
  const Vec3d point = scene_.localFromWorld(pointMm);
  for (int k = 0; k < size_.z && isInside(point); ++k)
  {
    for (int j = 0; j < size_.y; ++j)
    {
      for (int i = 0; i < size_.x; ++i)
      {
        const std::size_t cell = index({ i, j, k });
        const bool isBody = tissue_[cell] != scene_.outsideIndex();
        target_[cell] = isBody && glm::distance(centre({ i, j, k }), point) < pointRadiusMm;
      }
    }
  }
}

/// Air that is connected with the border.
void WindowGrid::findOuter()
{
  outer_.assign(tissue_.size(), 0);
  std::vector<Vec3i> next;
  const auto take = [&](const Vec3i& c) {
    char& mark = outer_[index(c)];
    if (!mark && tissue_[index(c)] == scene_.outsideIndex())
    {
      mark = 1;
      next.push_back(c);
    }
  };
  for (int k = 0; k < size_.z; ++k)
  {
    for (int j = 0; j < size_.y; ++j)
    {
      const bool whole = k == 0 || k == size_.z - 1 || j == 0 || j == size_.y - 1;
      for (int i = 0; i < size_.x; i += whole ? 1 : std::max(1, size_.x - 1))
      {
        take({ i, j, k });
      }
    }
  }
  while (!next.empty())
  {
    const Vec3i c = next.back();
    next.pop_back();
    for (int axis = 0; axis < 3; ++axis)
    {
      for (const int step : { -1, 1 })
      {
        Vec3i other = c;
        other[axis] += step;
        if (other[axis] >= 0 && other[axis] < size_[axis])
        {
          take(other);
        }
      }
    }
  }
}

/// Whether the body does: it was cut there.
bool WindowGrid::meetsBorder() const
{
  const Vec3i last = size_ - 1;
  for (std::size_t cell = 0; cell < outer_.size(); ++cell)
  {
    const Vec3i c(int(cell % std::size_t(size_.x)), int(cell / std::size_t(size_.x) % std::size_t(size_.y)),
                  int(cell / (std::size_t(size_.x) * size_.y)));
    if (!outer_[cell] && (glm::any(glm::equal(c, Vec3i(0))) || glm::any(glm::equal(c, last))))
    {
      return true;
    }
  }
  return false;
}

void WindowGrid::measureTarget()
{
  Vec3d sum(0.0);
  for (int k = 0; k < size_.z; ++k)
  {
    for (int j = 0; j < size_.y; ++j)
    {
      for (int i = 0; i < size_.x; ++i)
      {
        if (target_[index({ i, j, k })])
        {
          targetCentres_.push_back(centre({ i, j, k }));
          sum += targetCentres_.back();
        }
      }
    }
  }
  if (targetCentres_.empty())
  {
    return;
  }
  targetMiddle_ = sum / double(targetCentres_.size());
  // Cells weigh less the further they are from the plane, lest it count which of their layers a slab's faces cut.
  const double reachMm = 2.0 * std::max({ cellMm_.x, cellMm_.y, cellMm_.z });
  const double areaMm2 = cellMm_.x * cellMm_.y * cellMm_.z / reachMm;
  std::vector<double> areas(sectionDirections);
  parallelFor(sectionDirections, {}, [&](int i) {
    const Vec3d normal = evenDirection(i, 2 * sectionDirections); // the first half is one hemisphere
    double weights = 0.0;
    for (const Vec3d& cell : targetCentres_)
    {
      weights += std::max(0.0, 1.0 - std::abs(glm::dot(cell - targetMiddle_, normal)) / reachMm);
    }
    areas[std::size_t(i)] = areaMm2 * weights;
  });
  targetAreaMm2_ = std::max(areaMm2, *std::max_element(areas.begin(), areas.end()));
}

/// A cell of the body beside air, not where a cut may be.
bool WindowGrid::isSurface(const Vec3i& cell) const
{
  const Vec3d at = centre(cell);
  if (outer_[index(cell)] || glm::any(glm::lessThan(glm::min(at, boxMm_ - at), borderMm_)))
  {
    return false;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const int step : { -1, 1 })
    {
      Vec3i other = cell;
      other[axis] = std::clamp(other[axis] + step, 0, size_[axis] - 1);
      if (outer_[index(other)])
      {
        return true;
      }
    }
  }
  return false;
}

/// What lies beyond the border is not known.
Vec3d WindowGrid::outwardNormal(const Vec3d& local) const
{
  static const std::vector<Vec3d> directions = [] {
    std::vector<Vec3d> made;
    for (int i = 0; i < normalDirections; ++i)
    {
      made.push_back(evenDirection(i, normalDirections));
    }
    return made;
  }();
  Vec3d sum(0.0);
  for (const double radiusMm : normalRadiiMm)
  {
    for (const Vec3d& offset : directions)
    {
      const Vec3d place = local + radiusMm * offset;
      if (isInside(place))
      {
        sum += isOuter(at(place)) ? offset : -offset;
      }
    }
  }
  const double length = glm::length(sum);
  return length > 0.0 ? sum / length : sum;
}

bool WindowGrid::isCovered(const Vec3d& local, const Vec3d& outward) const
{
  if (skinTissue_ < 0)
  {
    return true;
  }
  for (double depthMm = -skinDepthMm; depthMm < skinDepthMm; depthMm += voxelStepMm())
  {
    if (voxelTissue(local - depthMm * outward) == skinTissue_)
    {
      return true;
    }
  }
  return false;
}

int WindowGrid::voxelTissue(const Vec3d& local) const
{
  const Vec3i n = scene_.placement().size;
  const Vec3i v = Vec3i(glm::floor(local / scene_.placement().spacingMm));
  const bool isThere = glm::all(glm::greaterThanEqual(v, Vec3i(0))) && glm::all(glm::lessThan(v, n));
  return isThere ? scene_.tissueVoxels()[(std::size_t(v.z) * n.y + v.y) * n.x + v.x] : -1;
}

double WindowGrid::voxelStepMm() const
{
  const Vec3d spacing = scene_.placement().spacingMm;
  return 0.5 * std::min({ spacing.x, spacing.y, spacing.z });
}

Vec3d WindowGrid::entry(const Vec3d& local, const Vec3d& axis) const
{
  const double reachMm = 2.0 * std::max({ cellMm_.x, cellMm_.y, cellMm_.z });
  for (double r = -reachMm; r < reachMm; r += voxelStepMm())
  {
    const int tissue = voxelTissue(local + r * axis);
    if (tissue >= 0 && tissue != scene_.outsideIndex())
    {
      return local + r * axis;
    }
  }
  return local;
}

bool WindowGrid::isOpen(const Vec3d& local, const Vec3d& outward) const
{
  if (!isCutEstimate_)
  {
    return true;
  }
  double r = 0.0;
  while (r < wayOutMm && isInside(local + r * outward))
  {
    r += stepMm_;
  }
  return r >= wayOutMm;
}

std::vector<WindowGrid::SkinPlace> WindowGrid::skinPlaces() const
{
  // Of each block of the surface, the cell that is nearest to the middle of its cells.
  struct Block
  {
    Vec3d sum{ 0.0 };
    std::vector<Vec3i> cells;
  };
  std::map<std::tuple<int, int, int>, Block> blocks;
  for (int k = 0; k < size_.z; ++k)
  {
    for (int j = 0; j < size_.y; ++j)
    {
      for (int i = 0; i < size_.x; ++i)
      {
        const Vec3i cell(i, j, k);
        if (!isSurface(cell))
        {
          continue;
        }
        const Vec3i of(centre(cell) / placesMm);
        Block& block = blocks[std::make_tuple(of.z, of.y, of.x)];
        block.sum += centre(cell);
        block.cells.push_back(cell);
      }
    }
  }
  std::vector<Vec3d> middles;
  for (const auto& [key, block] : blocks)
  {
    const Vec3d middle = block.sum / double(block.cells.size());
    const auto distance = [&](const Vec3i& cell) { return glm::distance(centre(cell), middle); };
    middles.push_back(
      centre(*std::min_element(block.cells.begin(), block.cells.end(),
                               [&](const Vec3i& a, const Vec3i& b) { return distance(a) < distance(b); })));
  }
  std::vector<SkinPlace> places(middles.size());
  std::vector<char> isPlace(middles.size(), 0);
  parallelFor(int(middles.size()), {}, [&](int i) {
    const Vec3d& middle = middles[std::size_t(i)];
    const Vec3d outward = outwardNormal(middle);
    places[std::size_t(i)] = { middle, outward };
    isPlace[std::size_t(i)] = outward != Vec3d(0.0) && isCovered(middle, outward);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    if (isPlace[i])
    {
      places[kept++] = places[i];
    }
  }
  places.resize(kept);
  return places;
}

} // namespace sono
