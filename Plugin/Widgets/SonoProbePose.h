#pragma once

#include "vtkVector.h"

/// Where a probe stands, as it is moved by hand: `axial` points into the body, `lateral` along the array, elevation =
/// axial x lateral. Right-handed unit vectors; every movement keeps them so. World mm, angles in degrees.
struct SonoProbePose
{
  vtkVector3d positionMm{ 0.0 };
  vtkVector3d axial{ 0.0, 0.0, 1.0 };
  vtkVector3d lateral{ 1.0, 0.0, 0.0 };

  /// From vectors as they are typed: of any length, not quite at right angles. What has no direction gets one.
  static SonoProbePose from(const double positionMm[3], const double axial[3], const double lateral[3]);

  vtkVector3d elevation() const { return axial.Cross(lateral); }
  /// A place given as (lateral, elevational, axial) mm.
  vtkVector3d world(double lateralMm, double elevationMm, double axialMm) const;

  /// About the axis: the lateral direction turns towards the elevation.
  void rotate(double degrees);
  /// Out of the image plane: the axis turns towards the elevation.
  void tilt(double degrees);
  /// In the image plane: the axis turns towards the lateral direction.
  void rock(double degrees);
  /// By the smallest rotation that takes one unit vector to another, so that nothing twists about them.
  void carry(const vtkVector3d& from, const vtkVector3d& to);

private:
  void turn(const vtkVector3d& axis, double radians);
};
