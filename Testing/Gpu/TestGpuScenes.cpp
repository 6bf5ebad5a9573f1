#include "FieldScenes.h"
#include "GpuParity.h"
#include "Probe/PulseFile.h"
#include "RelativeRms.h"
#include "TargetScenes.h"
#include "TestScenes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

namespace {

using namespace sono;
using namespace sono::test;

/// Random balls of random tissues, seen from random places with random settings.
class RandomScene
{
public:
  explicit RandomScene(unsigned seed)
    : random_(seed)
  {
    const int count = 2 + int(random_() % 5);
    for (int t = 0; t < count; ++t)
    {
      Tissue tissue =
        makeTissue("t" + std::to_string(t), between(1.3, 2.2), between(1400.0, 1700.0), between(0.0, 1.5));
      tissue.scattererMean = between(0.0, 1.0);
      tissue.scattererSigma = between(0.0, 1.0);
      tissue.scattererProbability = between(0.0, 1.0);
      tissue.tau = random_() % 3 ? 1.0 : between(0.5, 2.5);
      tissue.gamma = random_() % 3 ? 0.0 : between(-1.0, 1.0);
      tissue.roughnessMm = random_() % 3 ? between(0.0, 0.3) : 0.0;
      tissue.correlationMm = between(0.2, 3.0);
      tissues_.push_back(tissue);
    }
    const Vec3i size(12 + int(random_() % 20), 12 + int(random_() % 20), 20 + int(random_() % 20));
    const Vec3d spacing(between(0.4, 1.2), between(0.4, 1.2), between(0.4, 1.2));
    extent_ = Vec3d(size) * spacing;
    std::vector<std::pair<Vec3d, double>> balls;
    for (int b = 0; b < 6; ++b)
    {
      balls.push_back({ Vec3d(between(0, 1), between(0, 1), between(0, 1)) * extent_, between(1.0, 8.0) });
    }
    scene = makeScene(size, spacing, tissues_, [&](const Vec3d& p) {
      int label = 0;
      for (std::size_t b = 0; b < balls.size(); ++b)
      {
        label = glm::length(p - balls[b].first) < balls[b].second ? int(b) % count : label;
      }
      return label;
    });
    makeSettings();
    for (int l = 0; l < 6; ++l)
    {
      const Vec3d origin(between(0.2, 0.8) * extent_.x, between(0.2, 0.8) * extent_.y, -between(0.0, 3.0));
      lines.push_back(makeLine(origin, { between(-0.4, 0.4), between(-0.4, 0.4), 1.0 }));
    }
    if (random_() % 2)
    {
      const Vec3d low(between(0.3, 0.5) * extent_.x, between(0.3, 0.5) * extent_.y, between(0.3, 0.5) * extent_.z);
      targets.push_back(makeBox("needle", makeTissue("steel", 46.0, 5900.0, 0.1), low, low + Vec3d(2.1, 3.2, 1.7)));
    }
  }

  std::unique_ptr<Scene> scene;
  std::vector<ScanLine> lines;
  std::vector<TargetSurface> targets;
  TraceSettings tracing;
  EchoSettings echo;

private:
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  void makeSettings()
  {
    // Scene 66, where much is attenuated, is 0.9e-3 apart at 50 MHz and 1.2e-3 at 20 to 30; by seeds of paths up
    // to 1.6e-3.
    echo.samplingMHz = 50.0;
    echo.depthMm = tracing.depthMm = between(0.5, 1.2) * extent_.z;
    tracing.echoSampleMm = random_() % 2 ? echo.sampleMm() : 0.01;
    tracing.model = random_() % 4 ? InterfaceModel::Acoustic : InterfaceModel::Amadou2024;
    tracing.sampling = random_() % 2 ? Sampling::LowDiscrepancy : Sampling::Independent;
    tracing.deterministic = random_() % 6 == 0;
    tracing.pathsPerLine = 8000 + int(random_() % 1000); // so many that none counts alone
    tracing.maxCollisions = int(random_() % 12);
    tracing.coherenceMm = between(0.1, 50.0);
    tracing.lobeSigmaDeg = random_() % 4 ? between(0.01, 1.0) * 180.0 / M_PI : 0.0;
    tracing.radialBinMm = between(0.1, 0.6);
    tracing.seed = random_();
    echo.seed = random_();
    echo.lateralSigmaMm = between(0.4, 2.0);
    echo.elevationalSigmaMm = between(0.4, 2.0);
    echo.scattererCellMm = between(0.3, 0.8);
    if (random_() % 2)
    {
      echo.aperture = { between(3.0, 25.0), between(3.0, 20.0), random_() % 4 ? between(5.0, 60.0) : 0.0,
                        between(0.0, 60.0), between(0.1, 0.6),  random_() % 3 == 0 };
    }
  }

