#include "Phantoms/CalibrationPhantom.h"

#include "Core/Require.h"
#include "Phantoms/PhantomVolume.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double blockWidthMm = 178.0;
constexpr double blockDepthMm = 203.0;
constexpr const char* background = "phantom_gel";
constexpr int wireSides = 8; // a tenth of a wavelength each (chosen): as targets, more are more pieces

void requireInside(const CalibrationPhantomSettings& settings, const PhantomTarget& target)
{
  const double radius = 0.5 * target.diameterMm;
  const double lateral = std::fabs(phantomTargetCentreMm(settings, target).x);
  if (lateral + radius > 0.5 * blockWidthMm || target.depthMm < radius || target.depthMm + radius > blockDepthMm)
  {
    throw Error("target '" + target.name + "' of view " + std::to_string(target.view) + " at " +
                std::to_string(target.lateralMm) + ", " + std::to_string(target.depthMm) +
                " mm reaches out of the block of 178 x 203 mm: correct its place or the distance of the views");
  }
}

/// A target in the plane across it, as voxels see it.
struct Disc
{
  double x, z, radiusSquared;
  int label;
};

std::vector<std::string> tissuesOf(const std::vector<PhantomTarget>& targets)
{
  std::vector<std::string> tissues{ background };
  for (const PhantomTarget& target : targets)
  {
    if (std::find(tissues.begin(), tissues.end(), target.tissue) == tissues.end())
    {
      tissues.push_back(target.tissue);
    }
  }
  return tissues;
}

/// Wires as voxels: the centre of the cell of the voxel grid that holds the wire, and half a voxel around it.
bool inWireVoxel(const Vec3d& p, const Disc& wire, double spacingMm)
{
  // The block is symmetric about x = 0 but starts at z = 0.
  const double cells = std::round(blockWidthMm / spacingMm);
  const double left = -0.5 * cells * spacingMm;
  const double x = left + (std::floor((wire.x - left) / spacingMm) + 0.5) * spacingMm;
  const double z = (std::floor(wire.z / spacingMm) + 0.5) * spacingMm;
  return std::fabs(p.x - x) < 0.25 * spacingMm && std::fabs(p.z - z) < 0.25 * spacingMm;
}

std::vector<PhantomTarget> wiresOf(const std::vector<PhantomTarget>& targets)
{
  std::vector<PhantomTarget> wires;
  std::copy_if(targets.begin(), targets.end(), std::back_inserter(wires),
               [](const PhantomTarget& t) { return t.kind == PhantomTargetKind::Wire; });
  return wires;
}

/// Adds a prism of `sides` sides around the line (x, -half..half, z) whose cross-section has the area of the circle.
void addPrism(TargetSurface& surface, const Vec3d& centre, double radiusMm, double halfMm, int sides)
{
  const int first = int(surface.pointsMm.size());
  const double corner = radiusMm * std::sqrt(2.0 * pi / (sides * std::sin(2.0 * pi / sides)));
  for (const double y : { -halfMm, halfMm })
  {
    for (int i = 0; i < sides; ++i)
    {
      const double angle = 2.0 * pi * i / sides;
      surface.pointsMm.push_back({ centre.x + corner * std::cos(angle), y, centre.z + corner * std::sin(angle) });
    }
  }
  for (int i = 0; i < sides; ++i)
  {
    const int j = (i + 1) % sides;
    surface.triangles.push_back({ first + i, first + j, first + sides + j });
    surface.triangles.push_back({ first + i, first + sides + j, first + sides + i });
    if (i > 0 && j > 0)
    {
      surface.triangles.push_back({ first, first + j, first + i });
      surface.triangles.push_back({ first + sides, first + sides + i, first + sides + j });
    }
  }
}

} // namespace

void CalibrationPhantomSettings::validate() const
{
  requireInRange(spacingMm >= 0.1 && spacingMm <= 5.0, "voxel size of the phantom (mm)", spacingMm, "0.1 to 5");
  requireInRange(thicknessMm >= 1.0 && thicknessMm <= 127.0, "thickness of the phantom (mm)", thicknessMm, "1 to 127");
  requireInRange(viewPitchMm >= 0.0 && viewPitchMm <= 89.0, "distance of the phantom's views (mm)", viewPitchMm,
                 "0 to 89");
}

