#include "Trace/TraceSetup.h"

#include "Core/ParallelFor.h"
#include "Core/SoundSpeed.h"
#include "Kernel/NanoSpace.h"
#include "Kernel/TracePath.h"
#include "Probe/BeamAperture.h"
#include "Scene/NanoGridStorage.h"
#include "Trace/Rod.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

/// What tissues take of reverberating sound, a little more than soft ones do: where it has come far, little is much.
constexpr double usualDbPerCmMHz = 0.8;

TraceMedium makeMedium(const Tissue& tissue, const TraceSettings& settings)
{
  const double frequencyMHz = settings.frequencyMHz;
  TraceMedium m;
  m.impedance = float(tissue.impedanceMRayl);
  m.speed = float(tissue.soundSpeedMPerS);
  m.rangePerMm = settings.rangeIsTime() ? float(1000.0 * assumedSoundSpeedMmPerUs / tissue.soundSpeedMPerS) : 1.0f;
  m.decayPerMm = float(decayPerMm(tissue, frequencyMHz));
  const bool scatters =
    tissue.scattererProbability > 0.0 && (tissue.scattererMean != 0.0 || tissue.scattererSigma != 0.0);
  m.scatter = scatters ? float(std::sqrt(backscatterPerMmSr(tissue, frequencyMHz) / reverberationPerMmSr)) : 0.0f;
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

/// Of the transducer's face, into the body: the line is steered away from it.
Vec3d faceNormal(const ScanLine& line)
{
  const double lateral = line.steeringLateral;
  const double elevational = line.steeringElevational;
  const double straight = std::sqrt(std::max(0.0, 1.0 - lateral * lateral - elevational * elevational));
  return glm::normalize(straight * line.axis - lateral * line.lateral - elevational * line.elevation);
}

/// Where paths start and how they are aimed, all 0 where they start together.
struct StartSpread
{
  double lateralMm = 0.0; ///< to either side
  double elevationalMm = 0.0;
  double perTransmitFocus = 0.0; ///< 1/mm
  double perElevationFocus = 0.0;
};

StartSpread startSpread(const TraceSettings& settings)
{
  if (!settings.startApart())
  {
    return {};
  }
  // The inner half of the aperture (chosen, see Data/docs/physics.md 3.1): a quarter to either side.
  const auto inverse = [](double focusMm) { return focusMm > 0.0 ? 1.0 / focusMm : 0.0; };
  return { 0.25 * settings.aperture.apertureMm, 0.25 * settings.aperture.elevationApertureMm,
           inverse(settings.aperture.transmitFocusMm), inverse(settings.aperture.focusAcrossMm()) };
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
  const StartSpread spread = startSpread(settings);
  view.startsApart = settings.startApart();
  view.perTransmitFocus = float(spread.perTransmitFocus);
  view.perElevationFocus = float(spread.perElevationFocus);
  view.reverberates = settings.reverberates();
  view.favoursReflections = settings.rangeIsTime() && settings.reverberation;
  view.faceReflection = float(settings.faceReflection);
  if (settings.aperture.isNamed())
  {
    view.faceRadiusMm = float(0.5 * std::max(settings.aperture.apertureMm, settings.aperture.elevationApertureMm));
    const double wavelengthMm = assumedSoundSpeedMmPerUs / settings.frequencyMHz;
    view.cellLateralPerMm = float(1.5 * wavelengthMm / settings.aperture.apertureMm);
    view.cellElevationPerMm = float(1.5 * wavelengthMm / settings.aperture.elevationApertureMm);
  }
  view.maxCollisions = settings.maxCollisions;
  view.coherenceMm = float(settings.coherenceMm);
  view.depthMm = float(settings.pathDepthMm());
  // The deterministic path has nothing to play with.
  view.rouletteIntensity = settings.deterministic ? 0.0f : float(std::pow(10.0, settings.rouletteDb / 20.0));
  view.usualDecayPerMm = float(usualDbPerCmMHz * settings.frequencyMHz / (10.0 * 4.342944819032518));
  return view;
}

} // namespace

