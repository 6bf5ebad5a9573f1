#include "Echo/FormRf.h"
#include "Image/BMode.h"
#include "Image/ScanConvert.h"
#include "ImageTestTools.h"
#include "Simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace {

using namespace sono;

ScanGeometry compounded(ScanKind kind, int fans, double spanDeg)
{
  ScanGeometry geometry;
  geometry.kind = kind;
  geometry.lineCount = 96;
  geometry.depthMm = 60.0;
  geometry.sectorDeg = 60.0;
  geometry.radiusMm = 40.0;
  geometry.widthMm = 40.0;
  geometry.compoundFans = fans;
  geometry.compoundSpanDeg = spanDeg;
  return geometry;
}

constexpr double sampleMm = 0.1;
constexpr int sampleCount = 601;

/// What a function of fan, lateral and axial mm is along each line, as the lines themselves lie.
std::vector<float> along(const ScanGeometry& geometry, const std::function<double(int, double, double)>& f)
{
  std::vector<float> values;
  const auto lines = makeScanLines(geometry, ProbePose());
  for (std::size_t l = 0; l < lines.size(); ++l)
  {
    for (int s = 0; s < sampleCount; ++s)
    {
      const Vec3d place = lines[l].originMm + s * sampleMm * lines[l].axis;
      values.push_back(float(f(int(l) / geometry.lineCount, place.x, place.z)));
    }
  }
  return values;
}

float pixel(const PlaneImage& image, const std::vector<float>& values, double lateralMm, double axialMm)
{
  const auto i = std::size_t(std::lround((lateralMm - image.lateralMinMm) / image.pixelMm));
  const auto j = std::size_t(std::lround((axialMm - image.axialMinMm) / image.pixelMm));
  return values[j * std::size_t(image.width) + i];
}

TEST(Compounding, FansMeetWhereTheyAreInSpace)
{
  for (const ScanKind kind : { ScanKind::Linear, ScanKind::Curvilinear })
  {
    const auto field = [](int, double x, double z) { return 0.3 + 0.004 * x + 0.006 * z; };
    const ScanGeometry geometry = compounded(kind, 5, 30.0);
    const PlaneImage image = scanConvert(geometry, along(geometry, field), sampleCount, sampleMm, 0.3);
    const ScanGeometry single = compounded(kind, 1, 30.0);
    const PlaneImage straight = scanConvert(single, along(single, field), sampleCount, sampleMm, 0.3);
    ASSERT_EQ(image.width, straight.width);
    EXPECT_EQ(image.mask, straight.mask); // the straight one of the five sees all of it
    for (int j = 0; j < image.height; ++j)
    {
      for (int i = 0; i < image.width; ++i)
      {
        const std::size_t at = std::size_t(j) * std::size_t(image.width) + std::size_t(i);
        const double lateral = image.lateralMinMm + i * image.pixelMm;
        const double expected = field(0, lateral, image.axialMinMm + j * image.pixelMm);
        // Between the radii of a fan the field is not quite linear.
        ASSERT_NEAR(image.value[at], image.mask[at] ? expected : 0.0, 2e-4) << int(kind) << " " << i << " " << j;
      }
    }
  }
}

TEST(Compounding, AverageIsOfTheFansThatSeeAPlace)
{
  // Fans at -10, 0 and 10 degrees, 40 mm wide: 50 mm deep a steered fan stands 8.8 mm to its side.
  const ScanGeometry geometry = compounded(ScanKind::Linear, 3, 20.0);
  const auto values = along(geometry, [](int fan, double, double) { return fan; });
  const PlaneImage image = scanConvert(geometry, values, sampleCount, sampleMm, 0.5);
  EXPECT_NEAR(pixel(image, image.value, 0.0, 50.0), 1.0, 1e-6);
  EXPECT_NEAR(pixel(image, image.value, -17.0, 50.0), 0.5, 1e-6); // of the first and the second
  EXPECT_NEAR(pixel(image, image.value, 17.0, 50.0), 1.5, 1e-6);
  EXPECT_NEAR(pixel(image, image.value, 17.0, 10.0), 1.0, 1e-6); // 1.8 mm to the side: all three
  EXPECT_NEAR(pixel(image, image.value, 0.0, 59.5), 1.0, 1e-6);  // the straight one alone is as deep
  // Without a straight one nothing is seen there.
  const ScanGeometry two = compounded(ScanKind::Linear, 2, 20.0);
  const PlaneImage gap =
    scanConvert(two, along(two, [](int, double, double) { return 1.0; }), sampleCount, sampleMm, 0.5);
  EXPECT_EQ(gap.mask[std::size_t(gap.width) * std::size_t(gap.height - 1) + std::size_t(gap.width / 2)], 0);
}

