#include "GpuThorax.h"
#include "Image/GreyBytes.h"
#include "Image/LabelSlice.h"
#include "RelativeRms.h"
#include "TestScenes.h"

#include <cmath>

namespace {

using namespace sono;
using namespace sono::test;

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

TEST(GpuStages, WeightsOverOrdersOfMagnitudeWithManySeeds)
{
  SONO_GPU_OR_SKIP();
  // The seed's equations give some paths a thousand times the weight of others, so a single one of the half a million
  // that rounding sends another way shows. The CPU's own two marches, which differ in rounding alone, part as well: of
  // these seeds four. So a device may, but no more often, and what has not parted agrees closely.
  std::vector<double> differences;
  int parted = 0;
  int partedOnCpu = 0;
  for (const Sampling sampling : { Sampling::LowDiscrepancy, Sampling::Independent })
  {
    for (std::uint64_t seed = 1; seed <= 10; ++seed)
    {
      ImageSettings s = thoraxSettings();
      s.tracing.model = InterfaceModel::Amadou2024;
      s.tracing.sampling = sampling;
      s.tracing.seed = seed;
      s.tracing.pathsPerLine = 8000;
      s.tracing.maxCollisions = 3;
      const Chain gpu = thoraxChain(s, Device::Cuda);
      const Chain cpu = thoraxChain(s, Device::Cpu);
      s.tracing.march = March::NanoVDB;
      const double own = rfDifference(thoraxChain(s, Device::Cpu).rf, cpu.rf);
      differences.push_back(rfDifference(gpu.rf, cpu.rf));
      std::printf("sampling %d, seed %d: %.2g, the CPU's own two marches %.2g\n", int(sampling), int(seed),
                  differences.back(), own);
      parted += differences.back() > rfTolerance;
      partedOnCpu += own > rfTolerance;
    }
  }
  EXPECT_LE(parted, partedOnCpu);
  std::sort(differences.begin(), differences.end());
  EXPECT_LT(differences[differences.size() / 2], 0.2 * rfTolerance);
}

TEST(GpuStages, ManyCollisionsManyPathsFineBins)
{
  SONO_GPU_OR_SKIP();
  ImageSettings s = thoraxSettings();
  s.tracing.maxCollisions = 40;
  s.tracing.coherenceMm = 20.0;
  s.geometry.lineCount = 4; // few lines: batches are cut into slices
  s.tracing.pathsPerLine = 20001;
  expectSameRf(thoraxChain(s, Device::Cuda), thoraxChain(s, Device::Cpu), "20001 paths");
  s.tracing.pathsPerLine = 8000; // so many that none counts alone in a surface's echo
  s.tracing.radialBinMm = 0.01;  // 16640 bins do not fit in shared memory
  expectSameRf(thoraxChain(s, Device::Cuda), thoraxChain(s, Device::Cpu), "16640 bins");
  s.tracing.pathsPerLine = 3; // fewer than the batches
  s.tracing.radialBinMm = 0.25;
  expectSameRf(thoraxChain(s, Device::Cuda), thoraxChain(s, Device::Cpu), "3 paths");
}

TEST(GpuStages, TheIntensityAndItsErrorAgree)
{
  SONO_GPU_OR_SKIP();
  ImageSettings s = thoraxSettings();
  s.tracing.reverberation = true;
  for (const BeamAperture& aperture : { BeamAperture(), namedAperture() })
  {
    s.echo.aperture = aperture;
    const TracedLines gpu = thoraxChain(s, Device::Cuda).traced;
    const TracedLines cpu = thoraxChain(s, Device::Cpu).traced;
    EXPECT_NEAR(double(gpu.segments), double(cpu.segments), 1e-4 * double(cpu.segments));
    double worst = 0.0;
    for (std::size_t i = 0; i < cpu.intensity.size(); ++i)
    {
      // A path or two of a thousand that went another way.
      ASSERT_NEAR(gpu.intensity[i], cpu.intensity[i], 2e-3) << i;
      ASSERT_NEAR(gpu.standardError[i], cpu.standardError[i], 2e-3) << i;
      worst = std::max(worst, std::abs(double(gpu.intensity[i]) - cpu.intensity[i]));
    }
    std::printf("intensity, %s: %.2g\n", aperture.isNamed() ? "aperture" : "along the axis", worst);
    ASSERT_EQ(gpu.reverberation.size(), cpu.reverberation.size());
    const double apart = relativeRms(gpu.reverberation, cpu.reverberation); // not a number where nothing reverberates
    std::printf("reverberation: %.2g\n", apart);
    EXPECT_LT(apart, 0.01);
  }
}

TEST(GpuStages, TheAttenuationAgrees)
{
  SONO_GPU_OR_SKIP();
  ImageSettings s = thoraxSettings();
  const TracedLines gpu = thoraxChain(s, Device::Cuda).traced;
  const TracedLines cpu = thoraxChain(s, Device::Cpu).traced;
  ASSERT_EQ(gpu.attenuationNpPerMHz.size(), cpu.attenuationNpPerMHz.size());
  double squared = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < cpu.attenuationNpPerMHz.size(); ++i)
  {
    const double weight = double(cpu.intensity[i]);
    squared += weight * std::pow(double(gpu.attenuationNpPerMHz[i]) - cpu.attenuationNpPerMHz[i], 2);
    sum += weight * std::pow(double(cpu.attenuationNpPerMHz[i]), 2);
  }
  ASSERT_GT(sum, 0.0);
  EXPECT_LT(std::sqrt(squared / sum), 1e-3);

