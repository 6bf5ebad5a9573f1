#include "Scene/TissueMotion.h"

#include "Core/Progress.h"
#include "Scene/VoxelBox.h"

#include <cmath>
#include <string>
#include <utility>

namespace sono {

namespace {

std::size_t indexIn(const Vec3i& p, const Vec3i& size)
{
  return std::size_t(p.x) + std::size_t(size.x) * (std::size_t(p.y) + std::size_t(size.y) * std::size_t(p.z));
}

/// Calls visit(voxel) for each voxel between two corners.
template<class Visit>
void forVoxels(const Vec3i& first, const Vec3i& last, const Visit& visit)
{
  for (int k = first.z; k < last.z; ++k)
  {
    for (int j = first.y; j < last.y; ++j)
    {
      for (int i = first.x; i < last.x; ++i)
      {
        visit(Vec3i(i, j, k));
      }
    }
  }
}

} // namespace

TissueMotion::TissueMotion(const GridPlacement& grid, const std::vector<Vec3f>& displacementMm,
                           std::set<int> movingLabels)
  : grid_(grid)
  , movingLabels_(std::move(movingLabels))
{
  if (displacementMm.size() != grid.voxelCount())
  {
    throw Error("the displacement field has " + std::to_string(displacementMm.size()) +
                " values where the label map has " + std::to_string(grid.voxelCount()) +
                " voxels: compute it on the label map's grid");
  }
  Vec3i first = grid.size;
  Vec3i last(0);
  forVoxels(Vec3i(0), grid.size, [&](const Vec3i& p) {
    const Vec3f& u = displacementMm[indexIn(p, grid.size)];
    if (!std::isfinite(u.x + u.y + u.z))
    {
      throw Error("the displacement field is not finite at voxel " + std::to_string(p.x) + ", " + std::to_string(p.y) +
                  ", " + std::to_string(p.z) + ": give 0 mm where nothing is known");
    }
    if (u != Vec3f(0.0f))
    {
      first = glm::min(first, p);
      last = glm::max(last, p + 1);
    }
  });
  // With a border of zeros, where there is one.
  first = glm::max(first - 1, Vec3i(0));
  last = glm::min(last + 1, grid.size);
  grid_.size = glm::max(last - first, Vec3i(0));
  grid_.originMm = grid.worldFromIndex(Vec3d(first));
  displacementMm_.reserve(grid_.voxelCount());
  forVoxels(first, last, [&](const Vec3i& p) { displacementMm_.push_back(displacementMm[indexIn(p, grid.size)]); });
}

Vec3d TissueMotion::displacementMm(const Vec3d& world) const
{
  const Vec3d at = displacementMm_.empty() ? Vec3d(-1.0) : grid_.indexFromWorld(world);
  const Vec3d end = Vec3d(grid_.size) - 0.5;
  if (glm::any(glm::lessThan(at, Vec3d(-0.5))) || glm::any(glm::greaterThan(at, end)))
  {
    return Vec3d(0.0);
  }
  const Vec3d inside = glm::clamp(at, Vec3d(0.0), Vec3d(grid_.size - 1));
  const Vec3i low = glm::min(Vec3i(inside), glm::max(grid_.size - 2, Vec3i(0)));
  const Vec3i high = glm::min(low + 1, grid_.size - 1);
  const Vec3d t = inside - Vec3d(low);
  Vec3d sum(0.0);
  for (int corner = 0; corner < 8; ++corner)
  {
    const Vec3i far(corner & 1, (corner >> 1) & 1, corner >> 2);
    const Vec3i p(far.x ? high.x : low.x, far.y ? high.y : low.y, far.z ? high.z : low.z);
    const double weight = (far.x ? t.x : 1.0 - t.x) * (far.y ? t.y : 1.0 - t.y) * (far.z ? t.z : 1.0 - t.z);
    sum += weight * Vec3d(displacementMm_[indexIn(p, grid_.size)]);
  }
  return sum;
}

} // namespace sono
