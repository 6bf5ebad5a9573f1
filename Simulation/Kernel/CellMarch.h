#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/TissueCells.h"

#include <cmath>
#include <cstdint>

// A ray goes from voxel to voxel until the tissue changes.

namespace sono {

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

/// No cells of another tissue are passed.
struct NoStairs
{
  SONO_HD bool passes(int, float, const Vec3f&) const { return false; }
};

/// Marches to the first cell behind the ray's own whose tissue is not `current`. Cells that `stairs` passes
/// (StairsLeft) count as `current`, and are walked through one by one. Walks cell by cell, so that the next address
/// does not wait for the last word (a processor runs ahead), and jumps where a uniform cube is large enough to pay for
/// the wait.
template<class Cells, class Stairs>
SONO_HD inline CellHit marchToBoundary(const Cells& cells, const CellRay& ray, int current, const Stairs& stairs,
                                       float tMax)
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
    // Once a march or a stair: said, or what the loop needs goes to the stack for what happens here.
    if (__builtin_expect(tissue != current, 0) &&
        !stairs.passes(tissue, t, Vec3f(faceX - ax.step, faceY - ay.step, faceZ - az.step)))
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

} // namespace sono
