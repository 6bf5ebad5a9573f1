#include "DataSets/HoldProbe.h"

#include "DataSets/ImageSight.h"
#include "Kernel/LabelRow.h"
#include "Trace/Trace.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int lineCount = 24;
constexpr int pathsPerLine = 8;
constexpr double leastBinMm = 1.0;

/// Rodrigues' formula; `axis` has length 1.
Vec3d rotated(const Vec3d& v, const Vec3d& axis, double deg)
{
  const double angle = deg * M_PI / 180.0;
  return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
         axis * (glm::dot(axis, v) * (1.0 - std::cos(angle)));
}

} // namespace

ProbePose jittered(const ProbePose& view, const PoseJitter& jitter)
{
  const Vec3d elevation = glm::cross(view.axial, view.lateral);
  ProbePose pose = view;
  pose.positionMm += jitter.slideLateralMm * view.lateral + jitter.slideElevationMm * elevation;
  const auto turn = [&](const Vec3d& axis, double deg) {
    pose.axial = rotated(pose.axial, axis, deg);
    pose.lateral = rotated(pose.lateral, axis, deg);
  };
  turn(view.lateral, jitter.tiltDeg);
  turn(elevation, jitter.rockDeg);
  turn(pose.axial, jitter.rotationDeg);
  return pose.orthonormalized();
}

double maskSufficiency(const Scene& scene, const std::vector<std::uint8_t>& groups, const std::vector<MaskGroup>& masks,
                       const ImageSettings& settings, const ProbePose& pose)
{
  const LabelVolume& volume = scene.volume();
  std::vector<double> asked(masks.size() + 1, 0.0); // by value
  for (const LabelInfo& label : volume.labels)
  {
    if (const std::size_t group = groups[std::size_t(label.id)])
    {
      asked[group] = masks[group - 1].leastVisiblePercent / 100.0;
    }
  }
  if (std::all_of(asked.begin(), asked.end(), [](double share) { return share <= 0.0; }))
  {
    return 1.0;
  }
  ScanGeometry geometry = settings.geometry;
  geometry.lineCount = lineCount;
  TraceSettings tracing = settings.tracing;
  tracing.pathsPerLine = pathsPerLine;
  tracing.radialBinMm = std::max(tracing.radialBinMm, leastBinMm);
  tracing.reverberation = false; // which adds nothing to what arrives straight
  const std::vector<ScanLine> lines = makeScanLines(geometry, pose);
  const TracedLines traced = trace(scene, lines, tracing);
  std::vector<double> all(asked.size(), 0.0);
  std::vector<double> shown(asked.size(), 0.0);
  for (std::size_t line = 0; line + 1 < lines.size(); ++line)
  {
    for (int bin = 0; bin < traced.binCount; ++bin)
    {
      const double r = (bin + 0.5) * traced.binMm;
      const Vec3d place = lines[line].originMm + r * lines[line].axis;
      const double area = glm::distance(place, lines[line + 1].originMm + r * lines[line + 1].axis);
      const std::size_t group =
        groups[labelAtIndex(volume.placement.indexFromWorld(place), volume.voxels.data(), volume.placement.size)];
      const float intensity = traced.intensity[line * std::size_t(traced.binCount) + std::size_t(bin)];
      all[group] += area;
      shown[group] += intensity < ImageSight::leastIntensity(tracing.frequencyMHz, r) ? 0.0 : area;
    }
  }
  double least = 1.0;
  for (std::size_t group = 1; group < asked.size(); ++group)
  {
    if (asked[group] > 0.0)
    {
      const double share = all[group] > 0.0 ? shown[group] / all[group] : 0.0;
      least = std::min(least, share / asked[group]);
    }
  }
  return least;
}

} // namespace sono
