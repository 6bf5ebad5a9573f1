#include "Probe/ScanGeometry.h"

#include "Core/ParallelFor.h"
#include "Core/Progress.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

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

/// From -0.5 on the first of `count` lines to 0.5 on the last; 0 when there is one.
double fractionOf(double line, int count)
{
  return count > 1 ? line / (count - 1) - 0.5 : 0.0;
}

/// The angle of a line of a fan.
double angleOf(const ScanGeometry& geometry, double line)
{
  const double extent = geometry.sectorDeg * radiansPerDegree;
  return geometry.closesCircle() ? (line / geometry.lineCount - 0.5) * extent
                                 : fractionOf(line, geometry.lineCount) * extent;
}

double elevationAngle(const ScanGeometry& geometry, double elevation)
{
  return fractionOf(elevation, geometry.elevationLineCount) * geometry.elevationSectorDeg * radiansPerDegree;
}

/// The inverse of fractionOf. A single line sees only what lies on it; the tolerance is then that of two lines.
double lineOf(double fraction, int count)
{
  return count > 1 ? (fraction + 0.5) * (count - 1) : fraction;
}

bool isSeen(double line, int count)
{
  return line >= -lineTolerance && line <= count - 1 + lineTolerance;
}

bool isSeenDepth(const ScanGeometry& geometry, double r)
{
  return r >= -depthToleranceMm && r <= geometry.depthMm + depthToleranceMm;
}

/// Where a line starts and points to, as (lateral, axial).
struct PlaneLine
{
  double lateralMm;
  double axialMm;
  double lateralStep;
  double axialStep;
  double steering; ///< sine of the angle to the face's normal
};

PlaneLine planeLine(const ScanGeometry& geometry, double line, double steeringRad = 0.0)
{
  if (geometry.lineOrigin() == LineOrigin::Aperture)
  {
    const double sine = std::sin(steeringRad);
    return { fractionOf(line, geometry.lineCount) * geometry.widthMm, 0.0, sine, std::cos(steeringRad), sine };
  }
  const double angle = angleOf(geometry, line);
  const double radius = geometry.faceRadiusMm();
  const double sine = std::sin(angle);
  const double cosine = std::cos(angle);
  const double half = std::sin(0.5 * angle);
  const bool isCatheter = geometry.lineOrigin() == LineOrigin::Catheter;
  const double axial = isCatheter ? radius * cosine : -2.0 * radius * half * half; // R (cos - 1)
  if (geometry.lineOrigin() == LineOrigin::Apex)
  {
    return { radius * sine, axial, sine, cosine, sine };
  }
  return { radius * sine, axial, std::sin(angle + steeringRad), std::cos(angle + steeringRad), std::sin(steeringRad) };
}

/// Throws as validate().
std::vector<PlaneLine> planeLines(const ScanGeometry& geometry)
{
  geometry.validate();
  std::vector<PlaneLine> lines;
  for (int fan = 0; fan < geometry.fanCount(); ++fan)
  {
    const double steeringRad = geometry.steeringDeg(fan) * radiansPerDegree;
    for (int n = 0; n < geometry.lineCount; ++n)
    {
      lines.push_back(planeLine(geometry, n, steeringRad));
    }
  }
  return lines;
}

