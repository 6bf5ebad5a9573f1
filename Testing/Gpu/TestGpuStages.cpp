#include "FieldScenes.h"
#include "GpuParity.h"
#include "PhantomScene.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Probe/PulseFile.h"

namespace {

using namespace sono;
using namespace sono::test;

const Scene& thorax()
{
  static const auto scene = makePhantomScene(makeThoraxPhantom(2.0));
  return *scene;
}

ImageSettings thoraxSettings()
{
  ImageSettings s;
  s.geometry.lineCount = 64;
  s.tracing.pathsPerLine = 1000;
  s.matchStages();
  return s;
}

Chain thoraxChain(const ImageSettings& s, Device device)
{
  const auto lines = makeScanLines(s.geometry, thoraxPhantomA4C().orthonormalized());
  return runChain({ &thorax(), nullptr, nullptr }, lines, s.tracing, s.echo, device);
}

TEST(GpuStages, BundledThoraxInEveryModel)
{
  SONO_GPU_OR_SKIP();
  for (const InterfaceModel model : { InterfaceModel::Acoustic, InterfaceModel::Amadou2024 })
  {
    for (const Sampling sampling : { Sampling::LowDiscrepancy, Sampling::Independent })
    {
      for (const bool deterministic : { false, true })
      {
        ImageSettings s = thoraxSettings();
        s.tracing.model = model;
        s.tracing.sampling = sampling;
        s.tracing.deterministic = deterministic;
        // The weights of the seed's equations spread over orders of magnitude: more paths, so that none counts alone.
        s.tracing.pathsPerLine = model == InterfaceModel::Amadou2024 ? 8000 : 1000;
        expectSameRf(thoraxChain(s, Device::Cuda), thoraxChain(s, Device::Cpu),
                     "model " + std::to_string(int(model)) + ", sampling " + std::to_string(int(sampling)) +
                       ", deterministic " + std::to_string(deterministic));
      }
    }
  }
}

TEST(GpuStages, ManyCollisionsManyPathsFineBins)
{
  SONO_GPU_OR_SKIP();
  ImageSettings s = thoraxSettings();
  s.tracing.lobeSigmaDeg = 0.1 * 180.0 / M_PI;
  s.tracing.maxCollisions = 40;
  s.tracing.coherenceMm = 20.0;
  s.geometry.lineCount = 4; // few lines: batches are cut into slices
  s.tracing.pathsPerLine = 20001;
  expectSameRf(thoraxChain(s, Device::Cuda), thoraxChain(s, Device::Cpu), "20001 paths");
  s.tracing.pathsPerLine = 500;
  s.tracing.radialBinMm = 0.01; // 16000 bins do not fit in shared memory
  expectSameRf(thoraxChain(s, Device::Cuda), thoraxChain(s, Device::Cpu), "16000 bins");
  s.tracing.pathsPerLine = 3; // fewer than the batches
  s.tracing.radialBinMm = 0.25;
  expectSameRf(thoraxChain(s, Device::Cuda), thoraxChain(s, Device::Cpu), "3 paths");
}

TEST(GpuStages, TheIntensityAndItsErrorAgree)
{
  SONO_GPU_OR_SKIP();
  const ImageSettings s = thoraxSettings();
  const TracedLines gpu = thoraxChain(s, Device::Cuda).traced;
  const TracedLines cpu = thoraxChain(s, Device::Cpu).traced;
  EXPECT_NEAR(double(gpu.segments), double(cpu.segments), 1e-4 * double(cpu.segments));
  for (std::size_t i = 0; i < cpu.intensity.size(); ++i)
  {
    // A path or two of a thousand that went another way.
    ASSERT_NEAR(gpu.intensity[i], cpu.intensity[i], 2e-3) << i;
    ASSERT_NEAR(gpu.standardError[i], cpu.standardError[i], 2e-3) << i;
  }
}

TEST(GpuStages, ResultsRepeatToTheBit)
{
  SONO_GPU_OR_SKIP();
  const ImageSettings s = thoraxSettings();
  const Chain first = thoraxChain(s, Device::Cuda);
  ImageSettings other = s;
  other.geometry.lineCount = 17;
  other.tracing.seed = 5;
  thoraxChain(other, Device::Cuda); // leaves something else in the buffers
  const Chain second = thoraxChain(s, Device::Cuda);
  EXPECT_EQ(first.traced.intensity, second.traced.intensity);
  EXPECT_EQ(first.traced.standardError, second.traced.standardError);
  EXPECT_EQ(first.traced.boundaryEcho, second.traced.boundaryEcho);
  EXPECT_EQ(first.rf.iq, second.rf.iq);
}

TEST(GpuStages, ExplicitScatterers)
{
  SONO_GPU_OR_SKIP();
  const SceneS1 s1(200000);
  const PointScatterers points(s1.points);
  const EchoSources sources{ nullptr, nullptr, &points };
  const Chain gpu = runChain(sources, s1.lines, {}, s1.settings, Device::Cuda);
  expectSameRf(gpu, runChain(sources, s1.lines, {}, s1.settings, Device::Cpu), "points");
  // Against the direct sum, as the CPU is.
  for (const int line : { 5, 77 })
  {
    const auto reference = directIq(s1.points, s1.lines[std::size_t(line)], s1.settings);
    EXPECT_LE(nrmse(gpu.rf.iq.data() + std::size_t(line) * reference.size(), reference), 1e-3) << line;
  }
}

TEST(GpuStages, AFieldAndASampledPulse)
{
  SONO_GPU_OR_SKIP();
  ImageSettings s = thoraxSettings();
  s.geometry.lineCount = 16;
  FieldGrid grid;
  grid.lateral = { 0.0, 0.25, 24 };
  grid.elevational = { 0.0, 0.5, 10 };
  grid.depth = { 0.0, 2.0, 81 };
  s.echo.field = tabulate(grid, [](double l, double e, double d) {
    const double width = 1.0 + std::abs(d - 60.0) / 60.0;
    return std::exp(-0.5 * (l * l + e * e) / (width * width)) / width;
  });
  SampledPulse pulse;
  pulse.startUs = -1.0;
  pulse.stepUs = 0.01;
  for (int i = 0; i <= 300; ++i)
  {
    const double t = pulse.startUs + i * pulse.stepUs; // lopsided: its envelope is complex
    pulse.amplitude.push_back(t < 0.0 ? 0.0 : t * std::exp(-4.0 * t) * std::sin(2.0 * M_PI * 2.6 * t));
  }
  s.echo.pulse = std::make_shared<SampledPulse>(pulse);
  expectSameRf(thoraxChain(s, Device::Cuda), thoraxChain(s, Device::Cpu), "field");
}

TEST(GpuStages, WholeImagesAndBatches)
{
  SONO_GPU_OR_SKIP();
  ImageSettings s = thoraxSettings();
  s.bmode.addNoise = true;
  s.bmode.noiseDb = -80.0;
  std::vector<ProbePose> poses;
  for (int i = 0; i < 5; ++i)
  {
    ProbePose pose = thoraxPhantomA4C().orthonormalized();
    pose.axial += 0.05 * i * pose.lateral;
    poses.push_back(pose.orthonormalized());
  }
  s.device = Device::Cpu;
  const auto cpu = simulateImages(thorax(), poses, s);
  s.device = Device::Cuda;
  const auto gpu = simulateImages(thorax(), poses, s);
  ASSERT_EQ(gpu.size(), cpu.size());
  for (std::size_t i = 0; i < cpu.size(); ++i)
  {
    double squared = 0.0;
    int border = 0;
    for (std::size_t p = 0; p < cpu[i].value.size(); ++p)
    {
      const bool both = gpu[i].mask[p] == cpu[i].mask[p];
      border += both ? 0 : 1;
      squared += both ? std::pow(double(gpu[i].value[p]) - cpu[i].value[p], 2) : 0.0;
    }
    EXPECT_LE(border, 20) << i; // pixels whose centre lies on the sector's edge, to rounding
    // 1e-3 of the grey levels' range in the mean; at speckle's zeros the logarithm magnifies any rounding.
    EXPECT_LE(std::sqrt(squared / double(cpu[i].value.size())), 1e-3) << i;
    const auto alone = simulateImages(thorax(), { poses[i] }, s);
    EXPECT_EQ(alone.front().value, gpu[i].value) << i;
  }
}

TEST(GpuStages, ScanConversionOfEveryGeometry)
{
  SONO_GPU_OR_SKIP();
  for (const ScanKind kind : { ScanKind::Linear, ScanKind::PhasedSector, ScanKind::Curvilinear, ScanKind::Radial })
  {
    ImageSettings s = thoraxSettings();
    s.geometry.kind = kind;
    s.geometry.lineCount = 24;
    s.geometry.depthMm = 60.0;
    s.geometry.sectorDeg = kind == ScanKind::Radial ? 360.0 : 60.0;
    s.geometry.radiusMm = kind == ScanKind::Radial ? 3.0 : 60.0;
    s.tracing.pathsPerLine = 200;
    s.bmode.automaticReference = false;
    s.bmode.referenceAmplitude = 0.05;
    s.bmode.greyMap = GreyMap::Sigmoid;
    s.matchStages();
    const std::vector<ProbePose> poses{ thoraxPhantomA4C().orthonormalized() };
    s.device = Device::Cpu;
    const PlaneImage cpu = simulateImages(thorax(), poses, s).front();
    s.device = Device::Cuda;
    const PlaneImage gpu = simulateImages(thorax(), poses, s).front();
    ASSERT_EQ(gpu.value.size(), cpu.value.size());
    int differing = 0;
    for (std::size_t p = 0; p < cpu.value.size(); ++p)
    {
      differing += std::abs(gpu.value[p] - cpu.value[p]) > 0.01f || gpu.mask[p] != cpu.mask[p];
    }
    EXPECT_LE(differing, int(cpu.value.size() / 1000)) << int(kind);
  }
}

TEST(GpuStages, AnAbortedRunLeavesTheDeviceUsable)
{
  SONO_GPU_OR_SKIP();
  ImageSettings s = thoraxSettings();
  s.device = Device::Cuda;
  const std::vector<ProbePose> poses{ thoraxPhantomA4C().orthonormalized() };
  int asked = 0;
  EXPECT_THROW(simulateImages(thorax(), poses, s,
                              [&](double f) {
                                ++asked;
                                return f < 0.5;
                              }),
               Aborted);
  EXPECT_GT(asked, 0);
  EXPECT_FALSE(simulateImages(thorax(), poses, s).empty());
}

} // namespace
