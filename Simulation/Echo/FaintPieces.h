#pragma once

#include "Echo/HeardSurfaces.h"
#include "Echo/SurfaceLists.h"

#include <vector>

// Of most pieces that a line hears as such no point is heard: they lie too far beside its axis, or are turned too far
// away. A bound on the echoes of all points of a piece tells, before any of them is made.

namespace sono {

/// Within what the points of a brick's pieces lie, and by how much they differ: arrays by number, as in PieceList.
struct PieceExtents
{
  std::vector<float> uX, uY, uZ, vX, vY, vZ;     ///< from the middle to the rim along the tangents, mm
  std::vector<float> riseMm;                     ///< points lie by no more beside the tangent plane
  std::vector<float> turn;                       ///< and have slopes that differ by no more from the middle's
  std::vector<float> blobUMm, blobVMm;           ///< a coherent blob's deviation along an axis of the voxels
  std::vector<float> blobUPerHalf, blobVPerHalf; ///< the same along the tangents, of the way to the rim
  std::vector<float> diffuseRootMm;              ///< root of the largest point's area
  std::vector<float> coherentMm2;                ///< the largest blob's area

  /// Of so many pieces, up to whole vectors.
  void reserve(int count);
};

/// Takes from what a line hears the pieces none of whose points is heard (addDiffuse, addCoherent). A beam that is no
/// Gaussian is left as it is. `diffuseMost`: see SurfaceRows.
void leaveFaint(const PieceList& pieces, const PieceExtents& extents, const Beam& beam, const LineGrid& grid,
                const SurfaceTable& table, const float* diffuseMost, HeardList& heard);

} // namespace sono
