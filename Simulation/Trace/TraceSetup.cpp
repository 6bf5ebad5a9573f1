#include "Trace/TraceSetup.h"

#include "Core/ParallelFor.h"
#include "Kernel/NanoSpace.h"
#include "Kernel/TracePath.h"
#include "Scene/NanoGridStorage.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

TraceMedium makeMedium(const Tissue& tissue, double frequencyMHz)
{
  TraceMedium m;
  m.impedance = float(tissue.impedanceMRayl);
  m.speed = float(tissue.soundSpeedMPerS);
  // Intensity falls by 10^(-a f l / 10), l in cm.
  m.decayPerMm = float(tissue.attenuationDbPerCmMHz * frequencyMHz * std::log(10.0) / 100.0);
  m.tau = float(tissue.tau);
  m.gamma = float(tissue.gamma);
  m.roughnessMm = float(tissue.roughnessMm);
  m.correlationMm = float(tissue.correlationMm);
  return m;
}

/// Lines are cheap; those of a sweep are many.
constexpr std::size_t blockLines = 512;

int blocksOf(const std::vector<ScanLine>& lines)
{
  return int((lines.size() + blockLines - 1) / blockLines);
}

/// Calls visit(block, line) for all lines, those of a block one after the other.
template<class Visit>
void forBlocks(const std::vector<ScanLine>& lines, const Visit& visit)
{
  parallelFor(blocksOf(lines), {}, [&](int block) {
    const std::size_t end = std::min(lines.size(), std::size_t(block + 1) * blockLines);
    for (std::size_t l = std::size_t(block) * blockLines; l < end; ++l)
    {
      visit(block, l);
    }
  });
}

TraceView makeView(const TraceSettings& settings, const Scene& scene)
{
  TraceView view;
  view.firstTargetMedium = int(scene.tissues().size());
  view.outsideTissue = scene.outsideIndex();
  view.model = settings.model;
  const auto radians = [](double degrees) { return degrees * 0.017453292519943295; };
  view.lobe = makeLobe(radians(settings.lobeMeanDeg), radians(settings.lobeSigmaDeg), radians(settings.lobeMinDeg),
                       radians(settings.lobeMaxDeg));
  view.waveNumberAtOne = float(2000.0 * 3.14159265358979323846 * settings.frequencyMHz);
  view.lowDiscrepancy = settings.sampling != Sampling::Independent;
  view.deterministic = settings.deterministic;
  view.maxCollisions = settings.maxCollisions;
  view.coherenceMm = float(settings.coherenceMm);
  view.depthMm = float(settings.depthMm);
  // The deterministic path has nothing to play with.
  view.rouletteIntensity = settings.deterministic ? 0.0f : float(std::pow(10.0, settings.rouletteDb / 20.0));
  view.seed = settings.seed;
  return view;
}

} // namespace

VoxelBox fanBox(const Scene& scene, const std::vector<ScanLine>& lines, double depthMm)
{
  const Mat3d toLocal = scene.rotationToLocal();
  struct Corners
  {
    Vec3d low = Vec3d(1e30);
    Vec3d high = Vec3d(-1e30);
  };
  std::vector<Corners> corners(std::size_t(blocksOf(lines)));
  forBlocks(lines, [&](int block, std::size_t l) {
    // The half ball of radius depthMm in front of the line's origin.
    Corners& c = corners[std::size_t(block)];
    const Vec3d origin = scene.localFromWorld(lines[l].originMm);
    const Vec3d axis = toLocal * lines[l].axis;
    for (int a = 0; a < 3; ++a)
    {
      const double across = std::sqrt(std::max(0.0, 1.0 - axis[a] * axis[a]));
      c.high[a] = std::max(c.high[a], origin[a] + depthMm * (axis[a] >= 0.0 ? 1.0 : across));
      c.low[a] = std::min(c.low[a], origin[a] - depthMm * (axis[a] <= 0.0 ? 1.0 : across));
    }
  });
  Vec3d low(1e30);
  Vec3d high(-1e30);
  for (const Corners& c : corners)
  {
    low = glm::min(low, c.low);
    high = glm::max(high, c.high);
  }
  const Vec3d spacing = scene.placement().spacingMm;
  const Vec3d size(scene.placement().size);
  return { Vec3i(glm::clamp(glm::floor(low / spacing), Vec3d(0.0), size)),
           Vec3i(glm::clamp(glm::ceil(high / spacing) + 1.0, Vec3d(0.0), size)) };
}

TraceSetup::TraceSetup(const Scene& scene, const std::vector<ScanLine>& worldLines, const TraceSettings& settings,
                       const std::vector<TargetSurface>& targetSurfaces, const Progress& progress, Records records)
{
  settings.validate();
  if (worldLines.empty())
  {
    throw Error("the probe has no scan lines: set the number of lines to 1 or more");
  }
  const VoxelBox box = fanBox(scene, worldLines, settings.depthMm);
  const bool bakesAll = records == Records::All || settings.march == March::NanoVDB;
  const Progress layingOut = partOf(progress, 0.0, bakesAll ? 0.25 : 1.0);
  cells = settings.interactive ? scene.interactiveRegion(box, layingOut) : scene.regionOnDemand(box, layingOut);
  region = { cells, &cells->region() };
  if (bakesAll)
  {
    cells->bakeAll(partOf(progress, 0.25, 1.0));
  }
  const Vec3d corner = Vec3d(region->box.first) * scene.placement().spacingMm;
  cornerWorldMm = scene.worldFromLocal(corner);
  const Mat3d toLocal = scene.rotationToLocal();
  toWorld = scene.placement().direction;
  targets = std::make_unique<TargetScene>(localTriangles(targetSurfaces, toLocal, cornerWorldMm));
  for (const Tissue& tissue : scene.tissues())
  {
    media.push_back(makeMedium(tissue, settings.frequencyMHz));
  }
  for (const TargetSurface& target : targetSurfaces)
  {
    TissueTable().add(target.tissue); // checks the ranges
    media.push_back(makeMedium(target.tissue, settings.frequencyMHz));
  }
  if (settings.march == March::NanoVDB)
  {
    labels = &scene.labelGrid(progress);
    tissueOfLabel = scene.tissueOfLabel().data();
  }
  view = makeView(settings, scene);
  view.media = media.data();
  lines.resize(worldLines.size());
  forBlocks(worldLines, [&](int, std::size_t l) {
    const ScanLine& line = worldLines[l];
    lines[l] = { Vec3f(scene.localFromWorld(line.originMm) - corner), Vec3f(toLocal * line.axis) };
  });
  const CellSpace<NoTargets> empty{ region->view(), {} };
  PathState path;
  if (std::none_of(lines.begin(), lines.end(),
                   [&](const TraceLine& line) { return enterSpace(empty, line, view.depthMm, path); }))
  {
    throw Error("no scan line meets the label map: move the probe onto the skin or increase the depth");
  }
  paths = settings.deterministic ? 1 : settings.pathsPerLine;
  frequencyMHz = settings.frequencyMHz;
}

NanoSpace<EmbreeTargets> TraceSetup::nanoSpace() const
{
  return { labels->grid.storage->handle.grid<std::int32_t>(),
           tissueOfLabel,
           region->box.first,
           region->view(),
           { targets.get(), !targets->empty() } };
}

} // namespace sono
