#pragma once

#include "Probe/ScanGeometry.h"

#include <vector>

namespace sono {

/// An array's elements, in the probe's frame: x lateral, y elevation, z into the body. They stand side by side, a kerf
/// between two, in the middle of the face: as many as the probe says, and no fewer than its aperture has, or the face
/// that its lines start from; around a catheter or a convex face no more than there is room for. Of a matrix as many
/// rows.
struct ArrayElements
{
  std::vector<Vec3d> centresMm;
  std::vector<double> azimuthsRad; ///< of their normals, from z towards x
  double widthMm = 0.0;
  double heightMm = 0.0; ///< 0: not known
};

ArrayElements arrayElements(const ProbeSettings& probe);
/// So many, evenly spaced over the face; 0: as the array is built. Throws Error where they do not fit,
/// and for a matrix or a catheter, whose elements do not lie in a row before the body.
ArrayElements arrayElements(const ProbeSettings& probe, int count);

/// When and whether elements send a line (the time of the first is 0), and when it leaves the line's start.
struct LineFiring
{
  std::vector<double> delaysUs;
  std::vector<bool> isActive;
  double startUs = 0.0;
};

/// Of a line in the same frame: waves meet at the transmit focus, or make a plane where there is none.
LineFiring lineFiring(const ArrayElements& elements, const ProbeSettings& probe, const ScanLine& line);

} // namespace sono
