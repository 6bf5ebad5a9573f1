#pragma once

#include "Kernel/Interface.h"
#include "Kernel/LeftSurface.h"
#include "Kernel/SurfaceHit.h"

// What a path is, what it meets and what it tells on its way. See TracePath.h.

namespace sono {

/// A path between two boundaries.
struct PathState
{
  CellRay ray;
  float intensity = 1.0f;
  float absorbed = 0.0f; ///< attenuation met so far, Np of intensity
  float length = 0.0f;   ///< travelled since the transducer, mm
  float rangeMm = 0.0f;  ///< the same by time: c0 / c of each millimetre
  /// Of what is in phase, with its sign: the root of the intensity with which the path's own way arrives, over the
  /// chance with which the path was drawn.
  float amplitude = 1.0f;
  int reflections = 0;
  int tissue = 0;  ///< medium that the path is in
  int target = -1; ///< target that the path is in; the cells do not count there
  LeftSurface left;
  int collisions = 0;
  /// Of a path that every boundary so far has transmitted coherently: where in that share of all paths its number lies,
  /// [0, 1]. Uniform again, it is the next boundary's choice.
  float choice = 0.0f;
  int pieces = 0; ///< since the last boundary
};

/// Whether every boundary so far has transmitted the path coherently.
SONO_HD inline bool isOnCoherentWay(const PathState& path)
{
  return path.reflections == 0 && path.amplitude > 0.0f;
}

/// A straight piece of a path inside one tissue.
struct PathSegment
{
  Vec3f start;
  Vec3f direction;
  float length;
  float intensity; ///< at its start
  float decayPerMm;
  float absorbed;        ///< of PathState, at its start
  float lengthMm = 0.0f; ///< the same
  float rangeMm = 0.0f;
  float rangePerMm = 1.0f; ///< of the medium
  float scatter = 0.0f;
  int reflections = 0;
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
  /// It is the transducer's face that reflects, so far behind the boundary, through coupling, mm; the normal is then
  /// the face's.
  bool isFace = false;
  float toFaceMm = 0.0f;
  float cosine;
  Reflection reflection;
};

/// Who listens to a path. A sink derives from this and says what it wants to hear; the calls come in the order of the
/// way.
struct PathSink
{
  /// A piece, also an empty one.
  SONO_HD void segment(const PathSegment&) {}
  /// The path stands in front of a boundary. Its echo follows, unless the path ends there.
  SONO_HD void meets(const PathState&, const PathBoundary&) {}
  /// The echo of that boundary: its place and amplitude, before the coherence weight. In Amadou2024 it is part of the
  /// image; in Acoustic surfaces echo by themselves, and this is what a smooth one across the path would.
  SONO_HD void echo(const Vec3f& /*point*/, float /*amplitude*/) {}
  /// The same boundary, for a path that has been reflected, in Acoustic: what it lets be heard is boundaryArrival.
  SONO_HD void arrives(const PathState&, const PathBoundary&) {}
  /// The path has left the boundary along a branch; it may still end there, by roulette.
  SONO_HD void left(const PathState&, const PathBoundary&) {}
};

} // namespace sono