  std::mt19937 random_;
  std::vector<Tissue> tissues_;
  Vec3d extent_{ 0.0 };
};

/// Of the second's rms. What is far below any echo, a mirror's being 1, is nothing: a device sums in units of some
/// 1e-12.
template<class Values>
void expectClose(const Values& gpu, const Values& cpu, double most, const std::string& what)
{
  constexpr double nothing = 1e-9;
  ASSERT_EQ(gpu.size(), cpu.size()) << what;
  const auto loudest = [](const Values& values) {
    return std::accumulate(values.begin(), values.end(), 0.0,
                           [](double so, auto value) { return std::max(so, double(std::abs(value))); });
  };
  if (loudest(cpu) < nothing)
  {
    EXPECT_LE(loudest(gpu), 2.0 * loudest(cpu)) << what;
    return;
  }
  const double apart = relativeRms(gpu, cpu);
  std::printf("%s: %.2g\n", what.c_str(), apart);
  EXPECT_LE(apart, most) << what;
}

/// Of the direct sound the RF; of what reverberates the boundaries' echoes, the levels and what the media have taken.
/// Rounding that moves an echo by 5e-5 mm of range puts 0.005 of it into the next sample of 0.01 mm.
void expectAgreement(const RandomScene& random, unsigned seed)
{
  const EchoSources sources{ random.scene.get(), nullptr, nullptr };
  const auto run = [&](Device device, bool reverberation) {
    TraceSettings tracing = random.tracing;
    tracing.reverberation = reverberation;
    return runChain(sources, random.lines, tracing, random.echo, device, random.targets);
  };
  const std::string scene = "scene " + std::to_string(seed);
  expectSameRf(run(Device::Cuda, false), run(Device::Cpu, false), scene);
  const TracedLines gpu = run(Device::Cuda, true).traced;
  const TracedLines cpu = run(Device::Cpu, true).traced;
  ASSERT_EQ(gpu.reverberation.size(), cpu.reverberation.size()) << scene;
  expectClose(gpu.boundaryEcho, cpu.boundaryEcho, 0.005, scene + ", echoes of boundaries");
  expectClose(gpu.reverberation, cpu.reverberation, 0.001, scene + ", levels");
  expectClose(gpu.reverberationNpPerMHz, cpu.reverberationNpPerMHz, 0.001, scene + ", taken");
}

/// Small enough for compute-sanitizer (see run-gpu.sh); together they run every kernel.
TEST(GpuSmall, EveryKindOfBeam)
{
  SONO_GPU_OR_SKIP();
  RandomScene random(7);
  random.tracing.model = InterfaceModel::Acoustic;
  random.tracing.pathsPerLine = 60;
  random.tracing.maxCollisions = 4;
  random.lines.resize(3);
  const PointScatterers points({ { { 5.0, 5.0, 5.0 }, 1.0f }, { { 6.0, 5.5, 9.0 }, -0.5f } });
  const EchoSources sources{ random.scene.get(), nullptr, &points };
  const auto expectSame = [&](const char* what) {
    expectSameRf(runChain(sources, random.lines, random.tracing, random.echo, Device::Cuda),
                 runChain(sources, random.lines, random.tracing, random.echo, Device::Cpu), what);
  };
  random.echo.aperture = namedAperture();
  expectSame("aperture");
  ArrayAperture few;
  few.elementCount = 8;
  few.elementHeightMm = 3.0;
  few.transmitFocusMm = 12.0;
  few.elevationFocusMm = 12.0;
  random.echo.arrayField = std::make_shared<const ArrayField>(few, random.echo.depthMm);
  expectSame("array");
}

TEST(GpuSmall, UnusualSettings)
{
  SONO_GPU_OR_SKIP();
  RandomScene random(5);
  random.tracing.pathsPerLine = 1500; // several slices of a batch
  random.tracing.maxCollisions = 3;
  random.tracing.radialBinMm = random.tracing.depthMm / 8000.0; // too many for shared memory
  FieldGrid grid;
  grid.lateral = { 0.0, 0.5, 6 };
  grid.elevational = { -2.0, 1.0, 5 };
  grid.depth = { 0.0, 4.0, 40 };
  random.echo.field = tabulate(grid, [](double l, double e, double) { return std::exp(-0.3 * (l * l + e * e)); });
  SampledPulse pulse;
  pulse.startUs = -0.8;
  pulse.stepUs = 0.01;
  for (int i = 0; i <= 160; ++i)
  {
    const double t = pulse.startUs + i * pulse.stepUs; // a chirp: its envelope is complex
    pulse.amplitude.push_back(std::exp(-8.0 * t * t) * std::cos(2.0 * M_PI * (2.5 + 0.4 * t) * t));
  }
  random.echo.pulse = std::make_shared<SampledPulse>(pulse);
  random.lines.resize(2);
  expectAgreement(random, 5);
  ImageSettings settings;
  settings.geometry.lineCount = 3;
  settings.geometry.depthMm = 10.0;
  settings.tracing.pathsPerLine = 20;
  settings.bmode.automaticReference = false;
  settings.matchStages();
  settings.setDevice(Device::Cuda);
  const ProbePose pose{ { 6.0, 6.0, 0.0 } };
  Simulator simulator(borrowed(random.scene.get()));
  int images = 0;
  simulator.sweep({ pose, pose, pose }, settings, true, [&](const SweptPictures& p) { images += p.count; });
  EXPECT_EQ(images, 3);
}

TEST(GpuSmall, EveryUsualKernel)
{
  SONO_GPU_OR_SKIP();
  RandomScene random(3);
  random.tracing.pathsPerLine = 100;
  expectAgreement(random, 3);
  const PointScatterers points({ { { 5.0, 5.0, 5.0 }, 1.0f }, { { 6.0, 5.5, 9.0 }, -0.5f } });
  const EchoSources sources{ random.scene.get(), nullptr, &points };
  expectSameRf(runChain(sources, random.lines, random.tracing, random.echo, Device::Cuda),
               runChain(sources, random.lines, random.tracing, random.echo, Device::Cpu), "points");
  ImageSettings settings;
  settings.geometry.lineCount = 5;
  settings.geometry.depthMm = 12.0;
  settings.tracing.pathsPerLine = 50;
  settings.bmode.addNoise = true;
  settings.bmode.addHaze = true;
  settings.bmode.axialSmoothingMm = 0.3;
  settings.bmode.lateralSmoothingLines = 1.5;
  settings.bmode.noiseDb = -60.0;
  settings.matchStages();
  settings.setDevice(Device::Cuda);
  EXPECT_EQ(imagesOf(*random.scene, { ProbePose{ { 6.0, 6.0, 0.0 } } }, settings).size(), 1u);
}

TEST(GpuScenes, AHundredRandomScenesAgreeWithTheCpu)
{
  SONO_GPU_OR_SKIP();
  for (unsigned seed = 1; seed <= 100; ++seed)
  {
    expectAgreement(RandomScene(seed), seed);
  }
}

} // namespace
