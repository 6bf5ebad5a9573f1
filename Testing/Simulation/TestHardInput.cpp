#include "ErrorText.h"
#include "LayeredScene.h"

#include "Simulator.h"
#include "Trace/CollisionLimit.h"
#include "Trace/ProbeContact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

// What is allowed but hard: mirrors on both sides, tissues of no body's speed, no tissue at all.

using namespace sono;
using namespace sono::test;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

std::shared_ptr<const Scene> smoothLayers(const std::vector<Layer>& layers)
{
  return layeredScene(layers, [](Tissue& tissue) { tissue.roughnessMm = 0.0; });
}

ImageInput inputOf(bool reverberation, ImagingMode mode = ImagingMode::Fundamental)
{
  ImageInput input;
  input.pose.positionMm = { 10.0, 10.0, 0.0 };
  ImageSettings& s = input.settings;
  s.geometry.kind = ScanKind::Linear;
  s.geometry.lineCount = 5;
  s.geometry.widthMm = 8.0;
  s.geometry.depthMm = 50.0;
  s.tracing.pathsPerLine = 256;
  s.tracing.reverberation = reverberation;
  s.tracing.faceReflection = 1.0;
  s.echo.centreFrequencyMHz = 3.0;
  s.echo.imagingMode = mode;
  s.echo.aperture = { 8.0, 8.0, 40.0, 40.0, 0.0, false };
  s.pixelMm = 0.25;
  s.matchStages();
  s.setDevice(Device::Cpu);
  return input;
}

/// All results, as they would be shown.
struct Made
{
  TracedLines traced;
  RfLines rf;
  PlaneImage image;
  ScanPicture picture;
};

Made make(const std::shared_ptr<const Scene>& scene, const ImageInput& input)
{
  Simulator simulator(scene);
  const ImageResult image = simulator.image(input);
  return { simulator.traced(input).host(), simulator.rf(input).host(), image.plane().host(),
           simulator.picture(image, input.settings.geometry, input.pose, simulator.traced(input)) };
}

void expectFinite(const Made& made, const std::string& what)
{
  TracedLines::visitArrays(made.traced, [&](const auto& values, const char* name, TracedAxis) {
    EXPECT_TRUE(std::all_of(values.begin(), values.end(), [](const auto& v) { return std::isfinite(std::abs(v)); }))
      << what << ": " << name;
  });
  const std::vector<float> envelope = made.rf.envelope();
  EXPECT_TRUE(std::all_of(envelope.begin(), envelope.end(), [](float v) { return std::isfinite(v); })) << what;
  EXPECT_TRUE(std::all_of(made.image.value.begin(), made.image.value.end(), [](float v) { return v >= 0 && v <= 1; }))
    << what;
}

/// Where the middle line's envelope is largest, and where its labels change.
double brightestMm(const Made& made)
{
  const std::vector<float> envelope = made.rf.envelope();
  const auto first = envelope.begin() + 2 * made.rf.sampleCount;
  return double(std::max_element(first, first + made.rf.sampleCount) - first) * made.rf.sampleMm;
}

double labelStepMm(const Made& made)
{
  const PlaneImage& image = made.image;
  for (int j = 0; j < image.height; ++j)
  {
    if (made.picture.labels[std::size_t(j * image.width + image.width / 2)] == 1)
    {
      return image.axialMinMm + (j - 0.5) * image.pixelMm;
    }
  }
  return NAN;
}

/// Amplitude within half a millimetre of a range on the middle line, dB.
double levelAt(const Made& made, double rangeMm)
{
  const std::vector<float> envelope = made.rf.envelope();
  const auto at = [&](double mm) {
    return envelope.begin() + 2 * made.rf.sampleCount + std::lround(mm / made.rf.sampleMm);
  };
  return 20.0 * std::log10(double(*std::max_element(at(rangeMm - 0.5), at(rangeMm + 0.5))));
}

const Layer water{ 4.0, 1.5, 1540.0, 0.0 };
const Layer mirror{ 75.0, 5000.0, 5000.0, 0.0 };

} // namespace

