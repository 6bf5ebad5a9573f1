#include "TestScenes.h"

#include "Trace/RecordPaths.h"
#include "Trace/Trace.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace sono;
using namespace sono::test;

/// Layers across z with faces on voxel faces.
struct Stack
{
  std::vector<Tissue> tissues;
  std::vector<double> thicknessMm; ///< of all but the last
  std::unique_ptr<Scene> scene;

  explicit Stack(std::vector<Tissue> t, std::vector<double> thickness, Vec3i size = Vec3i(40, 40, 200))
    : tissues(std::move(t))
    , thicknessMm(std::move(thickness))
  {
    scene = makeScene(size, Vec3d(1.0), tissues, [this](const Vec3d& p) {
      int layer = 0;
      double z = 0.0;
      while (layer < int(thicknessMm.size()) && p.z > (z += thicknessMm[std::size_t(layer)]))
      {
        ++layer;
      }
      return layer;
    });
  }
};

TraceSettings straightSettings(double depthMm, double frequencyMHz)
{
  TraceSettings s;
  s.deterministic = true;
  s.maxCollisions = 20;
  s.depthMm = depthMm;
  s.frequencyMHz = frequencyMHz;
  return s;
}

TEST(TracePlanarStack, TheIntensityFollowsTheProductFormula)
{
  const Stack stack({ makeTissue("a", 1.38, 1450, 0.6), makeTissue("b", 1.70, 1580, 1.1),
                      makeTissue("c", 1.61, 1570, 0.2), makeTissue("d", 7.8, 4080, 5.0),
                      makeTissue("e", 1.65, 1550, 0.7) },
                    { 20.0, 15.0, 30.0, 4.0 });
  const double f = 3.6;
  const auto traced = trace(*stack.scene, { makeLine({ 20.3, 20.2, 0.0 }, { 0, 0, 1 }) }, straightSettings(100.0, f));
  double intensity = 1.0;
  double depth = 0.0;
  for (std::size_t i = 0; i < stack.tissues.size(); ++i)
  {
    const Tissue& one = stack.tissues[i];
    const double thickness = i < stack.thicknessMm.size() ? stack.thicknessMm[i] : 20.0;
    const double decay = one.attenuationDbPerCmMHz * f * std::log(10.0) / 100.0;
    // Mean over the first and the last bin of the layer.
    const double half = 0.5 * decay * traced.binMm;
    for (const double into : { 0.5 * traced.binMm, thickness - 0.5 * traced.binMm })
    {
      const double expected = intensity * std::exp(-decay * into) * std::sinh(half) / half;
      const double found = traced.intensity[std::size_t((depth + into) / traced.binMm)];
      EXPECT_NEAR(found / expected, 1.0, 1e-4) << "layer " << i << " at " << into;
    }
    if (i + 1 < stack.tissues.size())
    {
      const Tissue& two = stack.tissues[i + 1];
      const double r = (two.impedanceMRayl - one.impedanceMRayl) / (two.impedanceMRayl + one.impedanceMRayl);
      intensity *= std::exp(-decay * thickness) * (1.0 - r * r);
      depth += thickness;
    }
  }
}

TEST(TracePlanarStack, MonteCarloWithoutSpreadAgreesWithinItsError)
{
  const Stack stack({ makeTissue("a", 1.5, 1500, 0.5), makeTissue("b", 3.0, 1500, 0.5) }, { 20.0 });
  TraceSettings s = straightSettings(60.0, 2.0);
  s.deterministic = false;
  s.pathsPerLine = 20000;
  for (const Sampling sampling : { Sampling::Independent, Sampling::LowDiscrepancy })
  {
    s.sampling = sampling;
    const auto traced = trace(*stack.scene, { makeLine({ 20.3, 20.2, 0.0 }, { 0, 0, 1 }) }, s);
    const double r = 1.5 / 4.5;
    const std::size_t bin = std::size_t(40.0 / traced.binMm);
    const double expected = (1.0 - r * r) * std::pow(10.0, -0.5 * 2.0 * (bin + 0.5) * traced.binMm / 100.0);
    EXPECT_NEAR(traced.intensity[bin], expected, 4.0 * traced.standardError[bin] + 1e-5);
  }
}

