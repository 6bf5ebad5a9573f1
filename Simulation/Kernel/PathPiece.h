#pragma once

#include "Kernel/CellSpace.h"
#include "Kernel/PathState.h"
#include "Kernel/Reverberation.h"
#include "Kernel/TraceView.h"

// A path from where it stands to the next boundary, piece by piece: a piece lies in one medium.

namespace sono {

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

/// A path that has been reflected is heard by its time: where its medium is fast, it may go further.
SONO_HD inline float remainingLength(const TraceView& view, const TraceLine& line, const PathState& path)
{
  float length = path.length;
  if (path.reflections > 0 && view.model == InterfaceModel::Acoustic)
  {
    const float slow = smaller(1.0f, view.media[path.tissue].rangePerMm);
    length = 2.0f * view.depthMm - (2.0f * view.depthMm - path.rangeMm) / slow;
  }
  return remainingLength(view.depthMm, line, path.ray.position, path.ray.direction, length);
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
      boundary.surface = refineBoundary(space.cells, ray, hit);
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

/// Each piece ends at a new medium, at least one cell on: this bounds the pieces between two boundaries.
template<class Space>
SONO_HD inline int mostPieces(const Space& space)
{
  const Vec3i size = space.size();
  return size.x + size.y + size.z;
}

/// Takes the path to the end of its piece, which is written to `piece`. At a boundary the path stays in front of it.
template<class Space>
SONO_HD inline PieceEnd endPiece(const TraceView& view, const Space& space, const PieceLimit& limit, const CellHit& hit,
                                 PathState& path, PathBoundary& boundary, PathSegment& piece)
{
  float travelled = 0.0f;
  const bool met = findBoundary(space, view.firstTargetMedium, path, limit, hit, boundary, travelled);
  const TraceMedium& medium = view.media[path.tissue];
  piece = { path.ray.position, path.ray.direction, travelled,         path.intensity, medium.decayPerMm, path.absorbed,
            path.length,       path.rangeMm,       medium.rangePerMm, medium.scatter, path.reflections };
  const float left = expf(-medium.decayPerMm * travelled);
  path.intensity *= left;
  path.amplitude *= sqrtf(left);
  path.absorbed += medium.decayPerMm * travelled;
  path.length += travelled;
  path.rangeMm += medium.rangePerMm * travelled;
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
  path.left.move(path.ray.direction * boundary.restart);
  path.tissue = boundary.after.medium;
  path.target = boundary.after.target;
  return ++path.pieces < mostPieces(space) ? PieceEnd::Medium : PieceEnd::Path;
}

/// A path that has been reflected and comes back to the transducer: its face is what it meets. It may lie inside of the
/// body, where a piece ends at it, or behind the skin.
template<class Space>
SONO_HD inline PieceEnd meetFace(const TraceView& view, const Space& space, const TraceLine& own, float travelled,
                                 PieceEnd end, PathState& path, PathBoundary& boundary)
{
  if (path.reflections == 0 || view.faceReflection == 0.0f || view.model != InterfaceModel::Acoustic)
  {
    return end;
  }
  const Vec3f& d = path.ray.direction;
  const Vec3f place = path.ray.position + d * (end == PieceEnd::Path ? travelled : boundary.surface.t);
  const bool leaves = end == PieceEnd::Boundary && boundary.after.medium == view.outsideTissue;
  const FaceAhead face = faceAhead(view, own, place, d);
  constexpr float nextToMm = 2.0f;
  if (!face.isThere || path.target >= 0 || !(leaves || (end == PieceEnd::Path && fabsf(face.mm) < nextToMm)))
  {
    return end;
  }
  if (!leaves)
  {
    const BoundarySide here{ glm::clamp(space.cellAt(place), Vec3i(0), space.size() - 1), path.tissue, -1 };
    boundary.before = here;
    boundary.after = here;
    boundary.restart = travelled;
    boundary.voxelFace = false;
  }
  boundary.surface = { -own.face, leaves ? boundary.surface.t : travelled, true };
  boundary.cosine = -glm::dot(d, own.face);
  boundary.isFace = true;
  boundary.toFaceMm = face.mm;
  return PieceEnd::Boundary;
}

/// Others have no face.
template<class Space, class Beam>
SONO_HD inline PieceEnd meetFace(const TraceView&, const Space&, const Beam&, float, PieceEnd end, PathState&,
                                 PathBoundary&)
{
  return end;
}

/// Follows the path to the end of the piece ahead, which the sink gets. At a boundary the path stays in front of it.
template<class Space, class Beam, class Sink>
SONO_HD inline PieceEnd walkPiece(const TraceView& view, const Space& space, const Beam& beam, PathState& path,
                                  PathBoundary& boundary, Sink& sink)
{
  const PieceLimit limit = limitPiece(view, space, beam, path);
  CellHit hit{};
  if (path.target < 0)
  {
    hit = marchPastStairs(space, path.ray, path.tissue, path.left, limit.t);
  }
  PathSegment piece;
  boundary.isFace = false;
  const PieceEnd end = endPiece(view, space, limit, hit, path, boundary, piece);
  sink.segment(piece);
  return meetFace(view, space, beam, piece.length, end, path, boundary);
}

/// Follows the path to its next boundary. Returns false when the path ends before one.
template<class Space, class Beam, class Sink>
SONO_HD inline bool advanceToBoundary(const TraceView& view, const Space& space, const Beam& beam, PathState& path,
                                      PathBoundary& boundary, Sink& sink)
{
  PieceEnd end = PieceEnd::Medium;
  while (end == PieceEnd::Medium)
  {
    end = walkPiece(view, space, beam, path, boundary, sink);
  }
  return end == PieceEnd::Boundary;
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
  if (path.reflections > 0 && view.model == InterfaceModel::Acoustic)
  {
    sink.arrives(path, boundary);
  }
}

} // namespace sono
