#include "Probe/ArrayElements.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace sono {

namespace {

constexpr double radPerDeg = 0.017453292519943295;
constexpr double fullTurn = 360.0 * radPerDeg;
constexpr long maxCount = std::numeric_limits<long>::max();

double mmPerUs(const ProbeSettings& probe)
{
  return 1e-3 * probe.geometry.assumedSoundSpeedMPerS;
}

/// Whether lines start at places of their own, where a part of the elements sends them.
bool hasStarts(const ScanGeometry& geometry)
{
  return geometry.lineOrigin() != LineOrigin::Apex;
}

/// Along the face, of the elements that the lines need, together.
double faceWidthMm(const ProbeSettings& probe, double elementMm)
{
  const ScanGeometry& geometry = probe.geometry;
  if (!hasStarts(geometry))
  {
    return probe.apertureMm;
  }
  const double linesMm =
    geometry.faceRadiusMm() > 0.0 ? geometry.sectorDeg * radPerDeg * geometry.radiusMm : geometry.widthMm;
  return linesMm + elementMm;
}

/// As the array is built; or, where columns are named, so many, evenly over the face.
ArrayElements elementsOf(const ProbeSettings& probe, int named)
{
  const ScanGeometry& geometry = probe.geometry;
  ArrayElements elements;
  elements.widthMm =
    probe.elementWidthMm > 0.0 ? probe.elementWidthMm : 0.5 * mmPerUs(probe) / probe.centreFrequencyMHz;
  const double builtPitchMm = elements.widthMm + probe.kerfMm;
  const double widthMm = faceWidthMm(probe, elements.widthMm);
  const double pitchMm = named > 0 ? widthMm / double(named) : builtPitchMm;
  const bool isGrid = geometry.isMatrix();
  const long built = isGrid ? std::lround(std::sqrt(double(probe.elementCount))) : long(probe.elementCount);
  const auto countOver = [&](double mm) {
    return std::max({ 1l, built, std::lround((mm + probe.kerfMm) / builtPitchMm) });
  };
  const double radiusMm = geometry.faceRadiusMm();
  const long around = radiusMm > 0.0 ? std::max(1l, long(fullTurn * radiusMm / builtPitchMm)) : maxCount;
  const long columns = named > 0 ? long(named) : std::min(countOver(widthMm), around);
  const long rows = isGrid ? countOver(probe.elevationApertureMm) : 1;
  elements.heightMm = isGrid ? elements.widthMm : probe.elevationApertureMm;
  for (long row = 0; row < rows; ++row)
  {
    const double acrossMm = (double(row) - 0.5 * double(rows - 1)) * builtPitchMm;
    for (long column = 0; column < columns; ++column)
    {
      const double alongMm = (double(column) - 0.5 * double(columns - 1)) * pitchMm;
      const double angle = radiusMm > 0.0 ? alongMm / radiusMm : 0.0;
      elements.azimuthsRad.push_back(angle);
      elements.centresMm.push_back(radiusMm > 0.0 ? Vec3d(radiusMm * std::sin(angle), acrossMm,
                                                          radiusMm * std::cos(angle) + geometry.fanCentreAxialMm())
                                                  : Vec3d(alongMm, acrossMm, 0.0));
    }
  }
  return elements;
}

} // namespace

ArrayElements arrayElements(const ProbeSettings& probe)
{
  return elementsOf(probe, 0);
}

ArrayElements arrayElements(const ProbeSettings& probe, int count)
{
  const ScanGeometry& geometry = probe.geometry;
  if (geometry.isMatrix() || geometry.lineOrigin() == LineOrigin::Catheter)
  {
    throw Error(std::string("the probe is a ") + traitsOf(geometry.kind).label +
                ": channels are made of arrays with one row of elements; choose a linear, phased or curvilinear one");
  }
  if (probe.apertureMm <= 0.0 && !hasStarts(geometry))
  {
    throw Error("the probe does not name its aperture: set apertureMm, the width of its elements together");
  }
  const ArrayElements elements = elementsOf(probe, count);
  const double widthMm = faceWidthMm(probe, elements.widthMm);
  if (count > 0 && elements.widthMm > 1.01 * widthMm / double(count))
  {
    std::ostringstream sentence;
    sentence << count << " elements of " << elements.widthMm << " mm do not fit on a face of " << widthMm
             << " mm: set a smaller elementCount or elementWidthMm";
    throw Error(sentence.str());
  }
  return elements;
}

LineFiring lineFiring(const ArrayElements& elements, const ProbeSettings& probe, const ScanLine& line)
{
  const double focusMm = probe.transmitFocusMm;
  const Vec3d focus = line.originMm + focusMm * line.axis;
  /// How far a wave of the element has to go, beside those of others.
  const auto wayMm = [&](const Vec3d& centre) {
    return focusMm > 0.0 ? glm::length(focus - centre) : -glm::dot(centre, line.axis);
  };
  const bool isWhole = !hasStarts(probe.geometry) && probe.apertureMm == 0.0; // it is not known
  const double leastMm = 0.501 * (elements.widthMm + probe.kerfMm);
  const double halfAlongMm = std::max(0.5 * probe.apertureMm, leastMm);
  const double halfAcrossMm = std::max(0.5 * probe.elevationApertureMm, leastMm);
  LineFiring firing;
  double longestMm = -std::numeric_limits<double>::infinity();
  for (const Vec3d& centre : elements.centresMm)
  {
    const Vec3d fromLine = centre - line.originMm;
    const bool isActive =
      isWhole || (std::hypot(fromLine.x, fromLine.z) <= halfAlongMm && std::abs(fromLine.y) <= halfAcrossMm);
    firing.isActive.push_back(isActive);
    longestMm = isActive ? std::max(longestMm, wayMm(centre)) : longestMm;
  }
  for (std::size_t n = 0; n < elements.centresMm.size(); ++n)
  {
    firing.delaysUs.push_back(firing.isActive[n] ? (longestMm - wayMm(elements.centresMm[n])) / mmPerUs(probe) : 0.0);
  }
  firing.startUs = (longestMm - wayMm(line.originMm)) / mmPerUs(probe);
  return firing;
}

} // namespace sono
