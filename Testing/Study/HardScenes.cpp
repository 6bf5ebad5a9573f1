#include "HardScenes.h"

#include "Core/Progress.h"
#include "PhantomImaging.h"
#include "Probe/ArrayAperture.h"
#include "Probe/ArrayBeam.h"
#include "Study.h"
#include "TestScenes.h"

#include <cmath>
#include <limits>

namespace sono::study {
namespace {

/// A box of 60 voxels along each edge: a ball of tissue 1 in tissue 0 and a wall of tissue 2 behind, or any other
/// labels, given by the place in voxels. Sixteen lines fan out through it.
struct Box
{
  Vec3d spacingMm{ 1.0 };
  double contrast = 1.3; ///< of the impedance of tissue 1
  double attenuation = 0.5;
  double gamma = 0.0;
  Vec3d originMm{ 0.0 };
  Mat3d direction{ 1.0 };
  int tissues = 3;
  std::function<int(const Vec3d&)> label;
  Vec3d from{ 30.18, 30.42, 0.0 }; ///< of the lines, in voxels
  double fanRad = 0.02;            ///< between two of them
  Vec3d lean{ 0.0, 0.01, 0.0 };    ///< added to their directions
};

int ballAndWall(const Vec3d& voxel)
{
  return glm::length(voxel / 60.0 - Vec3d(0.5, 0.5, 0.4)) < 0.15 ? 1 : (voxel.z > 45.0 ? 2 : 0);
}

std::vector<Tissue> boxTissues(const Box& box)
{
  std::vector<Tissue> tissues = { test::makeTissue("a", 1.5, 1540, box.attenuation),
                                  test::makeTissue("b", 1.5 * box.contrast, 1600, box.attenuation),
                                  test::makeTissue("c", 2.4, 1700, box.attenuation) };
  for (int t = 3; t < box.tissues; ++t)
  {
    tissues.push_back(test::makeTissue("t" + std::to_string(t), 1.4 + 0.005 * t, 1450 + t, box.attenuation));
  }
  for (Tissue& t : tissues)
  {
    t.scattererProbability = 1.0;
    t.scattererSigma = 0.3;
    t.gamma = box.gamma;
  }
  return tissues;
}

BenchScene makeBox(const Box& box)
{
  BenchScene bench;
  bench.name = "box";
  const Vec3i size(60, 60, 60);
  const std::vector<Tissue> tissues = boxTissues(box);
  const auto scene = test::makeScene(size, box.spacingMm, tissues, [&](const Vec3d& p) {
    return box.label ? box.label(p / box.spacingMm) : ballAndWall(p / box.spacingMm);
  });
  LabelVolume volume = scene->volume();
  volume.placement.originMm = box.originMm + box.direction * volume.placement.originMm;
  volume.placement.direction = box.direction;
  TissueTable table;
  for (const Tissue& t : tissues)
  {
    table.add(t);
  }
  bench.scene = std::make_unique<Scene>(std::move(volume), table, "none");
  const double depth = 60.0 * box.spacingMm.z;
  bench.tracing.reverberation = false; // as in BenchScenes.cpp
  bench.tracing.depthMm = depth;
  bench.tracing.radialBinMm = depth / 240.0;
  bench.tracing.frequencyMHz = bench.echo.centreFrequencyMHz;
  bench.tracing.echoSampleMm = bench.echo.sampleMm();
  bench.echo.depthMm = depth;
  for (int i = 0; i < 16; ++i)
  {
    const double angle = (i - 7.5) * box.fanRad;
    bench.lines.push_back(
      test::makeLine(box.originMm + box.direction * (box.from * box.spacingMm),
                     box.direction * glm::normalize(Vec3d(std::sin(angle), 0.0, std::cos(angle)) + box.lean)));
  }
  return bench;
}

/// A box with one thing changed.
std::function<BenchScene()> boxWith(const std::function<void(Box&)>& change,
                                    const std::function<void(BenchScene&)>& further = {})
{
  return [=] {
    Box box;
    change(box);
    BenchScene bench = makeBox(box);
    if (further)
    {
      further(bench);
    }
    return bench;
  };
}

std::function<BenchScene()> bundled(const std::string& name, const std::function<void(TraceSettings&)>& change = {})
{
  return [=] {
    BenchScene bench = makeBenchScene(name);
    if (change)
    {
      change(bench.tracing);
    }
    return bench;
  };
}

std::function<BenchScene()> withTissue(const std::function<void(Tissue&)>& spoil)
{
  return [=] {
    Tissue t = test::makeTissue("spoilt", 1.5, 1540, 0.5);
    spoil(t);
    TissueTable().add(t);
    return makeBox({});
  };
}

/// Nearly along a wall, at 0.04 to 0.13 degrees: so flat that its smoothed surface counts no more. The near part is of
/// a slower tissue, the far part of a faster one, so that some lines are refracted and others reflected.
void grazing(Box& box)
{
  box.tissues = 4;
  box.label = [](const Vec3d& v) { return v.x > 31.0 ? (v.z < 28.0 ? 3 : 1) : 0; };
  box.from.x = 30.96;
  box.fanRad = 0.0001;
  box.lean = Vec3d(0.0015, 0.0, 0.0);
}

void oneElement(BenchScene& bench)
{
  ArrayAperture aperture = apertureOf(readProbePreset(dataFile("probes/phased_p4-2.json")));
  aperture.elementCount = 1;
  bench.echo.field =
    std::make_shared<PulseEchoField>(pulseEchoField(aperture, suggestedFieldGrid(aperture, bench.echo.depthMm)));
}

Mat3d turned(double handedness)
{
  const double c = std::cos(0.5);
  const double s = std::sin(0.5);
  const Mat3d aroundZ(Vec3d(c, s, 0.0), Vec3d(-s, c, 0.0), Vec3d(0.0, 0.0, 1.0));
  const Mat3d aroundX(Vec3d(1.0, 0.0, 0.0), Vec3d(0.0, c, s), Vec3d(0.0, -s, c));
  return aroundZ * aroundX * Mat3d(Vec3d(handedness, 0.0, 0.0), Vec3d(0.0, 1.0, 0.0), Vec3d(0.0, 0.0, 1.0));
}

std::vector<HardScene> makeHardScenes()
{
  const auto nothing = [](Box&) {};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto along = [](const Vec3d& from) {
    return [from](Box& b) {
      b.from = from;
      b.fanRad = 0.0;
      b.lean = Vec3d(0.0);
    };
  };
  const auto labels = [](int tissues, const std::function<int(const Vec3d&)>& label) {
    return [=](Box& b) {
      b.tissues = tissues;
      b.label = label;
    };
  };
  return {
    { "none", "stack", bundled("stack") },
    { "none", "cyst", bundled("cyst") },
    { "none", "rib", bundled("rib") },
    { "none", "a4c", bundled("a4c") },
    { "none", "phantom, wires as targets", bundled("phantom") },
    { "none", "a4c, 20 collisions, C0 20 mm",
      bundled("a4c",
              [](TraceSettings& t) {
                t.maxCollisions = 20;
                t.coherenceMm = 20.0;
              }) },
    { "none", "a4c, no chance", bundled("a4c", [](TraceSettings& t) { t.deterministic = true; }) },
    { "none", "a4c, Amadou2024", bundled("a4c", [](TraceSettings& t) { t.model = InterfaceModel::Amadou2024; }) },
    { "none", "box: a ball and a wall, voxels of 1 mm", boxWith(nothing) },
    { "grazing incidence", "lines along a wall", boxWith(grazing) },
    { "cos to 0 with gamma < 0", "the same, gamma -1.8", boxWith([](Box& b) {
        grazing(b);
        b.gamma = -1.8;
      }) },
    { "cos to 0 with gamma < 0", "the same, Amadou2024",
      boxWith(
        [](Box& b) {
          grazing(b);
          b.gamma = -1.8;
        },
        [](BenchScene& s) { s.tracing.model = InterfaceModel::Amadou2024; }) },
    { "Z1 = Z2", "ball of equal impedance, other speed", boxWith([](Box& b) { b.contrast = 1.0; }) },
    { "Z1 = Z2", "ball hardly different, 1:1.0001", boxWith([](Box& b) { b.contrast = 1.0001; }) },
    { "Z = 0", "tissue without impedance", withTissue([](Tissue& t) { t.impedanceMRayl = 0.0; }) },
    { "c = 0", "tissue without speed", withTissue([](Tissue& t) { t.soundSpeedMPerS = 0.0; }) },
    { "NaN in a tissue table", "attenuation NaN", withTissue([=](Tissue& t) { t.attenuationDbPerCmMHz = nan; }) },
    { "impedances 1:5000", "ball of air", boxWith([](Box& b) { b.contrast = 1.0 / 5000.0; }) },
    { "impedances 1:5000", "ball 5000 times as hard", boxWith([](Box& b) { b.contrast = 5000.0; }) },
    { "a path trapped", "between two walls 1:50, 1000 collisions",
      boxWith(
        [](Box& b) {
          b.contrast = 50.0;
          b.attenuation = 0.0;
          b.label = [](const Vec3d& v) { return (v.z > 5.0 && v.z < 8.0) || v.z > 20.0 ? 1 : 0; };
        },
        [](BenchScene& s) { s.tracing.maxCollisions = 1000; }) },
    { "a path trapped", "a4c, 200 collisions", bundled("a4c", [](TraceSettings& t) { t.maxCollisions = 200; }) },
    { "a hit that restarts on the wrong side", "walls of one voxel",
      boxWith(labels(3, [](const Vec3d& v) { return int(v.z) % 7 == 3 ? 1 : 0; })) },
    { "origin inside bone", "lines from inside the ball, 1:4", boxWith([](Box& b) {
        b.from = Vec3d(30.0, 30.0, 24.0);
        b.contrast = 4.0;
      }) },
    { "origin outside the volume", "20 voxels before it", boxWith([](Box& b) { b.from.z = -20.0; }) },
    { "origin on a voxel face", "at (30.5, 30.5, 10)", boxWith(along(Vec3d(30.5, 30.5, 10.0))) },
    { "a ray along an axis", "at (30.3, 30.4, 0)", boxWith(along(Vec3d(30.3, 30.4, 0.0))) },
    { "a ray along an edge", "at (30, 30, 0)", boxWith(along(Vec3d(30.0, 30.0, 0.0))) },
    { "labels that touch at a corner", "in turn, one voxel each",
      boxWith(labels(3, [](const Vec3d& v) { return (int(v.x) + int(v.y) + int(v.z)) % 3; })) },
    { "one-voxel labels", "every fifth voxel along each axis", boxWith([](Box& b) {
        b.label = [](const Vec3d& v) { return int(v.x) % 5 == 2 && int(v.y) % 5 == 2 && int(v.z) % 5 == 2 ? 1 : 0; };
        b.from = Vec3d(32.18, 32.12, 0.0);
      }) },
    { "an empty label map", "0 x 0 x 0 voxels",
      [] {
        TissueTable table;
        table.add(test::makeTissue("a", 1.5, 1540, 0.5));
        BenchScene bench = makeBox({});
        bench.scene = std::make_unique<Scene>(LabelVolume(), table, "none");
        return bench;
      } },
    { "a constant label map", "one tissue", boxWith(labels(3, [](const Vec3d&) { return 0; })) },
    { "200 labels", "slabs of 3 voxels by 4 by 15",
      boxWith(
        labels(200, [](const Vec3d& v) { return (int(v.x) / 4 + 15 * (int(v.y) / 15) + 7 * (int(v.z) / 3)) % 200; })) },
    { "spacing of 0.05 mm", "the ball and the wall", boxWith([](Box& b) { b.spacingMm = Vec3d(0.05); }) },
    { "spacing of 5 mm", "the ball and the wall", boxWith([](Box& b) { b.spacingMm = Vec3d(5.0); }) },
    { "anisotropic 1:10", "voxels of 0.3 x 0.3 x 3 mm", boxWith([](Box& b) { b.spacingMm = Vec3d(0.3, 0.3, 3.0); }) },
    { "oblique direction matrix", "turned twice by 0.5 rad", boxWith([](Box& b) { b.direction = turned(1.0); }) },
    { "left-handed direction matrix", "the same, mirrored", boxWith([](Box& b) { b.direction = turned(-1.0); }) },
    { "C0 = 0", "a4c", bundled("a4c", [](TraceSettings& t) { t.coherenceMm = 0.0; }) },
    { "depth 0", "the ball and the wall",
      boxWith(nothing, [](BenchScene& s) { s.tracing.depthMm = s.echo.depthMm = 0.0; }) },
    { "one line", "the ball and the wall", boxWith(nothing, [](BenchScene& s) { s.lines.resize(1); }) },
    { "one element", "the beam of a single element", boxWith(nothing, oneElement) },
    { "N = 1", "a4c, one path", bundled("a4c", [](TraceSettings& t) { t.pathsPerLine = 1; }) },
    { "10^6 paths", "one line of the ball and the wall",
      boxWith(nothing,
              [](BenchScene& s) {
                s.lines.resize(1);
                s.tracing.pathsPerLine = 1000000;
              }) },
    { "attenuation until exp underflows", "400 dB/cm/MHz", boxWith([](Box& b) { b.attenuation = 400.0; }) },
    { "no attenuation", "the ball and the wall", boxWith([](Box& b) { b.attenuation = 0.0; }) },
    { "1e5 mm from the origin", "the ball and the wall", boxWith([](Box& b) { b.originMm = Vec3d(1e5, -1e5, 1e5); }) },
  };
}

} // namespace

const std::vector<HardScene>& hardScenes()
{
  static const std::vector<HardScene> all = makeHardScenes();
  return all;
}

} // namespace sono::study
