#include "Image/ShownPlace.h"

#include "Kernel/LabelRow.h"

namespace sono {

namespace {

constexpr int halvings = 40; // of the depth of the image: far below a pixel

} // namespace

ShownPlace shownPlace(const PlaneScan& scan, const float* offsetMm, const ProbePose& pose, const Vec3d& worldMm)
{
  const Vec3d from = worldMm - pose.positionMm;
  const double lateralMm = glm::dot(from, pose.lateral);
  const double axialMm = glm::dot(from, pose.axial);
  const float x = scan.beams.axialFromCentre(float(axialMm));
  float lateral;
  float axial;
  scan.beams.directionAt(float(lateralMm), x, lateral, axial);
  float line;
  float depthMm;
  scan.beams.beamAt(float(lateralMm), x, line, depthMm);

  // The depth of what is shown at another depth of the line.
  const auto depthOf = [&](double shownMm) {
    const float moved = float(shownMm) - depthMm;
    const LabelShift shift = labelShift(scan, offsetMm, float(lateralMm) + moved * lateral, x + moved * axial);
    return shownMm + shift.pixels * scan.pixelMm * lateral + shift.axialMm * axial;
  };
  double low = 0.0;
  double high = scan.area.lastMm;
  double shownMm = high + (depthMm - depthOf(high)); // beyond the image
  if (depthMm < 0.0f)
  {
    shownMm = depthMm;
  }
  else if (shownMm < high)
  {
    for (int halving = 0; halving < halvings; ++halving)
    {
      const double middle = 0.5 * (low + high);
      (depthOf(middle) < depthMm ? low : high) = middle;
    }
    shownMm = 0.5 * (low + high);
  }

  ShownPlace place;
  place.lateralMm = lateralMm + (shownMm - depthMm) * lateral;
  place.axialMm = axialMm + (shownMm - depthMm) * axial;
  place.offPlaneMm = glm::dot(from, glm::cross(pose.axial, pose.lateral));
  float ignored;
  place.inSector = scan.fanCount > 1 ? scan.compound(nullptr, float(place.lateralMm),
                                                     scan.beams.axialFromCentre(float(place.axialMm)), ignored)
                                     : scan.area.contains(line, float(shownMm));
  return place;
}

} // namespace sono
