#include "Probe/ScanGeometry.h"

#include "Progress.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace sono {

namespace {

constexpr double radiansPerDegree = 3.14159265358979323846 / 180.0;

// The image plane's coordinates are single precision, so the outermost points come back a little outside.
constexpr double lineTolerance = 1e-3;
constexpr double depthToleranceMm = 1e-3;

bool isFinite(const Vec3d& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void requireRange(const char* parameter, double value, double minimum, double maximum, bool ok)
{
  if (!ok)
  {
    std::ostringstream message;
    message << parameter << " is " << value << "; choose a value ";
    if (std::isinf(maximum))
    {
      message << "above " << minimum << ".";
    }
    else
    {
      message << "between " << minimum << " and " << maximum << ".";
    }
    throw Error(message.str());
  }
}

void requirePositive(const char* parameter, double value)
{
  requireRange(parameter, value, 0.0, std::numeric_limits<double>::infinity(), std::isfinite(value) && value > 0.0);
}

/// Distance of the face from the centre that the lines of a fan come from.
double faceRadius(const ScanGeometry& geometry)
{
  return geometry.kind == ScanKind::Curvilinear ? geometry.radiusMm : 0.0;
}

/// From -0.5 on the first line to 0.5 on the last; 0 when there is one line.
double fractionOfLine(const ScanGeometry& geometry, double line)
{
  return geometry.lineCount > 1 ? line / (geometry.lineCount - 1) - 0.5 : 0.0;
}

/// Where a line starts and points to, as (lateral, axial).
struct PlaneLine
{
  double lateralMm;
  double axialMm;
  double lateralStep;
  double axialStep;
};

PlaneLine planeLine(const ScanGeometry& geometry, double line)
{
  const double fraction = fractionOfLine(geometry, line);
  if (geometry.kind == ScanKind::Linear)
  {
    return { fraction * geometry.widthMm, 0.0, 0.0, 1.0 };
  }
  const double angle = fraction * geometry.sectorDeg * radiansPerDegree;
  const double radius = faceRadius(geometry);
  const double sine = std::sin(angle);
  const double half = std::sin(0.5 * angle);
  return { radius * sine, -2.0 * radius * half * half, sine, std::cos(angle) }; // cos - 1 without cancellation
}

} // namespace

ProbePose ProbePose::orthonormalized() const
{
  if (!isFinite(positionMm) || !isFinite(axial) || !isFinite(lateral))
  {
    throw Error("the probe's position, axial or lateral direction is not finite; give three numbers for each.");
  }
  const double axialLength = glm::length(axial);
  const double lateralLength = glm::length(lateral);
  if (!(axialLength > 0.0) || !(lateralLength > 0.0) || !std::isfinite(axialLength) || !std::isfinite(lateralLength))
  {
    throw Error("the probe's axial or lateral direction is zero or too long; give two directions at an angle.");
  }
  ProbePose pose = *this;
  pose.axial = axial / axialLength;
  const Vec3d unit = lateral / lateralLength;
  const Vec3d across = unit - glm::dot(unit, pose.axial) * pose.axial;
  const double acrossLength = glm::length(across);
  if (!(acrossLength > 1e-6))
  {
    throw Error("the probe's axial and lateral directions are parallel; turn the lateral one.");
  }
  pose.lateral = across / acrossLength;
  return pose;
}

void ScanGeometry::validate() const
{
  requireRange("lineCount", lineCount, 1.0, 4096.0, lineCount >= 1 && lineCount <= 4096);
  requirePositive("depthMm", depthMm);
  switch (kind)
  {
    case ScanKind::Linear:
      requirePositive("widthMm", widthMm);
      return;
    case ScanKind::Curvilinear:
      requirePositive("radiusMm", radiusMm);
      [[fallthrough]];
    case ScanKind::PhasedSector:
      requireRange("sectorDeg", sectorDeg, 0.0, 180.0, sectorDeg > 0.0 && sectorDeg < 180.0);
      return;
  }
  throw Error("the scan kind is none of linear, phased sector and curvilinear; choose one of them.");
}

std::vector<ScanLine> makeScanLines(const ScanGeometry& geometry, const ProbePose& pose)
{
  geometry.validate();
  const ProbePose frame = pose.orthonormalized();
  const Vec3d elevation = glm::cross(frame.axial, frame.lateral);
  std::vector<ScanLine> lines;
  lines.reserve(std::size_t(geometry.lineCount));
  for (int n = 0; n < geometry.lineCount; ++n)
  {
    const PlaneLine plane = planeLine(geometry, n);
    ScanLine line;
    line.originMm = frame.positionMm + plane.lateralMm * frame.lateral + plane.axialMm * frame.axial;
    line.axis = plane.lateralStep * frame.lateral + plane.axialStep * frame.axial;
    line.lateral = plane.axialStep * frame.lateral - plane.lateralStep * frame.axial;
    line.elevation = elevation;
    lines.push_back(line);
  }
  return lines;
}

Vec2f planeFromBeam(const ScanGeometry& geometry, double line, double r)
{
  const PlaneLine plane = planeLine(geometry, line);
  return { float(plane.lateralMm + r * plane.lateralStep), float(plane.axialMm + r * plane.axialStep) };
}

Vec2f beamFromPlane(const ScanGeometry& geometry, double lateralMm, double axialMm)
{
  double fraction = lateralMm / geometry.widthMm;
  double r = axialMm;
  if (geometry.kind != ScanKind::Linear)
  {
    const double radius = faceRadius(geometry);
    fraction = std::atan2(lateralMm, axialMm + radius) / (geometry.sectorDeg * radiansPerDegree);
    r = std::hypot(lateralMm, axialMm + radius) - radius;
  }
  const double last = geometry.lineCount - 1;
  // A single line sees only what lies on it; the tolerance is then that of two lines.
  const double line = (fraction + 0.5) * std::max(last, 1.0) - (geometry.lineCount > 1 ? 0.0 : 0.5);
  const bool seen = line >= -lineTolerance && line <= last + lineTolerance && r >= -depthToleranceMm &&
                    r <= geometry.depthMm + depthToleranceMm;
  if (!seen)
  {
    return Vec2f(std::numeric_limits<float>::quiet_NaN());
  }
  return { float(std::clamp(line, 0.0, last)), float(std::clamp(r, 0.0, geometry.depthMm)) };
}

} // namespace sono
