#pragma once

#include "Kernel/LeftSurface.h"
#include "Kernel/SurfaceHit.h"

// The voxels of a smooth surface are a staircase: near it, a ray meets voxels of the tissue behind it although it goes
// away from it. These stairs of the surface left last do not count, and the march passes them.

namespace sono {

/// Tells the stairs of the surface that a path has left. A voxel is of the tissue in which its centre lies: the centres
/// of all stairs of a surface that does not bend towards the path lie behind its plane, or no further in front of it
/// than records err.
template<class Cells>
class StairsLeft
{
public:
  SONO_HD StairsLeft(const Cells& cells, const CellRay& ray, const LeftSurface& left)
    : cells_(cells)
    , left_(left)
  {
    const Vec3f n = left.normal();
    perVoxel_ = n * cells.spacing;
    const float slack = slackGrazing * glm::dot(glm::abs(n), cells.spacing) +
                        slackSteep * glm::dot(n, ray.direction) * glm::dot(perVoxel_, ray.direction);
    const float centre = 0.5f * (perVoxel_.x + perVoxel_.y + perVoxel_.z);
    highest_ = glm::dot(n, ray.position) - left.heightMm + slack - centre;
  }
  /// Whether a voxel of another tissue than the path's, met at `t`, is a stair.
  SONO_HD bool passes(int tissue, float t, const Vec3f& cell) const
  {
    return tissue == left_.tissue() && t < nearVoxels * cells_.meanSpacing && glm::dot(perVoxel_, cell) < highest_;
  }

private:
  /// Of a voxel's extent along the normal.
  static constexpr float slackGrazing = 0.4f;
  /// Of the height that a ray wins by a voxel's edges: one that leaves steeply is soon clear of stairs, and may have
  /// started from a voxel's face far from the surface; one that grazes would not see for long.
  static constexpr float slackSteep = 2.0f;
  static constexpr float nearVoxels = 6.0f; ///< further on a surface that bends may be met

  const Cells& cells_;
  const LeftSurface& left_;
  Vec3f perVoxel_; ///< how much higher the next voxel along each axis lies, as all heights along the surface's normal
  float highest_;  ///< stairs' corners lie below this
};

/// Where the ray went in among the stairs that it was in when it met a surface: it has met it there. Faces are met in
/// the same order as on the way forth.
template<class Cells>
SONO_HD inline CellHit entranceInto(const Cells& cells, const CellRay& ray, int current, const CellHit& hit)
{
  CellHit entrance = hit;
  while (cells.tissueAt(entrance.before) != current && entrance.before != ray.cell)
  {
    const Vec3i c = entrance.before;
    float t = -3e38f;
    for (int a = 0; a < 3; ++a)
    {
      const AxisMarch axis(ray.position[a] * cells.perMm[a], ray.direction[a] * cells.perMm[a]);
      const float met = axis.meet(axis.faceOf(c[a]) - axis.along);
      if (c[a] != ray.cell[a] && met >= t) // of faces met at once the last one in order
      {
        t = met;
        entrance.axis = a;
      }
    }
    entrance.t = larger(t, 0.0f);
    entrance.after = c;
    entrance.tissue = cells.tissueAt(c);
    for (int a = 0; a < 3; ++a)
    {
      entrance.before[a] -= a == entrance.axis ? (ray.direction[a] > 0.0f ? 1 : -1) : 0;
    }
  }
  return entrance;
}

/// Marches `space` to the next boundary, past the stairs of the surface left.
template<class Space>
SONO_HD inline CellHit marchPastStairs(const Space& space, const CellRay& ray, int current, const LeftSurface& left,
                                       float tMax)
{
  const CellHit hit = space.march(ray, current, StairsLeft(space.cells, ray, left), tMax);
  const bool inStairs = hit.tissue >= 0 && space.cells.tissueAt(hit.before) != current;
  return inStairs ? entranceInto(space.cells, ray, current, hit) : hit;
}

} // namespace sono
