// Sums over millions of paths: against closed forms, since that is where digits are lost.
#include "Core/SoundSpeed.h"
#include "GpuParity.h"
#include "TestScenes.h"
#include "Trace/Trace.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace {

using namespace sono;
using namespace sono::test;

constexpr double plateMm = 20.0;
constexpr double deepPlateMm = 30.0;
constexpr double frequencyMHz = 2.0;

/// A path goes straight on or straight back.
Tissue makeSmooth(const std::string& name, double impedance, double attenuation)
{
  Tissue tissue = makeTissue(name, impedance, 1540.0, attenuation);
  tissue.roughnessMm = 0.0;
  return tissue;
}

/// Lines that go straight through a plate, and a second one behind it that hardly echoes.
struct Plates
{
  // The second step is 2^-10 of an impedance, which single precision holds exactly.
  std::vector<Tissue> tissues{ makeSmooth("front", 1.0, 0.5), makeSmooth("plate", 1.5, 0.8),
                               makeSmooth("behind", 1.5 + 1.0 / 1024.0, 0.6) };
  std::unique_ptr<Scene> scene = makeScene(Vec3i(150, 12, 50), Vec3d(1.0), tissues, [](const Vec3d& p) {
    return p.z < plateMm ? 0 : (p.z < deepPlateMm ? 1 : 2);
  });
  TraceSettings settings;
  std::vector<ScanLine> lines;

  Plates()
  {
    settings.device = Device::Cuda;
    settings.depthMm = 37.5; // paths go 4 % deeper: 39 mm, whole bins
    settings.radialBinMm = 0.5;
    settings.frequencyMHz = frequencyMHz;
    settings.lobeSigmaDeg = 0.0; // straight on or straight back
    settings.maxCollisions = 2;
    for (int i = 0; i < 128; ++i)
    {
      lines.push_back(makeLine({ 10.3 + i, 6.2, 0.0 }, { 0, 0, 1 }));
    }
  }

  /// Factor of the intensity over a way in a tissue.
  double passed(int tissue, double mm) const
  {
    return std::pow(10.0, -tissues[std::size_t(tissue)].attenuationDbPerCmMHz * frequencyMHz * mm / 100.0);
  }
  /// Mean of that over a bin.
  double passedOver(int tissue, double fromMm, double toMm) const
  {
    const double k = tissues[std::size_t(tissue)].attenuationDbPerCmMHz * frequencyMHz * std::log(10.0) / 100.0;
    return (passed(tissue, fromMm) - passed(tissue, toMm)) / (k * (toMm - fromMm));
  }
  double reflected() const
  {
    const double r = (1.5 - 1.0) / (1.5 + 1.0);
    return r * r;
  }
};

TracedLines tracedOn(const Plates& plates)
{
  Simulator simulator(borrowed<Scene>(plates.scene.get()));
  return simulator.trace(plates.lines, plates.settings).host();
}

TEST(GpuSums, MillionsOfEqualPathsKeepTheirMean)
{
  SONO_GPU_OR_SKIP();
  Plates plates;
  for (const int paths : { 1000000, 10000000 })
  {
    plates.settings.pathsPerLine = paths;
    const TracedLines traced = tracedOn(plates);
    const double atPlate = plates.passed(0, plateMm);
    double worst = 0.0;
    double worstExponent = 0.0;
    for (int line = 0; line < traced.lineCount; ++line)
    {
      for (int b = 0; b < traced.binCount; ++b)
      {
        const double from = b * traced.binMm;
        const double to = from + traced.binMm;
        double expected;
        if (to <= plateMm)
        {
          expected = plates.passedOver(0, from, to);
        }
        else if (to <= deepPlateMm)
        {
          expected = (1.0 - plates.reflected()) * atPlate * plates.passedOver(1, from - plateMm, to - plateMm);
        }
        else
        {
          expected = (1.0 - plates.reflected()) * atPlate * plates.passed(1, deepPlateMm - plateMm) *
                     plates.passedOver(2, from - deepPlateMm, to - deepPlateMm);
        }
        const double measured = traced.intensity[std::size_t(line) * std::size_t(traced.binCount) + std::size_t(b)];
        worst = std::max(worst, std::abs(measured / expected - 1.0));
        if (from > plateMm)
        {
          // What is on its way behind the plate was attenuated alike.
          const double middle = 0.5 * (from + to);
          const double beyond = std::max(0.0, middle - deepPlateMm);
          const double absorbed =
            (0.5 * plateMm + 0.8 * (std::min(middle, deepPlateMm) - plateMm) + 0.6 * beyond) * std::log(10.0) / 100.0;
          const double exponent =
            traced.attenuationNpPerMHz[std::size_t(line) * std::size_t(traced.binCount) + std::size_t(b)];
          worstExponent = std::max(worstExponent, std::abs(exponent / absorbed - 1.0));
        }
      }
    }
    // 512 floats of about the same size add up to 2e-5; the share that is reflected comes within 1e-5.
    EXPECT_LT(worst, 4e-5) << paths << " paths";
    EXPECT_LT(worstExponent, 1e-4) << paths << " paths";
  }
}

TEST(GpuSums, AnEchoTooFaintForOnePathIsStillHeard)
{
  SONO_GPU_OR_SKIP();
  Plates plates;
  plates.lines.resize(4);
  plates.settings.pathsPerLine = 10000000;
  plates.settings.model = InterfaceModel::Amadou2024; // whose paths bring echoes
  const TracedLines traced = tracedOn(plates);
  // The share that goes on is applied to what goes on, though the choice carries it already.
  const double arriving = plates.passed(0, plateMm) * std::pow(1.0 - plates.reflected(), 2) * plates.passed(1, 10.0);
  const double step = 1.0 / 1024.0;
  const double expected = std::pow(step / (3.0 + step), 2) * arriving;
  ASSERT_LT(expected, std::ldexp(1.0, -18)); // half the unit in which a path's echo is counted
  const double k2 = 4.0 * 3.14159265358979323846 * frequencyMHz / assumedSoundSpeedMmPerUs;
  for (int line = 0; line < traced.lineCount; ++line)
  {
    std::complex<double> sum = 0.0;
    for (int e = 0; e < traced.echoCount; ++e)
    {
      const double r = e * traced.echoSampleMm;
      if (std::abs(r - deepPlateMm) < 0.5)
      {
        sum += std::complex<double>(
                 traced.boundaryEcho[std::size_t(line) * std::size_t(traced.echoCount) + std::size_t(e)]) *
               std::polar(1.0, -k2 * r);
      }
    }
    EXPECT_NEAR(std::abs(sum) / expected, 1.0, 1e-3) << line;
  }
}

TEST(GpuSums, DoNotDependOnTheOrder)
{
  SONO_GPU_OR_SKIP();
  Plates plates;
  plates.lines.resize(16);
  plates.settings.lobeSigmaDeg = 17.0;
  plates.settings.maxCollisions = 7;
  plates.settings.pathsPerLine = 300000;
  for (const InterfaceModel model : { InterfaceModel::Acoustic, InterfaceModel::Amadou2024 })
  {
    plates.settings.model = model;
    const TracedLines first = tracedOn(plates);
    for (int i = 0; i < 3; ++i)
    {
      const TracedLines again = tracedOn(plates);
      EXPECT_EQ(first.intensity, again.intensity);
      EXPECT_EQ(first.standardError, again.standardError);
      EXPECT_EQ(first.attenuationNpPerMHz, again.attenuationNpPerMHz);
      EXPECT_EQ(first.boundaryEcho, again.boundaryEcho);
    }
  }
}

} // namespace
