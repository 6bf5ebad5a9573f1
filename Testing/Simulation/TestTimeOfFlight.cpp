#include "LayerStack.h"
#include "LayeredScene.h"
#include "TargetScenes.h"

#include "Echo/FormRf.h"
#include "Echo/Pulse.h"
#include "Image/ErrorMap.h"
#include "Image/LabelSlice.h"
#include "Kernel/TimeOfFlight.h"
#include "Trace/Trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

// Range is time: Data/docs/physics.md 13.1.

using namespace sono;
using namespace sono::test;

namespace {

constexpr double assumedSpeed = 1540.0;

/// Boundaries of shared/PHYSICS.md 13 at 20, 32 and 50 mm.
const std::vector<Layer> stack{ { 20.0, 1.50, 1480.0, 0.3 },
                                { 32.0, 1.90, 1650.0, 0.8 },
                                { 50.0, 1.30, 1450.0, 0.6 },
                                { 90.0, 2.40, 1800.0, 1.0 } };

/// Where a depth is shown, in closed form.
double shownAt(const std::vector<Layer>& layers, double depthMm)
{
  double range = 0.0;
  double from = 0.0;
  for (const Layer& layer : layers)
  {
    range += (std::min(depthMm, layer.endMm) - from) * assumedSpeed / layer.speed;
    from = layer.endMm;
    if (depthMm <= layer.endMm)
    {
      break;
    }
  }
  return range;
}

TraceSettings tracing()
{
  TraceSettings s;
  s.device = Device::Cpu;
  s.depthMm = 70.0;
  s.pathsPerLine = 16;
  s.frequencyMHz = 2.5;
  return s;
}

EchoSettings echoes(const TraceSettings& tracing)
{
  EchoSettings s;
  s.device = Device::Cpu;
  s.depthMm = tracing.depthMm;
  s.centreFrequencyMHz = tracing.frequencyMHz;
  return s;
}

RangeMap mapOf(const TracedLines& traced)
{
  return { traced.depthOffsetMm.data(), traced.binCount, float(1.0 / traced.binMm) };
}

struct Peak
{
  double rangeMm;
  double amplitude;
};

/// The largest envelope within `around` mm of a place, by a parabola through its neighbours.
Peak peakNear(const RfLines& rf, double rangeMm, double around)
{
  const std::vector<float> envelope = rf.envelope();
  const auto first = std::size_t((rangeMm - around) / rf.sampleMm);
  const auto last = std::size_t((rangeMm + around) / rf.sampleMm);
  const std::size_t peak =
    std::size_t(std::max_element(envelope.begin() + std::ptrdiff_t(first), envelope.begin() + std::ptrdiff_t(last)) -
                envelope.begin());
  const double a = envelope[peak - 1];
  const double b = envelope[peak];
  const double c = envelope[peak + 1];
  const double beside = 0.5 * (a - c) / (a - 2.0 * b + c);
  return { (double(peak) + beside) * rf.sampleMm, b - 0.25 * (a - c) * beside };
}

} // namespace

TEST(TimeOfFlight, DepthsLieWhereTheirTimeSays)
{
  const auto scene = layeredScene(stack);
  const TracedLines traced = trace(*scene, { makeLine({ 10.1, 9.9, 0.0 }, { 0.0, 0.0, 1.0 }) }, tracing());
  ASSERT_EQ(traced.depthOffsetMm.size(), traced.intensity.size());
  const RangeMap map = mapOf(traced);
  for (double depthMm = 0.5; depthMm < 66.0; depthMm += 0.37)
  {
    EXPECT_NEAR(map.depthOf(float(shownAt(stack, depthMm))), depthMm, 0.002) << depthMm;
  }
}

