#include "Channels/ScenePoints.h"

#include "Channels/FanPlaces.h"
#include "Channels/SurfacePoints.h"
#include "Core/ParallelFor.h"
#include "Core/SoundSpeed.h"
#include "Echo/EchoSetup.h"
#include "Echo/MovingScatterers.h"
#include "Echo/Pulse.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int denseLines = 64;
constexpr double slabSigmas = 2.5; ///< of the two-way beam, to either side of the image plane

/// How far across the image plane points are taken, by depth.
class Slab
{
public:
  Slab(const BeamModel& beams, double depthMm)
  {
    for (int n = 0; n <= int(std::ceil(depthMm)) + 1; ++n)
    {
      halfMm_.push_back(slabSigmas * beams.widthAt(double(n)).elevationalSigmaMm);
    }
  }
  double halfMm(double depthMm) const
  {
    return halfMm_[std::size_t(std::clamp(depthMm + 0.5, 0.0, double(halfMm_.size() - 1)))];
  }
  double widestMm() const { return *std::max_element(halfMm_.begin(), halfMm_.end()); }

private:
  std::vector<double> halfMm_;
};

/// What the walks over a scene share.
struct Walk
{
  const Scene& scene;
  ProbeFrame frame;
  const FanPlaces& fan;
  const Slab& slab;
  const ScanGeometry& geometry;
  double deepestMm;

  Vec3d placeOf(const Vec3d& local) const { return frame.fromWorld(scene.worldFromLocal(local)); }
  /// Adds a scatterer, with what arrives there; nothing outside of the fan.
  void add(const Vec3d& place, double amplitude, ChannelPoints& out) const
  {
    const auto at = fan.at(place.x, place.z);
    if (!at || std::abs(place.y) > slab.halfMm(double(at->depthMm)))
    {
      return;
    }
    const FanPlaces::Arrival arrival = fan.arrival(*at);
    const float echo = float(amplitude) * arrival.intensity;
    if (echo != 0.0f)
    {
      out.push(Vec3f(place), echo, 0.0f, arrival.lagMm, arrival.sinkNp);
    }
  }
};

/// Bricks of the fan between two depths, [first, end), in the scene's coordinates.
struct BrickBox
{
  Vec3i first;
  Vec3i end;
};

BrickBox boxOf(const Walk& walk, const BrickGrid& grid, double fromMm, double toMm)
{
  Vec3d low(1e30);
  Vec3d high(-1e30);
  for (int line = 0; line < walk.geometry.lineCount; ++line)
  {
    for (const double depthMm : { fromMm, std::min(toMm, walk.deepestMm) })
    {
      const Vec2f plane = planeFromBeam(walk.geometry, line, depthMm);
      for (const double side : { -1.0, 1.0 })
      {
        const Vec3d local = walk.scene.localFromWorld(
          walk.frame.toWorld(Vec3d(double(plane.x), side * walk.slab.widestMm(), double(plane.y))));
        low = glm::min(low, local);
        high = glm::max(high, local);
      }
    }
  }
  low = glm::max(low, Vec3d(grid.lowMm));
  high = glm::min(high, Vec3d(grid.highMm));
  const double edge = double(grid.edgeMm);
  return { Vec3i(glm::floor(low / edge)), Vec3i(glm::floor(high / edge)) + 1 };
}

/// The scatterers of a row of bricks along x.
void addRow(const Walk& walk, const NestedScatterers& nested, const DensityView& density, int level,
            const NestedBricks& bricks, NestedScatterers::Generated& row, ChannelPoints& out)
{
  const double edge = double(nestedCellMm(level)) * nestedBrickCells;
  const double reachMm = 0.5 * std::sqrt(3.0) * edge;
  std::vector<int> wanted(std::size_t(bricks.count()), 0);
  std::vector<NestedShare> shares(wanted.size());
  bool any = false;
  for (int b = 0; b < bricks.count(); ++b)
  {
    const Vec3i brick = bricks.brick(b);
    const Vec3d place = walk.placeOf(Vec3d(nestedBrickCentre(brick, level)));
    const double depthMm = walk.fan.depthMm(place.x, place.z);
    if (depthMm < -reachMm || depthMm > walk.deepestMm + reachMm ||
        std::abs(place.y) > walk.slab.halfMm(depthMm + reachMm) + reachMm)
    {
      continue;
    }
    const Vec3i parent(brick.x >> 1, brick.y >> 1, brick.z >> 1);
    const Vec3d parentPlace = walk.placeOf(Vec3d(nestedBrickCentre(parent, level + 1)));
    if (!density.takes(level, float(depthMm), float(walk.fan.depthMm(parentPlace.x, parentPlace.z))))
    {
      continue;
    }
    shares[std::size_t(b)] = density.share(level, float(depthMm), 1.0f);
    wanted[std::size_t(b)] = shares[std::size_t(b)].count;
    any = true;
  }
  if (!any)
  {
    return;
  }
  nested.generate(level, bricks, wanted.data(), row);
  for (int b = 0; b < bricks.count(); ++b)
  {
    if (wanted[std::size_t(b)] == 0)
    {
      continue;
    }
    const NestedShare& share = shares[std::size_t(b)];
    for (int n = 0; n < share.count; ++n)
    {
      const std::size_t i = std::size_t(row.first[std::size_t(b)] + n);
      if (row.amplitude[i] == 0.0f)
      {
        continue;
      }
      double amplitude = double(row.amplitude[i] * share.scaleOf(n));
      const Vec3d local(row.x[i], row.y[i], row.z[i]);
      const Vec3d place = walk.placeOf(local);
      if (row.hasFibres[std::size_t(b)])
      {
        const Vec3d axis = walk.scene.rotationToLocal() * (walk.frame.axes() * glm::normalize(place));
        const double along = glm::dot(Vec3d(row.fibreX[i], row.fibreY[i], row.fibreZ[i]), axis);
        amplitude *= std::exp(-along * along);
      }
      walk.add(place, amplitude, out);
    }
  }
}

