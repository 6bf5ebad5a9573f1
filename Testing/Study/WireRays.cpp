#include "WireRays.h"

#include "Trace/RecordPaths.h"

#include <array>
#include <cmath>

namespace sono::study {

namespace {

/// The rays of all places, one place after the other.
std::vector<ScanLine> raysFrom(const ScanGeometry& geometry, const ProbePose& pose, double apertureMm,
                               const WireRays& rays)
{
  ScanGeometry fan = geometry;
  fan.lineCount = rays.directions;
  std::vector<ScanLine> lines;
  for (int p = 0; p < rays.places; ++p)
  {
    ProbePose place = pose;
    place.positionMm += pose.lateral * (apertureMm * ((p + 0.5) / rays.places - 0.5));
    const auto of = makeScanLines(fan, place);
    lines.insert(lines.end(), of.begin(), of.end());
  }
  return lines;
}

/// The surfaces for straight rays: a boundary without refraction, and with next to no reflection.
std::vector<TargetSurface> transparent(std::vector<TargetSurface> wires)
{
  const TissueTable tissues = bundledTissues();
  const Tissue& gel = *tissues.find("phantom_gel");
  for (TargetSurface& wire : wires)
  {
    wire.tissue = gel;
    wire.tissue.name = "transparent";
    wire.tissue.impedanceMRayl *= 1.01;
  }
  return wires;
}

/// Where a path enters a wire and leaves it; media from `firstWire` on are wires.
std::vector<std::array<Vec3d, 2>> passages(const RecordedPath& path, int firstWire)
{
  std::vector<std::array<Vec3d, 2>> found;
  for (std::size_t i = 0; i + 1 < path.hits.size(); ++i)
  {
    const BoundaryHit& in = path.hits[i];
    const BoundaryHit& out = path.hits[i + 1];
    if (in.to >= firstWire && out.from == in.to)
    {
      found.push_back({ in.pointMm, out.pointMm });
    }
  }
  return found;
}

} // namespace

std::vector<PointScatterer> scatterersMet(const Scene& scene, const std::vector<TargetSurface>& wires,
                                          const PhantomImaging& imaging, const ProbePose& pose, double apertureMm,
                                          double wireMm, double amplitudePerMm, const WireRays& rays)
{
  const auto lines = raysFrom(imaging.geometry, pose, apertureMm, rays);
  TraceSettings tracing = imaging.tracing;
  tracing.deterministic = true;
  tracing.pathsPerLine = 1;
  tracing.maxCollisions = 64;
  const double angle = imaging.geometry.sectorDeg * M_PI / 180.0 / (rays.directions - 1);
  const double area = 0.25 * M_PI * wireMm * wireMm;
  const Vec3d along = glm::cross(pose.axial, pose.lateral);
  const int copies = int(rays.elevationMm / rays.stepMm);
  std::vector<PointScatterer> met;
  for (const RecordedPath& path : recordPaths(scene, lines, tracing, int(lines.size()), transparent(wires)))
  {
    for (const auto& [in, out] : passages(path, int(scene.tissues().size())))
    {
      const Vec3d middle = 0.5 * (in + out);
      const double covered =
        glm::length(middle - lines[std::size_t(path.line)].originMm) * angle * glm::length(out - in);
      const double amplitude = amplitudePerMm * rays.stepMm * covered / area / rays.places;
      for (int c = 0; c < copies; ++c)
      {
        met.push_back({ middle + along * ((c - 0.5 * (copies - 1)) * rays.stepMm), float(amplitude) });
      }
    }
  }
  return met;
}

} // namespace sono::study
