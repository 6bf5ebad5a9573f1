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
  Vec3f perMm{ 1.0f, 1.0f, 1.0f }; ///< 1 / spacing
  float meanSpacing = 1.0f;        ///< cube root of the voxel's volume

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
  SONO_HD std::uint32_t wordAt(int x, int y, int z) const { return cell[offset(x, y, z)]; }
  /// The record of the voxel, whose word is given; 0 where it has none.
  SONO_HD std::uint32_t recordOf(int x, int y, int z, std::uint32_t word) const
  {
    return (word & 0x8000u) ? record[firstRecord[offset(x, y, z) >> 5] + ((word >> 8) & 31u)] : 0u;
  }
  SONO_HD bool contains(const Vec3i& c) const
  {
    return unsigned(c.x) < unsigned(size.x) && unsigned(c.y) < unsigned(size.y) && unsigned(c.z) < unsigned(size.z);
  }
  SONO_HD int tissueAt(const Vec3i& c) const { return int(wordAt(c.x, c.y, c.z) & 255u); }
  SONO_HD Vec3i cellAt(const Vec3f& position) const
  {
    const Vec3f p = position / spacing;
    return Vec3i(int(floorf(p.x)), int(floorf(p.y)), int(floorf(p.z)));
  }

  /// A place among the words that a march moves from cell to cell.
  class Cursor
  {
  public:
    SONO_HD Cursor(const TissueCells& cells, const Vec3i& cell, const Vec3i& sign)
      : cells_(cells)
      , cell_(cell)
      , sign_(sign)
    {
    }
    /// To the neighbour along one axis, in the sense of its sign.
    SONO_HD void move(bool alongX, bool alongY, bool alongZ)
    {
      cell_.x += alongX ? sign_.x : 0;
      cell_.y += alongY ? sign_.y : 0;
      cell_.z += alongZ ? sign_.z : 0;
    }
    SONO_HD void jump(const Vec3i& cell) { cell_ = cell; }
    SONO_HD std::uint32_t word() const { return cells_.wordAt(cell_.x, cell_.y, cell_.z); }

  private:
    const TissueCells& cells_;
    Vec3i cell_;
    Vec3i sign_;
  };
};

/// The same with the words row after row, border included: a step is one addition. A GPU, which computes addresses and
/// waits for memory with the same threads, is faster with them; a CPU with the blocks.
struct RowCells : TissueCells
{
  const std::uint16_t* words = nullptr;
  Vec3i pitch{ 0, 0, 0 }; ///< words from a voxel to the next along each axis

  /// (size.x + 2) x (size.y + 2) x (size.z + 2) words.
  static Vec3i pitchFor(const Vec3i& size) { return { 1, size.x + 2, (size.x + 2) * (size.y + 2) }; }
  SONO_HD std::size_t rowOffset(int x, int y, int z) const
  {
    return std::size_t(x + 1) + std::size_t(y + 1) * std::size_t(pitch.y) + std::size_t(z + 1) * std::size_t(pitch.z);
  }
  SONO_HD std::uint32_t wordAt(int x, int y, int z) const { return words[rowOffset(x, y, z)]; }
  SONO_HD int tissueAt(const Vec3i& c) const { return int(wordAt(c.x, c.y, c.z) & 255u); }

  class Cursor
  {
  public:
    SONO_HD Cursor(const RowCells& cells, const Vec3i& cell, const Vec3i& sign)
      : cells_(cells)
      , at_(cells.words + cells.rowOffset(cell.x, cell.y, cell.z))
      , stepX_(sign.x)
      , stepY_(sign.y * cells.pitch.y)
      , stepZ_(sign.z * cells.pitch.z)
    {
    }
    SONO_HD void move(bool alongX, bool alongY, bool) { at_ += alongX ? stepX_ : (alongY ? stepY_ : stepZ_); }
    SONO_HD void jump(const Vec3i& cell) { at_ = cells_.words + cells_.rowOffset(cell.x, cell.y, cell.z); }
    SONO_HD std::uint32_t word() const { return *at_; }