TEST(Compounding, LinesFromOnePointAreNotCompounded)
{
  for (const ScanKind kind : { ScanKind::PhasedSector, ScanKind::Radial, ScanKind::Matrix })
  {
    ScanGeometry geometry = compounded(kind, 5, 30.0);
    geometry.elevationLineCount = 3;
    EXPECT_EQ(geometry.fanCount(), 1);
    EXPECT_EQ(geometry.totalLineCount(), kind == ScanKind::Matrix ? 3 * 96 : 96);
  }
  ScanGeometry geometry = compounded(ScanKind::Linear, 16, 30.0);
  expectError([&] { geometry.validate(); }, "compoundFans");
  geometry = compounded(ScanKind::Linear, 3, 61.0);
  expectError([&] { geometry.validate(); }, "compoundSpanDeg");
  geometry.kind = ScanKind::PhasedSector; // where it is not used
  geometry.validate();
}

/// Settings of an image of points, with a small aperture.
ImageSettings ofPoints(ScanKind kind, int fans, double spanDeg)
{
  ImageSettings settings;
  settings.geometry = compounded(kind, fans, spanDeg);
  settings.geometry.depthMm = 32.0;
  settings.echo.centreFrequencyMHz = 5.0;
  settings.echo.aperture = { 5.0, 5.0, 25.0, 25.0, 0.0, false };
  settings.bmode.tgcDbPerCm = 0.0;
  settings.bmode.automaticReference = false;
  settings.bmode.referenceAmplitude = 10.0;
  settings.bmode.dynamicRangeDb = 150.0; // nothing is clipped
  settings.pixelMm = 0.1;
  settings.matchStages();
  settings.setDevice(Device::Cpu);
  return settings;
}

PlaneImage imageOf(const std::vector<PointScatterer>& points, const ImageSettings& settings)
{
  Simulator simulator;
  const auto lines = makeScanLines(settings.geometry, ProbePose());
  const auto rf =
    simulator.formRf(lines, TracedResult(), settings.echo, std::make_shared<const PointScatterers>(points));
  const auto bmode = simulator.makeBMode(rf, settings.bmode);
  return simulator.scanConvert(settings.geometry, bmode, settings.pixelMm).plane().host();
}

TEST(Compounding, APointStaysWhereItIs)
{
  for (const ScanKind kind : { ScanKind::Linear, ScanKind::Curvilinear })
  {
    const PlaneImage image = imageOf({ { { 3.0, 0.0, 25.0 }, 1.0f } }, ofPoints(kind, 5, 24.0));
    const auto peak = std::size_t(std::max_element(image.value.begin(), image.value.end()) - image.value.begin());
    const double lateral = image.lateralMinMm + double(peak % std::size_t(image.width)) * image.pixelMm;
    const double axial = image.axialMinMm + double(peak / std::size_t(image.width)) * image.pixelMm;
    EXPECT_NEAR(lateral, 3.0, 0.25) << int(kind); // lines are 0.42 mm apart, and more
    EXPECT_NEAR(axial, 25.0, 0.1) << int(kind);
  }
}

TEST(Compounding, SpeckleFallsAsTheRootOfTheFans)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<PointScatterer> points;
  for (int n = 0; n < 60000; ++n)
  {
    points.push_back({ { 24.0 * unit(random) - 12.0, 6.0 * unit(random) - 3.0, 16.0 + 16.0 * unit(random) }, 1.0f });
  }
  const auto scatterDb = [&](int fans) {
    const PlaneImage image = imageOf(points, ofPoints(ScanKind::Linear, fans, 40.0));
    double sum = 0.0;
    double squares = 0.0;
    int count = 0;
    for (double axial = 22.0; axial < 27.0; axial += 0.1)
    {
      for (double lateral = -5.0; lateral < 5.0; lateral += 0.1, ++count)
      {
        const double decibels = 150.0 * pixel(image, image.value, lateral, axial);
        sum += decibels;
        squares += decibels * decibels;
      }
    }
    return std::sqrt(squares / count - sum / count * (sum / count));
  };
  // The logarithm of a Rayleigh amplitude scatters by 5.57 dB. The aperture is seen over 11 degrees from there, and
  // fans 10 degrees apart are nearly independent: 2.5 dB if they were.
  EXPECT_NEAR(scatterDb(1), 5.57, 0.7);
  const double five = scatterDb(5);
  EXPECT_GT(five, 2.2);
  EXPECT_LT(five, 3.4);
}

} // namespace
