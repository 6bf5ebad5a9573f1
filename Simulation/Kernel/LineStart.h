#pragma once

#include "Kernel/PathPiece.h"

// From the transducer's face into the body and on to the first boundary.

namespace sono {

/// The way from the transducer to the first boundary, which every path of a line shares.
struct LineStart
{
  bool meets; ///< whether there is a first boundary
  PathState path;
  PathBoundary boundary;
};

/// Entry of a line into the space: inside it, or where the axis first meets its box.
template<class Space>
SONO_HD inline bool enterSpace(const Space& space, const TraceLine& line, float depthMm, PathState& path)
{
  const Vec3i size = space.size();
  const Vec3f extent = Vec3f(size) * space.spacing();
  float near = 0.0f;
  float far = depthMm;
  int axis = -1;
  for (int a = 0; a < 3; ++a)
  {
    const float inverse = safeInverse(line.axis[a]);
    if (inverse == 0.0f)
    {
      if (line.origin[a] < 0.0f || line.origin[a] >= extent[a])
      {
        return false;
      }
      continue;
    }
    const float t0 = (line.axis[a] > 0.0f ? 0.0f - line.origin[a] : extent[a] - line.origin[a]) * inverse;
    const float t1 = (line.axis[a] > 0.0f ? extent[a] - line.origin[a] : 0.0f - line.origin[a]) * inverse;
    if (t0 > near)
    {
      near = t0;
      axis = a;
    }
    far = smaller(far, t1);
  }
  if (near >= far)
  {
    return false;
  }
  path.ray.position = line.origin + line.axis * near;
  path.ray.direction = line.axis;
  path.ray.cell = glm::clamp(space.cellAt(path.ray.position), Vec3i(0), size - 1);
  for (int a = 0; a < 3; ++a)
  {
    // On a face the line belongs to the cell ahead of it.
    const bool onFace = path.ray.position[a] / space.spacing()[a] == float(path.ray.cell[a]);
    path.ray.cell[a] -= line.axis[a] < 0.0f && onFace && path.ray.cell[a] > 0 ? 1 : 0;
  }
  if (axis >= 0)
  {
    path.ray.cell[axis] = line.axis[axis] > 0.0f ? 0 : size[axis] - 1;
  }
  path.length = near;
  return true;
}

/// Traces what all paths of a line share. Whatever lies between the face and the first tissue that is not the outside
/// tissue is acoustic coupling: it neither reflects nor attenuates, and targets in it are not seen.
template<class Space, class Sink>
SONO_HD inline LineStart startLine(const TraceView& view, const Space& space, const TraceLine& line, Sink& sink)
{
  LineStart start;
  start.meets = false;
  PathState& path = start.path;
  if (!enterSpace(space, line, view.depthMm, path))
  {
    return start;
  }
  sink.segment(PathSegment{ line.origin, line.axis, path.length, 1.0f, 0.0f, 0.0f });
  path.tissue = space.tissueAt(path.ray.cell);
  if (path.tissue == view.outsideTissue)
  {
    const CellHit hit = space.toBoundary(path.ray, path.tissue, -1, 0.0f, remainingLength(view, line, path));
    sink.segment(PathSegment{ path.ray.position, line.axis, hit.t, 1.0f, 0.0f, 0.0f });
    if (hit.tissue < 0)
    {
      return start;
    }
    path.ray.position += line.axis * hit.t;
    path.ray.cell = hit.after;
    path.length += hit.t;
    path.tissue = hit.tissue;
  }
  if (space.targets.any())
  {
    // Inside a target when the next surface, of either kind, is one that the line leaves.
    const TargetHit entered = space.targets.nearest(path.ray.position, line.axis, 3e38f, false);
    const TargetHit left = space.targets.nearest(path.ray.position, line.axis, 3e38f, true);
    if (left.target >= 0 && (entered.target < 0 || left.t < entered.t))
    {
      path.target = left.target;
      path.tissue = view.firstTargetMedium + left.target;
    }
  }
  start.meets = advanceToBoundary(view, space, line, path, start.boundary, sink) && view.maxCollisions > 0;
  if (start.meets)
  {
    sink.meets(path, start.boundary);
    depositBoundary(view, path, start.boundary, sink);
  }
  return start;
}

} // namespace sono
