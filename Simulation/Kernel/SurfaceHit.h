#pragma once

#include "Kernel/BoundaryRecord.h"
#include "Kernel/CellMarch.h"

#include <cmath>
#include <cstdint>
#include <glm/vector_relational.hpp>

// Where within a voxel the surface lies that a march has met, and which way it faces.

namespace sono {

/// The refined boundary between two face-adjacent cells.
struct RefinedHit
{
  Vec3f normal;        ///< unit, from the old tissue to the new one; direction . normal > 0
  float t;             ///< sub-voxel distance along the ray
  bool smooth = false; ///< false: the voxel face itself
};

/// How far the surface of either side of a boundary is trusted, 0 or 1.
struct SideWeights
{
  float before;
  float after;
};

/// The records of the eight voxels around a point, each as its tissue is that before a boundary or that behind it.
struct RecordSum
{
  Vec3f normals; ///< from the tissue before to the one behind, on the octahedron, weighted
  float weight;  ///< of all
};

/// Around the point `share` of the way from the voxel `low` to the next along each axis, from centre to centre.
template<class Cells>
SONO_HD inline RecordSum sumRecords(const Cells& cells, const Vec3i& low, const Vec3f& share, int from, int to,
                                    const SideWeights& weights)
{
  RecordSum sum{ Vec3f(0.0f), 0.0f };
  for (int corner = 0; corner < 8; ++corner)
  {
    const int ox = corner & 1;
    const int oy = (corner >> 1) & 1;
    const int oz = corner >> 2;
    const std::uint32_t word = cells.wordAt(low.x + ox, low.y + oy, low.z + oz);
    const int tissue = int(word & 255u);
    const float side = tissue == from ? weights.before : (tissue == to ? -weights.after : 0.0f);
    if ((word & 0x8000u) == 0u || side == 0.0f)
    {
      continue;
    }
    const std::uint32_t bits = cells.recordOf(low.x + ox, low.y + oy, low.z + oz, word);
    const float w = decodeConfidence(bits) * (ox ? share.x : 1.0f - share.x) * (oy ? share.y : 1.0f - share.y) *
                    (oz ? share.z : 1.0f - share.z);
    // Neighbours point almost the same way, so the octahedron scales them almost alike.
    sum.normals += decodeOctahedral(bits) * (w * side);
    sum.weight += w * fabsf(side);
  }
  return sum;
}

/// The normal from tissue `from` to `to` at a point of their boundary, interpolated between the records of the eight
/// voxels around the point. A voxel's own record holds at its centre; a curved surface turns away from it.
/// Returns `fallback` where the records disagree.
template<class Cells>
SONO_HD inline Vec3f interpolateNormal(const Cells& cells, const Vec3f& point, int from, int to,
                                       const SideWeights& weights, const Vec3f& fallback)
{
  const Vec3f g = point / cells.spacing - Vec3f(0.5f);
  const Vec3i low(int(floorf(g.x)), int(floorf(g.y)), int(floorf(g.z)));
  if (glm::any(glm::lessThan(low, Vec3i(-1))) || glm::any(glm::greaterThanEqual(low, cells.size)))
  {
    return fallback;
  }
  const RecordSum sum = sumRecords(cells, low, g - Vec3f(low), from, to, weights);
  const float length = glm::length(sum.normals);
  return length > 0.3f * sum.weight ? sum.normals / length : fallback;
}

template<class Cells>
SONO_HD inline std::uint32_t recordAt(const Cells& cells, const Vec3i& c)
{
  return cells.recordOf(c.x, c.y, c.z, cells.wordAt(c.x, c.y, c.z));
}

/// The step from one voxel of a hit to the other: a unit vector along an axis.
SONO_HD inline Vec3f stepOf(const CellRay& ray, const CellHit& hit)
{
  return { hit.axis == 0 ? signNotZero(ray.direction.x) : 0.0f, hit.axis == 1 ? signNotZero(ray.direction.y) : 0.0f,
           hit.axis == 2 ? signNotZero(ray.direction.z) : 0.0f };
}

/// THE rule for the surface between two labels. Each side's record describes its own smoothed surface; they disagree
/// slightly. The side with the larger gradient leads; the other is dropped when its gradient is below 0.59 of it (a
/// thin wall has lost its own surface, its thick neighbour has not; gradients come in sevenths, and at 0.6 rounding
/// would decide on 3/7 beside 5/7); else the normals are averaged. The point moves along the ray to the plane of the
/// records, by one voxel at most; there the normal is interpolated. Where the smooth normal says that the ray leaves
/// rather than enters, the voxel face stands.
/// A voxel of a thin layer has two surfaces and one record. Where that looks against the step it is of the other
/// surface, and does not count. The two run side by side: where no record is to be trusted, one with a slight gradient
/// gives the normal, in the sense in which the ray enters, and the voxel's face the place.
template<class Cells>
SONO_HD inline RefinedHit refineBoundary(const Cells& cells, const CellRay& ray, const CellHit& hit)
{
  constexpr float against = -0.2f; // steps along a surface are 0, and normals err
  constexpr float least = 0.15f;
  constexpr float slightest = 0.1f;
  const Vec3f face = stepOf(ray, hit);
  const std::uint32_t bitsA = recordAt(cells, hit.before);
  const std::uint32_t bitsB = recordAt(cells, hit.after);
  if ((bitsA | bitsB) == 0u)
  {
    return { face, hit.t };
  }
  const BoundaryRecord a = decodeRecord(bitsA);
  const BoundaryRecord b = decodeRecord(bitsB);
  const float toldA = bitsA ? a.confidence : 0.0f;
  const float toldB = bitsB ? b.confidence : 0.0f;
  const float confA = glm::dot(a.normal, face) > against ? toldA : 0.0f;
  const float confB = glm::dot(b.normal, face) < -against ? toldB : 0.0f;
  const float best = larger(confA, confB);
  const float weightA = confA >= 0.59f * best ? 1.0f : 0.0f;
  const float weightB = confB >= 0.59f * best ? 1.0f : 0.0f;
  const Vec3f sum = a.normal * weightA - b.normal * weightB;
  const float length = glm::length(sum);
  if (best < least || length < 0.5f)
  {
    const Vec3f told = toldA > toldB ? a.normal : b.normal;
    const Vec3f across = told * signNotZero(glm::dot(told, ray.direction));
    // A ray must not be turned back through the face by which it came.
    const bool isTold = best < least && larger(toldA, toldB) > slightest && glm::dot(across, face) > 0.0f &&
                        glm::dot(across, ray.direction) > 0.01f;
    return { isTold ? across : face, hit.t };
  }
  const Vec3f n = sum / length;
  const float cosine = glm::dot(ray.direction, n);
  if (cosine < 0.01f)
  {
    return { face, hit.t };
  }
  const Vec3f pointA = (Vec3f(hit.before) + Vec3f(0.5f)) * cells.spacing + a.normal * (a.offset * cells.meanSpacing);
  const Vec3f pointB = (Vec3f(hit.after) + Vec3f(0.5f)) * cells.spacing + b.normal * (b.offset * cells.meanSpacing);
  const Vec3f point = (pointA * weightA + pointB * weightB) / (weightA + weightB);
  const float reach = cells.meanSpacing;
  const float plane = glm::dot(point - ray.position, n) / cosine;
  const float t = larger(0.0f, smaller(larger(plane, hit.t - reach), hit.t + reach));
  const Vec3f smooth = interpolateNormal(cells, ray.position + ray.direction * t, cells.tissueAt(hit.before),
                                         hit.tissue, { weightA, weightB }, n);
  return { glm::dot(ray.direction, smooth) < 0.01f ? n : smooth, t, true };
}

} // namespace sono