TEST(TimeOfFlight, FacesWithinBinsLieWhereTheyAre)
{
  // A plate of 2700 m/s in water, its faces at any place of a bin and of an integration step; thin ones, too.
  const Tissue bone = makeTissue("bone", 3.2, 2700.0, 0.0);
  const auto scene = layeredScene({ { 80.0, 1.48, 1480.0, 0.0 } });
  for (const double thicknessMm : { 9.03, 1.21 })
  {
    for (double faceMm = 24.0; faceMm < 24.3; faceMm += 0.017)
    {
      const double backMm = faceMm + thicknessMm;
      const std::vector<TargetSurface> targets{ makeBox("plate", bone, { 2.0, 2.0, faceMm }, { 18.0, 18.0, backMm }) };
      const TracedLines traced =
        trace(*scene, { makeLine({ 10.1, 9.9, 0.0 }, { 0.0, 0.0, 1.0 }) }, tracing(), {}, targets);
      const RangeMap map = mapOf(traced);
      const std::vector<Layer> layers{ { faceMm, 1.48, 1480.0, 0.0 },
                                       { backMm, 3.2, 2700.0, 0.0 },
                                       { 80.0, 1.48, 1480.0, 0.0 } };
      for (const double depthMm : { faceMm - 0.05, faceMm, faceMm + 0.1, backMm - 0.02, backMm, backMm + 0.07, 60.0 })
      {
        EXPECT_NEAR(map.depthOf(float(shownAt(layers, depthMm))), depthMm, 0.002) << faceMm << ", " << depthMm;
      }
    }
  }
}

TEST(TimeOfFlight, ALayerOfLessThanTwoBinsIsNotFurtherOffThanStraightLinesBetweenBins)
{
  // Its two bends cannot be told from one. Straight lines are off by up to (2700 - 1480) / 1540 x 0.25 / 4 = 0.05 mm.
  const auto scene = layeredScene({ { 80.0, 1.48, 1480.0, 0.0 } });
  const Tissue bone = makeTissue("bone", 3.2, 2700.0, 0.0);
  for (double faceMm = 24.0; faceMm < 24.3; faceMm += 0.017)
  {
    const std::vector<TargetSurface> targets{ makeBox("leaf", bone, { 2.0, 2.0, faceMm },
                                                      { 18.0, 18.0, faceMm + 0.7 }) };
    const TracedLines traced =
      trace(*scene, { makeLine({ 10.1, 9.9, 0.0 }, { 0.0, 0.0, 1.0 }) }, tracing(), {}, targets);
    const double shown = shownAt({ { faceMm, 1.48, 1480.0, 0.0 }, { 80.0, 3.2, 2700.0, 0.0 } }, faceMm + 0.7);
    EXPECT_NEAR(mapOf(traced).depthOf(float(shown)), faceMm + 0.7, 0.06) << faceMm;
  }
}

TEST(TimeOfFlight, ObliqueLinesAsLongInEachLayerAsTheyAre)
{
  const auto scene = layeredScene(stack);
  const double cosine = std::cos(0.3);
  const TracedLines traced = trace(*scene, { makeLine({ 1.0, 10.0, 0.0 }, { std::sin(0.3), 0.0, cosine }) }, tracing());
  const RangeMap map = mapOf(traced);
  for (double z = 1.0; z < 55.0; z += 1.3)
  {
    EXPECT_NEAR(map.depthOf(float(shownAt(stack, z) / cosine)), z / cosine, 0.002) << z;
  }
}

TEST(TimeOfFlight, BoundariesEchoWhereTheirTimeSays)
{
  const auto scene = layeredScene(stack);
  const std::vector<ScanLine> lines{ makeLine({ 10.1, 9.9, 0.0 }, { 0.0, 0.0, 1.0 }) };
  const TraceSettings t = tracing();
  const TracedLines traced = trace(*scene, lines, t);
  const RfLines rf = formRf(*scene, lines, traced, echoes(t));
  EXPECT_NEAR(peakNear(rf, 20.81, 1.0).rangeMm, 20.811, 0.02);
  EXPECT_NEAR(peakNear(rf, 32.01, 1.0).rangeMm, 32.011, 0.02);
  EXPECT_NEAR(peakNear(rf, 51.13, 1.0).rangeMm, 51.128, 0.02);
}

