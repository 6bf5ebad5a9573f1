#pragma once

#include "Kernel/PathState.h"
#include "Kernel/TraceView.h"

// How a path goes on from a boundary: mirrored or refracted, coherently or by facets; in Amadou2024 by the lobe.

namespace sono {

/// Without Monte-Carlo the path takes the stronger branch, mirrored or refracted, and carries its share.
SONO_HD inline Scattered strongerBranch(const PathState& path, const PathBoundary& boundary)
{
  const Vec3f& d = path.ray.direction;
  const Vec3f& n = boundary.surface.normal;
  const Reflection& r = boundary.reflection;
  const bool reflected = r.total || r.reflectance > 0.5f;
  const Vec3f w = reflected ? mirrorDirection(d, n, boundary.cosine) : refractedDirection(d, n, boundary.cosine, r);
  const float share = reflected ? r.reflectance : 1.0f - r.reflectance;
  return { glm::normalize(w), reflected, share, reflected && r.amplitude < 0.0f ? -sqrtf(share) : sqrtf(share) };
}

/// The transducer's face as a mirror, with the way through the coupling.
SONO_HD inline Scattered mirroredByFace(const TraceView& view, const PathBoundary& boundary, PathState& path)
{
  path.length += 2.0f * boundary.toFaceMm;
  path.rangeMm += 2.0f * boundary.toFaceMm;
  return { mirrorDirection(path.ray.direction, boundary.surface.normal, boundary.cosine), true,
           view.faceReflection * view.faceReflection, view.faceReflection };
}

/// Leaves the boundary along a branch. The path restarts on the voxel face, in the cell it stays in, and passes the
/// boundary's stairs.
SONO_HD inline void takeBranch(const TraceView& view, const PathBoundary& boundary, const Scattered& out,
                               PathState& path)
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
    // The surface, not the voxel's face, is where the medium changes and where a path turns.
    const float beyond = boundary.restart - boundary.surface.t;
    const float before = view.media[boundary.before.medium].rangePerMm;
    const float behind = view.media[boundary.after.medium].rangePerMm;
    path.rangeMm += beyond * (out.reflected ? -2.0f * before : behind - before);
    const int left = out.reflected ? boundary.after.medium : boundary.before.medium;
    const Vec3f into = out.reflected ? -boundary.surface.normal : boundary.surface.normal;
    path.left = leftSurface(left, into, beyond * glm::dot(incident, into));
  }
  else
  {
    path.left = LeftSurface();
  }
  path.intensity *= out.throughput;
  path.amplitude *= out.amplitude;
  path.choice = out.choice;
  path.reflections += out.reflected ? 1 : 0;
  path.pieces = 0;
  ++path.collisions;
}

/// Leaves the boundary along the branch drawn by `u`.
SONO_HD inline void leaveBoundary(const TraceView& view, const PathBoundary& boundary, const BounceSample& u,
                                  PathState& path)
{
  const Vec3f& d = path.ray.direction;
  const Vec3f& n = boundary.surface.normal;
  Scattered out;
  if (boundary.isFace)
  {
    out = mirroredByFace(view, boundary, path);
  }
  else if (view.deterministic)
  {
    out = strongerBranch(path, boundary);
  }
  else if (view.model == InterfaceModel::Acoustic)
  {
    const RoughBoundary rough =
      roughBoundary(view, view.media[boundary.before.medium], view.media[boundary.after.medium]);
    const bool betweenMirrors = path.reflections > 0 && path.amplitude != 0.0f;
    const float chance = reflectionChance(boundary.reflection, view.favoursReflections, betweenMirrors);
    out = scatterRough(rough, d, n, boundary.cosine, boundary.reflection, chance, u);
  }
  else
  {
    out = scatterByLobe(view.lobe, d, n, boundary.cosine, boundary.reflection, u);
  }
  if (out.reflected && view.model == InterfaceModel::Acoustic && !view.reverberates)
  {
    out.throughput = 0.0f;
  }
  takeBranch(view, boundary, out, path);
}

} // namespace sono
