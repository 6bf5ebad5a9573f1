#include "WindowCuts.h"

#include "Core/Error.h"
#include "Labels/BodyFill.h"
#include "Probe/AcousticWindow.h"
#include "Scene/Scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace sono {
namespace {

constexpr double nearSkinMm = 5.0;
constexpr double halfWidthMm = 10.0;
constexpr double longestWayMm = 60.0;
constexpr double stepMm = 1.0;

/// nullptr beyond the volume.
const std::uint16_t* voxelAt(const LabelVolume& volume, const Vec3d& world)
{
  const Vec3i size = volume.placement.size;
  const Vec3i v(glm::floor(volume.placement.indexFromWorld(world) + 0.5));
  const bool isThere = glm::all(glm::greaterThanEqual(v, Vec3i(0))) && glm::all(glm::lessThan(v, size));
  return isThere ? &volume.voxels[(std::size_t(v.z) * size.y + v.y) * size.x + v.x] : nullptr;
}

/// Beyond the volume, or in the air around the body.
bool isOutside(const LabelVolume& volume, const Vec3d& world)
{
  const std::uint16_t* voxel = voxelAt(volume, world);
  return !voxel || *voxel == 0;
}

bool hasSkinNear(const LabelVolume& volume, const Vec3d& world)
{
  const auto isSkin = [](const LabelInfo& label) { return label.name == "skin"; };
  const auto skin = std::find_if(volume.labels.begin(), volume.labels.end(), isSkin);
  for (double x = -nearSkinMm; x <= nearSkinMm && skin != volume.labels.end(); x += stepMm)
  {
    for (double y = -nearSkinMm; y <= nearSkinMm; y += stepMm)
    {
      for (double z = -nearSkinMm; z <= nearSkinMm; z += stepMm)
      {
        const Vec3d offset(x, y, z);
        const std::uint16_t* voxel = voxelAt(volume, world + offset);
        if (glm::length(offset) <= nearSkinMm && voxel && *voxel == skin->id)
        {
          return true;
        }
      }
    }
  }
  return false;
}

} // namespace

WindowCuts::WindowCuts(LabelVolume whole, bool isFilled, const std::string& dataDir, unsigned seed)
  : table_(TissueTable::read(dataDir + "/tissues.csv"))
  , map_(LabelTissueMap::read(dataDir + "/label_tissues.csv"))
  , whole_(std::move(whole))
  , truth_(whole_)
  , isFilled_(isFilled)
  , random_(seed)
{
  if (isFilled)
  {
    fillBody(truth_);
  }
}

/// Not std::uniform_real_distribution, whose numbers each library makes in its own way.
double WindowCuts::random(double low, double high)
{
  return low + (high - low) * (random_() / 4294967296.0);
}

LabelVolume WindowCuts::cutBox()
{
  const Vec3i size = whole_.placement.size;
  Vec3i from(0);
  LabelVolume part;
  part.placement = whole_.placement;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int length = std::max(4, int(random(0.3, 1.0) * size[axis]));
    from[axis] = int(random(0.0, size[axis] - length + 0.999));
    part.placement.size[axis] = length;
  }
  part.placement.originMm = whole_.placement.worldFromIndex(Vec3d(from));
  part.labels = whole_.labels;
  const Vec3i n = part.placement.size;
  part.voxels.reserve(part.placement.voxelCount());
  for (int k = 0; k < n.z; ++k)
  {
    for (int j = 0; j < n.y; ++j)
    {
      const auto row =
        whole_.voxels.begin() + std::ptrdiff_t((std::size_t(k + from.z) * size.y + j + from.y) * size.x + from.x);
      part.voxels.insert(part.voxels.end(), row, row + n.x);
    }
  }
  part.collectLabels();
  return part;
}