TEST(TimeOfFlight, BoundariesEchoAsStronglyAsTheLayersInFrontLeaveThem)
{
  // Wherever they lie within bins: layers of 29, 22 and 31 voxels. Absorbing ones, one of them above the speed of bone.
  const std::vector<StackLayer> materials{
    { 1.50, 1480.0, 0.5, 0.0 }, { 2.30, 2700.0, 1.5, 0.0 }, { 1.50, 1480.0, 1.0, 0.0 }, { 1.90, 1700.0, 0.2, 0.0 }
  };
  for (const double voxelMm : { 0.5, 0.47, 0.53, 0.61 })
  {
    LayerStack exact{ materials };
    std::vector<Layer> layers;
    for (int i = 0; i < 4; ++i)
    {
      StackLayer& layer = exact.layers[std::size_t(i)];
      layer.thicknessMm = voxelMm * (i == 0 ? 29 : i == 1 ? 22 : i == 2 ? 31 : 60);
      layers.push_back({ exact.depthMm(i), layer.impedanceMRayl, layer.speedMPerS, layer.attenuationDbPerCmMHz });
    }
    const auto scene = layeredScene(
      layers, [](Tissue& tissue) { tissue.roughnessMm = 0.0; }, voxelMm);
    const std::vector<ScanLine> lines{ makeLine({ 10.1, 9.9, 0.0 }, { 0.0, 0.0, 1.0 }) };
    TraceSettings t = tracing();
    t.pathsPerLine = 20000;
    const EchoSettings e = echoes(t);
    const RfLines rf = formRf(*scene, lines, trace(*scene, lines, t), e);
    const double band =
      assumedSpeed / 1000.0 / (4.0 * M_PI * pulseSigmaMm(e.centreFrequencyMHz, e.fractionalBandwidth));
    double way = 1.0;
    double range = 0.0;
    double exponent = 0.0;
    for (int b = 0; b < 3; ++b)
    {
      range += exact.rangeMm(b);
      exponent += exact.exponent(b);
      const double r = exact.reflection(b);
      // A pulse that has sunk is that much longer than a tone, (12.5).
      const double expected =
        way * std::abs(r) * std::exp(-exponent * e.centreFrequencyMHz + 0.5 * std::pow(exponent * band, 2));
      way *= 1.0 - r * r;
      const Peak peak = peakNear(rf, range, 0.6);
      EXPECT_NEAR(peak.rangeMm, range, 0.01) << voxelMm << ", " << b;
      EXPECT_NEAR(20.0 * std::log10(peak.amplitude / expected), 0.0, 0.1) << voxelMm << ", " << b;
    }
  }
}

TEST(TimeOfFlight, AScattererKeepsItsPhaseAndStrengthWhereItIsShown)
{
  // One scatterer in each layer; the speeds are told by hand, so that nothing but the moving is at work.
  TracedLines traced;
  traced.lineCount = 1;
  traced.binMm = 0.25;
  traced.binCount = 300;
  traced.intensity.assign(300, 1.0f);
  traced.standardError.assign(300, 0.0f);
  for (int b = 0; b < 300; ++b)
  {
    const double range = b * traced.binMm;
    traced.depthOffsetMm.push_back(float(range < 20.0 ? -0.04 * range : -0.8 + 0.06 * (range - 20.0)));
  }
  EchoSettings s;
  s.device = Device::Cpu;
  s.depthMm = 60.0;
  s.centreFrequencyMHz = 3.0;
  const std::vector<ScanLine> lines{ makeLine({ 0.0, 0.0, 0.0 }, { 0.0, 0.0, 1.0 }) };
  const double k2 = 4.0 * 3.14159265358979323846 * 3.0 / 1.54;
  for (const double range : { 7.3, 19.2, 23.4, 51.7 })
  {
    const double depth = range + (range < 20.0 ? -0.04 * range : -0.8 + 0.06 * (range - 20.0));
    const PointScatterers points({ { { 0.0, 0.0, depth }, 1.0 } });
    const RfLines rf = formRf({ nullptr, &traced, &points }, lines, s);
    const PointScatterers there({ { { 0.0, 0.0, range }, 1.0 } });
    const RfLines still = formRf({ nullptr, nullptr, &there }, lines, s);
    EXPECT_NEAR(peakNear(rf, range, 1.0).rangeMm, range, 2e-3);
    const auto at = std::size_t(std::lround(range / rf.sampleMm));
    EXPECT_NEAR(std::abs(rf.iq[at]), std::abs(still.iq[at]), 0.01 * std::abs(still.iq[at])) << range;
    EXPECT_NEAR(std::arg(rf.iq[at] * std::exp(std::complex<float>(0.0f, float(k2 * range)))), 0.0, 0.02) << range;
  }
}

