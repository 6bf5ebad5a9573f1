#include "EchoScenes.h"
#include "ErrorText.h"
#include "TestScenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace sono;
using namespace sono::test;
using sono::testing::errorOf;
using sono::testing::expectContains;

const double nan = std::numeric_limits<double>::quiet_NaN();

ScanLine oneLine()
{
  return makeLine({ 0, 0, 0 }, { 0, 0, 1 });
}

/// The message for settings that `spoil` has changed.
std::string errorWith(const std::function<void(EchoSettings&)>& spoil)
{
  EchoSettings s;
  spoil(s);
  return errorOf([&] { formRf({}, { oneLine() }, s); });
}

TEST(EchoInput, EachBadParameterIsNamed)
{
  struct Case
  {
    double EchoSettings::*field;
    std::vector<double> values;
    std::string name;
  };
  const std::vector<Case> cases{
    { &EchoSettings::centreFrequencyMHz, { 0.0, -1.0, nan, INFINITY }, "centre frequency" },
    { &EchoSettings::fractionalBandwidth, { 0.0, -0.1, 2.0, nan }, "fractional bandwidth" },
    { &EchoSettings::samplingMHz, { -1.0, 5.0, 4.9, 1e9, nan }, "sampling frequency" }, // 2.5 MHz needs more than 5
    { &EchoSettings::depthMm, { 0.0, -10.0, 1e6, nan }, "depth" },
    { &EchoSettings::lateralSigmaMm, { 0.0, -1.0, 1e3, nan }, "lateralSigmaMm" },
    { &EchoSettings::elevationalSigmaMm, { 0.0, -1.0, 1e3, nan }, "elevationalSigmaMm" },
    { &EchoSettings::scattererCellMm, { 0.0, -1.0, 1e-3, nan }, "scattererCellMm" },
    { &EchoSettings::scattererLevelDb, { nan, INFINITY, 1e3 }, "scattererLevelDb" },
  };
  for (const Case& c : cases)
  {
    for (const double value : c.values)
    {
      expectContains(errorWith([&](EchoSettings& s) { s.*c.field = value; }), c.name);
    }
  }
  expectContains(errorWith([](EchoSettings& s) { s.samplingMHz = 50.0, s.centreFrequencyMHz = 30.0; }),
                 "twice the centre frequency");
  // Enough for the carrier, but the pulse is shorter than the samples carry.
  expectContains(errorWith([](EchoSettings& s) { s.samplingMHz = 5.1, s.fractionalBandwidth = 1.5; }), "bandwidth");
}

TEST(EchoInput, LinesMustBeThereFitAndMatchTheTrace)
{
  const EchoSettings s;
  expectContains(errorOf([&] { formRf({}, {}, s); }), "scan lines");
  const std::vector<ScanLine> million(1000000, oneLine());
  expectContains(errorOf([&] { formRf({}, million, s); }), "number of scan lines is 1000000");
  ScanLine lost = oneLine();
  lost.originMm.y = nan;
  expectContains(errorOf([&] { formRf({}, { oneLine(), lost }, s); }), "scan line 1");

  TracedLines traced;
  traced.lineCount = 2;
  expectContains(errorOf([&] { formRf({ nullptr, &traced, nullptr }, { oneLine() }, s); }), "1 scan lines but 2");
  traced.lineCount = 1;
  expectContains(errorOf([&] { formRf({ nullptr, &traced, nullptr }, { oneLine() }, s); }), "trace again");
}

TEST(EchoInput, NothingThatScattersGivesAnEmptyImage)
{
  const EchoSettings s;
  const auto scene = makeScene(Vec3i(10), Vec3d(1.0), { makeTissue("gel", 1.5, 1540, 0.0) }, [](auto&) { return 0; });
  const PointScatterers none({});
  const PointScatterers silent({ { { 0, 0, 5 }, 0.0f }, { { 0, 0, 5 }, 0.0f } });
  EXPECT_EQ(none.count(), 0);
  for (const EchoSources& sources :
       { EchoSources{}, EchoSources{ scene.get(), nullptr, nullptr }, EchoSources{ nullptr, nullptr, &none },
         EchoSources{ scene.get(), nullptr, &silent } })
  {
    const RfLines rf = formRf(sources, { oneLine(), oneLine() }, s);
    EXPECT_EQ(rf.iq.size(), std::size_t(2 * s.sampleCount()));
    for (const std::complex<float> iq : rf.iq)
    {
      ASSERT_EQ(iq, std::complex<float>{});
    }
  }
}

TEST(EchoInput, ScatterersMustBeFinite)
{
  const auto errorOfPoint = [](const Vec3d& position, float amplitude) {
    return errorOf([&] { PointScatterers({ { { 0, 0, 1 }, 1.0f }, { position, amplitude } }); });
  };
  expectContains(errorOfPoint({ 0, nan, 0 }, 1.0f), "scatterer 1");
  expectContains(errorOfPoint({ 0, 0, INFINITY }, 1.0f), "scatterer 1");
  expectContains(errorOfPoint({ 0, 0, 1e300 }, 1.0f), "10^6 mm");
  expectContains(errorOfPoint({ 0, 0, 0 }, float(nan)), "amplitude");
}

TEST(EchoInput, CoincidentScatterersAddUp)
{
  const PointScatterers many(std::vector<PointScatterer>(100000, { { 0, 0, 20 }, 1e-5f }));
  EchoSettings s;
  s.samplingMHz = 50.0; // one lies near the peak
  const RfLines rf = formRf({ nullptr, nullptr, &many }, { oneLine() }, s);
  const std::vector<float> envelope = rf.envelope();
  EXPECT_NEAR(*std::max_element(envelope.begin(), envelope.end()), 1.0, 3e-3);
}

TEST(EchoInput, StopsWhenAsked)
{
  const std::vector<ScanLine> lines(64, oneLine());
  EXPECT_THROW(formRf({}, lines, EchoSettings{}, [](double) { return false; }), Aborted);
}

/// Not only between groups of lines, of which one may take seconds.
TEST(EchoInput, StopsWithinALine)
{
  const SceneS1 scene(100000);
  const PointScatterers points(scene.points);
  int asked = 0;
  EXPECT_THROW(
    formRf({ nullptr, nullptr, &points }, { scene.lines[64] }, scene.settings, [&](double) { return ++asked < 3; }),
    Aborted);
}

} // namespace
