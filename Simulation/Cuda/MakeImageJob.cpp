#include "Cuda/MakeImageJob.h"

#include "Core/ParallelFor.h"
#include "Core/SoundSpeed.h"
#include "Echo/EchoSetup.h"
#include "Echo/Pulse.h"
#include "Image/LabelSlice.h"
#include "Image/ReceiverNoise.h"
#include "Trace/TraceSetup.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <utility>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;

BeamJob makeBeam(const EchoSetup& setup)
{
  const BeamModel& beams = setup.beams;
  BeamJob job;
  job.kind = beams.kind();
  if (beams.reachTable())
  {
    job.reach = *beams.reachTable();
  }
  switch (job.kind)
  {
    case BeamKind::Field:
    {
      const auto& field = setup.settings.field;
      job.field = FieldJob{ field->view(), SharedVector<float>(field, &field->values()) };
      job.field->view.values = nullptr;
      const auto widthMm = [](const BeamFieldAxis& axis) { return 2.0 * double(std::max(-axis.lowMm, axis.highMm)); };
      job.largestAreaMm2 = widthMm(job.field->view.lateral) * widthMm(job.field->view.elevational);
      break;
    }
    case BeamKind::Array:
      job.array = setup.settings.arrayField;
      job.largestWeight = double(job.array->sight().largestWeight());
      job.largestAreaMm2 = double(job.array->sight().largestAreaMm2());
      break;
    default:
      job.largestWeight = 0.0;
      for (double depthMm = 0.0; depthMm < setup.settings.depthMm + 1.0; depthMm += 1.0)
      {
        const BeamWidth width = beams.widthAt(depthMm);
        const double areaMm2 = 2.0 * pi * width.lateralSigmaMm * width.elevationalSigmaMm * width.amplitude;
        job.largestWeight = std::max(job.largestWeight, width.amplitude);
        job.largestAreaMm2 = std::max(job.largestAreaMm2, areaMm2);
      }
      break;
  }
  return job;
}

/// Without pointers to the host's tables.
Beam forDevice(Beam beam)
{
  beam.field = nullptr;
  beam.array = nullptr;
  beam.arraySight = nullptr;
  return beam;
}

std::vector<Beam> makeSceneBeams(const EchoSetup& setup)
{
  constexpr int together = 128;
  std::vector<Beam> beams(setup.lines.size());
  const int count = int(beams.size());
  parallelFor((count + together - 1) / together, {}, [&](int group) {
    for (int l = group * together; l < std::min(count, (group + 1) * together); ++l)
    {
      beams[std::size_t(l)] = setup.sceneBeam(l);
    }
  });
  return beams;
}

SightJob makeSight(const FieldSight& sight)
{
  SightJob job;
  job.view = sight.view();
  job.seen.assign(job.view.seen, job.view.seen + job.view.size());
  job.lateralMm = sight.lateralMm();
  job.elevationalMm = sight.elevationalMm();
  return job;
}

VoxelJob makeVoxels(const Scene& scene)
{
  return { &scene.tissueVoxels(), &scene.stillDetail(), scene.anatomyId(), scene.placement().size,
           Vec3f(scene.placement().spacingMm) };
}

TissueJob makeTissues(const EchoSetup& setup)
{
  const Scene& scene = *setup.sources.scene;
  TissueJob job;
  job.voxels = makeVoxels(scene);
  job.media = setup.tissues->media();
  job.cellMm = float(setup.settings.scattererCellMm);
  job.seed = setup.settings.seed;
  if (setup.tissueSight)
  {
    job.sight = makeSight(*setup.tissueSight);
  }
  return job;
}

NestedJob makeNested(const EchoSetup& setup)
{
  const Scene& scene = *setup.sources.scene;
  NestedJob job;
  job.voxels = makeVoxels(scene);
  job.media = setup.nested->media();
  job.fibreScale = setup.nested->fibreScale();
  job.fibres = setup.nested->fibres();
  job.seed = setup.settings.seed;
  job.density = setup.density->view();
  job.perMm3.assign(job.density.perMm3, job.density.perMm3 + job.density.count);
  job.coarseEnough.assign(job.density.coarseEnough, job.density.coarseEnough + job.density.count);
  job.density.perMm3 = nullptr;
  job.density.coarseEnough = nullptr;
  for (int level = job.density.finest; level <= job.density.coarsest; ++level)
  {
    job.ranges.push_back(setup.density->range(level));
  }
  for (const FieldSight& sight : setup.nestedSight)
  {
    job.sights.push_back(makeSight(sight));
  }
  return job;
}