TEST(TimeOfFlight, ATargetsSpeedCounts)
{
  const Tissue steel = makeTissue("steel", 45.0, 5900.0, 0.0);
  const auto scene = layeredScene({ { 80.0, 1.6, 1540.0, 0.5 } });
  const std::vector<TargetSurface> targets{ makeBox("plate", steel, { 2.0, 2.0, 30.0 }, { 18.0, 18.0, 40.0 }) };
  const TracedLines traced = trace(*scene, { makeLine({ 10.1, 9.9, 0.0 }, { 0.0, 0.0, 1.0 }) }, tracing(), {}, targets);
  const RangeMap map = mapOf(traced);
  const double behind = 30.0 + 10.0 * 1540.0 / 5900.0;
  EXPECT_NEAR(map.depthOf(20.0f), 20.0, 1e-3);
  EXPECT_NEAR(map.depthOf(float(30.0 + 5.0 * 1540.0 / 5900.0)), 35.0, 0.005);
  EXPECT_NEAR(map.depthOf(float(behind + 20.0)), 60.0, 0.005);
}

TEST(TimeOfFlight, AWireIsTooThinToCount)
{
  // A wavelength is 0.616 mm.
  const Tissue nylon = makeTissue("nylon", 2.96, 2600.0, 0.0);
  const auto scene = layeredScene({ { 80.0, 1.6, 1540.0, 0.5 } });
  for (const double thickness : { 0.1, 0.6, 0.65 })
  {
    const std::vector<TargetSurface> targets{ makeBox("wire", nylon, { 2.0, 9.0, 20.0 },
                                                      { 18.0, 11.0, 20.0 + thickness }),
                                              makeBox("plate", nylon, { 2.0, 2.0, 30.0 }, { 18.0, 18.0, 40.0 }) };
    const TracedLines traced =
      trace(*scene, { makeLine({ 10.1, 9.9, 0.0 }, { 0.0, 0.0, 1.0 }) }, tracing(), {}, targets);
    const double counts = thickness < 0.616 ? 0.0 : thickness;
    const double behind = 50.0 - (10.0 + counts) * (1.0 - 1540.0 / 2600.0);
    EXPECT_NEAR(mapOf(traced).depthOf(float(behind)), 50.0, 0.005) << thickness;
  }
}

