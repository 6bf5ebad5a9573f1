#include "ReverberationScenes.h"

#include "PhantomImaging.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Study.h"
#include "TargetScenes.h"
#include "TestScenes.h"

#include "Core/SoundSpeed.h"

#include <array>
#include <cmath>
#include <limits>

namespace sono::study {

namespace {

constexpr double pi = 3.14159265358979323846;

Tissue smooth(const std::string& name, double roughnessMm)
{
  Tissue tissue = *bundledTissues().find(name);
  tissue.roughnessMm = roughnessMm;
  return tissue;
}

/// The gain that keeps a tissue alike at all depths, dB/cm.
double evenGain(double attenuationDbPerCmMHz, double frequencyMHz)
{
  return 2.0 * attenuationDbPerCmMHz * frequencyMHz;
}

ImageInput inputOf(const std::string& probe, double depthMm, double gainDbPerCmMHz, bool quick)
{
  const ProbePreset preset = readProbePreset(dataFile("probes/" + probe + ".json"));
  ImageInput input;
  ImageSettings& s = input.settings;
  s.geometry = preset.geometry;
  s.geometry.depthMm = depthMm;
  s.geometry.lineCount = quick ? 16 : s.geometry.lineCount;
  s.echo.centreFrequencyMHz = preset.centreFrequencyMHz;
  s.echo.fractionalBandwidth = preset.fractionalBandwidth;
  s.echo.aperture = preset.aperture();
  s.tracing.pathsPerLine = quick ? 16 : 1000;
  s.tracing.maxCollisions = 60;
  s.bmode.tgcDbPerCm = evenGain(gainDbPerCmMHz, s.echo.centreFrequencyMHz);
  s.setDevice(Device::Cpu);
  s.matchStages();
  return input;
}

/// A round rod across the beam, from one x to another: a prism with a flat side up.
TargetSurface rodAlong(const Tissue& tissue, double fromMm, double toMm, double y)
{
  constexpr int sides = 24;
  const double radiusMm = 0.5 * needleThickMm / std::cos(pi / sides);
  TargetSurface rod{ "needle", tissue, {}, {}, needleThickMm };
  for (const double x : { fromMm, toMm })
  {
    for (int i = 0; i < sides; ++i)
    {
      const double turn = 2.0 * pi * (i + 0.5) / sides;
      rod.pointsMm.push_back(
        { x, y + radiusMm * std::sin(turn), needleTopMm + 0.5 * needleThickMm - radiusMm * std::cos(turn) });
    }
  }
  for (int i = 0; i < sides; ++i)
  {
    const int j = (i + 1) % sides;
    rod.triangles.push_back({ i, j, sides + j });
    rod.triangles.push_back({ i, sides + j, sides + i });
    if (i > 0 && j > 0)
    {
      rod.triangles.push_back({ 0, j, i });
      rod.triangles.push_back({ sides, sides + i, sides + j });
    }
  }
  return rod;
}

// From one x to another.
constexpr std::array<double, 2> needleMm{ 10.0, 21.0 };
constexpr std::array<double, 2> stripMm{ 29.0, 40.0 };

constexpr double wallMm = 10.0;
const Vec3d sphereMm(105.0, 10.0, -22.0); ///< middle of the diaphragm's sphere
constexpr double sphereRadiusMm = 110.0;
const Vec3d ballMm(150.0, 10.0, 60.0);
constexpr double ballRadiusMm = 6.0;
const Vec3d veinMm(95.0, 10.0, 62.0);
constexpr double veinRadiusMm = 5.0;

} // namespace

const Vec3d cystMm(60.0, 12.0, 20.0);

ArtefactScene pleuraScene(double roughnessMm, bool quick)
{
  const double voxelMm = quick ? 1.0 : 0.25;
  const Vec3d size(50.0, 12.0, 64.0);
  const std::vector<Tissue> tissues{ *bundledTissues().find("skin"),   *bundledTissues().find("fat"),
                                     *bundledTissues().find("muscle"), smooth("connective_tissue", roughnessMm),
                                     smooth("lung", roughnessMm),      *bundledTissues().find("cortical_bone") };
  ArtefactScene made;
  made.scene = test::makeScene(Vec3i(size / voxelMm), Vec3d(voxelMm), tissues, [&](const Vec3d& p) {
    const double aside = std::abs(p.x - 0.5 * size.x) - 17.0; // the middle of a rib
    const bool rib = std::hypot(aside / 5.0, (p.z - 8.0) / 3.0) < 1.0;
    return rib ? 5 : p.z < 1.5 ? 0 : p.z < 4.0 ? 1 : p.z < pleuraMm - 1.0 ? 2 : p.z < pleuraMm ? 3 : 4;
  });
  made.input = inputOf("linear_l14", 4.5 * pleuraMm, 0.9, quick); // 0.9 dB/(cm MHz): the wall's mean
  made.input.pose.positionMm = { 0.5 * size.x, 0.5 * size.y, 0.0 };
  return made;
}

ArtefactScene diaphragmScene(double roughnessMm, bool quick)
{
  const double voxelMm = quick ? 2.0 : 0.5;
  const Vec3d size(260.0, 20.0, 150.0);
  Tissue ball = smooth("liver", roughnessMm);
  ball.name = "haemangioma";
  ball.backscatterPerCmSr *= 20.0;
  const std::vector<Tissue> tissues{ *bundledTissues().find("skin"),
                                     *bundledTissues().find("fat"),
                                     *bundledTissues().find("muscle"),
                                     smooth("liver", roughnessMm),
                                     ball,
                                     smooth("blood", roughnessMm),
                                     smooth("lung", roughnessMm) };
  ArtefactScene made;
  made.scene = test::makeScene(Vec3i(size / voxelMm), Vec3d(voxelMm), tissues, [](const Vec3d& p) {
    return p.z < 2.0                                                   ? 0
           : p.z < 6.0                                                 ? 1
           : p.z < wallMm                                              ? 2
           : glm::distance(p, sphereMm) > sphereRadiusMm               ? 6
           : glm::distance(p, ballMm) < ballRadiusMm                   ? 4
           : std::hypot(p.x - veinMm.x, p.z - veinMm.z) < veinRadiusMm ? 5
                                                                       : 3;
  });
  made.input = inputOf("curvilinear_c5-2", 135.0, 0.5, quick);
  made.input.pose.positionMm = { 0.5 * size.x, 0.5 * size.y, 0.0 };
  return made;
}

MirrorPlace ballBehindDiaphragm(const ScanGeometry& geometry, const ProbePose& pose)
{
  const std::vector<ScanLine> lines = makeScanLines(geometry, pose);
  const double shown = 1000.0 * assumedSoundSpeedMmPerUs / bundledTissues().find("liver")->soundSpeedMPerS;
  MirrorPlace best{ 0, 0.0, 0.0 };
  double nearest = std::numeric_limits<double>::max();
  for (std::size_t l = 0; l < lines.size(); ++l)
  {
    const ScanLine& line = lines[l];
    const Vec3d from = line.originMm - sphereMm;
    const double along = glm::dot(from, line.axis);
    const double hitMm = -along + std::sqrt(along * along - glm::dot(from, from) + sphereRadiusMm * sphereRadiusMm);
    const Vec3d hit = line.originMm + hitMm * line.axis;
    const Vec3d normal = glm::normalize(sphereMm - hit);
    const Vec3d mirrored = line.axis - 2.0 * glm::dot(line.axis, normal) * normal;
    const double backMm = glm::dot(ballMm - hit, mirrored);
    const double missMm = glm::distance(hit + backMm * mirrored, ballMm);
    if (missMm < nearest)
    {
      nearest = missMm;
      best = { int(l), shown * (hitMm + backMm), shown * hitMm };
    }
  }
  return best;
}

ArtefactScene needleScene(bool quick)
{
  const double voxelMm = quick ? 1.0 : 0.5;
  const Vec3d size(50.0, 12.0, 48.0);
  ArtefactScene made;
  made.scene = test::makeScene(Vec3i(size / voxelMm), Vec3d(voxelMm), { smooth("soft_tissue", 0.0) },
                               [](const Vec3d&) { return 0; });
  made.input = inputOf("linear_l14", 40.0, 0.54, quick);
  made.input.pose.positionMm = { 0.5 * size.x, 0.5 * size.y, 0.0 };
  Tissue steel = *bundledTissues().find("metal");
  steel.name = "steel"; // handbooks' 7900 kg/m^3 and 5790 m/s
  steel.impedanceMRayl = 45.7;
  steel.soundSpeedMPerS = 5790.0;
  steel.roughnessMm = 0.0;
  made.input.targets.push_back(rodAlong(steel, needleMm[0], needleMm[1], 0.5 * size.y));
  made.input.targets.push_back(test::makeBox("strip", steel, { stripMm[0], 0.5 * size.y - 3.0, needleTopMm },
                                             { stripMm[1], 0.5 * size.y + 3.0, needleTopMm + needleThickMm }));
  return made;
}

ArtefactScene cystScene(ImagingMode mode, bool quick)
{
  const double voxelMm = quick ? 1.0 : 0.5;
  const Vec3d size(120.0, 24.0, 64.0);
  std::vector<Tissue> tissues;
  for (const char* name : { "skin", "fat", "muscle", "liver", "water" })
  {
    tissues.push_back(*bundledTissues().find(name));
  }
  ArtefactScene made;
  made.scene = test::makeScene(Vec3i(size / voxelMm), Vec3d(voxelMm), tissues, [](const Vec3d& p) {
    return p.z < 2.0 ? 0 : p.z < 7.0 ? 1 : p.z < wallMm ? 2 : glm::distance(p, cystMm) > cystRadiusMm ? 3 : 4;
  });
  made.input = inputOf("curvilinear_c5-2", 45.0, 0.5, quick);
  made.input.pose.positionMm = { cystMm.x, cystMm.y, 0.0 };
  ImageSettings& s = made.input.settings;
  s.geometry.sectorDeg *= 0.6;
  s.geometry.lineCount = quick ? 16 : 100;
  s.echo.imagingMode = mode;
  s.matchStages();
  return made;
}

ArtefactScene heartScene(bool quick)
{
  ArtefactScene made;
  made.scene = sceneOf(makeThoraxPhantom(quick ? 4.0 : 1.0));
  made.input = inputOf("phased_p4-2", 160.0, 0.5, quick);
  made.input.pose = thoraxPhantomA4C().orthonormalized();
  // As vtkSonoUltrasound starts, but for the paths.
  made.input.settings.tracing.maxCollisions = 20;
  made.input.settings.tracing.coherenceMm = 20.0;
  made.input.settings.bmode.tgcDbPerCm = 3.0;
  return made;
}

} // namespace sono::study
