#pragma once

#include "Kernel/CellSpace.h"
#include "Kernel/TraceView.h"

// One path through a space (see CellSpace), for one thread of any device. `Sink` takes what the path leaves behind:
//   segment(const PathSegment&)             a straight piece inside one tissue
//   echo(const Vec3f& point, float amplitude)  the echo of a boundary, before the coherence weight

namespace sono {

/// A path between two boundaries.
struct PathState
{
  CellRay ray;
  float intensity = 1.0f;
  float length = 0.0f; ///< travelled since the transducer, mm
  int tissue = 0;      ///< medium that the path is in
  int target = -1;     ///< target that the path is in; the cells do not count there
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

/// One side of a boundary.
struct BoundarySide
{
  Vec3i cell;
  int medium;
  int target;
};

/// A boundary that a path met, ready for the choice of a branch.
struct PathBoundary
{
  float restart;      ///< where the path goes on, mm along its ray: the voxel face
  RefinedHit surface; ///< the sub-voxel surface
  BoundarySide before;
  BoundarySide after;
  bool voxelFace; ///< a boundary between cells, which are a staircase; false: a target's surface
  float cosine;
  Reflection reflection;
};

/// How far a path may go from where it stands: to the ends of the slab 0 <= r <= depth of its line, and no farther than
/// an echo could still arrive in time, path length + way back <= 2 depth. Nothing beyond would be deposited or heard.
SONO_HD inline float remainingLength(float depthMm, const TraceLine& line, const Vec3f& position,
                                     const Vec3f& direction, float length)
{
  const Vec3f q = position - line.origin;
  const float r = glm::dot(q, line.axis);
  const float along = glm::dot(direction, line.axis);
  float t = 3e38f;
  if (along > 1e-7f)
  {
    t = (depthMm - r) / along;
  }
  else if (along < -1e-7f)
  {
    t = r / -along;
  }
  // |q + t w| = K - t with K = 2 depth - length.
  const float k = 2.0f * depthMm - length;
  const float towards = k + glm::dot(q, direction);
  const float timely = towards > 0.0f ? (k * k - glm::dot(q, q)) / (2.0f * towards) : 0.0f;
  return larger(0.0f, smaller(t, timely));
}

SONO_HD inline float remainingLength(const TraceView& view, const TraceLine& line, const PathState& path)
{
  return remainingLength(view.depthMm, line, path.ray.position, path.ray.direction, path.length);
}

SONO_HD inline bool sameAcoustics(const TraceMedium& a, const TraceMedium& b)
{
  return a.impedance == b.impedance && a.speed == b.speed;
}

/// How a piece of a path ended.
enum class PieceEnd
{
  Path,    ///< with the path: nothing more is met
  Medium,  ///< at media of equal impedance and speed, which are no boundary: only the attenuation changes there
  Boundary ///< at a boundary, where the path branches
};

/// How far a piece of a path can go: to the next target at most.
struct PieceLimit
{
  TargetHit target;
  float t; ///< mm along the ray
};

/// `Beam` is a TraceLine, or whatever else a remainingLength(view, beam, path) knows.
template<class Space, class Beam>
SONO_HD inline PieceLimit limitPiece(const TraceView& view, const Space& space, const Beam& beam, const PathState& path)
{
  const float tMax = remainingLength(view, beam, path);
  TargetHit target{ tMax, Vec3f(0.0f), -1 };
  if (space.targets.any())
  {
    target = space.targets.nearest(path.ray.position, path.ray.direction, tMax, path.target >= 0);
  }
  return { target, target.target >= 0 ? target.t : tMax };
}

/// Where the path leaves its medium, if it does: at the cells' `hit`, which counts outside of targets only, or at a
/// target's surface. `travelled` is how far it got.
template<class Space>
SONO_HD inline bool findBoundary(const Space& space, int firstTargetMedium, const PathState& path,
                                 const PieceLimit& limit, const CellHit& hit, PathBoundary& boundary, float& travelled)
{
  const CellRay& ray = path.ray;
  const TargetHit& target = limit.target;
  const bool meetsTarget = target.target >= 0;
  boundary.before = { ray.cell, path.tissue, path.target };
  if (path.target < 0)
  {
    travelled = hit.t;
    if (hit.tissue >= 0)
    {
      boundary.restart = hit.t;
      boundary.surface = space.refine(ray, hit);
      boundary.before.cell = hit.before;
      boundary.after = { hit.after, hit.tissue, -1 };
      boundary.voxelFace = true;
      return true;
    }
    if (!meetsTarget || hit.t < target.t)
    {
      return false;
    }
  }
  travelled = limit.t;
  if (!meetsTarget)
  {
    return false;
  }
  const Vec3i cell = space.cellAt(ray.position + ray.direction * target.t);
  if (!space.contains(cell))
  {
    return false;
  }
  boundary.restart = target.t;
  boundary.surface = { path.target < 0 ? -target.normal : target.normal, target.t };
  boundary.before.cell = cell;
  boundary.after = path.target < 0 ? BoundarySide{ cell, firstTargetMedium + target.target, target.target }
                                   : BoundarySide{ cell, space.tissueAt(cell), -1 };
  boundary.voxelFace = false;
  return true;
}

/// Takes the path to the end of its piece, which is written to `piece`. At a boundary the path stays in front of it.
template<class Space>
SONO_HD inline PieceEnd endPiece(const TraceView& view, const Space& space, const PieceLimit& limit, const CellHit& hit,
                                 PathState& path, PathBoundary& boundary, PathSegment& piece)
{
  float travelled = 0.0f;
  const bool met = findBoundary(space, view.firstTargetMedium, path, limit, hit, boundary, travelled);
  const TraceMedium& medium = view.media[path.tissue];
  piece = { path.ray.position, path.ray.direction, travelled, path.intensity, medium.decayPerMm };
  path.intensity *= expf(-medium.decayPerMm * travelled);
  path.length += travelled;
  if (!met)
  {
    return PieceEnd::Path;
  }
  const TraceMedium& next = view.media[boundary.after.medium];
  if (!sameAcoustics(medium, next))
  {
    boundary.cosine = smaller(1.0f, glm::dot(path.ray.direction, boundary.surface.normal));
    boundary.reflection =
      reflectionAt(view.model, medium.impedance, next.impedance, medium.speed, next.speed, boundary.cosine);
    return PieceEnd::Boundary;
  }
  path.ray.position += path.ray.direction * boundary.restart;
  path.ray.cell = boundary.after.cell;
  path.ignoreUntil -= boundary.restart;
  path.tissue = boundary.after.medium;
  path.target = boundary.after.target;
  return PieceEnd::Medium;
}

/// Each piece ends at a new medium, at least one cell on: this bounds the pieces between two boundaries.
template<class Space>
SONO_HD inline int mostPieces(const Space& space)
{
  const Vec3i size = space.size();
  return size.x + size.y + size.z;
}

/// Follows the path to its next boundary and hands every segment to the sink. Returns false when the path ends before
/// one.
template<class Space, class Beam, class Sink>
SONO_HD inline bool advanceToBoundary(const TraceView& view, const Space& space, const Beam& beam, PathState& path,
                                      PathBoundary& boundary, Sink& sink)
{
  const int most = mostPieces(space);
  for (int count = 0; count < most; ++count)
  {
    const PieceLimit limit = limitPiece(view, space, beam, path);
    CellHit hit{};
    if (path.target < 0)
    {
      hit = space.toBoundary(path.ray, path.tissue, path.ignored, path.ignoreUntil, limit.t);
    }
    PathSegment piece;
    const PieceEnd end = endPiece(view, space, limit, hit, path, boundary, piece);
    sink.segment(piece);
    if (end != PieceEnd::Medium)
    {
      return end == PieceEnd::Boundary;
    }
  }
  return false;
}

/// The echo of a boundary, at the sub-voxel point, shaped by the tissue behind it.
template<class Sink>
SONO_HD inline void depositBoundary(const TraceView& view, const PathState& path, const PathBoundary& boundary,
                                    Sink& sink)
{
  const TraceMedium& from = view.media[boundary.before.medium];
  const TraceMedium& to = view.media[boundary.after.medium];
  const float amplitude =
    boundaryEcho(view.model, from.impedance, to.impedance, path.intensity, boundary.cosine, to.tau, to.gamma);
  sink.echo(path.ray.position + path.ray.direction * boundary.surface.t, amplitude);
}

/// Without Monte-Carlo the path takes the stronger branch, mirrored or refracted, and carries its share.
SONO_HD inline Scattered strongerBranch(const PathState& path, const PathBoundary& boundary)
{
  const Vec3f& d = path.ray.direction;
  const Vec3f& n = boundary.surface.normal;
  const Reflection& r = boundary.reflection;
  const bool reflected = r.total || r.reflectance > 0.5f;
  const Vec3f w = reflected ? mirrorDirection(d, n, boundary.cosine) : refractedDirection(d, n, boundary.cosine, r);
  return { glm::normalize(w), reflected, reflected ? r.reflectance : 1.0f - r.reflectance };
}

/// How far a path that restarts on a voxel face must go before it counts as clear of the boundary it leaves. The cells
/// of a smooth surface are a staircase that reaches half a voxel's extent along the normal to either side of it; the
/// face itself may lie on the far side. The rest is for curvature and, where the normal is but the face's, for its
/// error.
template<class Space>
SONO_HD inline float clearance(const Space& space, const PathBoundary& boundary, const Vec3f& incident,
                               const Scattered& out)
{
  const Vec3f& n = boundary.surface.normal;
  const Vec3f h = space.spacing();
  const float stair = 0.5f * (fabsf(n.x) * h.x + fabsf(n.y) * h.y + fabsf(n.z) * h.z);
  const float beyond = (boundary.restart - boundary.surface.t) * glm::dot(incident, n);
  const float slack = (boundary.surface.smooth ? 0.3f : 0.8f) * space.meanSpacing();
  const float across = stair + slack + (out.reflected ? beyond : -beyond);
  const float leaving = larger(fabsf(glm::dot(out.direction, n)), 0.1f);
  return larger(0.0f, smaller(8.0f * space.meanSpacing(), across / leaving));
}

/// Leaves the boundary along a branch. The path restarts on the voxel face, in the cell it stays in, and does not see
/// the tissue on the other side again until it is clear of the boundary.
template<class Space>
SONO_HD inline void takeBranch(const Space& space, const PathBoundary& boundary, const Scattered& out, PathState& path)
{
  const Vec3f incident = path.ray.direction;
  const BoundarySide& side = out.reflected ? boundary.before : boundary.after;
  path.ray.position += incident * boundary.restart;
  path.ray.direction = out.direction;
  path.ray.cell = side.cell;
  path.tissue = side.medium;
  path.target = side.target;
  if (boundary.voxelFace)
  {
    path.ignored = out.reflected ? boundary.after.medium : boundary.before.medium;
    path.ignoreUntil = clearance(space, boundary, incident, out);
  }
  else
  {
    path.ignoreUntil -= boundary.restart;
  }
  path.intensity *= out.throughput;
  ++path.collisions;
}

/// Leaves the boundary along the branch drawn by `u`.
template<class Space>
SONO_HD inline void leaveBoundary(const TraceView& view, const Space& space, const PathBoundary& boundary,
                                  const BounceSample& u, PathState& path)
{
  const Scattered out = view.deterministic
                          ? strongerBranch(path, boundary)
                          : scatterAt(view.model, view.lobe, path.ray.direction, boundary.surface.normal,
                                      boundary.cosine, boundary.reflection, u);
  takeBranch(space, boundary, out, path);
}

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
  sink.segment(PathSegment{ line.origin, line.axis, path.length, 1.0f, 0.0f });
  path.tissue = space.tissueAt(path.ray.cell);
  if (path.tissue == view.outsideTissue)
  {
    const CellHit hit = space.toBoundary(path.ray, path.tissue, -1, 0.0f, remainingLength(view, line, path));
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
    depositBoundary(view, path, start.boundary, sink);
  }
  return start;
}

/// Identifies a path's random stream.
struct PathKey
{
  std::uint32_t line;
  std::uint32_t batch;
  std::uint32_t path;                        ///< within its batch
  const BounceScramble* scrambles = nullptr; ///< of the batch, one a bounce up to maxCollisions, or null to make them
};

SONO_HD inline BounceSample drawBounce(const TraceView& view, const PathKey& key, std::uint32_t bounce)
{
  if (view.lowDiscrepancy)
  {
    return lowDiscrepancySample(
      key.scrambles ? key.scrambles[bounce] : makeBounceScramble(view.seed, key.line, key.batch, bounce), key.path);
  }
  return independentSample(view.seed, key.line, key.batch, key.path, bounce);
}

/// Russian roulette: a path too faint to be seen lives on with a probability in proportion, at the intensity it then
/// stands for. The mean is unchanged.
SONO_HD inline bool survivesRoulette(const TraceView& view, const PathKey& key, PathState& path)
{
  if (path.intensity >= view.rouletteIntensity)
  {
    return true;
  }
  const float u =
    uniformFrom(philox(view.seed, key.line, key.path, std::uint32_t(path.collisions), key.batch | 0x80000000u).v[0]);
  const bool survives = u * view.rouletteIntensity < path.intensity;
  path.intensity = view.rouletteIntensity;
  return survives;
}

/// One path, from the first boundary on; it ends where it meets a boundary more than maxCollisions allow.
template<class Space, class Sink>
SONO_HD inline void tracePath(const TraceView& view, const Space& space, const TraceLine& line, const LineStart& start,
                              const PathKey& key, Sink& sink)
{
  PathState path = start.path;
  PathBoundary boundary = start.boundary;
  for (;;)
  {
    leaveBoundary(view, space, boundary, drawBounce(view, key, std::uint32_t(path.collisions)), path);
    if (!(path.intensity > 0.0f) || !survivesRoulette(view, key, path) ||
        !advanceToBoundary(view, space, line, path, boundary, sink) || path.collisions >= view.maxCollisions)
    {
      return;
    }
    depositBoundary(view, path, boundary, sink);
  }
}

} // namespace sono