/// How far apart the ends of every n-th line lie at most.
float widestGapMm(const std::vector<BeamReach>& beams)
{
  float widest = 0.0f;
  for (std::size_t l = 1; l < beams.size(); ++l)
  {
    const auto endOf = [](const BeamReach& b) { return b.beam.origin + b.beam.axis * b.depthMm; };
    widest = std::max({ widest, glm::distance(beams[l].beam.origin, beams[l - 1].beam.origin),
                        glm::distance(endOf(beams[l]), endOf(beams[l - 1])) });
  }
  return widest;
}

/// Calls visit(brick), from several threads and often more than once, for the bricks of a grid that some beam may see,
/// as `seeing` has the beams meet them. Where that is enough, some of the lines tell for those between.
void forBricksOfLines(const EchoSetup& setup, const std::vector<Beam>& sceneBeams, const BrickGrid& grid,
                      bool areSomeEnough, const std::function<std::vector<BeamReach>(std::vector<BeamReach>)>& seeing,
                      const std::function<void(const Vec3i&)>& visit)
{
  constexpr int groupLines = 8;
  constexpr int every = 4;
  constexpr float largestGapMm = 10.0f;
  const int lineCount = int(setup.lines.size());
  const auto beamsOf = [&](int step) {
    std::vector<BeamReach> beams;
    const auto add = [&](int l) {
      beams.push_back(setup.beams.reachOf(sceneBeams[std::size_t(l)], setup.finisher.reachMm(l)));
    };
    for (int l = 0; l < lineCount - 1; l += step)
    {
      add(l);
    }
    add(lineCount - 1);
    return beams;
  };
  std::vector<BeamReach> beams = beamsOf(areSomeEnough ? every : 1);
  float gapMm = areSomeEnough ? widestGapMm(beams) : 0.0f;
  if (gapMm > largestGapMm)
  {
    beams = beamsOf(1);
    gapMm = 0.0f;
  }
  const int beamCount = int(beams.size());
  parallelFor((beamCount + groupLines - 1) / groupLines, {}, [&](int group) {
    const auto first = beams.begin() + group * groupLines;
    std::vector<BeamReach> own = seeing({ first, first + std::min(groupLines, beamCount - group * groupLines) });
    for (BeamReach& beam : own)
    {
      beam.marginMm += 0.5f * gapMm;
    }
    forSeenBricks(grid, own, [&](const Vec3i& brick, const std::vector<std::size_t>&) { visit(brick); });
  });
}

/// The blocks of pieces that some beam may see. Blocks are much larger than what lies between neighbouring lines; a
/// field's sight is made for bricks.
std::vector<int> seenBlocks(const EchoSetup& setup, const std::vector<Beam>& sceneBeams, const SurfacePieces& pieces)
{
  const SurfaceEchoes& surfaces = *setup.surfaces;
  const bool areBlocks = !surfaces.pieceSight();
  BrickGrid grid = surfaces.pieceGrid();
  grid.edgeMm *= float(areBlocks ? SurfacePieces::blockBricks : 1);
  std::vector<std::atomic<bool>> seen(std::size_t(pieces.blockCount()));
  forBricksOfLines(
    setup, sceneBeams, grid, areBlocks,
    [&](std::vector<BeamReach> beams) { return surfaces.seeingPieces(std::move(beams)); },
    [&](const Vec3i& brick) {
      const int block = pieces.blockOf(areBlocks ? brick * SurfacePieces::blockBricks : brick);
      if (block >= 0)
      {
        seen[std::size_t(block)].store(true, std::memory_order_relaxed);
      }
    });
  std::vector<int> blocks;
  for (std::size_t b = 0; b < seen.size(); ++b)
  {
    if (seen[b])
    {
      blocks.push_back(int(b));
    }
  }
  return blocks;
}

/// What of a group some beam may see.
TargetPointJob makeTargetPoints(const EchoSetup& setup, const std::vector<Beam>& sceneBeams, const TargetGroup& targets)
{
  TargetPointJob job;
  const BrickGrid& grid = targets.pieces.grid();
  job.edgeMm = grid.edgeMm;
  const Vec3i first(glm::round(grid.lowMm / grid.edgeMm));
  const Vec3i size = Vec3i(glm::round(grid.highMm / grid.edgeMm)) - first;
  std::vector<std::atomic<bool>> seen(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z));
  forBricksOfLines(
    setup, sceneBeams, grid, false,
    [&](std::vector<BeamReach> beams) { return SurfaceEchoes::seeingTargets(std::move(beams), targets); },
    [&](const Vec3i& brick) {
      const Vec3i at = brick - first;
      seen[std::size_t(at.x) + std::size_t(size.x) * (std::size_t(at.y) + std::size_t(size.y) * std::size_t(at.z))]
        .store(true, std::memory_order_relaxed);
    });
  std::vector<Vec3i> bricks;
  std::size_t n = 0;
  for (int k = 0; k < size.z; ++k)
  {
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i, ++n)
      {
        if (seen[n])
        {
          bricks.push_back(first + Vec3i(i, j, k));
        }
      }
    }
  }
  std::vector<std::vector<SurfacePoint>> points(bricks.size());
  parallelFor(int(bricks.size()), {},
              [&](int b) { targets.pieces.cutBrick(bricks[std::size_t(b)], points[std::size_t(b)]); });
  for (std::size_t b = 0; b < bricks.size(); ++b)
  {
    if (!points[b].empty())
    {
      const int before = int(job.points.size());
      job.points.insert(job.points.end(), points[b].begin(), points[b].end());
      job.bricks.push_back({ (Vec3f(bricks[b]) + 0.5f) * grid.edgeMm, before, int(job.points.size()) });
    }
  }
  job.ring = targets.ring;
  if (targets.sight)
  {
    job.sight = makeSight(*targets.sight);
  }
  return job;
}

