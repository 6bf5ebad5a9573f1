#pragma once

#include "Core/Progress.h"
#include "Kernel/TissueCells.h"
#include "Scene/VoxelBox.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace sono {

/// What the tracer reads of the scene: a box of dense cells (see TissueCells) instead of the NanoVDB grids. Some 10^5
/// paths cross the same voxels again and again, and each boundary needs a normal: a word a voxel and a record a
/// boundary voxel give them in one read each, several times as fast as the march through the label grid, which stays
/// the reference (NanoSpace). The box is what visibility culling leaves (fanBox): nothing beyond the depth before the
/// lines can echo in time.
///
/// Words are baked from the tissue indices of the voxels. Boundary records are baked from the same voxels, by the same
/// smoothing as the labels' signed distance fields (SurfaceField), of which they hold distance, normal and gradient:
/// the tissue's occupancy smoothed by a Gaussian of one voxel for the position and two for the normal, isotropic in mm
/// (a voxel being the cube root of its volume), at voxels that touch another tissue with a face. In voxels that are
/// long along one axis the normal's Gaussian is 1.35 of that length, up to three voxels: slices' terraces are wide
/// there. Normals of smooth surfaces are those of fits (BoundaryFits).
struct TraceRegion
{
  VoxelBox box;
  Vec3f spacing{ 1.0f, 1.0f, 1.0f };
  std::vector<std::uint16_t> cell;
  std::vector<std::uint32_t> firstRecord;
  std::vector<std::uint32_t> record; ///< one a voxel that touches another tissue

  TissueCells view() const
  {
    TissueCells cells;
    cells.cell = cell.data();
    cells.firstRecord = firstRecord.data();
    cells.record = record.data();
    cells.size = box.size();
    cells.blocks = TissueCells::blocksFor(cells.size);
    cells.spacing = spacing;
    cells.perMm = Vec3f(1.0f) / spacing;
    cells.meanSpacing = std::cbrt(spacing.x * spacing.y * spacing.z);
    return cells;
  }
  std::size_t bytes() const
  {
    return cell.size() * sizeof(cell[0]) + (firstRecord.size() + record.size()) * sizeof(record[0]);
  }
};

/// The region's words, and places for its records, which are 0 until they are baked (see RegionOnDemand). Arguments as
/// below.
TraceRegion layOutRegion(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm, const VoxelBox& box,
                         const Progress& progress = {});

/// The region with all of its records. `tissues` are the tissue indices of the whole volume of `size` voxels, i
/// fastest; `box` lies inside it.
TraceRegion buildTraceRegion(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm,
                             const VoxelBox& box, const Progress& progress = {});

} // namespace sono
