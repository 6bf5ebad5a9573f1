#pragma once

#include "Kernel/SurfacePiece.h"
#include "Scene/StepMap.h"
#include "Scene/SurfaceFace.h"

#include <algorithm>
#include <cmath>

// The smooth piece of a face, on a core or by a warp (SurfacePieces).

namespace sono::stepfit {
inline namespace SONO_LANES_NAMESPACE {

/// How much of a surface the columns along an axis stand for. Each axis' columns cover all of it, evenly but for a
/// stretch by 1 / facing; those that see it best share it, with smooth weights.
SONO_LANES inline float shareOf(const Vec3f& normal, int axis)
{
  const auto part = [](float facing) {
    constexpr float leastFacing = 0.5f; // of a normal along the column: some axis has 0.577
    const float q = std::max(0.0f, std::fabs(facing) - leastFacing);
    return q * q;
  };
  return part(normal[axis]) / (part(normal.x) + part(normal.y) + part(normal.z));
}

/// Its share is 0 where another axis' columns stand for all of the surface.
SONO_LANES inline SurfacePiece fitPiece(StepMap& map, const Vec3f& spacing, const SurfaceFace& face)
{
  const Vec3i voxel = face.voxel;
  const int axis = face.axis;
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  Quadratic q{};
  if (!map.smoothest(voxel, axis, spacing, q) && face.roughNormal != Vec3f(0.0f))
  {
    // In voxels.
    q.c1 = -face.roughNormal[u] * spacing[u] / (face.roughNormal[axis] * spacing[axis]);
    q.c2 = -face.roughNormal[v] * spacing[v] / (face.roughNormal[axis] * spacing[axis]);
  }
  Vec3f normal(0.0f); // in voxels, where columns are what covers the surface
  normal[axis] = 1.0f;
  normal[u] = -q.c1;
  normal[v] = -q.c2;
  SurfacePiece piece{};
  piece.share = shareOf(glm::normalize(normal), axis);
  if (!(piece.share > 0.0f))
  {
    piece.share = 0.0f;
    return piece;
  }
  piece.positionMm = (Vec3f(voxel) + 0.5f) * spacing;
  piece.positionMm[axis] += (0.5f + q.c0) * spacing[axis];
  piece.slopeU = q.c1 * spacing[axis] / spacing[u];
  piece.slopeV = q.c2 * spacing[axis] / spacing[v];
  piece.bendUU = 2.0f * q.c3 * spacing[axis] / (spacing[u] * spacing[u]);
  piece.bendUV = q.c5 * spacing[axis] / (spacing[u] * spacing[v]);
  piece.bendVV = 2.0f * q.c4 * spacing[axis] / (spacing[v] * spacing[v]);
  piece.axis = std::uint8_t(axis);
  piece.below = face.below;
  piece.above = face.above;
  piece.voxel = voxel;
  piece.roughNormal = face.roughNormal;
  return piece;
}

} // namespace SONO_LANES_NAMESPACE
} // namespace sono::stepfit
