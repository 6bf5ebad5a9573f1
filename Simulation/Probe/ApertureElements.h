#pragma once

#include "Probe/ArrayAperture.h"

#include <vector>

namespace sono {

/// (lateral, axial) in the image plane, from the middle of the face.
struct Place
{
  double lateralMm;
  double axialMm;
};

/// A piece of an element, over the whole height.
struct Piece
{
  Place centre;
  Place normal;
  double weight; ///< apodization times width
  int element;   ///< whose delay it shares
};

/// An aperture cut up for the field.
struct Elements
{
  std::vector<Place> centre;
  std::vector<Piece> pieces;
  double pieceWidthMm;
};

/// Pieces are at most half as wide as `shortestMm`, the shortest wavelength.
Elements makeElements(const ArrayAperture& aperture, double shortestMm);

/// For each element the length of path that its delay makes up for, so that the waves meet on the axis at depth
/// `focusMm`; infinity sends a plane wave.
std::vector<double> delayLengthsMm(const Elements& elements, double focusMm);

} // namespace sono
