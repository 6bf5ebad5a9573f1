#include "SonoGuidance.h"

#include "Probe/ScanGeometry.h"

#include <algorithm>
#include <cmath>

namespace sono {
namespace {

ProbePose poseOf(const PoseNumbers& n)
{
  return ProbePose{ { n[0], n[1], n[2] }, { n[3], n[4], n[5] }, { n[6], n[7], n[8] } }.orthonormalized();
}

double degrees(double radians)
{
  return radians * 180.0 / M_PI;
}

} // namespace

bool Guidance::isReached(double withinMm, double withinDeg) const
{
  const double awayMm =
    std::sqrt(slideLateralMm * slideLateralMm + slideElevationMm * slideElevationMm + pressMm * pressMm);
  return awayMm <= withinMm && std::abs(tiltDeg) <= withinDeg && std::abs(rockDeg) <= withinDeg &&
         std::abs(rotateDeg) <= withinDeg;
}

Guidance guidance(const PoseNumbers& from, const PoseNumbers& to)
{
  const ProbePose at = poseOf(from);
  const ProbePose goal = poseOf(to);
  const Vec3d elevation = glm::cross(at.axial, at.lateral);
  const Vec3d way = goal.positionMm - at.positionMm;
  Guidance found;
  found.slideLateralMm = glm::dot(way, at.lateral);
  found.slideElevationMm = glm::dot(way, elevation);
  found.pressMm = glm::dot(way, at.axial);
  // The goal's beam is (sin rock, cos rock sin tilt, cos rock cos tilt) along lateral, elevation and axial.
  const double tilt = std::atan2(glm::dot(goal.axial, elevation), glm::dot(goal.axial, at.axial));
  const double rock = std::asin(std::clamp(glm::dot(goal.axial, at.lateral), -1.0, 1.0));
  const Vec3d tiltedElevation = std::cos(tilt) * elevation - std::sin(tilt) * at.axial;
  const Vec3d rockedLateral = glm::cross(tiltedElevation, goal.axial); // since elevation = axial x lateral
  found.tiltDeg = degrees(tilt);
  found.rockDeg = degrees(rock);
  found.rotateDeg = degrees(std::atan2(glm::dot(goal.lateral, tiltedElevation), glm::dot(goal.lateral, rockedLateral)));
  return found;
}

} // namespace sono
