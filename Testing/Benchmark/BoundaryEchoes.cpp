#include "BoundaryEchoes.h"

#include "Stage.h"

#include "Kernel/TimeOfFlight.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace sono {

namespace {

constexpr double stepMm = 0.05;
constexpr double besideMm = 0.5;
constexpr double steepestDeg = 25.0;
constexpr double firstMm = 3.0; // the face itself
constexpr int normalVoxels = 3; // radius of the ball whose voxels tell a boundary's direction

/// Tissue indices by place; -1 outside of the volume.
class Tissues
{
public:
  explicit Tissues(const Scene& scene)
    : scene_(scene)
    , size_(scene.placement().size)
    , spacing_(scene.placement().spacingMm)
  {
  }

  int at(const Vec3i& voxel) const
  {
    if (glm::any(glm::lessThan(voxel, Vec3i(0))) || glm::any(glm::greaterThanEqual(voxel, size_)))
    {
      return -1;
    }
    return scene_
      .tissueVoxels()[std::size_t(voxel.x) +
                      std::size_t(size_.x) * (std::size_t(voxel.y) + std::size_t(size_.y) * std::size_t(voxel.z))];
  }
  int at(const Vec3d& local) const { return at(Vec3i(glm::floor(local / spacing_))); }

  /// Unit, from tissue a into b, by the voxels around; 0 where they do not tell.
  Vec3d normal(const Vec3d& local, int a, int b) const
  {
    const Vec3i middle(glm::floor(local / spacing_));
    Vec3d sum(0.0);
    for (int z = -normalVoxels; z <= normalVoxels; ++z)
    {
      for (int y = -normalVoxels; y <= normalVoxels; ++y)
      {
        for (int x = -normalVoxels; x <= normalVoxels; ++x)
        {
          const Vec3i voxel = middle + Vec3i(x, y, z);
          const int tissue = at(voxel);
          const Vec3d off = (Vec3d(voxel) + 0.5) * spacing_ - local;
          if (x * x + y * y + z * z <= normalVoxels * normalVoxels && (tissue == a || tissue == b))
          {
            sum += (tissue == b ? 1.0 : -1.0) * off;
          }
        }
      }
    }
    const double length = glm::length(sum);
    return length > 0.0 ? sum / length : Vec3d(0.0);
  }

private:
  const Scene& scene_;
  Vec3i size_;
  Vec3d spacing_;
};

struct Crossing
{
  int line;
  double depthMm;
};

std::map<std::pair<int, int>, std::vector<Crossing>> crossings(const Scene& scene, const std::vector<ScanLine>& lines,
                                                               double depthMm)
{
  const Tissues tissues(scene);
  std::map<std::pair<int, int>, std::vector<Crossing>> found;
  for (std::size_t l = 0; l < lines.size(); ++l)
  {
    const Vec3d origin = scene.localFromWorld(lines[l].originMm);
    const Vec3d axis = scene.rotationToLocal() * lines[l].axis;
    int before = tissues.at(origin + axis * firstMm);
    for (double r = firstMm; r < depthMm - 1.0; r += stepMm)
    {
      const Vec3d place = origin + axis * r;
      const int tissue = tissues.at(place);
      if (tissue != before && tissue >= 0 && before >= 0 && tissue != scene.outsideIndex() &&
          before != scene.outsideIndex() &&
          std::abs(glm::dot(tissues.normal(place, before, tissue), axis)) > std::cos(steepestDeg * M_PI / 180.0))
      {
        found[std::minmax(before, tissue)].push_back({ int(l), r - 0.5 * stepMm });
      }
      before = tissue;
    }
  }
  return found;
}

/// Where a depth is shown: the offset there hardly changes from one range to the next.
double rangeOf(const TracedLines& traced, const Crossing& c)
{
  const float* offsetMm = traced.depthOffsetMm.data() + std::size_t(c.line) * std::size_t(traced.binCount);
  const RangeMap map{ offsetMm, traced.binCount, float(1.0 / traced.binMm) };
  double rangeMm = c.depthMm;
  for (int i = 0; i < 4; ++i)
  {
    rangeMm += c.depthMm - double(map.depthOf(float(rangeMm)));
  }
  return rangeMm;
}

double medianEnvelopeDb(const TracedLines& traced, const RfLines& rf, const std::vector<float>& envelope,
                        const std::vector<Crossing>& places)
{
  std::vector<double> levels;
  for (const Crossing& c : places)
  {
    const double rangeMm = rangeOf(traced, c);
    const int last = std::min(rf.sampleCount - 1, int((rangeMm + besideMm) / rf.sampleMm));
    for (int s = int(std::ceil((rangeMm - besideMm) / rf.sampleMm)); s <= last; ++s)
    {
      const float e = envelope[std::size_t(c.line) * std::size_t(rf.sampleCount) + std::size_t(s)];
      levels.push_back(20.0 * std::log10(std::max(double(e), 1e-15)));
    }
  }
  return medianOf(std::move(levels));
}

} // namespace

std::vector<BoundaryDrift> boundaryDrifts(const Scene& scene, const std::vector<ScanLine>& lines, TraceSettings tracing,
                                          const EchoSettings& echo, const std::vector<int>& pathsPerLine,
                                          int leastCrossings)
{
  std::vector<BoundaryDrift> drifts;
  std::vector<std::vector<Crossing>> places;
  for (auto& [pair, found] : crossings(scene, lines, echo.depthMm))
  {
    if (int(found.size()) >= leastCrossings)
    {
      const auto name = [&](int tissue) { return scene.tissues()[std::size_t(tissue)].name; };
      drifts.push_back({ name(pair.first) + "|" + name(pair.second), int(found.size()), {}, 0.0 });
      places.push_back(std::move(found));
    }
  }
  tracing.reverberation = false; // what lies around an echo has a drift of its own: see `measure time`
  for (const int paths : pathsPerLine)
  {
    tracing.pathsPerLine = paths;
    const TracedLines traced = trace(scene, lines, tracing);
    const RfLines rf = formRf(scene, lines, traced, echo);
    const std::vector<float> envelope = rf.envelope();
    for (std::size_t b = 0; b < drifts.size(); ++b)
    {
      drifts[b].medianDb.push_back(medianEnvelopeDb(traced, rf, envelope, places[b]));
    }
  }
  for (BoundaryDrift& drift : drifts)
  {
    const auto [least, most] = std::minmax_element(drift.medianDb.begin(), drift.medianDb.end());
    drift.driftDb = *most - *least;
  }
  return drifts;
}

} // namespace sono
