#include "DataSets/HoldProbe.h"

#include "DataSets/ImageSight.h"
#include "Kernel/LabelRow.h"
#include "Trace/Trace.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sono {

namespace {

constexpr int lineCount = 24;
constexpr int pathsPerLine = 8;
constexpr std::size_t linesTogether = 4;
constexpr double leastBinMm = 1.0;

/// Rodrigues' formula; `axis` has length 1.
Vec3d rotated(const Vec3d& v, const Vec3d& axis, double deg)
{
  const double angle = deg * M_PI / 180.0;
  return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
         axis * (glm::dot(axis, v) * (1.0 - std::cos(angle)));
}

/// Where a line meets a group that is asked for.
struct LookPlace
{
  int bin;
  std::size_t group;
  double areaMm2;
};

struct LookLine
{
  int line;
  double areaMm2 = 0.0; ///< of all its places
  std::vector<LookPlace> places;
};

/// The lines that meet some, those first that have most of it.
std::vector<LookLine> looksAt(const LabelVolume& volume, const std::vector<std::uint8_t>& groups,
                              const std::vector<double>& asked, const std::vector<ScanLine>& lines,
                              const TraceSettings& tracing)
{
  std::vector<LookLine> looks;
  for (std::size_t line = 0; line + 1 < lines.size(); ++line)
  {
    LookLine look{ int(line), 0.0, {} };
    const Vec3d first = volume.placement.indexFromWorld(lines[line].originMm);
    const Vec3d step = volume.placement.indexFromWorld(lines[line].originMm + lines[line].axis) - first;
    for (int bin = 0; bin < tracing.binCount(); ++bin)
    {
      const double r = (bin + 0.5) * tracing.radialBinMm;
      const std::size_t group = groups[labelAtIndex(first + r * step, volume.voxels.data(), volume.placement.size)];
      if (asked[group] > 0.0)
      {
        const double areaMm2 = glm::distance(lines[line].originMm + r * lines[line].axis,
                                             lines[line + 1].originMm + r * lines[line + 1].axis);
        look.places.push_back({ bin, group, areaMm2 });
        look.areaMm2 += areaMm2;
      }
    }
    if (!look.places.empty())
    {
      looks.push_back(std::move(look));
    }
  }
  std::stable_sort(looks.begin(), looks.end(),
                   [](const LookLine& a, const LookLine& b) { return a.areaMm2 > b.areaMm2; });
  return looks;
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
  tracing.intensityAlone = true;
  const std::vector<ScanLine> lines = makeScanLines(geometry, pose);
  const std::vector<LookLine> looks = looksAt(volume, groups, asked, lines, tracing);
  std::vector<double> all(asked.size(), 0.0);
  for (const LookLine& look : looks)
  {
    for (const LookPlace& place : look.places)
    {
      all[place.group] += place.areaMm2;
    }
  }
  std::vector<double> leastIntensity;
  for (int bin = 0; bin < tracing.binCount(); ++bin)
  {
    leastIntensity.push_back(ImageSight::leastIntensity(tracing.frequencyMHz, (bin + 0.5) * tracing.radialBinMm));
  }
  TraceRounds rounds(scene, lines, tracing, {}, {});
  std::vector<double> shown(asked.size(), 0.0);
  const auto sufficiency = [&] {
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
  };
  // The lines that have most of it first: often a part of them shows enough.
  for (std::size_t first = 0; first < looks.size() && sufficiency() < 1.0; first += linesTogether)
  {
    const std::size_t end = std::min(first + linesTogether, looks.size());
    std::vector<int> together;
    for (std::size_t n = first; n < end; ++n)
    {
      together.push_back(looks[n].line);
    }
    rounds.traceLines(together, pathsPerLine);
    const TracedLines& traced = rounds.traced();
    for (std::size_t n = first; n < end; ++n)
    {
      const float* intensity = traced.intensity.data() + std::size_t(looks[n].line) * std::size_t(traced.binCount);
      for (const LookPlace& place : looks[n].places)
      {
        const bool isShadow = intensity[place.bin] < leastIntensity[std::size_t(place.bin)];
        shown[place.group] += isShadow ? 0.0 : place.areaMm2;
      }
    }
  }
  return sufficiency();
}

} // namespace sono
