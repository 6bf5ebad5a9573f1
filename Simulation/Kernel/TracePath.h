#pragma once

#include "Kernel/TraceView.h"

namespace sono
{

/// A path between two boundaries.
struct PathState
{
  CellRay ray;
  float intensity = 1.0f;
  float length = 0.0f; ///< travelled since the transducer, mm
  int tissue = 0;      ///< that the path is in
  int ignored = -1;    ///< see marchToBoundary
  float ignoreUntil = 0.0f;
  int collisions = 0;
};

/// A straight piece of a path inside one tissue.
struct PathSegment
{
  Vec3f start;
  Vec3f direction;
  float length;
  float intensity; ///< at its start
  float decayPerMm;
};

/// A boundary that a path met, ready for the choice of a branch.
struct PathBoundary
{
  CellHit hit;
  RefinedHit surface;
  int from; ///< tissue indices
  int to;
  float cosine;
  Reflection reflection;
};

/// How far a path may go from where it stands: to the ends of the slab 0 <= r <= depth of its line, and no farther than
/// an echo could still arrive in time, path length + way back <= 2 depth. Nothing beyond would be deposited or heard.
SONO_HD inline float remainingLength(const TraceView& view, const TraceLine& line, const PathState& path)
{
  const Vec3f q = path.ray.position - line.origin;
  const float r = glm::dot(q, line.axis);
  const float along = glm::dot(path.ray.direction, line.axis);
  float t = 3e38f;
  if (along > 1e-7f)
  {
    t = (view.depthMm - r) / along;
  }
  else if (along < -1e-7f)
  {
    t = r / -along;
  }
  // |q + t w| = K - t with K = 2 depth - length.
  const float k = 2.0f * view.depthMm - path.length;
  const float towards = k + glm::dot(q, path.ray.direction);
  const float timely = towards > 0.0f ? (k * k - glm::dot(q, q)) / (2.0f * towards) : 0.0f;
  return larger(0.0f, smaller(t, timely));
}

SONO_HD inline bool sameAcoustics(const TraceMedium& a, const TraceMedium& b)
{
  return a.impedance == b.impedance && a.speed == b.speed;
}

/// Follows the path to its next boundary and hands every segment to `sink.segment(PathSegment)`. Returns false when the
/// path ends before one. Tissues with equal impedance and speed are no boundary: only the attenuation changes there.
template<class Sink>
SONO_HD inline bool advanceToBoundary(const TraceView& view,
                                      const TraceLine& line,
                                      PathState& path,
                                      PathBoundary& boundary,
                                      Sink& sink)
{
  // A march ends at a new tissue, which lies at least one cell on: the count bounds any path.
  const int maxPieces = view.cells.size.x + view.cells.size.y + view.cells.size.z;
  for (int piece = 0; piece < maxPieces; ++piece)
  {
    const float tMax = remainingLength(view, line, path);
    const CellHit hit = marchToBoundary(view.cells, path.ray, path.tissue, path.ignored, path.ignoreUntil, tMax);
    const TraceMedium& medium = view.media[path.tissue];
    sink.segment(PathSegment{ path.ray.position, path.ray.direction, hit.t, path.intensity, medium.decayPerMm });
    path.intensity *= expf(-medium.decayPerMm * hit.t);
    path.length += hit.t;
    if (hit.tissue < 0)
    {
      return false;
    }
    const TraceMedium& next = view.media[hit.tissue];
    if (!sameAcoustics(medium, next))
    {
      boundary.hit = hit;
      boundary.surface = refineBoundary(view.cells, path.ray, hit);
      boundary.from = path.tissue;
      boundary.to = hit.tissue;
      boundary.cosine = smaller(1.0f, glm::dot(path.ray.direction, boundary.surface.normal));
      boundary.reflection =
        reflectionAt(view.model, medium.impedance, next.impedance, medium.speed, next.speed, boundary.cosine);
      return true;
    }
    path.ray.position += path.ray.direction * hit.t;
    path.ray.cell = hit.after;
    path.ignoreUntil -= hit.t;
    path.tissue = hit.tissue;
  }
  return false;
}

/// The echo of a boundary goes to `sink.echo(point, amplitude)` at the sub-voxel point.
template<class Sink>
SONO_HD inline void depositBoundary(const TraceView& view,
                                    const PathState& path,
                                    const PathBoundary& boundary,
                                    Sink& sink)
{
  const TraceMedium& from = view.media[boundary.from];
  const TraceMedium& to = view.media[boundary.to];
  const float amplitude =
    boundaryEcho(view.model, from.impedance, to.impedance, path.intensity, boundary.cosine, to.tau, to.gamma);
  sink.echo(path.ray.position + path.ray.direction * boundary.surface.t, amplitude);
}

/// Leaves the boundary along the branch drawn by `u`. The path restarts on the voxel face, in the cell it stays in, and
/// does not see the tissue on the other side again for about one voxel along the normal.
SONO_HD inline void leaveBoundary(const TraceView& view,
                                  const PathBoundary& boundary,
                                  const BounceSample& u,
                                  PathState& path)
{
  const RefinedHit& surface = boundary.surface;
  Scattered out;
  if (view.deterministic)
  {
    const bool reflected = boundary.reflection.total || boundary.reflection.reflectance > 0.5f;
    out = { reflected ? mirrorDirection(path.ray.direction, surface.normal, boundary.cosine)
                      : refractedDirection(path.ray.direction, surface.normal, boundary.cosine, boundary.reflection),
            reflected,
            reflected ? boundary.reflection.reflectance : 1.0f - boundary.reflection.reflectance };
    out.direction = glm::normalize(out.direction);
  }
  else
  {
    out = scatterAt(view.model, view.lobe, path.ray.direction, surface.normal, boundary.cosine, boundary.reflection, u);
  }
  path.ray.position += path.ray.direction * boundary.hit.t;
  path.ray.direction = out.direction;
  path.ray.cell = out.reflected ? boundary.hit.before : boundary.hit.after;
  path.tissue = out.reflected ? boundary.from : boundary.to;
  path.ignored = out.reflected ? boundary.to : boundary.from;
  const float leaving = fabsf(glm::dot(out.direction, surface.normal));
  path.ignoreUntil = view.cells.meanSpacing * smaller(8.0f, 0.8f / larger(leaving, 0.1f));
  path.intensity *= out.throughput;
  ++path.collisions;
}

/// The way from the transducer to the first boundary, which every path of a line shares.
struct LineStart
{
  bool enters; ///< whether the line meets the cells at all
  bool meets;  ///< whether there is a first boundary
  PathState path;
  PathBoundary boundary;
};

/// Entry of a line into the cells: inside them, or where the axis first meets their box.
SONO_HD inline bool enterCells(const TissueCells& cells, const TraceLine& line, float depthMm, PathState& path)
{
  const Vec3f extent = Vec3f(cells.size) * cells.spacing;
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
  path.ray.cell = glm::clamp(cells.cellAt(path.ray.position), Vec3i(0), cells.size - 1);
  if (axis >= 0)
  {
    path.ray.cell[axis] = line.axis[axis] > 0.0f ? 0 : cells.size[axis] - 1;
  }
  path.length = near;
  return true;
}

/// Traces what all paths of a line share. Whatever lies between the face and the first tissue that is not the outside
/// tissue is acoustic coupling: it neither reflects nor attenuates.
template<class Sink>
SONO_HD inline LineStart startLine(const TraceView& view, const TraceLine& line, Sink& sink)
{
  LineStart start;
  start.meets = false;
  PathState& path = start.path;
  start.enters = enterCells(view.cells, line, view.depthMm, path);
  if (!start.enters)
  {
    return start;
  }
  sink.segment(PathSegment{ line.origin, line.axis, path.length, 1.0f, 0.0f });
  path.tissue = view.cells.tissueAt(path.ray.cell);
  if (path.tissue == view.outsideTissue)
  {
    const float tMax = remainingLength(view, line, path);
    const CellHit hit = marchToBoundary(view.cells, path.ray, path.tissue, -1, 0.0f, tMax);
    sink.segment(PathSegment{ path.ray.position, line.axis, hit.t, 1.0f, 0.0f });
    if (hit.tissue < 0)
    {
      return start;
    }
    path.ray.position += line.axis * hit.t;
    path.ray.cell = hit.after;
    path.length += hit.t;
    path.tissue = hit.tissue;
  }
  start.meets = advanceToBoundary(view, line, path, start.boundary, sink) && view.maxCollisions > 0;
  if (start.meets)
  {
    depositBoundary(view, path, start.boundary, sink);
  }
  return start;
}

/// Identifies a path's random stream.
struct PathKey
{
  std::uint32_t line;
  std::uint32_t batch;
  std::uint32_t path; ///< within its batch
};

SONO_HD inline BounceSample drawBounce(const TraceView& view, const PathKey& key, std::uint32_t bounce)
{
  if (view.lowDiscrepancy)
  {
    return lowDiscrepancySample(makeBounceScramble(view.seed, key.line, key.batch, bounce), key.path);
  }
  return independentSample(view.seed, key.line, key.batch, key.path, bounce);
}

/// One path, from the first boundary on; it ends where it meets a boundary more than maxCollisions allow.
template<class Sink>
SONO_HD inline void tracePath(const TraceView& view,
                              const TraceLine& line,
                              const LineStart& start,
                              const PathKey& key,
                              Sink& sink)
{
  PathState path = start.path;
  PathBoundary boundary = start.boundary;
  for (;;)
  {
    leaveBoundary(view, boundary, drawBounce(view, key, std::uint32_t(path.collisions)), path);
    if (path.intensity <= 0.0f || !advanceToBoundary(view, line, path, boundary, sink) ||
        path.collisions >= view.maxCollisions)
    {
      return;
    }
    depositBoundary(view, path, boundary, sink);
  }
}

} // namespace sono
