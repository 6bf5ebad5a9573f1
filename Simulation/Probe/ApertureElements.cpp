#include "Probe/ApertureElements.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;

double apodizationOf(const ArrayAperture& aperture, int element)
{
  if (aperture.apodization == Apodization::Boxcar)
  {
    return 1.0;
  }
  const double x = (element - 0.5 * (aperture.elementCount - 1)) / aperture.elementCount;
  return 0.5 * (1.0 + std::cos(2.0 * pi * x));
}

/// A position along the face, from its middle, and the normal there.
Place onFace(const ArrayAperture& aperture, double alongMm)
{
  const double radius = aperture.faceRadiusMm;
  if (radius == 0.0)
  {
    return { alongMm, 0.0 };
  }
  const double half = std::sin(0.5 * alongMm / radius);
  return { radius * std::sin(alongMm / radius), -2.0 * radius * half * half };
}

Place normalAt(const ArrayAperture& aperture, double alongMm)
{
  const double angle = aperture.faceRadiusMm == 0.0 ? 0.0 : alongMm / aperture.faceRadiusMm;
  return { std::sin(angle), std::cos(angle) };
}

} // namespace

Elements makeElements(const ArrayAperture& aperture, double shortestMm)
{
  Elements elements;
  const int split = std::max(1, int(std::ceil(aperture.elementWidthMm / (0.5 * shortestMm) - 1e-9)));
  elements.pieceWidthMm = aperture.elementWidthMm / split;
  for (int n = 0; n < aperture.elementCount; ++n)
  {
    const double middle = (n - 0.5 * (aperture.elementCount - 1)) * aperture.pitchMm();
    elements.centre.push_back(onFace(aperture, middle));
    for (int piece = 0; piece < split; ++piece)
    {
      const double along = middle + (piece - 0.5 * (split - 1)) * elements.pieceWidthMm;
      elements.pieces.push_back(
        { onFace(aperture, along), normalAt(aperture, along), apodizationOf(aperture, n) * elements.pieceWidthMm, n });
    }
  }
  return elements;
}

std::vector<double> delayLengthsMm(const Elements& elements, double focusMm)
{
  std::vector<double> lengths;
  for (const Place& c : elements.centre)
  {
    lengths.push_back(std::isinf(focusMm) ? -c.axialMm : std::hypot(c.lateralMm, focusMm - c.axialMm) - focusMm);
  }
  return lengths;
}

} // namespace sono
