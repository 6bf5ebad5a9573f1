#pragma once

#include "Kernel/BoundaryRecord.h"
#include "Kernel/Vec.h"

#include <cmath>
#include <cstdint>
#include <glm/vector_relational.hpp>

namespace sono {

/// A view of the tracer's cache of a region: one 16-bit word per voxel and one record per boundary voxel. The word's
/// low byte is the tissue index. Its high byte is, below 128, the half-width of a cube around the voxel known to hold
/// that tissue alone; else 128 + the voxel's rank among those of its block that have a record. Local millimetres with 0
/// at the region's outer corner. Voxels lie in blocks of 4 x 4 x 2, one cache line of words each, so that a ray in any
/// direction meets about three voxels a line.
struct TissueCells
{
  const std::uint16_t* cell = nullptr;
  const std::uint32_t* firstRecord = nullptr; ///< of each block
  const std::uint32_t* record = nullptr;
  Vec3i size{ 0, 0, 0 };
  Vec3i blocks{ 0, 0, 0 };
  Vec3f spacing{ 1.0f, 1.0f, 1.0f };
  float meanSpacing = 1.0f; ///< cube root of the voxel's volume

  /// With a border of one voxel all around, which holds `outsideWord`: a march needs no other test for the region's
  /// end.
  static Vec3i blocksFor(const Vec3i& size) { return { (size.x + 5) >> 2, (size.y + 5) >> 2, (size.z + 3) >> 1 }; }
  static constexpr std::uint16_t outsideWord = 255;
  SONO_HD std::size_t offset(const Vec3i& c) const { return offset(c.x, c.y, c.z); }
  /// For -1 <= x <= size.x, and so on.
  SONO_HD std::size_t offset(int x, int y, int z) const
  {
    const unsigned ux = unsigned(x + 1);
    const unsigned uy = unsigned(y + 1);
    const unsigned uz = unsigned(z + 1);
    const unsigned block = (ux >> 2) + unsigned(blocks.x) * ((uy >> 2) + unsigned(blocks.y) * (uz >> 1));
    return (std::size_t(block) << 5) | ((ux & 3u) | ((uy & 3u) << 2) | ((uz & 1u) << 4));
  }
  /// The record of the voxel with that offset and word; 0 where it has none.
  SONO_HD std::uint32_t recordOf(std::size_t offset, std::uint32_t word) const
  {
    return (word & 0x8000u) ? record[firstRecord[offset >> 5] + ((word >> 8) & 31u)] : 0u;
  }
  SONO_HD std::uint32_t recordAt(const Vec3i& c) const
  {
    const std::size_t at = offset(c);
    return recordOf(at, cell[at]);
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

SONO_HD inline float smaller(float a, float b)
{
  return a < b ? a : b;
}
SONO_HD inline float larger(float a, float b)
{
  return a > b ? a : b;
}

/// One axis of a march in voxel units. The face at which the ray leaves the cube [c - skip, c + skip] is
/// c + sign * skip + step, and is met at t = (face - p) * inverse + never.
struct AxisMarch
{
  float p;
  float d;
  float inverse;
  float never; ///< huge where the ray runs along the face
  int sign;
  int step; ///< 1 when ascending, else 0

  SONO_HD AxisMarch(float position, float direction)
    : p(position)
    , d(direction)
    , inverse(safeInverse(direction))
    , never(inverse == 0.0f ? 3e38f : 0.0f)
    , sign(direction > 0.0f ? 1 : -1)
    , step(direction > 0.0f ? 1 : 0)
  {
  }
  SONO_HD float leave(int c, int skip) const { return (float(c + sign * skip + step) - p) * inverse + never; }
  /// The cell at t, known to lie in the cube around c.
  SONO_HD int cellAt(float t, int c, int skip) const
  {
    const int moved = int(floorf(p + t * d));
    return moved < c - skip ? c - skip : (moved > c + skip ? c + skip : moved);
  }
};

/// Cubes of a smaller half-width are walked through.
constexpr int worthJumping = 5;

/// Marches to the first cell whose tissue is not `current`. Cells of tissue `ignored` count as `current` while
/// t < ignoreUntil (hysteresis after a boundary; -1: none), and are passed one by one: what is left of them then is met
/// at the next face. Walks cell by cell, so that the next address does not wait
/// for the last word (a processor runs ahead), and jumps where a uniform cube is large enough to pay for the wait.
SONO_HD inline CellHit marchToBoundary(const TissueCells& cells, const CellRay& ray, int current, int ignored,
                                       float ignoreUntil, float tMax)
{
  const AxisMarch ax(ray.position.x / cells.spacing.x, ray.direction.x / cells.spacing.x);
  const AxisMarch ay(ray.position.y / cells.spacing.y, ray.direction.y / cells.spacing.y);
  const AxisMarch az(ray.position.z / cells.spacing.z, ray.direction.z / cells.spacing.z);
  int x = ray.cell.x;
  int y = ray.cell.y;
  int z = ray.cell.z;
  float tx = ax.leave(x, 0);
  float ty = ay.leave(y, 0);
  float tz = az.leave(z, 0);
  float t = 0.0f;
  // Each step leaves at least one plane of cells behind, so this bounds any ray.
  const int maxSteps = cells.size.x + cells.size.y + cells.size.z + 3;
  for (int count = 0; count < maxSteps; ++count)
  {
    const float first = smaller(tx, smaller(ty, tz));
    t = larger(first, t);
    if (t >= tMax)
    {
      break;
    }
    const bool alongX = tx == first;
    const bool alongY = !alongX && ty == first;
    const bool alongZ = !alongX && !alongY;
    x += alongX ? ax.sign : 0;
    y += alongY ? ay.sign : 0;
    z += alongZ ? az.sign : 0;
    const std::uint32_t word = cells.cell[cells.offset(x, y, z)];
    const int tissue = int(word & 255u);
    if (tissue != current && (tissue != ignored || t >= ignoreUntil))
    {
      const int axis = alongX ? 0 : (alongY ? 1 : 2);
      const Vec3i after(x, y, z);
      const Vec3i before(x - (alongX ? ax.sign : 0), y - (alongY ? ay.sign : 0), z - (alongZ ? az.sign : 0));
      if (tissue == int(TissueCells::outsideWord))
      {
        return { t, before, before, -1, axis };
      }
      return { t, before, after, tissue, axis };
    }
    // 128 and above are ranks of records.
    const int skip = int(word >> 8);
    if (skip >= worthJumping && skip < 128 && tissue == current)
    {
      // Go on to the cell behind the face through which the ray leaves the cube, less one step.
      const float leaveX = ax.leave(x, skip - 1);
      const float leaveY = ay.leave(y, skip - 1);
      const float leaveZ = az.leave(z, skip - 1);
      const float leave = smaller(leaveX, smaller(leaveY, leaveZ));
      t = larger(leave, t);
      if (t >= tMax)
      {
        break;
      }
      const int nextX = leaveX == leave ? x + ax.sign * skip : ax.cellAt(t, x, skip - 1);
      const int nextY = leaveY == leave ? y + ay.sign * skip : ay.cellAt(t, y, skip - 1);
      const int nextZ = leaveZ == leave ? z + az.sign * skip : az.cellAt(t, z, skip - 1);
      x = nextX;
      y = nextY;
      z = nextZ;
    }
    tx = ax.leave(x, 0);
    ty = ay.leave(y, 0);
    tz = az.leave(z, 0);
  }
  return { smaller(larger(t, 0.0f), tMax), ray.cell, ray.cell, -1, 0 };
}

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

/// The normal from tissue `from` to `to` at a point of their boundary, interpolated between the records of the eight
/// voxels around the point. A voxel's own record holds at its centre; a curved surface turns away from it.
/// Returns `fallback` where the records disagree.
SONO_HD inline Vec3f interpolateNormal(const TissueCells& cells, const Vec3f& point, int from, int to,
                                       const SideWeights& weights, const Vec3f& fallback)
{
  const Vec3f g = point / cells.spacing - 0.5f;
  const Vec3i low(int(floorf(g.x)), int(floorf(g.y)), int(floorf(g.z)));
  const Vec3f f = g - Vec3f(low);
  if (glm::any(glm::lessThan(low, Vec3i(-1))) || glm::any(glm::greaterThanEqual(low, cells.size)))
  {
    return fallback;
  }
  Vec3f sum(0.0f);
  float total = 0.0f;
  for (int corner = 0; corner < 8; ++corner)
  {
    const int ox = corner & 1;
    const int oy = (corner >> 1) & 1;
    const int oz = corner >> 2;
    const std::size_t at = cells.offset(low.x + ox, low.y + oy, low.z + oz);
    const std::uint32_t word = cells.cell[at];
    const int tissue = int(word & 255u);
    const float side = tissue == from ? weights.before : (tissue == to ? -weights.after : 0.0f);
    if ((word & 0x8000u) == 0u || side == 0.0f)
    {
      continue;
    }
    const std::uint32_t bits = cells.recordOf(at, word);
    const float w =
      decodeConfidence(bits) * (ox ? f.x : 1.0f - f.x) * (oy ? f.y : 1.0f - f.y) * (oz ? f.z : 1.0f - f.z);
    // Neighbours point almost the same way, so the octahedron scales them almost alike.
    sum += decodeOctahedral(bits) * (w * side);
    total += w * fabsf(side);
  }
  const float length = glm::length(sum);
  return length > 0.3f * total ? sum / length : fallback;
}

/// THE rule for the surface between two labels. Each side's record describes its own smoothed surface; they disagree
/// slightly. The side with the larger gradient leads; the other is dropped when its gradient is below 0.6 of it (a thin
/// wall has lost its own surface, its thick neighbour has not); else the normals are averaged. The point moves
/// along the ray to the plane of the records, by one voxel at most; there the normal is interpolated. Where no record
/// is trustworthy, or the smooth normal says that the ray leaves rather than enters, the voxel face stands.
SONO_HD inline RefinedHit refineBoundary(const TissueCells& cells, const CellRay& ray, const CellHit& hit)
{
  const Vec3f face(hit.axis == 0 ? signNotZero(ray.direction.x) : 0.0f,
                   hit.axis == 1 ? signNotZero(ray.direction.y) : 0.0f,
                   hit.axis == 2 ? signNotZero(ray.direction.z) : 0.0f);
  const std::uint32_t bitsA = cells.recordAt(hit.before);
  const std::uint32_t bitsB = cells.recordAt(hit.after);
  if ((bitsA | bitsB) == 0u)
  {
    return { face, hit.t };
  }
  const BoundaryRecord a = decodeRecord(bitsA);
  const BoundaryRecord b = decodeRecord(bitsB);
  const float confA = bitsA ? a.confidence : 0.0f;
  const float confB = bitsB ? b.confidence : 0.0f;
  const float best = larger(confA, confB);
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
  const float reach = cells.meanSpacing;
  const float plane = glm::dot(point - ray.position, n) / cosine;
  const float t = larger(0.0f, smaller(larger(plane, hit.t - reach), hit.t + reach));
  const Vec3f smooth = interpolateNormal(cells, ray.position + ray.direction * t, cells.tissueAt(hit.before),
                                         hit.tissue, { weightA, weightB }, n);
  return { glm::dot(ray.direction, smooth) < 0.01f ? n : smooth, t, true };
}

} // namespace sono