TEST(TraceAttenuation, FallsByItsDecibelsOverSixteenCentimetres)
{
  const Stack stack({ makeTissue("a", 1.5, 1540, 0.5) }, {});
  const auto traced = trace(*stack.scene, { makeLine({ 20.3, 20.2, 0.0 }, { 0, 0, 1 }) }, straightSettings(160.0, 3.6));
  for (int b = 0; b < traced.binCount; b += 40)
  {
    // One-way intensity is round-trip amplitude: 3.6 dB per cm there and back at 0.5 dB/cm/MHz and 3.6 MHz.
    const double r = (b + 0.5) * traced.binMm;
    EXPECT_NEAR(20.0 * std::log10(traced.intensity[std::size_t(b)]), -3.6 * r / 10.0, 0.01) << r;
  }
}

TEST(TraceOblique, RefractsBySnell)
{
  const double c1 = 1450.0;
  const double c2 = 1580.0;
  const Stack stack({ makeTissue("a", 1.38, c1, 0.0), makeTissue("b", 1.70, c2, 0.0), makeTissue("c", 7.8, 4080, 0.0) },
                    { 20.0, 40.0 }, Vec3i(120, 40, 100));
  const double t1 = 0.5;
  const double t2 = std::asin(std::sin(t1) * c2 / c1);
  const auto line = makeLine({ 10.0, 20.2, 0.0 }, { std::sin(t1), 0.0, std::cos(t1) });
  TraceSettings s = straightSettings(90.0, 2.0);
  // Second interface: 40 mm deeper along the refracted ray, projected onto the unrefracted axis.
  const double first = 20.0 / std::cos(t1);
  const double second = first + 40.0 / std::cos(t2) * std::cos(t2 - t1);
  const double cos1 = std::cos(t1);
  const double cos2 = std::cos(t2);
  const double r = (1.70 * cos1 - 1.38 * cos2) / (1.70 * cos1 + 1.38 * cos2);
  const RecordedPath path = recordPaths(*stack.scene, { line }, s, 1).at(0);
  ASSERT_GE(path.hits.size(), 2u);
  EXPECT_NEAR(path.hits[1].depthMm, second, 1e-3);
  EXPECT_NEAR(path.hits[1].intensity, 1.0 - r * r, 2e-4);
}

TEST(TraceOblique, ReflectsTotallyBeyondTheCriticalAngle)
{
  std::vector<Tissue> tissues = { makeTissue("a", 1.5, 1500, 0.0), makeTissue("b", 3.0, 3000, 0.0) };
  for (Tissue& t : tissues)
  {
    t.roughnessMm = 0.0;
  }
  const Stack stack(tissues, { 20.0 }, Vec3i(120, 40, 100));
  const double critical = std::asin(0.5);
  for (const double t : { critical - 0.01, critical + 0.01 })
  {
    TraceSettings s = straightSettings(80.0, 2.0);
    s.deterministic = false;
    s.pathsPerLine = 4096;
    s.coherenceMm = 1e9;
    const auto line = makeLine({ 10.0, 20.2, 0.0 }, { std::sin(t), 0.0, std::cos(t) });
    const auto traced = trace(*stack.scene, { line }, s);
    const double cos1 = std::cos(t);
    const double sin2 = 2.0 * std::sin(t);
    const double cos2 = std::sqrt(std::max(0.0, 1.0 - sin2 * sin2));
    const double r = sin2 >= 1.0 ? 1.0 : (3.0 * cos1 - 1.5 * cos2) / (3.0 * cos1 + 1.5 * cos2);
    // The refracted paths go on; the mirrored ones reverberate, and do not add to the beam before the hit.
    const double hit = 20.0 / cos1;
    const auto at = [&](double depth) { return traced.intensity[std::size_t(depth / traced.binMm)]; };
    EXPECT_NEAR(at(hit - 5.0), 1.0, 1e-5);
    EXPECT_NEAR(at(hit + 5.0), 1.0 - r * r, t > critical ? 0.0 : 2e-3);
  }
}