void addTissues(const Walk& walk, const EchoSetup& setup, int perCell, const Progress& progress, ChannelPoints& out)
{
  const EchoSettings& echo = setup.settings;
  const NestedScatterers nested(walk.scene, echo.centreFrequencyMHz, 1.0, echo.seed);
  const double energyMm = pulseEnergyMm(echo);
  const ScattererDensity density(setup.finisher.sumCount() * echo.sampleMm(), [&](double depthMm) {
    return setup.beams.cellAreaMm2(depthMm) * energyMm * candidatesPerCell / perCell;
  });
  const DensityView view = density.view();
  for (int level = view.finest; level <= view.coarsest; ++level)
  {
    const ScattererDensity::Range range = density.range(level);
    if (!(range.fromMm < range.toMm))
    {
      continue;
    }
    const BrickBox box = boxOf(walk, nested.grid(level), range.fromMm, range.toMm);
    const Vec3i size = glm::max(box.end - box.first, Vec3i(0));
    std::vector<ChannelPoints> slices(std::size_t(size.x > 0 && size.y > 0 ? size.z : 0));
    const double part = 1.0 / (view.coarsest - view.finest + 1);
    parallelFor(int(slices.size()), partOf(progress, part * (level - view.finest), part * (level - view.finest + 1)),
                [&](int k) {
                  NestedScatterers::Generated row;
                  NestedBricks bricks;
                  for (int j = 0; j < size.y; ++j)
                  {
                    bricks.clear();
                    bricks.append(box.first + Vec3i(0, j, k), 0, size.x);
                    addRow(walk, nested, view, level, bricks, row, slices[std::size_t(k)]);
                  }
                });
    for (const ChannelPoints& slice : slices)
    {
      out.append(slice);
    }
  }
}

} // namespace

double crossSectionPerEcho(const EchoSettings& echo)
{
  const BeamModel beams(echo, InterfaceModel::Acoustic);
  return beams.focusAreaMm2() * echo.centreFrequencyMHz / assumedSoundSpeedMmPerUs;
}

ChannelPoints scenePoints(const EchoSources& sources, const ProbeSettings& probe, const ProbePose& pose,
                          const EchoSettings& echo, int scatterersPerCell, const Progress& progress)
{
  if ((sources.traced ? sources.traced->model : sources.model) != InterfaceModel::Acoustic)
  {
    throw Error("the lines were traced with Amadou2024, whose boundaries echo along lines alone: choose the model "
                "Acoustic");
  }
  const std::vector<ScanLine> lines = makeScanLines(probe.geometry, pose);
  const EchoSetup setup(sources, lines, echo);
  const FanPlaces fan(probe.geometry, sources.traced, pulseDownshift(echo));
  const double deepestMm = sources.traced ? sources.traced->binCount * sources.traced->binMm : probe.geometry.rangeMm();
  const Slab slab(setup.beams, deepestMm);
  const Walk walk{ *sources.scene, ProbeFrame(pose), fan, slab, probe.geometry, deepestMm };
  ChannelPoints out;
  addTissues(walk, setup, scatterersPerCell, partOf(progress, 0.0, 0.7), out);
  if (sources.scene->motion())
  {
    const double perEcho = crossSectionPerEcho(echo);
    const MovingStatistics statistics = movingStatistics(*sources.scene, echo, InterfaceModel::Acoustic);
    // What lies between lines far apart is none of their beams', but in the fan.
    const MovingPart part = probe.geometry.lineCount >= denseLines
                              ? movingPart(*sources.scene, statistics, lines, echo, InterfaceModel::Acoustic)
                              : MovingPart{};
    for (const PointScatterer& point : movingScatterers(*sources.scene, statistics, part, partOf(progress, 0.7, 0.8)))
    {
      walk.add(walk.frame.fromWorld(point.positionMm), perEcho * double(point.amplitude), out);
    }
  }
  if (sources.points)
  {
    const double perEcho = crossSectionPerEcho(echo);
    for (const PointScatterer& point : sources.points->all())
    {
      walk.add(walk.frame.fromWorld(point.positionMm), perEcho * double(point.amplitude), out);
    }
  }
  out.append(surfacePoints(setup, fan, walk.frame, probe, partOf(progress, 0.8, 1.0)));
  return out;
}

} // namespace sono
