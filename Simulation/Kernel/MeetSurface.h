#pragma once

#include "Kernel/SurfaceHit.h"

#include <cstdint>

// The voxels of a smooth surface are a staircase: near it, a ray meets voxels of the tissue behind it although it goes
// away from it. These stairs do not count. They are told from what does at the hit, by the same records that say which
// way the surface faces there, so that the march itself knows nothing of them.

namespace sono {

/// The surface that a path has left last: the tissue on its other side in the low byte; above, a bit for each of the
/// six ways through a voxel's face, set where that way leads off from the surface. -1: none.
using LeftSurface = std::int32_t;
constexpr LeftSurface noSurfaceLeft = -1;

SONO_HD inline int wayThrough(int axis, bool ascending)
{
  return 1 << (8 + 2 * axis + (ascending ? 1 : 0));
}

/// `normal` points into the medium that the path goes on in.
SONO_HD inline LeftSurface leftSurface(int tissue, const Vec3f& normal)
{
  constexpr float off = 0.8f;
  LeftSurface left = tissue;
  for (int axis = 0; axis < 3; ++axis)
  {
    left |= (normal[axis] > off ? wayThrough(axis, true) : 0) | (normal[axis] < -off ? wayThrough(axis, false) : 0);
  }
  return left;
}

/// Whether a ray in tissue `current` just passes a stair at a hit: it does not enter the surface there, by more than
/// normals err where it has just left that or is among its stairs already. In thin walls records do not tell; there no
/// stair of the surface left is behind a face through which the way leads off from it. What touches no other tissue is
/// a stair behind the corner of one on a flat wall only.
template<class Cells>
SONO_HD inline bool isStair(const Cells& cells, const CellRay& ray, const CellHit& hit, int current, LeftSurface left,
                            float clearAt, const MetPlane& plane)
{
  constexpr float normalError = 0.04f; // 2 degrees
  constexpr float thick = 0.7f;
  constexpr float flat = 0.99f;
  const int from = cells.tissueAt(hit.before);
  const bool inStair = from != current;
  if (inStair)
  {
    const bool isInner = (cells.wordAt(hit.after.x, hit.after.y, hit.after.z) & 0x8000u) == 0u;
    if (from != hit.tissue || (isInner && plane.confidence < flat))
    {
      return false;
    }
  }
  const bool justLeft = hit.tissue == (left & 255) && hit.t < clearAt;
  if (plane.confidence == 0.0f)
  {
    const Vec3f& d = ray.direction;
    const bool ascending = (hit.axis == 0 ? d.x : (hit.axis == 1 ? d.y : d.z)) > 0.0f;
    return justLeft && (inStair || (left & wayThrough(hit.axis, ascending)) == 0);
  }
  const float cosine = glm::dot(ray.direction, plane.normal);
  return inStair || justLeft ? cosine < normalError : cosine < 0.01f && plane.confidence > thick;
}

/// Marches to the next surface that the ray enters, past stairs on the way. Where it turns out among stairs that they
/// were none, the surface was met where the ray went in among them, which is exact: the ray's cell stays in front of
/// them meanwhile, and the march from there finds the same face again.
template<class Space>
SONO_HD inline CellHit meetSurface(const Space& space, CellRay& ray, int current, LeftSurface left, float clearAt,
                                   float tMax, MetPlane& plane)
{
  CellRay onward = ray;
  bool isSure = false;
  while (true)
  {
    const CellHit hit = space.toBoundary(onward, current, tMax);
    if (hit.tissue < 0)
    {
      return hit;
    }
    const bool inStair = space.cells.tissueAt(hit.before) != current;
    plane = planeAt(space.cells, ray, hit, inStair);
    if (!isSure && isStair(space.cells, ray, hit, current, left, clearAt, plane))
    {
      ray.cell = inStair ? ray.cell : hit.before;
      onward.cell = hit.after;
    }
    else if (inStair && !isSure)
    {
      onward.cell = ray.cell;
      isSure = true;
    }
    else
    {
      return hit;
    }
  }
}

} // namespace sono
