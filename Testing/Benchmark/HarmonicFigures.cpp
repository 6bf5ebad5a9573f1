#include "HarmonicFigures.h"

#include "Folders.h"
#include "Simulator.h"
#include "TestScenes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double neperPerDb = 0.11512925464970229; // of amplitude

const Tissue& tissueCalled(const std::string& name)
{
  static const TissueTable table = TissueTable::read(dataFile("tissues.csv"));
  return *table.find(name);
}

constexpr double wallMm = 10.0;
const Vec3d cystMm(45.0, 12.0, 25.0);
constexpr double cystRadiusMm = 8.0;

std::shared_ptr<const Scene> cystScene()
{
  const std::vector<Tissue> tissues{ tissueCalled("skin"), tissueCalled("fat"), tissueCalled("muscle"),
                                     tissueCalled("liver"), tissueCalled("water") };
  return test::makeScene({ 180, 48, 110 }, Vec3d(0.5), tissues, [](const Vec3d& p) {
    return p.z < 2.0 ? 0 : p.z < 7.0 ? 1 : p.z < wallMm ? 2 : glm::length(p - cystMm) > cystRadiusMm ? 3 : 4;
  });
}

ImageInput cystInput(ImagingMode mode)
{
  const double sentFrequencyMHz = 2.0;
  const ProbePreset probe = readProbePreset(dataFile("probes/curvilinear_c5-2.json"));
  ImageInput input;
  input.pose.positionMm = { cystMm.x, cystMm.y, 0.0 };
  ImageSettings& s = input.settings;
  s.geometry = probe.geometry;
  s.geometry.depthMm = 45.0;
  s.echo.imagingMode = mode;
  s.echo.centreFrequencyMHz = receivedMHz(mode, sentFrequencyMHz);
  s.echo.fractionalBandwidth = receivedBandwidth(mode, probe.fractionalBandwidth);
  s.echo.aperture = probe.aperture();
  s.bmode.addHaze = true;
  s.bmode.automaticReference = false;
  s.bmode.tgcDbPerCm = 0.0;
  s.bmode.dynamicRangeDb = 250.0;
  s.setDevice(Device::Cpu);
  s.matchStages();
  return input;
}

/// Mean power in the cyst against that in the liver at the same depth, dB.
double clutterDb(const std::shared_ptr<const Scene>& scene, ImagingMode mode)
{
  const ImageInput input = cystInput(mode);
  const BModeSettings& bmode = input.settings.bmode;
  Simulator simulator(scene);
  const BModeLines lines = simulator.bmode(input).host();
  const std::vector<ScanLine> axes = makeScanLines(input.settings.geometry, input.pose);
  double cyst = 0.0;
  double liver = 0.0;
  int cystCount = 0;
  int liverCount = 0;
  for (int l = 0; l < lines.lineCount; ++l)
  {
    for (int s = 0; s < lines.sampleCount; ++s)
    {
      const Vec3d p = axes[std::size_t(l)].originMm + s * lines.sampleMm * axes[std::size_t(l)].axis;
      const double power = std::pow(10.0, (double(lines.grey[std::size_t(l) * lines.sampleCount + s]) - 1.0) *
                                            bmode.dynamicRangeDb / 10.0);
      const double fromMiddleMm = glm::length(p - cystMm);
      if (fromMiddleMm < 0.5 * cystRadiusMm)
      {
        cyst += power;
        ++cystCount;
      }
      else if (fromMiddleMm > 1.75 * cystRadiusMm && std::abs(p.z - cystMm.z) < 0.5 * cystRadiusMm)
      {
        liver += power;
        ++liverCount;
      }
    }
  }
  return 10.0 * std::log10(cyst / cystCount / (liver / liverCount));
}

} // namespace

double harmonicGrowthErrorDb()
{
  const Tissue& liver = tissueCalled("liver");
  Simulator simulator(test::makeScene({ 40, 40, 220 }, Vec3d(0.5), { liver }, [](const Vec3d&) { return 0; }));
  ImageInput input;
  input.pose.positionMm = { 10.0, 10.0, 0.0 };
  ImageSettings& s = input.settings;
  s.geometry.lineCount = 1;
  s.geometry.depthMm = 100.0;
  s.echo.imagingMode = ImagingMode::Harmonic;
  s.echo.centreFrequencyMHz = 3.6;
  s.tracing.facePressureKPa = 100.0;
  s.setDevice(Device::Cpu);
  s.matchStages();
  const TracedLines lines = simulator.traced(input).host();
  const double fMHz = s.tracing.frequencyMHz;
  const double a1 = neperPerDb * liver.attenuationDbPerCmMHz * fMHz / 10.0; // Np/mm
  const double a2 = 2.0 * a1;
  const double density = 1e6 * liver.impedanceMRayl / liver.soundSpeedMPerS;
  const double sourcePerMm = 1e-3 * liver.nonlinearity * 2e6 * pi * fMHz * 1e3 * s.tracing.facePressureKPa /
                             (2.0 * density * std::pow(liver.soundSpeedMPerS, 3.0));
  double worstDb = 0.0;
  for (int bin = 4; bin < lines.binCount; ++bin)
  {
    const double z = (bin + 0.5) * lines.binMm;
    const double expected = sourcePerMm * z * std::exp(-2.0 * a1 * z) * std::exp(-a2 * z); // a2 = 2 a1
    worstDb = std::max(worstDb, std::abs(20.0 * std::log10(lines.intensity[std::size_t(bin)] / expected)));
  }
  return worstDb;
}

double cystClutterReductionDb()
{
  const auto scene = cystScene();
  return clutterDb(scene, ImagingMode::Fundamental) - clutterDb(scene, ImagingMode::Harmonic);
}

} // namespace sono