  s.tracing.model = InterfaceModel::Amadou2024;
  for (const Device device : { Device::Cpu, Device::Cuda })
  {
    const std::vector<float> none = thoraxChain(s, device).traced.attenuationNpPerMHz;
    EXPECT_EQ(none, std::vector<float>(none.size(), 0.0f)) << int(device);
  }
}

TEST(GpuStages, RoughBoundaries)
{
  SONO_GPU_OR_SKIP();
  // Of the same thorax: all that is rough is rough in the same way, between almost smooth and steeper than any tissue.
  for (const auto& [heightMm, lengthMm] :
       std::vector<std::pair<double, double>>{ { 0.02, 1.0 }, { 0.1, 1.0 }, { 0.3, 0.8 } })
  {
    std::vector<Tissue> tissues = { makeTissue("a", 1.5, 1540, 0.5), makeTissue("b", 1.7, 1590, 0.7),
                                    makeTissue("c", 2.9, 2400, 2.0) };
    for (Tissue& t : tissues)
    {
      t.roughnessMm = heightMm;
      t.correlationMm = lengthMm;
      t.scattererMean = 1.0;
      t.scattererProbability = 1.0;
    }
    const auto scene = makeScene(Vec3i(60, 60, 80), Vec3d(0.5), tissues, [](const Vec3d& p) {
      const double ball = glm::length(p - Vec3d(15.0, 15.0, 22.0));
      return ball < 4.0 ? 2 : (ball < 9.0 ? 1 : 0);
    });
    TraceSettings tracing;
    EchoSettings echo;
    tracing.depthMm = echo.depthMm = 38.0;
    tracing.pathsPerLine = 4000;
    std::vector<ScanLine> lines;
    for (int l = 0; l < 12; ++l)
    {
      lines.push_back(makeLine({ 9.0 + l, 15.0, -1.0 }, { 0.03 * (l - 6), 0.02, 1.0 }));
    }
    const EchoSources sources{ scene.get(), nullptr, nullptr };
    expectSameRf(runChain(sources, lines, tracing, echo, Device::Cuda),
                 runChain(sources, lines, tracing, echo, Device::Cpu), "rough by " + std::to_string(heightMm));
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

TEST(GpuStages, WholeImagesAndSweeps)
{
  SONO_GPU_OR_SKIP();
  ImageSettings s = thoraxSettings();
  s.bmode.addNoise = true;
  s.bmode.noiseDb = -80.0;
  s.bmode.addHaze = true;
  s.bmode.axialSmoothingMm = 0.3;
  s.bmode.lateralSmoothingLines = 1.5;
  std::vector<ProbePose> poses;
  for (int i = 0; i < 21; ++i) // a group and a part of one
  {
    ProbePose pose = thoraxPhantomA4C().orthonormalized();
    pose.axial += 0.01 * i * pose.lateral;
    poses.push_back(pose.orthonormalized());
  }
  const std::vector<ProbePose> some{ poses[0], poses[9], poses[20] };
  s.setDevice(Device::Cpu);
  const auto cpu = imagesOf(thorax(), some, s);
  s.setDevice(Device::Cuda);
  const auto gpu = imagesOf(thorax(), some, s);
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
  }

  // A sweep's pictures are those of its poses, and so are its labels.
  Simulator simulator(borrowed(&thorax()));
  int seen = 0;
  simulator.sweep(poses, s, true, [&](const SweptPictures& pictures) {
    for (int n = 0; n < pictures.count; ++n, ++seen)
    {
      EXPECT_EQ(pictures.firstPose + n, seen);
      Simulator alone(borrowed(&thorax()));
      const ImageInput input{ poses[std::size_t(seen)], s, {}, nullptr };
      const ScanPicture picture =
        alone.picture(alone.image(input), input.settings.geometry, input.pose, alone.traced(input));
      const std::size_t first = std::size_t(n) * picture.grey.size;
      int differing = 0;
      for (std::size_t p = 0; p < picture.grey.size; ++p)
      {
        // The regions may differ, and with them the rounding of places.
        differing += std::abs(int(picture.grey[p]) - int(pictures.grey[first + p])) > 1;
        ASSERT_EQ(picture.labels[p], pictures.labels[first + p]) << seen << " " << p;
        ASSERT_EQ(picture.mask[p], pictures.mask[p]) << seen << " " << p;
      }
      EXPECT_LE(differing, int(picture.grey.size / 1000)) << seen;
    }
  });
  EXPECT_EQ(seen, int(poses.size()));
}

TEST(GpuStages, SmoothedLevelsAreTheCpus)
{
  SONO_GPU_OR_SKIP();
  ImageInput input{ thoraxPhantomA4C().orthonormalized(), thoraxSettings(), {}, nullptr };
  BModeSettings& display = input.settings.bmode;
  display.axialSmoothingMm = 0.3;
  display.lateralSmoothingLines = 1.5;
  display.greyMap = { 0.0f, 0.2f, 0.7f, 1.0f };
  input.settings.setDevice(Device::Cuda);
  for (const bool ofLevels : { false, true })
  {
    display.smoothCompressed = ofLevels;
    Simulator simulator(borrowed(&thorax()));
    const BModeLines gpu = simulator.bmode(input).host();
    const RfLines rf = simulator.rf(input).host();
    // Of the same lines, so that no path of another way is in between.
    const BModeLines cpu = makeBMode(rf.envelope(), rf.lineCount, rf.sampleCount, rf.sampleMm, display);
    ASSERT_EQ(gpu.grey.size(), cpu.grey.size());
    float most = 0.0f;
    for (std::size_t i = 0; i < cpu.grey.size(); ++i)
    {
      most = std::max(most, std::fabs(gpu.grey[i] - cpu.grey[i]));
    }
    EXPECT_LE(most, 1e-3f) << ofLevels;
  }
}

TEST(GpuStages, APictureIsItsLevelsInBytesAndHasTheCpusLabels)
{
  SONO_GPU_OR_SKIP();
  for (const double assumedMPerS : { 1540.0, 1450.0 })
  {
    ImageInput input{ thoraxPhantomA4C().orthonormalized(), thoraxSettings(), {}, nullptr };
    input.settings.geometry.assumedSoundSpeedMPerS = assumedMPerS;
    input.settings.matchStages();
    input.settings.setDevice(Device::Cuda);
    Simulator simulator(borrowed(&thorax()));
    const ImageResult image = simulator.image(input);
    const ScanPicture picture = simulator.picture(image, input.settings.geometry, input.pose, simulator.traced(input));
    const TracedLines& traced = simulator.traced(input).host();
    const PlaneImage& levels = image.plane().host(); // which WholeImagesAndSweeps holds against the CPU's
    const auto same = [](const auto& span, const auto& expected) {
      return std::vector<std::decay_t<decltype(expected[0])>>(span.begin(), span.end()) == expected;
    };
    EXPECT_TRUE(same(picture.mask, levels.mask));
    EXPECT_TRUE(same(picture.grey, greyBytes(levels.value, levels.mask)));
    EXPECT_TRUE(same(picture.labels, sliceLabels(thorax().volume(), input.settings.geometry, input.pose, levels,
                                                 { &traced.depthOffsetMm, traced.binCount, traced.binMm })));
  }
}

TEST(GpuStages, HandlesStayWhatTheyWere)
{
  SONO_GPU_OR_SKIP();
  Simulator simulator(borrowed(&thorax()));
  ImageInput input{ thoraxPhantomA4C().orthonormalized(), thoraxSettings(), {}, nullptr };
  input.settings.setDevice(Device::Cuda);
  std::vector<TracedResult> traced;
  std::vector<RfResult> rf;
  std::vector<BModeResult> bmode;
  std::vector<ImageResult> images;
  for (int seed = 1; seed <= 4; ++seed) // none is looked at before the last was made
  {
    input.settings.tracing.seed = std::uint64_t(seed);
    traced.push_back(simulator.traced(input));
    rf.push_back(simulator.rf(input));
    bmode.push_back(simulator.bmode(input));
    images.push_back(simulator.image(input));
  }
  for (int seed = 1; seed <= 4; ++seed)
  {
    Simulator alone(borrowed(&thorax()));
    input.settings.tracing.seed = std::uint64_t(seed);
    const std::size_t n = std::size_t(seed - 1);
    EXPECT_EQ(traced[n].host().intensity, alone.traced(input).host().intensity) << seed;
    EXPECT_EQ(traced[n].host().boundaryEcho, alone.traced(input).host().boundaryEcho) << seed;
    EXPECT_EQ(rf[n].host().iq, alone.rf(input).host().iq) << seed;
    EXPECT_EQ(bmode[n].host().grey, alone.bmode(input).host().grey) << seed;
    EXPECT_EQ(images[n].plane().host().value, alone.image(input).plane().host().value) << seed;
  }
  EXPECT_NE(images[0].plane().host().value, images[1].plane().host().value);
}

TEST(GpuStages, AStageTakesWhatLiesOnTheHost)
{
  SONO_GPU_OR_SKIP();
  const ImageSettings s = thoraxSettings();
  const auto lines = makeScanLines(s.geometry, thoraxPhantomA4C().orthonormalized());
  TraceSettings tracing = s.tracing;
  tracing.device = Device::Cpu;
  EchoSettings echo = s.echo;
  echo.device = Device::Cuda;
  Simulator simulator(borrowed(&thorax()));
  const TracedResult traced = simulator.trace(lines, tracing);
  const RfResult gpu = simulator.formRf(lines, traced, echo);
  EXPECT_TRUE(gpu.onDevice());
  const RfLines cpu = formRf(thorax(), lines, traced.host(), echo);
  EXPECT_LE(rfDifference(gpu.host(), cpu), rfTolerance);
  // The other way: traced on the GPU, formed on the CPU.
  tracing.device = Device::Cuda;
  echo.device = Device::Cpu;
  const RfResult back = simulator.formRf(lines, simulator.trace(lines, tracing), echo);
  EXPECT_FALSE(back.onDevice());
  EXPECT_LE(rfDifference(back.host(), cpu), rfTolerance);
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
    s.geometry.compoundFans = 3; // of linear and curvilinear
    s.geometry.assumedSoundSpeedMPerS = 1480.0;
    s.tracing.pathsPerLine = 200;
    s.bmode.automaticReference = false;
    s.bmode.referenceAmplitude = 0.05;
    s.bmode.greyMap = { 0.0f, 0.1f, 0.5f, 0.9f, 1.0f };
    s.bmode.tgcDb = { 3.0, 0.0, -2.0, 1.0, 5.0, -4.0, 0.0, 2.0 };
    s.bmode.lateralGainDb = { 4.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0, 3.0 };
    s.matchStages();
    const std::vector<ProbePose> poses{ thoraxPhantomA4C().orthonormalized() };
    s.setDevice(Device::Cpu);
    const PlaneImage cpu = imagesOf(thorax(), poses, s).front();
    s.setDevice(Device::Cuda);
    const PlaneImage gpu = imagesOf(thorax(), poses, s).front();
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
  s.setDevice(Device::Cuda);
  const std::vector<ProbePose> poses(40, thoraxPhantomA4C().orthonormalized());
  int asked = 0;
  EXPECT_THROW(imagesOf(thorax(), { poses[0] }, s,
                        [&](double f) {
                          ++asked;
                          return f < 0.2;
                        }),
               Aborted);
  EXPECT_GT(asked, 0);
  EXPECT_FALSE(imagesOf(thorax(), { poses[0] }, s).empty());

  Simulator simulator(borrowed(&thorax()));
  int delivered = 0;
  EXPECT_THROW(simulator.sweep(
                 poses, s, false, [&](const SweptPictures& pictures) { delivered += pictures.count; },
                 [](double f) { return f < 0.5; }),
               Aborted);
  EXPECT_GT(delivered, 0);
  EXPECT_LT(delivered, 40);
  EXPECT_FALSE(imagesOf(thorax(), { poses[0] }, s).empty());
}

} // namespace
