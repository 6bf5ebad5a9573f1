#pragma once

#include "Kernel/PathKey.h"
#include "Kernel/PathPiece.h"

// From the transducer's face into the body: either once a line, on to the first boundary, for all its paths; or, where
// the probe names its aperture, for each path from a place of its own.

namespace sono {

/// The way from the transducer to the first boundary, where every path of a line shares it.
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
  path.rangeMm = near - line.aheadMm;
  return true;
}

/// Takes a path along its line into the body; the sink gets the coupling. Whatever lies between the face and the first
/// tissue that is not the outside tissue is acoustic coupling: it neither reflects nor attenuates, and targets in it
/// are not seen. Returns whether there is a body.
template<class Space, class Sink>
SONO_HD inline bool enterBody(const TraceView& view, const Space& space, const TraceLine& line, PathState& path,
                              Sink& sink)
{
  if (!enterSpace(space, line, view.depthMm, path))
  {
    return false;
  }
  sink.segment(PathSegment{ line.origin, line.axis, path.length, 1.0f, 0.0f, 0.0f });
  path.tissue = space.tissueAt(path.ray.cell);
  if (path.tissue == view.outsideTissue)
  {
    const CellHit hit = space.march(path.ray, path.tissue, NoStairs(), remainingLength(view, line, path));
    sink.segment(PathSegment{ path.ray.position, line.axis, hit.t, 1.0f, 0.0f, 0.0f });
    if (hit.tissue < 0)
    {
      return false;
    }
    path.ray.position += line.axis * hit.t;
    path.ray.cell = hit.after;
    path.length += hit.t;
    path.rangeMm += hit.t;
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
  return true;
}

/// Traces what all paths of a line share.
template<class Space, class Sink>
SONO_HD inline LineStart startLine(const TraceView& view, const Space& space, const TraceLine& line, Sink& sink)
{
  LineStart start;
  start.meets = false;
  PathState& path = start.path;
  if (!enterBody(view, space, line, path, sink))
  {
    return start;
  }
  start.meets = advanceToBoundary(view, space, line, path, start.boundary, sink) && view.maxCollisions > 0;
  if (start.meets)
  {
    sink.meets(path, start.boundary);
    depositBoundary(view, path, start.boundary, sink);
  }
  return start;
}

/// The line of a path that starts apart: from its place on the aperture to the focus, in each axis its own
/// (Data/docs/physics.md (3.5), (3.6)). Whatever the path leaves is seen from there: a path that nothing turns away
/// leaves what one along the beam's axis would.
SONO_HD inline TraceLine pathLine(const TraceView& view, const TraceLine& line, const PathKey& key)
{
  const BounceSample u = drawStart(view, key);
  const Vec3f lateral = line.lateral * (2.0f * u.polar - 1.0f);
  const Vec3f elevation = line.elevation * (2.0f * u.azimuth - 1.0f);
  return { line.origin + lateral + elevation,
           glm::normalize(line.axis - lateral * view.perTransmitFocus - elevation * view.perElevationFocus),
           Vec3f(0.0f),
           Vec3f(0.0f),
           line.face,
           0.5f * (glm::dot(lateral, lateral) * view.perTransmitFocus +
                   glm::dot(elevation, elevation) * view.perElevationFocus) };
}

/// How much coupling a path met.
struct CouplingLength : PathSink
{
  float mm = 0.0f;

  SONO_HD void segment(const PathSegment& s) { mm += s.length; }
};

/// Takes a path of its own from the face into the body: one segment. Returns whether there is a body.
template<class Space, class Sink>
SONO_HD inline bool startPath(const TraceView& view, const Space& space, const TraceLine& own, PathState& path,
                              Sink& sink)
{
  CouplingLength coupling;
  const bool inBody = enterBody(view, space, own, path, coupling);
  sink.segment(PathSegment{ own.origin, own.axis, coupling.mm, 1.0f, 0.0f, 0.0f });
  return inBody;
}

} // namespace sono
