#include "BenchScenes.h"

#include "PhantomImaging.h"
#include "Progress.h"
#include "Scene/TestObjects.h"
#include "Scene/ThoraxPhantom.h"
#include "TestScenes.h"

#include <cmath>

namespace sono::study {

namespace {

/// `lineCount` lines, at most all 128 of the geometry.
std::vector<ScanLine> middleLines(const ScanGeometry& geometry, const ProbePose& pose, int lineCount)
{
  const auto all = makeScanLines(geometry, pose);
  const auto first = all.begin() + (std::ptrdiff_t(all.size()) - lineCount) / 2;
  return { first, first + lineCount };
}

/// Adds what a path leaves from `r` on, inside `layer`, going down or up.
void followStack(const TraceSettings& tracing, double r, std::size_t layer, bool down, double intensity, double length,
                 int collisions, std::vector<double>& bins)
{
  const std::vector<Layer>& layers = stackLayers();
  const double decay = layers[layer].tissue.attenuationDbPerCmMHz * tracing.frequencyMHz * std::log(10.0) / 100.0;
  const bool lastDown = down && layer + 1 == layers.size();
  double wall = down ? (lastDown ? tracing.depthMm : layers[layer + 1].fromMm) : layers[layer].fromMm;
  // Nothing is heard of a path whose length and way back are more than twice the depth.
  const double heard = 2.0 * tracing.depthMm - length - r;
  const bool late = heard <= 0.0 || (down && r + 0.5 * heard < wall);
  wall = late ? (down && heard > 0.0 ? r + 0.5 * heard : r) : wall;
  const double low = std::min(r, wall);
  const double high = std::max(r, wall);
  for (std::size_t b = 0; b < bins.size(); ++b)
  {
    const double from = std::max(low, double(b) * tracing.radialBinMm);
    const double to = std::min(high, double(b + 1) * tracing.radialBinMm);
    if (to > from)
    {
      const double near = down ? from - r : r - to;
      const double share = decay > 0.0 ? -std::expm1(-decay * (to - from)) / decay : to - from;
      bins[b] += intensity * std::exp(-decay * near) * share / tracing.radialBinMm;
    }
  }
  if (late || lastDown || (!down && layer == 0) || collisions == tracing.maxCollisions)
  {
    return;
  }
  const std::size_t next = down ? layer + 1 : layer - 1;
  const double z1 = layers[layer].tissue.impedanceMRayl;
  const double z2 = layers[next].tissue.impedanceMRayl;
  const double reflectance = std::pow((z2 - z1) / (z2 + z1), 2);
  const double arrives = intensity * std::exp(-decay * (high - low));
  length += high - low;
  followStack(tracing, wall, layer, !down, arrives * reflectance, length, collisions + 1, bins);
  followStack(tracing, wall, next, down, arrives * (1.0 - reflectance), length, collisions + 1, bins);
}

} // namespace

const std::vector<Layer>& stackLayers()
{
  static const std::vector<Layer> layers = { { 0.0, test::makeTissue("gel", 1.50, 1540, 0.5) },
                                             { 10.0, test::makeTissue("fat", 1.38, 1450, 0.6) },
                                             { 25.0, test::makeTissue("muscle", 1.70, 1580, 1.1) },
                                             { 45.0, test::makeTissue("bone", 4.00, 2500, 2.0) },
                                             { 50.0, test::makeTissue("blood", 1.61, 1570, 0.2) } };
  return layers;
}

std::vector<double> stackIntensity(const TraceSettings& tracing)
{
  std::vector<double> bins(std::size_t(std::ceil(tracing.depthMm / tracing.radialBinMm - 1e-9)), 0.0);
  followStack(tracing, 0.0, 0, true, 1.0, 0.0, 0, bins);
  return bins;
}

BenchScene makeBenchScene(const std::string& name, double spacingMm, int lineCount)
{
  BenchScene bench;
  bench.name = name;
  if (name == "stack")
  {
    const double h = spacingMm > 0.0 ? spacingMm : 1.0;
    std::vector<Tissue> tissues;
    for (const Layer& layer : stackLayers())
    {
      Tissue t = layer.tissue;
      t.scattererProbability = 1.0;
      t.scattererSigma = 0.3;
      tissues.push_back(t);
    }
    bench.tracing.depthMm = 80.0;
    bench.tracing.lobeSigmaRad = 0.0;
    bench.scene = test::makeScene(Vec3i(Vec3d(20.0, 20.0, 80.0) / h), Vec3d(h), tissues, [](const Vec3d& p) {
      int layer = 0;
      while (layer + 1 < int(stackLayers().size()) && p.z > stackLayers()[std::size_t(layer) + 1].fromMm)
      {
        ++layer;
      }
      return layer;
    });
    for (int i = 0; i < lineCount; ++i)
    {
      bench.lines.push_back(test::makeLine({ 6.0 + 8.0 * i / lineCount, 10.2, 0.0 }, { 0.0, 0.0, 1.0 }));
    }
  }
  else if (name == "a4c")
  {
    bench.scene = sceneOf(makeThoraxPhantom(spacingMm > 0.0 ? spacingMm : 1.0));
    bench.lines = middleLines(ScanGeometry(), thoraxPhantomA4C().orthonormalized(), lineCount);
  }
  else if (name == "cyst" || name == "rib")
  {
    TestObjectSettings object;
    object.spacingMm = spacingMm > 0.0 ? spacingMm : 0.5;
    bench.scene = sceneOf(makeTestObject(name == "cyst" ? TestObject::EnhancementSphere : TestObject::Rib, object));
    ScanGeometry geometry;
    geometry.depthMm = 110.0;
    bench.tracing.depthMm = geometry.depthMm;
    bench.lines = middleLines(geometry, ProbePose{}, lineCount);
  }
  else if (name == "phantom")
  {
    CalibrationPhantomSettings phantom;
    phantom.spacingMm = spacingMm > 0.0 ? spacingMm : 0.5;
    const auto targets = readPhantomTargets(SONOVDB_DATA_DIR "/phantom_040gse.csv");
    bench.scene = sceneOf(makeCalibrationPhantom(targets, phantom));
    bench.targets.push_back(phantomWireSurface(targets, phantom, bundledTissues()));
    bench.lines = middleLines(ScanGeometry(), phantomViewPose(phantom, 1), lineCount);
  }
  else
  {
    throw Error("there is no bench scene '" + name + "': take stack, cyst, rib, a4c or phantom");
  }
  bench.echo.depthMm = bench.tracing.depthMm;
  bench.tracing.frequencyMHz = bench.echo.centreFrequencyMHz;
  bench.tracing.echoSampleMm = bench.echo.sampleMm();
  return bench;
}

} // namespace sono::study