SurfaceJob makeSurfaces(const EchoSetup& setup, const std::vector<Beam>& sceneBeams)
{
  const SurfaceEchoes& surfaces = *setup.surfaces;
  const Scene& scene = *setup.sources.scene;
  SurfaceJob job;
  job.voxels = makeVoxels(scene);
  job.pieces = &scene.surfacePieces();
  job.blocks = seenBlocks(setup, sceneBeams, *job.pieces);
  job.longestStepMm = surfaces.longestStepMm();
  job.nets = surfaces.nets();
  job.seed = setup.settings.seed;
  job.media = surfaces.rows().count();
  job.pieceTable = surfaces.pieceTable();
  job.targetTable = surfaces.targetTable();
  for (SurfaceTable* table : { &job.pieceTable, &job.targetTable })
  {
    table->rows = nullptr;
    table->diffuseL = nullptr;
    table->diffuseE = nullptr;
  }
  job.rows = surfaces.rows().all();
  job.diffuseL = surfaces.rows().diffuseL();
  job.diffuseE = surfaces.rows().diffuseE();
  if (surfaces.pieceSight())
  {
    job.sight = makeSight(*surfaces.pieceSight());
  }
  for (const TargetGroup& group : surfaces.targets())
  {
    if (group.pieces.grid().highMm != group.pieces.grid().lowMm)
    {
      TargetPointJob points = makeTargetPoints(setup, sceneBeams, group);
      if (!points.bricks.empty())
      {
        job.targets.push_back(std::move(points));
      }
    }
  }
  return job;
}

PointJob makePoints(const EchoSetup& setup)
{
  PointJob job;
  job.table = setup.sources.points->table();
  for (std::size_t l = 0; l < setup.lines.size(); ++l)
  {
    job.beams.push_back(forDevice(setup.pointBeam(int(l))));
  }
  if (setup.pointSight)
  {
    job.sight = makeSight(*setup.pointSight);
  }
  return job;
}

} // namespace

TraceJob makeTraceJob(const TraceSetup& setup, const TraceSettings& settings, int linesPerImage)
{
  TraceJob job;
  tuneTraceJob(setup, settings, job);
  job.lines = setup.lines;
  job.linesPerImage = linesPerImage;
  job.seeds.assign(setup.lines.size() / std::size_t(linesPerImage), setup.seed);
  job.region = setup.region;
  job.bakedBlocks = setup.cells->bakedBlocks();
  job.targets = buildTargetBvh(setup.targets->triangles());
  job.paths = setup.paths;
  job.binCount = settings.binCount();
  job.binMm = float(settings.radialBinMm);
  job.echoSampleMm = float(settings.echoSampleMm);
  return job;
}

void tuneTraceJob(const TraceSetup& setup, const TraceSettings& settings, TraceJob& job)
{
  job.view = setup.view;
  job.media = setup.media;
  job.view.media = nullptr;
  job.frequencyMHz = setup.frequencyMHz;
  job.rangeIsTime = settings.rangeIsTime() && !settings.intensityAlone;
  job.echoCount = settings.echoCount();
  job.radPerMm = float(4.0 * 3.14159265358979323846 * settings.frequencyMHz / assumedSoundSpeedMmPerUs);
}

