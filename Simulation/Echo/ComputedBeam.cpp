#include "Echo/ComputedBeam.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sono {

namespace {

int piecesOf(double wholeMm, double pieceMm)
{
  return std::clamp(int(std::lround(wholeMm / pieceMm)), 1, 4096);
}

double orNever(double focusMm)
{
  return focusMm > 0.0 ? focusMm : std::numeric_limits<double>::infinity();
}

} // namespace

ArrayAperture elementsOf(const EchoSettings& settings)
{
  const BeamAperture& whole = settings.aperture;
  if (!whole.isNamed())
  {
    throw Error("the computed beam needs the probe's aperture: give its width and height, or choose the Gaussian beam");
  }
  ArrayAperture elements;
  elements.centreFrequencyMHz = settings.centreFrequencyMHz;
  elements.imagingMode = settings.imagingMode;
  elements.fractionalBandwidth = settings.fractionalBandwidth;
  elements.transmitFocusMm = orNever(whole.transmitFocusMm);
  elements.elevationFocusMm = orNever(whole.elevationFocusMm);
  const double widthMm = whole.elementWidthMm > 0.0 ? whole.elementWidthMm : 0.5 * elements.wavelengthMm();
  elements.kerfMm = 0.0;
  elements.elementCount = piecesOf(whole.apertureMm, widthMm);
  elements.elementWidthMm = whole.apertureMm / elements.elementCount;
  elements.elevationCount = whole.elevationIsArray ? piecesOf(whole.elevationApertureMm, widthMm) : 1;
  elements.elementHeightMm = whole.elevationApertureMm / elements.elevationCount;
  return elements;
}

} // namespace sono
