#include "Trace/ProbeContact.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

namespace sono {

namespace {

constexpr double waterMRayl = 1.48;
constexpr double mostReflected = 0.3; // of the intensity, at normal incidence
constexpr double mostGapMm = 10.0;
constexpr double farMm = 500.0;
constexpr double mostInsideMm = 15.0;
constexpr double leastImage = 0.5;
constexpr double farthestSkinMm = 60.0;

/// Number of the voxel at a place in the world; -1 beyond the volume.
std::ptrdiff_t voxelAt(const Scene& scene, const Vec3d& world)
{
  const Vec3i size = scene.placement().size;
  const Vec3d v = glm::floor(scene.placement().indexFromWorld(world) + 0.5);
  const bool isThere = glm::all(glm::greaterThanEqual(v, Vec3d(0.0))) && glm::all(glm::lessThan(v, Vec3d(size)));
  return isThere ? std::ptrdiff_t(v.x) + size.x * (std::ptrdiff_t(v.y) + size.y * std::ptrdiff_t(v.z)) : -1;
}

/// The tissue there; null where what surrounds the body is.
const Tissue* bodyAt(const Scene& scene, const Vec3d& world)
{
  const std::ptrdiff_t voxel = voxelAt(scene, world);
  const int tissue = voxel < 0 ? scene.outsideIndex() : int(scene.tissueVoxels()[std::size_t(voxel)]);
  return voxel < 0 || tissue == scene.outsideIndex() ? nullptr : &scene.tissues()[std::size_t(tissue)];
}

bool keepsSoundOut(const Tissue& tissue)
{
  const double r = (tissue.impedanceMRayl - waterMRayl) / (tissue.impedanceMRayl + waterMRayl);
  return r * r > mostReflected;
}

double halfVoxelMm(const Scene& scene)
{
  const Vec3d spacing = scene.placement().spacingMm;
  return 0.5 * std::min({ spacing.x, spacing.y, spacing.z });
}

/// Way along a line to the first voxel of the body; infinite where there is none as near as `mostMm`.
double gapMm(const Scene& scene, const ScanLine& line, double mostMm)
{
  const double step = halfVoxelMm(scene);
  for (double t = 0.0; t < std::min(farMm, mostMm); t += step)
  {
    if (bodyAt(scene, line.originMm + t * line.axis))
    {
      return t;
    }
  }
  return INFINITY;
}

} // namespace

std::string probeContactWarning(const Scene& scene, const std::vector<ScanLine>& lines)
{
  const std::vector<LabelInfo>& labels = scene.volume().labels;
  if (std::all_of(labels.begin(), labels.end(), [&](const LabelInfo& label) {
        return scene.tissueOfLabel()[std::size_t(label.id)] == scene.outsideIndex();
      }))
  {
    return "The label map holds nothing but what lies outside of a body" +
           (labels.empty() ? std::string() : " (" + labels.front().tissue + ")") +
           ", which counts as coupling gel: choose the array that holds the labels, or another Outside Tissue.";
  }
  std::map<const LabelInfo*, std::size_t> blocking;
  double gap = INFINITY;
  for (const ScanLine& line : lines)
  {
    const Tissue* tissue = bodyAt(scene, line.originMm);
    if (!tissue)
    {
      gap = std::min(gap, gapMm(scene, line, gap));
      continue;
    }
    gap = 0.0;
    if (keepsSoundOut(*tissue))
    {
      ++blocking[scene.volume().find(scene.volume().voxels[std::size_t(voxelAt(scene, line.originMm))])];
    }
  }
  for (const auto& [label, count] : blocking)
  {
    if (2 * count > lines.size())
    {
      return "The transducer's face is inside '" + label->name + "' (" + label->tissue +
             "), which sound hardly enters or leaves: move the probe onto the skin.";
    }
  }
  if (std::isfinite(gap) && gap > mostGapMm)
  {
    return "The transducer's face is " + std::to_string(std::lround(gap)) +
           " mm off the body, and the gap counts as coupling gel: move the probe onto the skin.";
  }
  return {};
}

std::string probePlaceWarning(const Scene& scene, const ScanGeometry& geometry, const ProbePose& pose)
{
  if (geometry.lineOrigin() == LineOrigin::Catheter)
  {
    return {};
  }
  const ProbePose probe = pose.orthonormalized();
  const auto isBody = [&](double behindMm) {
    return bodyAt(scene, probe.positionMm - behindMm * probe.axial) != nullptr;
  };
  double insideMm = 0.0;
  while (insideMm < farMm && isBody(insideMm))
  {
    insideMm += 1.0;
  }
  if (insideMm > mostInsideMm)
  {
    return "The transducer's face lies " + std::to_string(std::lround(insideMm)) +
           " mm inside the body: press Find Window in the panel of the probe (in a script: Acoustic Window) to put it "
           "onto the skin.";
  }

  const double share = shareInsideVolume(scene, geometry, probe);
  if (share < leastImage)
  {
    return "Only " + std::to_string(std::lround(100.0 * share)) +
           " % of the image lies within the label map's volume, and what lies beyond is unknown and stays dark: take "
           "another place with Find Window in the panel of the probe (in a script: Acoustic Window), or less depth.";
  }
  return {};
}

double shareInsideVolume(const Scene& scene, const ScanGeometry& geometry, const ProbePose& pose)
{
  ScanGeometry plane = geometry;
  plane.kind = plane.isVolume() ? ScanKind::PhasedSector : plane.kind;
  plane.lineCount = 33;
  const auto lines = makeScanLines(plane, pose.orthonormalized());
  double all = 0.0;
  double within = 0.0;
  const double stepMm = plane.depthMm / 64.0;
  for (double r = 0.5 * stepMm; r < plane.depthMm; r += stepMm)
  {
    const double areaMm2 =
      stepMm * glm::distance(lines[16].originMm + r * lines[16].axis, lines[17].originMm + r * lines[17].axis);
    for (const ScanLine& line : lines)
    {
      all += areaMm2;
      within += voxelAt(scene, line.originMm + r * line.axis) >= 0 ? areaMm2 : 0.0;
    }
  }
  return within / all;
}

std::optional<ProbePose> poseOnSkin(const Scene& scene, const ProbePose& pose)
{
  ProbePose probe = pose.orthonormalized();
  const Vec3d start = probe.positionMm;
  const bool startsInside = bodyAt(scene, start) != nullptr;
  const double step = halfVoxelMm(scene);
  for (double t = 0.0; t <= farthestSkinMm; t += step)
  {
    probe.positionMm = start + (startsInside ? -t : t) * probe.axial;
    if ((bodyAt(scene, probe.positionMm) == nullptr) == startsInside)
    {
      return probe;
    }
  }
  return std::nullopt;
}

ProbePose pressedIn(const Scene& scene, const ProbePose& pose, const BeamAperture& aperture, double pressMm)
{
  ProbePose probe = pose.orthonormalized();
  const Vec3d start = probe.positionMm;
  const Vec3d lateral = 0.5 * aperture.apertureMm * probe.lateral;
  const Vec3d elevation = 0.5 * aperture.elevationApertureMm * glm::cross(probe.axial, probe.lateral);
  const auto meetsBone = [&](const Vec3d& middle) {
    for (int place = 0; place < 9; ++place)
    {
      const Tissue* tissue =
        bodyAt(scene, middle + double(place % 3 - 1) * lateral + double(place / 3 - 1) * elevation);
      if (tissue && keepsSoundOut(*tissue))
      {
        return true;
      }
    }
    return false;
  };
  const double step = halfVoxelMm(scene);
  for (double t = std::min(step, pressMm); t > 0.0; t = t < pressMm ? std::min(t + step, pressMm) : 0.0)
  {
    const Vec3d middle = start + t * probe.axial;
    if (meetsBone(middle))
    {
      break;
    }
    probe.positionMm = middle;
  }
  return probe;
}

} // namespace sono