EchoJob makeEchoJob(const EchoSetup& setup, int linesPerImage)
{
  EchoJob job;
  job.linesPerImage = linesPerImage;
  job.noise = setup.finisher.reverberation().noise;
  job.reverberationRms = setup.finisher.reverberation().rms;
  job.lineCount = int(setup.lines.size());
  job.sampleCount = setup.settings.sampleCount();
  job.sumCount = setup.finisher.sumCount();
  job.rangeCount = setup.finisher.rangeCount();
  job.sampleMm = setup.settings.sampleMm();
  job.radPerMm = setup.finisher.radPerMm();
  job.pulseRe = setup.finisher.pulse().re();
  job.pulseIm = setup.finisher.pulse().im();
  if (setup.model == InterfaceModel::Acoustic)
  {
    job.downshift = pulseDownshift(setup.settings);
  }
  job.beam = makeBeam(setup);
  if (setup.sources.scene)
  {
    job.sceneBeams = makeSceneBeams(setup);
  }
  if (setup.level)
  {
    for (int s = 0; s < job.rangeCount; ++s)
    {
      job.boundaryLevel.push_back(float(setup.level->at(s * job.sampleMm)));
    }
  }
  // Without scatterers there is nothing to look for.
  if (setup.tissues && setup.tissues->grid().highMm.x > 0.0f)
  {
    job.tissues = makeTissues(setup);
  }
  if (setup.nested && setup.nested->grid(0).highMm.x > 0.0f)
  {
    job.nested = makeNested(setup);
  }
  if (setup.surfaces)
  {
    job.surfaces = makeSurfaces(setup, job.sceneBeams);
    if (job.surfaces->blocks.empty() && job.surfaces->targets.empty())
    {
      job.surfaces.reset();
    }
  }
  std::transform(job.sceneBeams.begin(), job.sceneBeams.end(), job.sceneBeams.begin(), forDevice);
  if (setup.sources.points && setup.sources.points->count() > 0)
  {
    job.points = makePoints(setup);
  }
  if (setup.sources.traced)
  {
    const TracedLines& traced = *setup.sources.traced;
    GivenTrace given;
    given.intensity = traced.intensity;
    given.attenuationNpPerMHz = traced.attenuationNpPerMHz;
    given.depthOffsetMm = traced.depthOffsetMm;
    given.reverberation = traced.reverberation;
    given.reverberationNpPerMHz = traced.reverberationNpPerMHz;
    given.binCount = traced.binCount;
    given.binMm = float(traced.binMm);
    given.boundaryEcho.reserve(traced.echoCount > 0 ? std::size_t(job.lineCount) * std::size_t(job.rangeCount) : 0);
    for (int l = 0; l < job.lineCount && traced.echoCount > 0; ++l)
    {
      const LineSum sum = setup.finisher.boundaryEchoes(l);
      const std::size_t before = given.boundaryEcho.size();
      given.boundaryEcho.resize(before + std::size_t(job.rangeCount));
      std::copy_n(sum.iq.data(), 2 * std::size_t(job.rangeCount),
                  reinterpret_cast<float*>(given.boundaryEcho.data() + before));
    }
    job.given = std::move(given);
  }
  return job;
}

LabelJob makeLabelJob(const Scene& scene, const ProbePose* poses, int poseCount, const PlaneImage& layout)
{
  LabelJob job;
  job.voxels = SharedVector<std::uint16_t>(std::shared_ptr<void>(), &scene.volume().voxels);
  job.sceneId = scene.anatomyId();
  job.size = scene.placement().size;
  for (int i = 0; i < poseCount; ++i)
  {
    const std::vector<LabelRow> rows = labelRows(scene.volume(), poses[i], layout);
    job.rows.insert(job.rows.end(), rows.begin(), rows.end());
  }
  return job;
}

BModeJob makeBModeJob(const BModeSettings& settings, int lineCount, int sampleCount, double sampleMm)
{
  settings.validate();
  BModeJob job;
  const std::vector<double> gainDb = depthGainDb(settings, sampleCount, sampleMm);
  for (const double decibels : gainDb)
  {
    job.gainFactor.push_back(gainFactor(decibels));
    job.gainDb.push_back(decibels + settings.gainDb + settings.dynamicRangeDb);
  }
  job.firstReferenceSample = firstReferenceSample(sampleCount, sampleMm);
  job.automaticReference = settings.automaticReference;
  job.referenceAmplitude = settings.referenceAmplitude;
  job.rangeDb = float(settings.dynamicRangeDb);
  job.rejectDb = float(settings.rejectDb);
  job.lateralGainDb = lateralGainDb(settings, lineCount);
  job.greyMap = settings.greyMap;
  job.axialSmoothing = axialSmoothing(settings, sampleMm);
  job.lateralSmoothing = lateralSmoothing(settings);
  job.smoothCompressed = settings.smoothCompressed;
  job.linesAcross = linesAcross(settings, lineCount);
  job.haze = makeHaze(settings, lineCount, sampleCount, sampleMm);
  job.noiseRms = settings.addNoise ? float(std::pow(10.0, settings.noiseDb / 20.0)) : 0.0f;
  job.noiseNodesPerSample = noiseNodesPerSample(settings.pulseSigmaMm / sampleMm);
  job.noiseSeed = settings.noiseSeed;
  return job;
}

} // namespace sono
