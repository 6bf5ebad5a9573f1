#include "FieldScenes.h"
#include "GpuThorax.h"
#include "Probe/PulseFile.h"
#include "TestScenes.h"

#include <cmath>
#include <complex>

namespace {

using namespace sono;
using namespace sono::test;

TEST(GpuEcho, BeamsOfAnApertureAndOfAnArray)
{
  SONO_GPU_OR_SKIP();
  for (const InterfaceModel model : { InterfaceModel::Acoustic, InterfaceModel::Amadou2024 })
  {
    ImageSettings s = thoraxSettings();
    s.tracing.model = model; // in Amadou2024 the beam of one width, whatever the aperture
    s.tracing.maxCollisions = 4;
    s.tracing.pathsPerLine = model == InterfaceModel::Amadou2024 ? 8000 : 1000;
    s.echo.aperture = namedAperture();
    expectSameRf(thoraxChain(s, Device::Cuda), thoraxChain(s, Device::Cpu),
                 "aperture, model " + std::to_string(int(model)));
    s.geometry.lineCount = 16;
    s.echo.arrayField = computedBeam(s.echo.depthMm);
    expectSameRf(thoraxChain(s, Device::Cuda), thoraxChain(s, Device::Cpu),
                 "array, model " + std::to_string(int(model)));
  }
}

TEST(GpuEcho, AttenuationLowersTheFrequency)
{
  SONO_GPU_OR_SKIP();
  // A uniform tissue: the mean turn of the phase from sample to sample is that of the frequency that (12.5) says.
  Tissue tissue = makeTissue("soft", 1.6, 1540.0, 0.5);
  tissue.scattererMean = 0.0; // a mean would add up to what does not vary, which the low frequencies contain
  tissue.scattererSigma = 1.0;
  tissue.scattererProbability = 1.0;
  const auto scene = makeScene(Vec3i(60, 60, 110), Vec3d(1.0), { tissue }, [](const Vec3d&) { return 0; });
  TraceSettings tracing;
  EchoSettings echo;
  tracing.depthMm = echo.depthMm = 105.0;
  tracing.frequencyMHz = echo.centreFrequencyMHz = 3.6;
  echo.fractionalBandwidth = 0.74;
  echo.samplingMHz = 50.0; // the frequency is told by neighbouring samples
  tracing.pathsPerLine = 16;
  std::vector<ScanLine> lines;
  for (int l = 0; l < 64; ++l)
  {
    lines.push_back(makeLine({ 10.0 + 0.6 * l, 30.0, 0.0 }, { 0.0, 0.0, 1.0 }));
  }
  const EchoSources sources{ scene.get(), nullptr, nullptr };
  const Chain gpu = runChain(sources, lines, tracing, echo, Device::Cuda);
  expectSameRf(gpu, runChain(sources, lines, tracing, echo, Device::Cpu), "downshift");
  const double depthMm = 90.0;
  const int middle = int(depthMm / gpu.rf.sampleMm);
  std::complex<double> turned = 0.0;
  for (int l = 0; l < gpu.rf.lineCount; ++l)
  {
    const auto* iq = gpu.rf.iq.data() + std::size_t(l) * std::size_t(gpu.rf.sampleCount);
    for (int s = middle - 400; s < middle + 400; ++s)
    {
      turned += std::complex<double>(iq[s + 1]) * std::conj(std::complex<double>(iq[s]));
    }
  }
  const double shiftMHz = std::arg(turned) / (2.0 * M_PI) * gpu.rf.samplingMHz;
  const double spectrumMHz = 0.74 * 3.6 / (2.0 * std::sqrt(2.0 * 0.3 * std::log(10.0)));
  const double exponent = 2.0 * 0.5 * depthMm / 10.0 / (20.0 / std::log(10.0));
  EXPECT_NEAR(shiftMHz, -exponent * spectrumMHz * spectrumMHz, 0.05);
}

TEST(GpuEcho, TheReferenceLeavesOutTheFirstMillimetres)
{
  SONO_GPU_OR_SKIP();
  ImageInput input{ thoraxPhantomA4C().orthonormalized(), thoraxSettings(), {}, nullptr };
  const auto reference = [&](Device device) {
    input.settings.setDevice(device);
    Simulator simulator(borrowed(&thorax()));
    return simulator.bmode(input).host().referenceAmplitude;
  };
  const double cpu = reference(Device::Cpu);
  EXPECT_NEAR(reference(Device::Cuda), cpu, 1e-3 * cpu);
}

TEST(GpuEcho, ExplicitScatterers)
{
  SONO_GPU_OR_SKIP();
  const SceneS1 s1(200000);
  const PointScatterers points(s1.points);
  const EchoSources sources{ nullptr, nullptr, &points };
  const Chain gpu = runChain(sources, s1.lines, {}, s1.settings, Device::Cuda);
  expectSameRf(gpu, runChain(sources, s1.lines, {}, s1.settings, Device::Cpu), "points");
  EchoSettings wide = s1.settings;
  wide.aperture = namedAperture();
  expectSameRf(runChain(sources, s1.lines, {}, wide, Device::Cuda), runChain(sources, s1.lines, {}, wide, Device::Cpu),
               "points, aperture");
  wide.arrayField = computedBeam(wide.depthMm);
  expectSameRf(runChain(sources, s1.lines, {}, wide, Device::Cuda), runChain(sources, s1.lines, {}, wide, Device::Cpu),
               "points, array");
  // Against the direct sum, as the CPU is.
  for (const int line : { 5, 77 })
  {
    const auto reference = directIq(s1.points, s1.lines[std::size_t(line)], s1.settings);
    EXPECT_LE(nrmse(gpu.rf.iq.data() + std::size_t(line) * reference.size(), reference), 1e-3) << line;
  }
}

TEST(GpuEcho, AFieldAndASampledPulse)
{
  SONO_GPU_OR_SKIP();
  ImageSettings s = thoraxSettings();
  s.geometry.lineCount = 16;
  s.echo.samplingMHz = 50.0; // what that pulse begins with
  s.matchStages();
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

} // namespace