VoxelBox fanBox(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings)
{
  const double depthMm = settings.pathDepthMm();
  const StartSpread spread = startSpread(settings);
  const double tilt =
    std::atan(std::hypot(spread.lateralMm * spread.perTransmitFocus, spread.elevationalMm * spread.perElevationFocus));
  const double tiltCosine = tilt > 0.0 ? std::cos(tilt) : 1.0;
  const double tiltSine = tilt > 0.0 ? std::sin(tilt) : 0.0;
  const Mat3d toLocal = scene.rotationToLocal();
  struct Corners
  {
    Vec3d low = Vec3d(1e30);
    Vec3d high = Vec3d(-1e30);
  };
  std::vector<Corners> corners(std::size_t(blocksOf(lines)));
  forBlocks(lines, [&](int block, std::size_t l) {
    // The half balls of radius depthMm in front of where its paths start.
    Corners& c = corners[std::size_t(block)];
    const Vec3d origin = scene.localFromWorld(lines[l].originMm);
    const Vec3d axis = toLocal * lines[l].axis;
    const Vec3d aside = spread.lateralMm * glm::abs(toLocal * lines[l].lateral) +
                        spread.elevationalMm * glm::abs(toLocal * lines[l].elevation);
    for (int a = 0; a < 3; ++a)
    {
      // How far a half ball reaches towards a side that its axis, tilted as far as may be, has this cosine to.
      const double sine = std::sqrt(std::max(0.0, 1.0 - axis[a] * axis[a]));
      const auto reach = [&](double cosine) {
        return cosine * tiltCosine + sine * tiltSine >= 0.0 ? depthMm
                                                            : depthMm * (sine * tiltCosine - cosine * tiltSine);
      };
      c.high[a] = std::max(c.high[a], origin[a] + aside[a] + reach(axis[a]));
      c.low[a] = std::min(c.low[a], origin[a] - aside[a] - reach(-axis[a]));
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

std::vector<LocalBall> fanReach(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                                double besideMm)
{
  constexpr double togetherMm = 15.0;     // small against what a path goes
  std::vector<std::vector<Vec3d>> groups; // of lines' origins, mm
  for (const ScanLine& line : lines)
  {
    const Vec3d originMm = scene.localFromWorld(line.originMm);
    const auto near = std::find_if(groups.begin(), groups.end(), [&](const std::vector<Vec3d>& group) {
      return glm::distance(group.front(), originMm) <= togetherMm;
    });
    (near == groups.end() ? groups.emplace_back() : *near).push_back(originMm);
  }
  const StartSpread spread = startSpread(settings);
  const double asideMm = std::hypot(spread.lateralMm, spread.elevationalMm); // from where a path starts to its line
  std::vector<LocalBall> balls;
  for (const std::vector<Vec3d>& group : groups)
  {
    LocalBall ball{ Vec3d(0.0), 0.0 };
    for (const Vec3d& originMm : group)
    {
      ball.middleMm += originMm / double(group.size());
    }
    for (const Vec3d& originMm : group)
    {
      const double fromMiddleMm = glm::distance(originMm, ball.middleMm);
      ball.mm = std::max(ball.mm, fromMiddleMm + asideMm + settings.pathDepthMm() + besideMm);
    }
    balls.push_back(ball);
  }
  return balls;
}

TraceSetup::TraceSetup(const Scene& scene, const std::vector<ScanLine>& worldLines, const TraceSettings& settings,
                       const std::vector<TargetSurface>& targetSurfaces, const Progress& progress, Records records)
{
  settings.validate();
  if (worldLines.empty())
  {
    throw Error("the probe has no scan lines: set the number of lines to 1 or more");
  }
  const VoxelBox box = fanBox(scene, worldLines, settings);
  const bool bakesAll = settings.march == March::NanoVDB || (records == Records::All && settings.interactive);
  const bool bakes = bakesAll || records == Records::All;
  const Progress layingOut = partOf(progress, 0.0, bakes ? 0.25 : 1.0);
  cells = settings.interactive ? scene.interactiveRegion(box, layingOut) : scene.regionOnDemand(box, layingOut);
  region = { cells, &cells->region() };
  if (bakesAll)
  {
    cells->bakeAll(partOf(progress, 0.25, 1.0));
  }
  else if (bakes)
  {
    // Poses nearby find theirs: what is baked anew goes up to the device again. Who shares a region has baked them.
    const double besideMm = scene.sharesRegion(box) ? 2.0 : 15.0;
    cells->bakeIn(fanReach(scene, worldLines, settings, besideMm), partOf(progress, 0.25, 1.0));
  }
  const Vec3d corner = Vec3d(region->box.first) * scene.placement().spacingMm;
  cornerWorldMm = scene.worldFromLocal(corner);
  const Mat3d toLocal = scene.rotationToLocal();
  toWorld = scene.placement().direction;
  targets = std::make_unique<TargetScene>(localTriangles(targetSurfaces, toLocal, cornerWorldMm));
  if (settings.march == March::NanoVDB)
  {
    labels = &scene.labelGrid(progress);
    tissueOfLabel = scene.tissueOfLabel().data();
  }
  tune(scene, settings, targetSurfaces);
  lines.resize(worldLines.size());
  const StartSpread spread = startSpread(settings);
  forBlocks(worldLines, [&](int, std::size_t l) {
    const ScanLine& line = worldLines[l];
    const Vec2d cosine2 = apertureCosines2(line);
    lines[l] = { Vec3f(scene.localFromWorld(line.originMm) - corner), Vec3f(toLocal * line.axis),
                 Vec3f(toLocal * line.lateral * (spread.lateralMm * std::sqrt(cosine2.x))),
                 Vec3f(toLocal * line.elevation * (spread.elevationalMm * std::sqrt(cosine2.y))),
                 Vec3f(toLocal * faceNormal(line)) };
  });
  const CellSpace<NoTargets> empty{ region->view(), {} };
  PathState path;
  if (std::none_of(lines.begin(), lines.end(),
                   [&](const TraceLine& line) { return enterSpace(empty, line, view.depthMm, path); }))
  {
    throw Error("no scan line meets the label map: move the probe onto the skin or increase the depth");
  }
  paths = settings.pathsAtMost();
  seed = settings.seed;
}

void TraceSetup::tune(const Scene& scene, const TraceSettings& settings,
                      const std::vector<TargetSurface>& targetSurfaces)
{
  media.clear();
  for (const Tissue& tissue : scene.tissues())
  {
    media.push_back(makeMedium(tissue, settings));
  }
  for (const TargetSurface& target : targetSurfaces)
  {
    TissueTable().add(target.tissue); // checks the ranges
    media.push_back(makeMedium(target.tissue, settings));
    media.back().rings = ringingRod(target).has_value();
  }
  view = makeView(settings, scene);
  view.media = media.data();
  view.cornerMm = Vec3f(scene.localFromWorld(cornerWorldMm));
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
