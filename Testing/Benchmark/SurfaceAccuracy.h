#pragma once

namespace sono {

/// How far the boundaries that a ray meets are from the true ones.
struct SurfaceAccuracy
{
  double offsetVoxel = 0.0;   ///< mean distance of the hit from the true surface, in cube roots of the voxel's volume
  double normalMeanDeg = 0.0; ///< mean angle between the hit's normal and the true one
  double normalP95Deg = 0.0;
};

/// Each figure's worst value over spheres and ellipsoids (axes 1 : 1.3 : 0.8 and 0.8 : 1 : 1.3) whose smallest half
/// axis is 15 and 30 voxels, in isotropic voxels and in voxels of 1 x 1 x 3, met by rays from outside and inside.
SurfaceAccuracy worstSurfaceAccuracy();

/// One of them. The half axes are in the ratio `axes`; the smallest is `radiusVoxel` cube roots of the voxel's volume.
struct EllipsoidCase
{
  double radiusVoxel;
  double axes[3];
  double spacingMm[3];
};
SurfaceAccuracy measureEllipsoid(const EllipsoidCase& shape);

} // namespace sono