/// Nothing is lost on the way: the twelfth echo is as strong as the second (the first is one surface's, not a path's).
TEST(HardInput, FaceAndPlateThatReflectAllEndForTime)
{
  const auto scene = smoothLayers({ water, mirror });
  ImageInput input = inputOf(true);
  input.settings.tracing.maxCollisions = 1000;
  input.settings.echo.aperture = {}; // all paths along the axes
  input.settings.matchStages();
  const Made made = make(scene, input);
  expectFinite(made, "plates");
  for (int echo = 3; echo <= 11; ++echo)
  {
    EXPECT_NEAR(levelAt(made, 4.0 * echo), levelAt(made, 8.0), 1.0) << echo;
  }
  // 13 ways there and back within 52 mm, in two pieces each at most of what crosses the coupling.
  EXPECT_LE(made.traced.segments, std::uint64_t(5 * 256) * 4 * 13);
  const auto lines = makeScanLines(input.settings.geometry, input.pose);
  EXPECT_EQ(collisionLimitWarning(*scene, lines, input.settings.tracing), "");

  input.settings.tracing.maxCollisions = 7;
  const Made cut = make(scene, input);
  expectFinite(cut, "7 boundaries");
  EXPECT_LT(levelAt(cut, 40.0), levelAt(made, 40.0) - 40.0);
  expectContains(collisionLimitWarning(*scene, lines, input.settings.tracing),
                 "Max Collisions is 7, and the paths that it ends still carry 100 % of the sound");
  input.settings.tracing.faceReflection = 0.0;
  EXPECT_EQ(collisionLimitWarning(*scene, lines, input.settings.tracing), "");
  input.settings.tracing.faceReflection = 1.0;
  input.settings.tracing.reverberation = false;
  EXPECT_EQ(collisionLimitWarning(*scene, lines, input.settings.tracing), "");
}

TEST(HardInput, ShowsAWallBehindAnySpeed)
{
  struct Case
  {
    double speed;
    double thickMm;
  };
  for (const Case& c : { Case{ 300.0, 8.0 }, Case{ 4000.0, 30.0 } })
  {
    const auto scene = smoothLayers({ { c.thickMm, 1.6, c.speed, 0.1 }, { 75.0, 3.2, 1540.0, 0.1 } });
    for (const bool reverberation : { false, true })
    {
      for (const ImagingMode mode : { ImagingMode::Fundamental, ImagingMode::Harmonic })
      {
        const Made made = make(scene, inputOf(reverberation, mode));
        const std::string what = std::to_string(c.speed) + (reverberation ? " reverberating" : "");
        expectFinite(made, what);
        // 0.012 mm of depth are 0.06 of range in the slow one; in the fast one the corner is within a bin of 0.25 mm.
        EXPECT_NEAR(brightestMm(made), c.thickMm * 1540.0 / c.speed, 0.06) << what << " " << int(mode);
        EXPECT_NEAR(labelStepMm(made), c.thickMm * 1540.0 / c.speed, 0.3) << what << " " << int(mode);
      }
    }
  }
}

/// The ends of the ranges that a tissue table may have.
TEST(HardInput, StaysFiniteToTheEndsOfTheRanges)
{
  for (const double speed : { 10.0, 1e5 })
  {
    for (const double impedance : { 1e-4, 1.6, 1e4 })
    {
      for (const double attenuation : { 0.0, 1e30 })
      {
        const auto scene = smoothLayers({ { 5.0, impedance, speed, attenuation }, { 75.0, 1.6, 1540.0, 0.5 } });
        for (const ImagingMode mode : { ImagingMode::Fundamental, ImagingMode::Harmonic })
        {
          const std::string what = std::to_string(speed) + " m/s, " + std::to_string(impedance) + " MRayl";
          expectFinite(make(scene, inputOf(true, mode)), what);
          expectFinite(make(scene, inputOf(false, mode)), what);
        }
      }
    }
  }
}

TEST(HardInput, NoTissueAtAllIsSaid)
{
  const auto scene = std::shared_ptr<const Scene>(makeScene(
    { 40, 40, 120 }, Vec3d(0.5), { makeTissue("air", 0.0004, 330.0, 1.2) }, [](const Vec3d&) { return 0; }, "air"));
  const ImageInput input = inputOf(false);
  for (const bool reverberation : { false, true })
  {
    for (const ImagingMode mode : { ImagingMode::Fundamental, ImagingMode::Harmonic })
    {
      expectFinite(make(scene, inputOf(reverberation, mode)), "air");
    }
  }
  const auto lines = makeScanLines(input.settings.geometry, input.pose);
  EXPECT_EQ(collisionLimitWarning(*scene, lines, inputOf(true).settings.tracing), "");
  const std::string sentence = probeContactWarning(*scene, lines);
  expectContains(sentence, "holds nothing but what lies outside of a body (air)");
  expectContains(sentence, "choose the array that holds the labels");
}

TEST(HardInput, AFrequencyAboveHalfTheSamplingNamesTheWayOut)
{
  EchoSettings s;
  s.samplingMHz = 20.0;
  s.centreFrequencyMHz = 12.0;
  expectContains(
    errorOf([&] { s.validate(); }),
    "the sampling frequency of 20 MHz is not above twice the centre frequency of 12 MHz: raise Sampling (MHz) "
    "above 24, or lower the probe's Centre Frequency");
  s.imagingMode = ImagingMode::Harmonic;
  expectContains(errorOf([&] { s.validate(); }),
                 "the second harmonic lies at 12 MHz, not below half the sampling frequency of 20 MHz: raise Sampling "
                 "(MHz) above 24, lower the probe's Centre Frequency, or set its Imaging Mode to Fundamental");
  s.samplingMHz = 24.1;
  EXPECT_EQ(errorOf([&] { s.validate(); }), "no error");
}