/// All lines of a pose, from those of its plane.
void placeLines(const ScanGeometry& geometry, const std::vector<PlaneLine>& planeLines, const ProbePose& pose,
                ScanLine* line)
{
  const ProbePose frame = pose.orthonormalized();
  const Vec3d across = glm::cross(frame.axial, frame.lateral);
  const int elevations = geometry.isVolume() ? geometry.elevationLineCount : 1;
  for (int e = 0; e < elevations; ++e)
  {
    const double phi = elevations > 1 ? elevationAngle(geometry, e) : 0.0;
    const Vec3d axial = std::cos(phi) * frame.axial + std::sin(phi) * across;
    const Vec3d elevation = std::cos(phi) * across - std::sin(phi) * frame.axial;
    for (const PlaneLine& plane : planeLines)
    {
      line->originMm = frame.positionMm + plane.lateralMm * frame.lateral + plane.axialMm * axial;
      line->axis = plane.lateralStep * frame.lateral + plane.axialStep * axial;
      line->lateral = plane.axialStep * frame.lateral - plane.lateralStep * axial;
      line->elevation = elevation;
      line->steeringLateral = plane.steering;
      line->steeringElevational = plane.axialStep * std::sin(phi);
      ++line;
    }
  }
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

double ScanGeometry::faceRadiusMm() const
{
  return lineOrigin() == LineOrigin::ConvexFace || lineOrigin() == LineOrigin::Catheter ? radiusMm : 0.0;
}

double ScanGeometry::fanCentreAxialMm() const
{
  return lineOrigin() == LineOrigin::ConvexFace ? -radiusMm : 0.0;
}

double ScanGeometry::steeringDeg(int fan) const
{
  return fractionOf(fan, fanCount()) * compoundSpanDeg;
}

bool ScanGeometry::uses(const Parameter& number) const
{
  const std::string name = number.name;
  const std::vector<std::string>& own = traitsOf(kind).numbers;
  return name == "scanKind" || name == "lineCount" || name == "depthMm" || name == "assumedSoundSpeedMPerS" ||
         std::find(own.begin(), own.end(), name) != own.end();
}

Range ScanGeometry::rangeOf(const Parameter& number) const
{
  const bool isBounded = number.name == std::string("sectorDeg") && traitsOf(kind).maxSectorDeg < 360.0;
  return isBounded ? inside(0, traitsOf(kind).maxSectorDeg) : number.range;
}

void ScanGeometry::validate() const
{
  traitsOf(kind); // first: the others are asked of it
  visit(*this, [this](const auto& value, Parameter parameter) {
    if (uses(parameter))
    {
      parameter.range = rangeOf(parameter);
      requireInRange(value, parameter);
    }
  });
  requireInRange(
    totalLineCount(),
    Parameter{ isVolume() ? "lineCount x elevationLineCount" : "lineCount x compoundFans", "", between(1, 65536), "" });
}

bool operator==(const BeamAperture& a, const BeamAperture& b)
{
  const auto tied = [](const BeamAperture& x) {
    return std::tie(x.apertureMm, x.elevationApertureMm, x.transmitFocusMm, x.elevationFocusMm, x.elementWidthMm,
                    x.elevationIsArray);
  };
  return tied(a) == tied(b);
}

BeamAperture ProbeSettings::aperture() const
{
  BeamAperture aperture = *this;
  aperture.elevationIsArray = geometry.isMatrix();
  return aperture;
}

std::vector<ScanLine> makeScanLines(const ScanGeometry& geometry, const std::vector<ProbePose>& poses)
{
  const std::vector<PlaneLine> plane = planeLines(geometry);
  const std::size_t perPose = std::size_t(geometry.totalLineCount());
  std::vector<ScanLine> lines(poses.size() * perPose);
  parallelFor(int(poses.size()), {}, [&](int pose) {
    placeLines(geometry, plane, poses[std::size_t(pose)], lines.data() + std::size_t(pose) * perPose);
  });
  return lines;
}

std::vector<ScanLine> makeScanLines(const ScanGeometry& geometry, const ProbePose& pose)
{
  const std::vector<PlaneLine> plane = planeLines(geometry);
  std::vector<ScanLine> lines(std::size_t(geometry.totalLineCount()));
  placeLines(geometry, plane, pose, lines.data());
  return lines;
}

Vec2f planeFromBeam(const ScanGeometry& geometry, double line, double r)
{
  const PlaneLine plane = planeLine(geometry, line);
  return { float(plane.lateralMm + r * plane.lateralStep), float(plane.axialMm + r * plane.axialStep) };
}

Vec2f beamFromPlane(const ScanGeometry& geometry, double lateralMm, double axialMm)
{
  const int count = geometry.lineCount;
  double line = lineOf(lateralMm / geometry.widthMm, count);
  double r = axialMm;
  if (geometry.lineOrigin() != LineOrigin::Aperture)
  {
    const double radius = geometry.faceRadiusMm();
    const double forward = axialMm - geometry.fanCentreAxialMm();
    const double fraction = std::atan2(lateralMm, forward) / (geometry.sectorDeg * radiansPerDegree);
    line = geometry.closesCircle() ? std::fmod((fraction + 0.5) * count, count) : lineOf(fraction, count);
    r = std::hypot(lateralMm, forward) - radius;
  }
  if (!isSeenDepth(geometry, r) || !(geometry.closesCircle() || isSeen(line, count)))
  {
    return Vec2f(std::numeric_limits<float>::quiet_NaN());
  }
  const double last = geometry.closesCircle() ? count : count - 1;
  return { float(std::clamp(line, 0.0, last)), float(std::clamp(r, 0.0, geometry.depthMm)) };
}

PlaneBeams planeBeams(const ScanGeometry& geometry)
{
  const bool parallel = geometry.lineOrigin() == LineOrigin::Aperture || geometry.lineCount == 1;
  const double extent = parallel ? geometry.widthMm : geometry.sectorDeg * radiansPerDegree;
  const double faceRadiusMm = geometry.faceRadiusMm();
  const int steps = geometry.closesCircle() ? geometry.lineCount : geometry.lineCount - 1;
  return { parallel, float(faceRadiusMm), float(geometry.fanCentreAxialMm()), float(-extent / 2.0),
           float(steps / extent) };
}

PlaneExtent planeExtent(const ScanGeometry& geometry)
{
  const PlaneBeams map = planeBeams(geometry);
  const double inner = geometry.faceRadiusMm();
  const double centreAxialMm = geometry.fanCentreAxialMm();
  const double outer = inner + geometry.depthMm;
  if (map.parallel)
  {
    const double halfWidth = geometry.lineCount == 1 ? 0.0 : geometry.widthMm / 2.0;
    return { halfWidth, centreAxialMm + inner, centreAxialMm + outer };
  }
  const double half = geometry.sectorDeg * radiansPerDegree / 2.0;
  const double widest = std::min(half, 1.5707963267948966);
  const double backMm = half < widest + 1e-9 ? inner * std::cos(half) : outer * std::cos(half);
  return { outer * std::sin(widest), centreAxialMm + backMm, centreAxialMm + outer };
}

Vec3d volumeFromBeam(const ScanGeometry& geometry, double line, double elevation, double r)
{
  const double theta = angleOf(geometry, line);
  const double phi = elevationAngle(geometry, elevation);
  return r * Vec3d(std::sin(theta), std::cos(theta) * std::sin(phi), std::cos(theta) * std::cos(phi));
}

Vec3d beamFromVolume(const ScanGeometry& geometry, const Vec3d& positionMm)
{
  const double r = glm::length(positionMm);
  const double forward = std::hypot(positionMm.y, positionMm.z);
  const double theta = std::atan2(positionMm.x, forward) / (geometry.sectorDeg * radiansPerDegree);
  const double phi = std::atan2(positionMm.y, positionMm.z) / (geometry.elevationSectorDeg * radiansPerDegree);
  const double line = lineOf(theta, geometry.lineCount);
  const double elevation = lineOf(phi, geometry.elevationLineCount);
  if (!isSeenDepth(geometry, r) || !isSeen(line, geometry.lineCount) || !isSeen(elevation, geometry.elevationLineCount))
  {
    return Vec3d(std::numeric_limits<double>::quiet_NaN());
  }
  return { std::clamp(line, 0.0, geometry.lineCount - 1.0),
           std::clamp(elevation, 0.0, geometry.elevationLineCount - 1.0), std::min(r, geometry.depthMm) };
}

} // namespace sono