LabelVolume WindowCuts::cutAskew()
{
  LabelVolume part = whole_;
  const double z = random(-1.0, 1.0);
  const double turn = random(0.0, 6.283185307);
  const Vec3d normal(std::sqrt(1.0 - z * z) * std::cos(turn), std::sqrt(1.0 - z * z) * std::sin(turn), z);
  const Vec3i n = part.placement.size;
  const Vec3d through = Vec3d(n) * Vec3d(random(0.3, 0.7), random(0.3, 0.7), random(0.3, 0.7));
  std::size_t at = 0;
  for (int k = 0; k < n.z; ++k)
  {
    for (int j = 0; j < n.y; ++j)
    {
      for (int i = 0; i < n.x; ++i, ++at)
      {
        const bool isBeyond = glm::dot((Vec3d(i, j, k) - through) * part.placement.spacingMm, normal) > 0.0;
        part.voxels[at] = isBeyond ? 0 : part.voxels[at];
      }
    }
  }
  part.collectLabels();
  return part;
}

bool WindowCuts::isOnSkin(const LabelVolume& part, const Vec3d& world, const Vec3d& outward) const
{
  const LabelVolume& own = isFilled_ ? part : truth_;
  if (!hasSkinNear(own, world) || !isOutside(own, world + (nearSkinMm + 5.0) * outward))
  {
    return false;
  }
  if (!isFilled_)
  {
    return true;
  }
  const Vec3d helper = std::abs(outward.x) < 0.9 ? Vec3d(1.0, 0.0, 0.0) : Vec3d(0.0, 1.0, 0.0);
  const Vec3d across = halfWidthMm * glm::normalize(glm::cross(outward, helper));
  const Vec3d over = glm::cross(outward, across);
  const Vec3d starts[] = { world, world + across, world - across, world + over, world - over };
  return std::all_of(std::begin(starts), std::end(starts), [&](const Vec3d& start) {
    const double wayMm = wayOutMm(start, outward);
    bool isInPart = wayMm < longestWayMm;
    for (double r = 0.0; r < wayMm && isInPart; r += stepMm)
    {
      isInPart = voxelAt(part, start + r * outward) != nullptr;
    }
    return isInPart;
  });
}

double WindowCuts::wayOutMm(const Vec3d& world, const Vec3d& outward) const
{
  double r = 0.0;
  while (r < longestWayMm && !isOutside(truth_, world + r * outward))
  {
    r += stepMm;
  }
  return r;
}

void WindowCuts::run(int count, const std::vector<std::string>& targets, CutFigures& figures)
{
  for (int i = 0; i < count; ++i)
  {
    LabelVolume part = !isFilled_ && i % 4 == 3 ? cutAskew() : cutBox();
    const std::string& target = targets[std::size_t(i) % targets.size()];
    ++figures.cuts;
    try
    {
      if (isFilled_)
      {
        fillBody(part);
      }
      assignTissues(part, map_, table_, "soft_tissue");
      const Scene scene(std::move(part), table_, "air");
      const Vec3d boxMm = Vec3d(scene.placement().size) * scene.placement().spacingMm;
      const auto windows = findAcousticWindows(scene, windowTarget(scene, target), ProbeSettings());
      figures.windows += int(windows.size());
      for (const AcousticWindow& window : windows)
      {
        const Vec3d& p = window.pose.positionMm;
        figures.deepestMm = std::max(figures.deepestMm, isFilled_ ? wayOutMm(p, -window.pose.axial) : 0.0);
        if (!isOnSkin(scene.volume(), p, -window.pose.axial))
        {
          ++figures.onCutFaces;
          const Vec3d local = scene.localFromWorld(p);
          const Vec3d border = glm::min(local, boxMm - local);
          std::fprintf(
            stderr, "cut %d, %s: no skin at (%.1f, %.1f, %.1f) mm, %.0f mm from the border, way out %.0f mm\n", i,
            target.c_str(), p.x, p.y, p.z, std::min({ border.x, border.y, border.z }), wayOutMm(p, -window.pose.axial));
        }
      }
    }
    catch (const Error&) // what is left has not the target, or no skin
    {
      ++figures.withoutWindow;
    }
  }
}

} // namespace sono