LabelVolume makeCalibrationPhantom(const std::vector<PhantomTarget>& targets,
                                   const CalibrationPhantomSettings& settings)
{
  settings.validate();
  const std::vector<std::string> tissues = tissuesOf(targets);
  std::vector<Disc> cylinders;
  std::vector<Disc> wires;
  for (const PhantomTarget& target : targets)
  {
    requireInside(settings, target);
    const Vec3d centre = phantomTargetCentreMm(settings, target);
    const int label = int(std::find(tissues.begin(), tissues.end(), target.tissue) - tissues.begin());
    const Disc disc{ centre.x, centre.z, 0.25 * target.diameterMm * target.diameterMm, label };
    (target.kind == PhantomTargetKind::Cylinder ? cylinders : wires).push_back(disc);
  }
  if (!settings.wiresAsVoxels)
  {
    wires.clear();
  }
  return makePhantomVolume(
    { blockWidthMm, settings.thicknessMm, blockDepthMm }, settings.spacingMm, tissues, [&](const Vec3d& p) {
      int label = 0;
      for (const Disc& d : cylinders)
      {
        const bool inside = (p.x - d.x) * (p.x - d.x) + (p.z - d.z) * (p.z - d.z) < d.radiusSquared;
        label = inside ? d.label : label;
      }
      for (const Disc& d : wires)
      {
        label = inWireVoxel(p, d, settings.spacingMm) ? d.label : label;
      }
      return label;
    });
}

ProbePose phantomViewPose(const CalibrationPhantomSettings& settings, int view)
{
  requireInRange(view >= 1 && view <= phantomViewCount, "view of the phantom", view, "1 to 3");
  ProbePose pose;
  pose.positionMm.x = (view - 0.5 * (phantomViewCount + 1)) * settings.viewPitchMm;
  return pose;
}

Vec3d phantomTargetCentreMm(const CalibrationPhantomSettings& settings, const PhantomTarget& target)
{
  return phantomViewPose(settings, target.view).positionMm + Vec3d(target.lateralMm, 0.0, target.depthMm);
}

TargetSurface phantomWireSurface(const std::vector<PhantomTarget>& targets, const CalibrationPhantomSettings& settings,
                                 const TissueTable& tissues)
{
  settings.validate();
  const std::vector<PhantomTarget> wires = wiresOf(targets);
  if (wires.empty())
  {
    throw Error("the phantom has no wires: add lines of kind 'wire' to its table");
  }
  const Tissue* tissue = tissues.find(wires.front().tissue);
  if (!tissue)
  {
    throw Error("the phantom's wires are of tissue '" + wires.front().tissue +
                "', which is not in the tissue table; choose one of its tissues or add a row");
  }
  TargetSurface surface{ "wires", *tissue, {}, {} };
  // A hundredth of a millimetre inside the block, so that the ends are no boundary of its own.
  const double half = 0.5 * settings.thicknessMm - 0.01;
  for (const PhantomTarget& wire : wires)
  {
    requireInside(settings, wire);
    addPrism(surface, phantomTargetCentreMm(settings, wire), 0.5 * wire.diameterMm, half, wireSides);
  }
  return surface;
}

std::vector<PointScatterer> phantomWireScatterers(const std::vector<PhantomTarget>& targets,
                                                  const CalibrationPhantomSettings& settings, double amplitudePerMm,
                                                  double stepMm)
{
  settings.validate();
  requireInRange(stepMm > 0.0 && stepMm <= settings.thicknessMm, "step of the wires' scatterers (mm)", stepMm,
                 "more than 0 and at most the phantom's thickness");
  std::vector<PointScatterer> scatterers;
  const int count = int(settings.thicknessMm / stepMm);
  for (const PhantomTarget& wire : wiresOf(targets))
  {
    const Vec3d centre = phantomTargetCentreMm(settings, wire);
    for (int i = 0; i < count; ++i)
    {
      const double y = (i - 0.5 * (count - 1)) * stepMm;
      scatterers.push_back({ centre + Vec3d(0.0, y, 0.0), float(amplitudePerMm * stepMm) });
    }
  }
  return scatterers;
}

} // namespace sono
