#pragma once

#include "Core/Progress.h"
#include "Labels/LabelVolume.h"
#include "Scene/VoxelBox.h"

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace sono {

/// Opaque owner of one NanoVDB grid, so that no header needs NanoVDB to name one (see NanoGridStorage.h).
class NanoGrid
{
public:
  NanoGrid();
  ~NanoGrid();
  NanoGrid(NanoGrid&&) noexcept;
  NanoGrid& operator=(NanoGrid&&) noexcept;

  /// Size in bytes of the grid's buffer; 0 before it was built.
  std::size_t bytes() const;

  struct Storage;
  std::unique_ptr<Storage> storage;
};

/// The label ids of a volume as a NanoVDB Int32 grid, background 0, index space = voxel indices.
struct LabelGrid
{
  NanoGrid grid;
  int at(const Vec3i& ijk) const;
};
LabelGrid buildLabelGrid(const LabelVolume& volume, const Progress& progress = {});

/// A triangle surface in world coordinates.
struct TriangleSurface
{
  std::vector<std::array<float, 3>> points;
  std::vector<std::array<int, 3>> triangles;
};

/// The bounding box of each of `volume.labels`, in their order, in one pass over the voxels.
std::vector<VoxelBox> labelBoxes(const LabelVolume& volume);

/// One label's surface: a narrow-band signed distance field in mm, negative inside, as a NanoVDB grid over the voxel
/// centres (Fp8: 8 bits a voxel between a leaf's extremes, so rounded to a hundredth of the band at most). It is the
/// distance of the label's occupancy smoothed by a Gaussian of one voxel (isotropic in mm, sigma = cube root of the
/// voxel's volume): d = -sigma probit(occupancy), exact for a plane (Data/docs/physics.md
/// section 5).
struct SurfaceField
{
  int labelId = 0;
  NanoGrid sdf;
  double bandMm = 0.0;      ///< values are clamped to +-band, which is also the background
  double smoothingMm = 0.0; ///< sigma
  VoxelBox box;             ///< the label's bounding box

  float at(const Vec3i& ijk) const; ///< signed distance at a voxel centre, mm
};
/// `box` is the label's bounding box. Throws Error when it is empty.
SurfaceField buildSurface(const LabelVolume& volume, int labelId, const VoxelBox& box, const Progress& progress = {});

/// The zero level of a field as triangles, `volume` placing it in the world.
TriangleSurface meshSurface(const LabelVolume& volume, const SurfaceField& field);

} // namespace sono