  private:
    const RowCells& cells_;
    const std::uint16_t* at_;
    int stepX_;
    int stepY_;
    int stepZ_;
  };
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

/// fmin and fmax are one instruction of the GPU, but calls on a CPU, where these are one.
SONO_HD inline float smaller(float a, float b)
{
#if defined(__CUDA_ARCH__)
  return fminf(a, b);
#else
  return a < b ? a : b;
#endif
}
SONO_HD inline float larger(float a, float b)
{
#if defined(__CUDA_ARCH__)
  return fmaxf(a, b);
#else
  return a > b ? a : b;
#endif
}

/// One axis of a march in voxel units. The face at which the ray leaves cell c is c + step, met at
/// t = (face - p) * inverse + never.
struct AxisMarch
{
  float p;
  float d;
  float inverse;
  float never; ///< huge where the ray runs along the face
  float along; ///< sign of the direction
  float step;  ///< 1 when ascending, else 0

  SONO_HD AxisMarch(float position, float direction)
    : p(position)
    , d(direction)
    , inverse(safeInverse(direction))
    , never(inverse == 0.0f ? 3e38f : 0.0f)
    , along(direction > 0.0f ? 1.0f : -1.0f)
    , step(direction > 0.0f ? 1.0f : 0.0f)
  {
  }
  SONO_HD int sign() const { return along > 0.0f ? 1 : -1; }
  SONO_HD float faceOf(int c) const { return float(c) + step; }
  SONO_HD int cellOf(float face) const { return int(face - step); }
  SONO_HD float meet(float face) const { return (face - p) * inverse + never; }
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
template<class Cells>
SONO_HD inline CellHit marchToBoundary(const Cells& cells, const CellRay& ray, int current, int ignored,
                                       float ignoreUntil, float tMax)
{
  const AxisMarch ax(ray.position.x * cells.perMm.x, ray.direction.x * cells.perMm.x);
  const AxisMarch ay(ray.position.y * cells.perMm.y, ray.direction.y * cells.perMm.y);
  const AxisMarch az(ray.position.z * cells.perMm.z, ray.direction.z * cells.perMm.z);
  typename Cells::Cursor cursor(cells, ray.cell, Vec3i(ax.sign(), ay.sign(), az.sign()));
  // Whole numbers, exact in single precision.
  float faceX = ax.faceOf(ray.cell.x);
  float faceY = ay.faceOf(ray.cell.y);
  float faceZ = az.faceOf(ray.cell.z);
  float t = 0.0f;
  // Each step leaves at least one plane of cells behind, so this bounds any ray.
  const int most = cells.size.x + cells.size.y + cells.size.z + 3;
  for (int count = 0; count < most; ++count)
  {
    const float tx = ax.meet(faceX);
    const float ty = ay.meet(faceY);
    const float tz = az.meet(faceZ);
    const float first = smaller(tx, smaller(ty, tz));
    t = larger(first, t);
    if (t >= tMax)
    {
      break;
    }
    const bool alongX = tx == first;
    const bool alongY = !alongX && ty == first;
    const bool alongZ = !alongX && !alongY;
    faceX += alongX ? ax.along : 0.0f;
    faceY += alongY ? ay.along : 0.0f;
    faceZ += alongZ ? az.along : 0.0f;
    cursor.move(alongX, alongY, alongZ);
    const std::uint32_t word = cursor.word();
    const int tissue = int(word & 255u);
    if (tissue != current && (tissue != ignored || t >= ignoreUntil))
    {
      const Vec3i after(ax.cellOf(faceX), ay.cellOf(faceY), az.cellOf(faceZ));
      const Vec3i before(after.x - (alongX ? ax.sign() : 0), after.y - (alongY ? ay.sign() : 0),
                         after.z - (alongZ ? az.sign() : 0));
      const bool outside = tissue == int(TissueCells::outsideWord);
      return { t, before, outside ? before : after, outside ? -1 : tissue, alongX ? 0 : (alongY ? 1 : 2) };
    }
    // 128 and above are ranks of records.
    const int skip = int(word >> 8);
    if (skip >= worthJumping && skip < 128 && tissue == current)
    {
      // Go on to the cell behind the face through which the ray leaves the cube, less one step.
      const float reach = float(skip - 1);
      const float leaveX = ax.meet(faceX + ax.along * reach);
      const float leaveY = ay.meet(faceY + ay.along * reach);
      const float leaveZ = az.meet(faceZ + az.along * reach);
      const float leave = smaller(leaveX, smaller(leaveY, leaveZ));
      t = larger(leave, t);
      if (t >= tMax)
      {
        break;
      }
      const Vec3i at(ax.cellOf(faceX), ay.cellOf(faceY), az.cellOf(faceZ));
      const Vec3i next(leaveX == leave ? at.x + ax.sign() * skip : ax.cellAt(t, at.x, skip - 1),
                       leaveY == leave ? at.y + ay.sign() * skip : ay.cellAt(t, at.y, skip - 1),
                       leaveZ == leave ? at.z + az.sign() * skip : az.cellAt(t, at.z, skip - 1));
      cursor.jump(next);
      faceX = ax.faceOf(next.x);
      faceY = ay.faceOf(next.y);
      faceZ = az.faceOf(next.z);
    }
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
template<class Cells>
SONO_HD inline Vec3f interpolateNormal(const Cells& cells, const Vec3f& point, int from, int to,
                                       const SideWeights& weights, const Vec3f& fallback)
{
  const Vec3f g = point / cells.spacing - Vec3f(0.5f);
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
    const std::uint32_t word = cells.wordAt(low.x + ox, low.y + oy, low.z + oz);
    const int tissue = int(word & 255u);
    const float side = tissue == from ? weights.before : (tissue == to ? -weights.after : 0.0f);
    if ((word & 0x8000u) == 0u || side == 0.0f)
    {
      continue;
    }
    const std::uint32_t bits = cells.recordOf(low.x + ox, low.y + oy, low.z + oz, word);
    const float w =
      decodeConfidence(bits) * (ox ? f.x : 1.0f - f.x) * (oy ? f.y : 1.0f - f.y) * (oz ? f.z : 1.0f - f.z);
    // Neighbours point almost the same way, so the octahedron scales them almost alike.
    sum += decodeOctahedral(bits) * (w * side);
    total += w * fabsf(side);
  }
  const float length = glm::length(sum);
  return length > 0.3f * total ? sum / length : fallback;
}

template<class Cells>
SONO_HD inline std::uint32_t recordAt(const Cells& cells, const Vec3i& c)
{
  return cells.recordOf(c.x, c.y, c.z, cells.wordAt(c.x, c.y, c.z));
}

/// THE rule for the surface between two labels. Each side's record describes its own smoothed surface; they disagree
/// slightly. The side with the larger gradient leads; the other is dropped when its gradient is below 0.59 of it (a
/// thin wall has lost its own surface, its thick neighbour has not; gradients come in sevenths, and at 0.6 rounding
/// would decide on 3/7 beside 5/7); else the normals are averaged. The point moves along the ray to the plane of the
/// records, by one voxel at most; there the normal is interpolated. Where no record is trustworthy, or the smooth
/// normal says that the ray leaves rather than enters, the voxel face stands.
template<class Cells>
SONO_HD inline RefinedHit refineBoundary(const Cells& cells, const CellRay& ray, const CellHit& hit)
{
  const Vec3f face(hit.axis == 0 ? signNotZero(ray.direction.x) : 0.0f,
                   hit.axis == 1 ? signNotZero(ray.direction.y) : 0.0f,
                   hit.axis == 2 ? signNotZero(ray.direction.z) : 0.0f);
  const std::uint32_t bitsA = recordAt(cells, hit.before);
  const std::uint32_t bitsB = recordAt(cells, hit.after);
  if ((bitsA | bitsB) == 0u)
  {
    return { face, hit.t };
  }
  const BoundaryRecord a = decodeRecord(bitsA);
  const BoundaryRecord b = decodeRecord(bitsB);
  const float confA = bitsA ? a.confidence : 0.0f;
  const float confB = bitsB ? b.confidence : 0.0f;
  const float best = larger(confA, confB);
  const float weightA = confA >= 0.59f * best ? 1.0f : 0.0f;
  const float weightB = confB >= 0.59f * best ? 1.0f : 0.0f;
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
