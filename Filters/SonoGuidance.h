#pragma once

#include "vtkSonoFiltersModule.h" // for export macro

#include <array>

namespace sono {

/// A probe's place in the world, LPS mm: position of its face, axial (into the body), lateral (along the array).
using PoseNumbers = std::array<double, 9>;

/// What a hand has to do so that a probe that stands at one pose comes to stand at another. Slides are along the
/// probe's own axes as it stands, with elevation = axial x lateral; angles in degrees.
struct Guidance
{
  double slideLateralMm = 0.0;
  double slideElevationMm = 0.0;
  double pressMm = 0.0;   ///< along the beam; negative: lift
  double tiltDeg = 0.0;   ///< out of the image plane, -180 to 180: the beam turns towards the elevation
  double rockDeg = 0.0;   ///< then in the image plane, -90 to 90: the beam turns towards the lateral direction
  double rotateDeg = 0.0; ///< then about the beam, -180 to 180: the lateral direction turns towards the elevation

  /// Whether no slide, all three together, is more than this, and no angle.
  VTKSONOFILTERS_EXPORT bool isReached(double withinMm, double withinDeg) const;
};

/// Tilted, rocked and rotated in this order, each about the axis as it is by then, the one becomes the other. Axes of
/// any length; a lateral direction counts as far as it is orthogonal to the axial one. Throws Error where a pose has
/// none.
VTKSONOFILTERS_EXPORT Guidance guidance(const PoseNumbers& from, const PoseNumbers& to);

} // namespace sono