TEST(TimeOfFlight, AStrandOfLabelsIsTooNarrowToCountAndAWallIsNot)
{
  // A row of bodies of nylon one behind the other, the axis through all of them. Two wavelengths are 1.23 mm.
  const std::vector<Tissue> tissues{ makeTissue("gel", 1.6, 1540.0, 0.5), makeTissue("nylon", 2.96, 2600.0, 0.0) };
  const ScanLine line = makeLine({ 10.1, 9.9, 0.0 }, { 0.0, 0.0, 1.0 });
  using Body = std::function<bool(const Vec3d&)>;
  const auto strand = [](double mm) -> Body {
    return [=](const Vec3d& p) { return p.x > 10.0 && p.x < 10.0 + mm && p.z > 0.0 && p.z < mm; };
  };
  const Body turned = [&](const Vec3d& p) { return strand(0.5)({ p.y + 0.5, p.x, p.z }); };
  const auto wall = [](double degrees) -> Body { // of half a millimetre to one, as the voxels have it
    const double slope = std::tan(degrees * M_PI / 180.0);
    return [=](const Vec3d& p) { return std::fabs(p.z - 2.0 - slope * (p.x - 10.0)) < 0.26 * std::hypot(1.0, slope); };
  };
  struct Case
  {
    const char* name;
    Body body;
    bool counts;
  };
  const std::vector<Case> cases{
    { "strand of 0.5 mm across the plane", strand(0.5), false },
    { "strand of 0.5 mm in the plane", turned, false },
    { "strand of 2 mm", strand(2.0), true },
    { "wall", wall(0.0), true },
    { "wall at 20 degrees", wall(20.0), true },
    { "wall at 45 degrees", wall(45.0), true },
    { "wall at 60 degrees", wall(60.0), true },
  };
  for (const Case& c : cases)
  {
    const auto isNylon = [&](const Vec3d& p) {
      return p.z > 10.0 && p.z < 60.0 && c.body({ p.x, p.y, std::fmod(p.z, 10.0) });
    };
    const auto scene = makeScene({ 40, 40, 160 }, Vec3d(0.5), tissues, isNylon);
    double onAxisMm = 0.0; // the axis lies beside the middles of its column of voxels
    for (double z = 0.25; z < 80.0; z += 0.5)
    {
      onAxisMm += isNylon({ 10.25, 9.75, z }) ? 0.5 : 0.0;
    }
    ASSERT_GE(onAxisMm, 2.5) << c.name;
    TraceSettings t = tracing();
    for (const bool hasAperture : { false, true })
    {
      t.aperture.apertureMm = hasAperture ? 20.0 : 0.0;
      t.aperture.elevationApertureMm = hasAperture ? 14.0 : 0.0;
      const TracedLines traced = trace(*scene, { line }, t);
      const double counted = c.counts || !hasAperture ? onAxisMm : 0.0;
      EXPECT_NEAR(mapOf(traced).depthOf(float(65.0 - counted * (1.0 - 1540.0 / 2600.0))), 65.0, 0.01)
        << c.name << (hasAperture ? ", aperture" : "");
    }
  }
}

TEST(TimeOfFlight, AmadousRangeIsDepth)
{
  const auto scene = layeredScene(stack);
  TraceSettings t = tracing();
  t.model = InterfaceModel::Amadou2024;
  const TracedLines traced = trace(*scene, { makeLine({ 10.1, 9.9, 0.0 }, { 0.0, 0.0, 1.0 }) }, t);
  EXPECT_TRUE(traced.depthOffsetMm.empty());
  EXPECT_EQ(traced.binCount, 280);
}

TEST(TimeOfFlight, LabelsFitThePictureBehindFat)
{
  // 30 mm of fat at 1450 m/s: what lies behind is shown 1.86 mm too deep.
  const std::vector<Layer> fat{ { 30.0, 1.38, 1450.0, 0.4 }, { 45.0, 1.65, 1540.0, 0.5 }, { 90.0, 1.7, 1540.0, 0.5 } };
  const auto scene = layeredScene(fat);
  for (const ScanKind kind : { ScanKind::Linear, ScanKind::PhasedSector })
  {
    ScanGeometry geometry;
    geometry.kind = kind;
    geometry.lineCount = 33;
    geometry.widthMm = 10.0;
    geometry.sectorDeg = 16.0;
    geometry.depthMm = 60.0;
    const ProbePose pose{ { 10.0, 10.0, 0.0 }, { 0.0, 0.0, 1.0 }, { 1.0, 0.0, 0.0 } };
    TraceSettings t = tracing();
    t.depthMm = geometry.depthMm;
    const TracedLines traced = trace(*scene, makeScanLines(geometry, pose), t);
    const PlaneImage image = scanConvert(geometry, std::vector<float>(33, 1.0f), 1, geometry.depthMm, 0.1);
    const auto labels =
      sliceLabels(scene->volume(), geometry, pose, image, { &traced.depthOffsetMm, traced.binCount, traced.binMm });
    const int middle = image.width / 2;
    const auto edge = [&](std::uint16_t from) {
      int j = image.height - 1;
      while (labels[std::size_t(j) * std::size_t(image.width) + std::size_t(middle)] != from)
      {
        --j;
      }
      return image.axialMinMm + (j + 0.5) * image.pixelMm;
    };
    EXPECT_NEAR(edge(0), shownAt(fat, 30.0), 0.06);
    EXPECT_NEAR(edge(1), shownAt(fat, 45.0), 0.06);
    // The error of the paths moves along.
    EXPECT_EQ(errorPlane(geometry, traced, 0.1).mask, image.mask);
  }
}
