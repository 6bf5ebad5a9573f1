#pragma once

#include "Kernel/StairsLeft.h"

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/Ray.h>

namespace sono {

/// The reference implementation of a space: marches the scene's NanoVDB label grid itself, node by node (hierarchical
/// DDA: Museth 2014), where CellSpace marches a cache of it. The faces at which a ray leaves a node or voxel are
/// computed from the node's integer corner, not stepped to, so hit times are as exact as the cache's. Cells are
/// relative to the region's corner, like the cache's, whose boundary records both use.
template<class Targets>
struct NanoSpace
{
  const nanovdb::NanoGrid<std::int32_t>* labels;
  const std::uint8_t* tissueOfLabel; ///< 65536 entries
  Vec3i first;                       ///< voxel of the region's corner
  TissueCells cells;
  Targets targets;

  using Accessor = nanovdb::DefaultReadAccessor<std::int32_t>;

  SONO_HD Vec3i size() const { return cells.size; }
  SONO_HD Vec3f spacing() const { return cells.spacing; }
  SONO_HD float meanSpacing() const { return cells.meanSpacing; }
  SONO_HD Vec3i cellAt(const Vec3f& position) const { return cells.cellAt(position); }
  SONO_HD bool contains(const Vec3i& cell) const { return cells.contains(cell); }
  SONO_HD int tissueAt(const Vec3i& cell) const { return tissueAt(labels->getAccessor(), cell); }
  SONO_HD int tissueAt(const Accessor& accessor, const Vec3i& cell) const
  {
    return tissueOfLabel[accessor.getValue(nanovdb::Coord(cell.x + first.x, cell.y + first.y, cell.z + first.z))];
  }

  /// Edge of the largest node around the cell that holds one value: 1 in a leaf.
  SONO_HD int uniformEdge(const Accessor& accessor, const Vec3i& cell) const
  {
    const nanovdb::Coord at(cell.x + first.x, cell.y + first.y, cell.z + first.z);
    return accessor.probeLeaf(at) ? 1 : int(accessor.getDim(at, nanovdb::Ray<float>()));
  }

  /// As marchToBoundary.
  template<class Stairs>
  SONO_HD CellHit march(const CellRay& ray, int current, const Stairs& stairs, float tMax) const
  {
    const Accessor accessor = labels->getAccessor();
    const AxisMarch axes[3] = { { ray.position.x * cells.perMm.x, ray.direction.x * cells.perMm.x },
                                { ray.position.y * cells.perMm.y, ray.direction.y * cells.perMm.y },
                                { ray.position.z * cells.perMm.z, ray.direction.z * cells.perMm.z } };
    Vec3i c = ray.cell;
    float t = 0.0f;
    const int maxSteps = cells.size.x + cells.size.y + cells.size.z + 3;
    for (int count = 0; count < maxSteps; ++count)
    {
      const int edge = tissueAt(accessor, c) == current ? uniformEdge(accessor, c) : 1;
      float first3[3];
      Vec3i low;
      for (int a = 0; a < 3; ++a)
      {
        // Nodes are aligned in the volume's index space.
        low[a] = ((c[a] + first[a]) & ~(edge - 1)) - first[a];
        first3[a] = (float(axes[a].step > 0.0f ? low[a] + edge : low[a]) - axes[a].p) * axes[a].inverse + axes[a].never;
      }
      const float leave = smaller(first3[0], smaller(first3[1], first3[2]));
      t = larger(leave, t);
      if (t >= tMax)
      {
        break;
      }
      const int axis = first3[0] == leave ? 0 : (first3[1] == leave ? 1 : 2);
      Vec3i before = c;
      if (edge > 1)
      {
        for (int a = 0; a < 3; ++a)
        {
          const int moved = int(floorf(axes[a].p + t * axes[a].d));
          before[a] = moved < low[a] ? low[a] : (moved > low[a] + edge - 1 ? low[a] + edge - 1 : moved);
        }
        before[axis] = axes[axis].step > 0.0f ? low[axis] + edge - 1 : low[axis];
      }
      c = before;
      c[axis] += axes[axis].sign();
      if (!cells.contains(c))
      {
        return { t, before, before, -1, axis };
      }
      const int tissue = tissueAt(accessor, c);
      if (tissue != current && !stairs.passes(tissue, t, Vec3f(c)))
      {
        return { t, before, c, tissue, axis };
      }
    }
    return { smaller(larger(t, 0.0f), tMax), ray.cell, ray.cell, -1, 0 };
  }
};

} // namespace sono
