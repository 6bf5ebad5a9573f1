#include "FieldScenes.h"
#include "GpuParity.h"
#include "PhantomScene.h"
#include "Phantoms/ThoraxPhantom.h"
#include "TargetScenes.h"
#include "TestScenes.h"

#include <cmath>

// Scatterers of tissues and echoes of surfaces in Acoustic, each alone and together: GPU against CPU.

namespace {

using namespace sono;
using namespace sono::test;

enum class Echoes
{
  Scatterers,
  Surfaces
};

/// A ball of one tissue in another that differ in impedance or in backscatter, smooth or rough.
std::unique_ptr<Scene> ballScene(Echoes echoes, double roughnessMm)
{
  std::vector<Tissue> tissues{ makeTissue("blood", 1.6, 1540.0, 0.3), makeTissue("muscle", 1.6, 1540.0, 0.6) };
  for (Tissue& t : tissues)
  {
    t.roughnessMm = roughnessMm;
    t.correlationMm = 1.0;
    if (echoes == Echoes::Scatterers)
    {
      t.scattererSigma = 1.0;
      t.scattererProbability = 0.7;
      t.backscatterPerCmSr = t.name == "muscle" ? 1e-4 : 1e-6;
      t.backscatterExponent = 3.0;
      t.fibreAnisotropyDb = t.name == "muscle" ? 14.5 : 0.0;
    }
  }
  if (echoes == Echoes::Surfaces)
  {
    tissues[1].impedanceMRayl = 1.7;
  }
  return makeScene(Vec3i(64, 64, 70), Vec3d(0.7), tissues, [](const Vec3d& p) {
    const double r = glm::length(p - Vec3d(22.0, 22.0, 25.0));
    return r < 14.0 && r > 7.0 ? 1 : 0; // blood inside and outside of a wall
  });
}

std::vector<ScanLine> fan(int count)
{
  std::vector<ScanLine> lines;
  for (int l = 0; l < count; ++l)
  {
    const double place = double(l) / (count - 1) - 0.5;
    lines.push_back(makeLine({ 22.0 + 16.0 * place, 22.0, -0.5 }, { 0.5 * place, 0.05, 1.0 }));
  }
  return lines;
}

struct Settings
{
  TraceSettings tracing;
  EchoSettings echo;
};

Settings fanSettings()
{
  Settings s;
  s.tracing.depthMm = s.echo.depthMm = 46.0;
  s.tracing.pathsPerLine = 1000;
  return s;
}

void expectSame(const Scene& scene, const std::vector<ScanLine>& lines, const Settings& s, const std::string& what,
                const std::vector<TargetSurface>& targets = {})
{
  const EchoSources sources{ &scene, nullptr, nullptr };
  const Chain gpu = runChain(sources, lines, s.tracing, s.echo, Device::Cuda, targets);
  const Chain cpu = runChain(sources, lines, s.tracing, s.echo, Device::Cpu, targets);
  float peak = 0.0f;
  for (const auto& v : cpu.rf.iq)
  {
    peak = std::max(peak, std::abs(v));
  }
  EXPECT_GT(peak, 1e-7f) << what; // there is something to compare
  expectSameRf(gpu, cpu, what);
}

TEST(GpuAcoustic, ScatterersWithFibresInEveryBeam)
{
  SONO_GPU_OR_SKIP();
  const auto scene = ballScene(Echoes::Scatterers, 0.0);
  Settings s = fanSettings();
  ASSERT_NE(scene->fibres(), nullptr);
  expectSame(*scene, fan(24), s, "scatterers, Gaussian");
  s.echo.aperture = namedAperture();
  expectSame(*scene, fan(24), s, "scatterers, aperture");
  s.echo.arrayField = computedBeam(s.echo.depthMm);
  expectSame(*scene, fan(8), s, "scatterers, array");
}

TEST(GpuAcoustic, ScatterersFollowAScan)
{
  SONO_GPU_OR_SKIP();
  const auto plain = ballScene(Echoes::Scatterers, 0.0);
  std::vector<std::uint8_t> detail(plain->tissueVoxels().size());
  for (std::size_t at = 0; at < detail.size(); ++at)
  {
    detail[at] = std::uint8_t(48 + (at * 2654435761u >> 8) % 160); // -10 to 10 dB
  }
  TissueTable table;
  for (const Tissue& tissue : plain->tissues())
  {
    table.add(tissue);
  }
  const Scene scene(plain->volume(), table, "none", detail);
  Settings s = fanSettings();
  s.echo.aperture = namedAperture();
  expectSame(scene, fan(24), s, "scan's detail, Acoustic");
  s.tracing.model = InterfaceModel::Amadou2024;
  expectSame(scene, fan(24), s, "scan's detail, Amadou2024");
}

TEST(GpuAcoustic, SurfacesInEveryBeam)
{
  SONO_GPU_OR_SKIP();
  for (const double roughnessMm : { 0.0, 0.03, 0.3 })
  {
    const auto scene = ballScene(Echoes::Surfaces, roughnessMm);
    const std::string what = "surfaces, rough by " + std::to_string(roughnessMm);
    Settings s = fanSettings();
    expectSame(*scene, fan(24), s, what + ", Gaussian");
    s.echo.aperture = namedAperture();
    expectSame(*scene, fan(24), s, what + ", aperture");
    s.echo.arrayField = computedBeam(s.echo.depthMm);
    expectSame(*scene, fan(8), s, what + ", array");
  }
}

TEST(GpuAcoustic, TheThoraxFromTheSameTracedLines)
{
  SONO_GPU_OR_SKIP();
  // Paths that part on the two devices play no role here.
  ImageSettings s;
  s.geometry.lineCount = 64;
  s.tracing.pathsPerLine = 1000;
  s.matchStages();
  s.tracing.device = Device::Cpu;
  s.echo.aperture = namedAperture();
  const auto scene = makePhantomScene(makeThoraxPhantom(2.0));
  const auto lines = makeScanLines(s.geometry, thoraxPhantomA4C().orthonormalized());
  Simulator simulator(borrowed(scene.get()));
  const TracedResult traced = simulator.trace(lines, s.tracing);
  s.echo.device = Device::Cuda;
  const RfLines gpu = simulator.formRf(lines, traced, s.echo, nullptr).host();
  s.echo.device = Device::Cpu;
  const RfLines cpu = simulator.formRf(lines, traced, s.echo, nullptr).host();
  const double difference = rfDifference(gpu, cpu);
  EXPECT_LE(difference, rfTolerance);
  std::printf("thorax from the same traced lines: %.2g\n", difference);
}

TEST(GpuAcoustic, AFieldsBricks)
{
  SONO_GPU_OR_SKIP();
  FieldGrid grid;
  grid.lateral = { 0.0, 0.25, 24 };
  grid.elevational = { 0.0, 0.5, 10 };
  grid.depth = { 0.0, 2.0, 31 };
  Settings s = fanSettings();
  s.echo.field = tabulate(grid, [](double l, double e, double d) {
    const double width = 1.0 + std::abs(d - 25.0) / 25.0;
    return std::exp(-0.5 * (l * l + e * e) / (width * width)) / width;
  });
  expectSame(*ballScene(Echoes::Scatterers, 0.0), fan(16), s, "scatterers, field");
  expectSame(*ballScene(Echoes::Surfaces, 0.05), fan(16), s, "surfaces, field");
}

TEST(GpuAcoustic, TargetsEcho)
{
  SONO_GPU_OR_SKIP();
  Tissue steel = makeTissue("steel", 4.0, 3000.0, 1.0);
  for (const double roughnessMm : { 0.0, 0.1 })
  {
    steel.roughnessMm = roughnessMm;
    steel.correlationMm = 1.0;
    const std::vector<TargetSurface> targets{ makeBox("box", steel, { 15, 18, 6 }, { 25, 26, 9 }),
                                              makeBox("wire", steel, { 27, 10, 12 }, { 27.3, 34, 12.3 }) };
    Settings s = fanSettings();
    const auto scene = ballScene(Echoes::Surfaces, roughnessMm);
    expectSame(*scene, fan(16), s, "targets, rough by " + std::to_string(roughnessMm), targets);
    s.echo.aperture = namedAperture();
    expectSame(*scene, fan(16), s, "targets, aperture, rough by " + std::to_string(roughnessMm), targets);
  }
}

TEST(GpuAcoustic, RodsRing)
{
  SONO_GPU_OR_SKIP();
  const auto scene = ballScene(Echoes::Surfaces, 0.0);
  Settings s = fanSettings();
  s.echo.aperture = namedAperture();
  const auto rods = [](double firstMm, double secondMm) {
    std::vector<TargetSurface> targets{
      makeBox("one", makeTissue("steel", 46.0, 5900.0, 0.1), { 12, 18, 9 }, { 20, 26, 10 }),
      makeBox("two", makeTissue("titanium", 27.0, 6070.0, 0.1), { 22, 18, 6 }, { 30, 26, 7 }),
      makeBox("box", makeTissue("bone", 4.0, 3000.0, 1.0), { 20, 10, 14 }, { 25, 14, 15 })
    };
    targets[0].rodDiameterMm = firstMm;
    targets[1].rodDiameterMm = secondMm;
    return targets;
  };
  expectSame(*scene, fan(16), s, "two rods that ring", rods(0.8, 1.3));
  expectSame(*scene, fan(16), s, "one of them", rods(0.0, 1.3));
}

TEST(GpuAcoustic, ASweepShowsTargets)
{
  SONO_GPU_OR_SKIP();
  const auto scene = makePhantomScene(makeThoraxPhantom(2.0));
  ImageSettings s;
  s.geometry.lineCount = 32;
  s.tracing.pathsPerLine = 200;
  s.matchStages();
  s.setDevice(Device::Cuda);
  const ProbePose pose = thoraxPhantomA4C().orthonormalized();
  const Vec3d middle = pose.positionMm + 60.0 * pose.axial;
  const std::vector<TargetSurface> targets{ makeBox("box", makeTissue("steel", 4.0, 3000.0, 1.0), middle - 5.0,
                                                    middle + 5.0) };
  const auto pictures = [&](const std::vector<TargetSurface>& shown) {
    std::vector<std::uint8_t> bytes;
    Simulator simulator(borrowed(scene.get()));
    simulator.sweep(
      { pose }, s, false,
      [&](const SweptPictures& swept) {
        const PlaneImage layout = planeImageLayout(s.geometry, s.pixelMm);
        bytes.assign(swept.grey, swept.grey + std::size_t(layout.width) * std::size_t(layout.height));
      },
      {}, shown);
    return bytes;
  };
  Simulator alone(borrowed(scene.get()));
  const ImageInput input{ pose, s, targets, nullptr };
  const ScanPicture picture = alone.picture(alone.image(input));
  const std::vector<std::uint8_t> swept = pictures(targets);
  ASSERT_EQ(swept.size(), picture.grey.size);
  int differing = 0;
  for (std::size_t p = 0; p < swept.size(); ++p)
  {
    differing += std::abs(int(picture.grey[p]) - int(swept[p])) > 1;
  }
  EXPECT_LE(differing, int(swept.size() / 1000));
  EXPECT_NE(swept, pictures({}));
}

TEST(GpuAcoustic, PiecesComeAsBeamsReachThemAndRepeatToTheBit)
{
  SONO_GPU_OR_SKIP();
  const auto scene = ballScene(Echoes::Surfaces, 0.05);
  const auto other = ballScene(Echoes::Surfaces, 0.0);
  const Settings s = fanSettings();
  const auto rf = [&](const Scene& shown, int lines) {
    return runChain({ &shown, nullptr, nullptr }, fan(lines), s.tracing, s.echo, Device::Cuda).rf.iq;
  };
  const auto few = rf(*scene, 2); // the outermost lines
  const auto all = rf(*scene, 24);
  rf(*other, 24); // takes the pieces' place
  EXPECT_EQ(rf(*scene, 24), all);
  EXPECT_EQ(rf(*scene, 2), few);
}

} // namespace
