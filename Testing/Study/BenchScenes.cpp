#include "BenchScenes.h"

#include "Core/Progress.h"
#include "Core/SoundSpeed.h"
#include "PhantomImaging.h"
#include "Phantoms/TestObjects.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Study.h"
#include "TestScenes.h"

#include <cmath>

namespace sono::study {

namespace {

/// `lineCount` lines, at most all of the geometry.
std::vector<ScanLine> middleLines(const ScanGeometry& geometry, const ProbePose& pose, int lineCount)
{
  const auto all = makeScanLines(geometry, pose);
  const auto first = all.begin() + (std::ptrdiff_t(all.size()) - lineCount) / 2;
  return { first, first + lineCount };
}

/// Adds what goes straight on leaves, through so many boundaries; what is reflected is not followed.
void followStack(const TraceSettings& tracing, StackLine& out)
{
  const std::vector<Layer>& layers = stackLayers();
  double intensity = 1.0;
  double absorbed = 0.0;
  for (std::size_t layer = 0; layer < layers.size() && int(layer) <= tracing.maxCollisions; ++layer)
  {
    const double decay = layers[layer].tissue.attenuationDbPerCmMHz * tracing.frequencyMHz * std::log(10.0) / 100.0;
    const double low = layers[layer].fromMm;
    const double high = layer + 1 == layers.size() ? tracing.pathDepthMm() : layers[layer + 1].fromMm;
    for (std::size_t b = 0; b < out.intensity.size(); ++b)
    {
      const double from = std::max(low, double(b) * tracing.radialBinMm);
      const double to = std::min(high, double(b + 1) * tracing.radialBinMm);
      if (to > from)
      {
        const double near = from - low;
        const double share = decay > 0.0 ? -std::expm1(-decay * (to - from)) / decay : to - from;
        const double value = intensity * std::exp(-decay * near) * share / tracing.radialBinMm;
        out.intensity[b] += value;
        out.absorbed[b] += value * (absorbed + decay * (near + 0.5 * (to - from)));
      }
    }
    absorbed += decay * (high - low);
    intensity *= std::exp(-decay * (high - low));
    if (layer + 1 < layers.size())
    {
      const double z1 = layers[layer].tissue.impedanceMRayl;
      const double z2 = layers[layer + 1].tissue.impedanceMRayl;
      intensity *= 1.0 - std::pow((z2 - z1) / (z2 + z1), 2);
    }
  }
}

/// The depth that is shown at a range: layer by layer, as far as its time goes.
double stackDepth(double rangeMm)
{
  const std::vector<Layer>& layers = stackLayers();
  double fromRange = 0.0;
  for (std::size_t layer = 0;; ++layer)
  {
    const double rangePerMm = 1000.0 * assumedSoundSpeedMmPerUs / layers[layer].tissue.soundSpeedMPerS;
    const double into = (rangeMm - fromRange) / rangePerMm;
    if (layer + 1 == layers.size() || layers[layer].fromMm + into <= layers[layer + 1].fromMm)
    {
      return layers[layer].fromMm + into;
    }
    fromRange += (layers[layer + 1].fromMm - layers[layer].fromMm) * rangePerMm;
  }
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

StackLine stackLine(const TraceSettings& tracing)
{
  StackLine line;
  line.intensity.resize(std::size_t(tracing.binCount()));
  line.absorbed.resize(line.intensity.size());
  for (std::size_t b = 0; b < line.intensity.size(); ++b)
  {
    const double rangeMm = double(b) * tracing.radialBinMm;
    line.depthOffsetMm.push_back(stackDepth(rangeMm) - rangeMm);
  }
  followStack(tracing, line);
  return line;
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
      t.roughnessMm = 0.0; // the exact sum knows mirrors alone
      tissues.push_back(t);
    }
    bench.tracing.depthMm = 80.0;
    bench.scene = test::makeScene(Vec3i(Vec3d(20.0, 20.0, 84.0) / h), Vec3d(h), tissues, [](const Vec3d& p) {
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
    const auto targets = readPhantomTargets(dataFile("phantom_040gse.csv"));
    bench.scene = sceneOf(makeCalibrationPhantom(targets, phantom));
    bench.targets.push_back(phantomWireSurface(targets, phantom, bundledTissues()));
    ScanGeometry close;
    close.lineCount = 2048;
    bench.lines = middleLines(close, phantomViewPose(phantom, 1), lineCount);
  }
  else
  {
    throw Error("there is no bench scene '" + name + "': take stack, cyst, rib, a4c or phantom");
  }
  bench.tracing.reverberation = false; // the twin in double precision knows the direct sound alone
  bench.echo.samplingMHz = 50.0;       // the seed's
  bench.echo.depthMm = bench.tracing.depthMm;
  bench.tracing.frequencyMHz = bench.echo.centreFrequencyMHz;
  bench.tracing.echoSampleMm = bench.echo.sampleMm();
  return bench;
}

} // namespace sono::study
