#pragma once

#include "Kernel/BoundaryRecord.h"
#include "Kernel/Vec.h"

#include <cmath>
#include <cstdint>

namespace sono
{

/// A view of the tracer's cache of a region: one 16-bit word per voxel (low byte: tissue index, high byte: half-width
/// of the largest cube around the voxel known to hold that tissue alone) and one boundary record per voxel. Local
/// millimetres with 0 at the region's outer corner; i fastest.
struct TissueCells
{
  const std::uint16_t* cell = nullptr;
  const std::uint32_t* record = nullptr;
  Vec3i size{ 0, 0, 0 };
  Vec3f spacing{ 1.0f, 1.0f, 1.0f };
  float meanSpacing = 1.0f; ///< cube root of the voxel's volume

  SONO_HD std::size_t offset(const Vec3i& c) const
  {
    return std::size_t(c.x) + std::size_t(size.x) * (std::size_t(c.y) + std::size_t(size.y) * std::size_t(c.z));
  }
  SONO_HD bool contains(const Vec3i& c) const
  {
    return unsigned(c.x) < unsigned(size.x) && unsigned(c.y) < unsigned(size.y) && unsigned(c.z) < unsigned(size.z);
  }
  SONO_HD int tissueAt(const Vec3i& c) const { return cell[offset(c)] & 255; }
  SONO_HD Vec3i cellAt(const Vec3f& position) const
  {
    const Vec3f p = position / spacing;
    return Vec3i(int(floorf(p.x)), int(floorf(p.y)), int(floorf(p.z)));
  }
};

/// A ray that is being marched. Position and cell are carried together: a ray restarts from the face it met in the
/// cell it belongs to, so that no epsilon decides on which side it stands.
struct CellRay
{
  Vec3f position;  ///< mm
  Vec3f direction; ///< unit
  Vec3i cell;
};

/// Where a march ended.
struct CellHit
{
  float t;      ///< mm along the ray
  Vec3i before; ///< the last cell of the tissue left
  Vec3i after;  ///< the first cell of the new tissue
  int tissue;   ///< of `after`; -1 when the ray ended at tMax or left the region
  int axis;     ///< of the face between them
};

SONO_HD inline float safeInverse(float d)
{
  return fabsf(d) < 1e-9f ? 0.0f : 1.0f / d;
}

/// Marches to the first cell whose tissue is not `current`. Cells of tissue `ignored` count as `current` while
/// t < ignoreUntil (hysteresis after a boundary; -1: none). Steps over uniform cubes at once.
SONO_HD inline CellHit marchToBoundary(const TissueCells& cells,
                                       const CellRay& ray,
                                       int current,
                                       int ignored,
                                       float ignoreUntil,
                                       float tMax)
{
  const Vec3f p = ray.position / cells.spacing;
  const Vec3f d = ray.direction / cells.spacing;
  const Vec3f inverse(safeInverse(d.x), safeInverse(d.y), safeInverse(d.z));
  const Vec3i side(d.x > 0.0f ? 1 : 0, d.y > 0.0f ? 1 : 0, d.z > 0.0f ? 1 : 0);
  Vec3i c = ray.cell;
  float t = 0.0f;
  int skip = cells.contains(c) ? cells.cell[cells.offset(c)] >> 8 : 0;
  // Each step leaves at least one plane of cells behind, so this bounds any ray.
  const int maxSteps = cells.size.x + cells.size.y + cells.size.z + 3;
  CellHit hit{ tMax, c, c, -1, 0 };
  for (int step = 0; step < maxSteps; ++step)
  {
    // The face through which the ray leaves the cube [c - skip, c + skip].
    float exit = 3e38f;
    int axis = 0;
    for (int a = 0; a < 3; ++a)
    {
      const int face = side[a] ? c[a] + skip + 1 : c[a] - skip;
      const float ta = inverse[a] == 0.0f ? 3e38f : (float(face) - p[a]) * inverse[a];
      if (ta < exit)
      {
        exit = ta;
        axis = a;
      }
    }
    exit = fmaxf(exit, t);
    if (exit >= tMax)
    {
      hit.t = tMax;
      return hit;
    }
    hit.before = c;
    if (skip > 0)
    {
      for (int a = 0; a < 3; ++a)
      {
        if (a != axis)
        {
          const int moved = int(floorf(p[a] + exit * d[a]));
          hit.before[a] = moved < c[a] - skip ? c[a] - skip : (moved > c[a] + skip ? c[a] + skip : moved);
        }
      }
      hit.before[axis] = side[axis] ? c[axis] + skip : c[axis] - skip;
    }
    c = hit.before;
    c[axis] += side[axis] ? 1 : -1;
    t = exit;
    hit.t = t;
    hit.axis = axis;
    if (!cells.contains(c))
    {
      return hit;
    }
    const std::uint32_t word = cells.cell[cells.offset(c)];
    const int tissue = int(word & 255u);
    if (tissue != current && (tissue != ignored || t >= ignoreUntil))
    {
      hit.after = c;
      hit.tissue = tissue;
      return hit;
    }
    skip = int(word >> 8);
  }
  return hit;
}

/// The refined boundary between two face-adjacent cells.
struct RefinedHit
{
  Vec3f normal; ///< unit, from the old tissue to the new one; direction . normal > 0
  float t;      ///< sub-voxel distance along the ray
};

/// THE rule for the surface between two labels. Each side's record describes its own smoothed surface; they disagree
/// slightly. The side with the larger gradient leads; the other is dropped when its gradient is below 0.6 of it (a thin
/// wall has lost its own surface, its thick neighbour has not); else the normals are averaged. The point moves
/// along the ray to the plane of the records, by one voxel at most. Where no record is trustworthy, or the smooth
/// normal says that the ray leaves rather than enters, the voxel face stands.
SONO_HD inline RefinedHit refineBoundary(const TissueCells& cells, const CellRay& ray, const CellHit& hit)
{
  Vec3f face(0.0f);
  face[hit.axis] = ray.direction[hit.axis] > 0.0f ? 1.0f : -1.0f;
  const std::uint32_t bitsA = cells.record[cells.offset(hit.before)];
  const std::uint32_t bitsB = cells.record[cells.offset(hit.after)];
  if ((bitsA | bitsB) == 0u)
  {
    return { face, hit.t };
  }
  const BoundaryRecord a = decodeRecord(bitsA);
  const BoundaryRecord b = decodeRecord(bitsB);
  const float confA = bitsA ? a.confidence : 0.0f;
  const float confB = bitsB ? b.confidence : 0.0f;
  const float best = fmaxf(confA, confB);
  const float weightA = confA >= 0.6f * best ? 1.0f : 0.0f;
  const float weightB = confB >= 0.6f * best ? 1.0f : 0.0f;
  const Vec3f sum = a.normal * weightA - b.normal * weightB;
  const float length = glm::length(sum);
  if (best < 0.15f || length < 0.5f)
  {
    return { face, hit.t };
  }
  const Vec3f n = sum / length;
  const float cosine = glm::dot(ray.direction, n);
  if (cosine < 0.01f)
  {
    return { face, hit.t };
  }
  const Vec3f pointA = (Vec3f(hit.before) + 0.5f) * cells.spacing + a.normal * (a.offset * cells.meanSpacing);
  const Vec3f pointB = (Vec3f(hit.after) + 0.5f) * cells.spacing + b.normal * (b.offset * cells.meanSpacing);
  const Vec3f point = (pointA * weightA + pointB * weightB) / (weightA + weightB);
  const float t = glm::dot(point - ray.position, n) / cosine;
  const float reach = cells.meanSpacing;
  return { n, fmaxf(0.0f, fminf(fmaxf(t, hit.t - reach), hit.t + reach)) };
}

} // namespace sono