TEST(TraceSkips, EqualAcousticsAreNoBoundary)
{
  const Stack stack(
    { makeTissue("a", 1.6, 1550, 0.5), makeTissue("b", 1.6, 1550, 1.5), makeTissue("c", 1.6, 1550, 0.5) },
    { 30.0, 30.0 });
  TraceSettings s = straightSettings(90.0, 2.0);
  s.deterministic = false;
  s.pathsPerLine = 8;
  const auto traced = trace(*stack.scene, { makeLine({ 20.3, 20.2, 0.0 }, { 0, 0, 1 }) }, s);
  const double r = 75.125;
  const double db = 0.5 * 2.0 * (r - 30.0) / 10.0 + 1.5 * 2.0 * 3.0;
  EXPECT_NEAR(traced.intensity[std::size_t(r / traced.binMm)], std::pow(10.0, -db / 10.0), 1e-5);
}

TEST(TraceDeterminism, SameSeedSameBitsOtherSeedOthers)
{
  const auto scene =
    makeScene(Vec3i(60), Vec3d(1.0), { makeTissue("a", 1.5, 1500, 0.5), makeTissue("b", 1.7, 1600, 0.5) },
              [](const Vec3d& p) { return glm::length(p - Vec3d(30.0)) < 15.0 ? 1 : 0; });
  std::vector<ScanLine> lines;
  for (int i = 0; i < 9; ++i)
  {
    lines.push_back(makeLine({ 20.0 + i, 30.0, 0.0 }, { 0, 0, 1 }));
  }
  TraceSettings s;
  s.depthMm = 60.0;
  s.pathsPerLine = 100;
  const auto one = trace(*scene, lines, s);
  const auto two = trace(*scene, lines, s);
  EXPECT_EQ(one.intensity, two.intensity);
  EXPECT_EQ(one.boundaryEcho, two.boundaryEcho);
  s.seed = 2;
  EXPECT_NE(one.intensity, trace(*scene, lines, s).intensity);
}

TEST(TraceCoupling, AirBeforeTheSkinNeitherReflectsNorAttenuates)
{
  const auto scene = makeScene(
    Vec3i(40, 40, 60), Vec3d(1.0), { makeTissue("air", 0.0004, 330, 1.6), makeTissue("muscle", 1.7, 1580, 1.0) },
    [](const Vec3d& p) { return p.z < 10.0 ? 0 : 1; }, "air");
  const auto traced = trace(*scene, { makeLine({ 20.3, 20.2, -5.0 }, { 0, 0, 1 }) }, straightSettings(50.0, 2.0));
  EXPECT_FLOAT_EQ(traced.intensity[std::size_t(12.0 / traced.binMm)], 1.0f);
  EXPECT_NEAR(traced.intensity[std::size_t(25.125 / traced.binMm)], std::pow(10.0, -1.0 * 2.0 * 1.0125 / 10.0), 1e-4);
}

TEST(TraceErrors, ProbeOutsideTheVolumeAndBadSettings)
{
  const Stack stack({ makeTissue("a", 1.5, 1540, 0.5) }, {});
  const auto traceFrom = [&](const Vec3d& origin, const TraceSettings& s) {
    return trace(*stack.scene, { makeLine(origin, { 0, 0, 1 }) }, s);
  };
  EXPECT_THROW(traceFrom({ 500.0, 500.0, 500.0 }, straightSettings(50.0, 2.0)), Error);
  EXPECT_THROW(traceFrom({ 100.0, 20.0, 0.0 }, straightSettings(50.0, 2.0)), Error);
  TraceSettings s = straightSettings(50.0, 2.0);
  s.depthMm = 0.0;
  EXPECT_THROW(traceFrom({ 20.0, 20.0, 0.0 }, s), Error);
  s.depthMm = NAN;
  EXPECT_THROW(traceFrom({ 20.0, 20.0, 0.0 }, s), Error);
  EXPECT_THROW(trace(*stack.scene, {}, straightSettings(50.0, 2.0)), Error);
}

} // namespace
