#pragma once

#include "Core/Progress.h"
#include "Trace/Trace.h"

#include <vector>

namespace sono {

/// A boundary that a path met, where its echo comes from: on the surface, which lies between voxels.
struct BoundaryHit
{
  Vec3d pointMm;         ///< world
  Vec3d normal;          ///< world, unit length, from the medium before into the one behind
  float intensity;       ///< of the path on arrival, 1 at the transducer
  float echo;            ///< amplitude of the boundary's echo, were it smooth, before the coherence weight
  float incidenceCosine; ///< of the angle between the path and the normal, above 0
  float depthMm;         ///< along the line's axis
  float pathMm;          ///< travelled since the transducer
  int bounce;            ///< boundaries met before
  int from;              ///< medium before and behind: indices into the scene's tissues and, after these, the targets
  int to;
};

/// One path for display: its corners in world mm, the intensity on arrival at each and the boundaries met before it;
/// and these boundaries.
struct RecordedPath
{
  int line = 0;
  std::vector<Vec3d> pointMm;
  std::vector<float> intensity;
  std::vector<int> bounce;
  std::vector<BoundaryHit> hits;
  float cutOff = 0.0f; ///< intensity at its end where that is one boundary more than a path may meet
};

/// `count` of the paths that trace() would follow with the same arguments, chosen evenly over lines and paths, in the
/// order of the lines and of their paths. Throws Error unless `count` is 1 to 100,000, and as trace(), Aborted when
/// asked to stop.
std::vector<RecordedPath> recordPaths(const Scene& scene, const std::vector<ScanLine>& lines,
                                      const TraceSettings& settings, int count,
                                      const std::vector<TargetSurface>& targets = {}, const Progress& progress = {});

} // namespace sono
