#pragma once

#include "Probe/ScanGeometry.h"

#include <vector>

namespace sono {

/// An array's elements and how they send the lines, in the probe's frame: x lateral, y elevation, z into the body. A
/// probe says how wide an element and the beam's aperture are, not how many elements there are: they stand side by side
/// over the face, without gaps; over the aperture, where all lines start at one point.
struct ArrayElements
{
  std::vector<Vec3d> centresMm;
  std::vector<double> azimuthsRad; ///< of their normals, from z towards x
  double widthMm = 0.0;
  double heightMm = 0.0; ///< 0: not known
};

ArrayElements arrayElements(const ProbeSettings& probe);
/// So many, evenly spaced over the same face; 0: as many as there are side by side. Throws Error where they do not fit,
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
