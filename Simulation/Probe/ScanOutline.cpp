#include "Probe/ScanGeometry.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

using Polyline = std::vector<Vec3d>;

constexpr double degreesPerStep = 2.0;

/// Appends (place(0), ..., place(1)) with as many steps as an arc of `degrees` wants.
template<typename Place>
void addArc(Polyline& line, double degrees, const Place& place)
{
  const int steps = std::max(1, int(std::ceil(degrees / degreesPerStep)));
  for (int n = 0; n <= steps; ++n)
  {
    line.push_back(place(double(n) / steps));
  }
}

std::vector<Polyline> planarOutline(const ScanGeometry& geometry)
{
  const double last = geometry.closesCircle() ? geometry.lineCount : geometry.lineCount - 1;
  const double degrees = geometry.lineOrigin() == LineOrigin::Aperture ? 0.0 : geometry.sectorDeg;
  const auto arcAt = [&](double r, bool backwards) {
    return [&geometry, last, r, backwards](double share) {
      const Vec2f p = planeFromBeam(geometry, last * (backwards ? 1.0 - share : share), r);
      return Vec3d(p.x, 0.0, p.y);
    };
  };
  Polyline border;
  Polyline face;
  addArc(border, degrees, arcAt(geometry.depthMm, false));
  if (!geometry.closesCircle())
  {
    addArc(border, degrees, arcAt(0.0, true));
    border.push_back(border.front());
  }
  addArc(face, degrees, arcAt(0.0, false));
  return { border, face };
}

std::vector<Polyline> volumeOutline(const ScanGeometry& geometry)
{
  const double line = geometry.lineCount - 1;
  const double elevation = geometry.elevationLineCount - 1;
  const auto at = [&](double a, double e) {
    return volumeFromBeam(geometry, a * line, e * elevation, geometry.depthMm);
  };
  Polyline border;
  addArc(border, geometry.sectorDeg, [&](double t) { return at(t, 0.0); });
  addArc(border, geometry.elevationSectorDeg, [&](double t) { return at(1.0, t); });
  addArc(border, geometry.sectorDeg, [&](double t) { return at(1.0 - t, 1.0); });
  addArc(border, geometry.elevationSectorDeg, [&](double t) { return at(0.0, 1.0 - t); });
  std::vector<Polyline> outline{ border };
  for (const Vec3d& corner : { at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0) })
  {
    outline.push_back({ Vec3d(0.0), corner });
  }

  return outline;
}

} // namespace

std::vector<std::vector<Vec3d>> scanOutline(const ScanGeometry& geometry)
{
  geometry.validate();
  return geometry.isVolume() ? volumeOutline(geometry) : planarOutline(geometry);
}

} // namespace sono
