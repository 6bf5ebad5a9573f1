#pragma once

#include "Kernel/StairsLeft.h"

namespace sono {

/// Where a ray meets a target: a closed surface in the scene with a tissue of its own (needle, wire, catheter).
struct TargetHit
{
  float t;
  Vec3f normal; ///< unit, out of the target
  int target;   ///< -1: none within reach
};

/// A space without targets.
struct NoTargets
{
  SONO_HD bool any() const { return false; }
  SONO_HD TargetHit nearest(const Vec3f&, const Vec3f&, float, bool) const { return { 0.0f, Vec3f(0.0f), -1 }; }
};

/// The space that paths run through: the region's cells and the targets in it. It is one of two implementations of what
/// TracePath.h asks of a space (the other is NanoSpace); both must give the same boundaries.
/// `Targets` offers any() and nearest(position, direction, tMax, inside): outside a target only surfaces entered count,
/// inside only surfaces left, so that a ray never meets again the surface it starts from.
template<class Targets, class Cells = TissueCells>
struct CellSpace
{
  Cells cells;
  Targets targets;

  SONO_HD Vec3i size() const { return cells.size; }
  SONO_HD Vec3f spacing() const { return cells.spacing; }
  SONO_HD float meanSpacing() const { return cells.meanSpacing; }
  SONO_HD Vec3i cellAt(const Vec3f& position) const { return cells.cellAt(position); }
  SONO_HD bool contains(const Vec3i& cell) const { return cells.contains(cell); }
  SONO_HD int tissueAt(const Vec3i& cell) const { return cells.tissueAt(cell); }
  template<class Stairs>
  SONO_HD CellHit march(const CellRay& ray, int current, const Stairs& stairs, float tMax) const
  {
    return marchToBoundary(cells, ray, current, stairs, tMax);
  }
};

} // namespace sono
