#include "Image/BMode.h"
#include "Image/ScanConvert.h"
#include "ImageTestTools.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace {

using namespace sono;

constexpr double pi = 3.141592653589793;

ScanGeometry geometryOf(ScanKind kind)
{
  ScanGeometry geometry;
  geometry.kind = kind;
  geometry.lineCount = 128;
  geometry.depthMm = 120.0;
  geometry.sectorDeg = kind == ScanKind::Curvilinear ? 70.0 : 90.0;
  geometry.radiusMm = 60.0;
  geometry.widthMm = 38.0;
  return geometry;
}

double sectorAreaMm2(const ScanGeometry& geometry)
{
  if (geometry.kind == ScanKind::Linear)
  {
    return geometry.widthMm * geometry.depthMm;
  }
  const double inner = geometry.kind == ScanKind::Curvilinear ? geometry.radiusMm : 0.0;
  const double outer = inner + geometry.depthMm;
  return 0.5 * geometry.sectorDeg * pi / 180.0 * (outer * outer - inner * inner);
}

double perimeterMm(const ScanGeometry& geometry)
{
  if (geometry.kind == ScanKind::Linear)
  {
    return 2.0 * (geometry.widthMm + geometry.depthMm);
  }
  const double inner = geometry.kind == ScanKind::Curvilinear ? geometry.radiusMm : 0.0;
  const double outer = inner + geometry.depthMm;
  return geometry.sectorDeg * pi / 180.0 * (inner + outer) + 2.0 * geometry.depthMm;
}

/// (angle in degrees or lateral mm, r in mm) of a plane position, from the definition of the three layouts.
std::pair<double, double> polar(const ScanGeometry& geometry, double lateralMm, double axialMm)
{
  if (geometry.kind == ScanKind::Linear)
  {
    return { lateralMm, axialMm };
  }
  const double centre = geometry.kind == ScanKind::Curvilinear ? geometry.radiusMm : 0.0;
  return { std::atan2(lateralMm, axialMm + centre) * 180.0 / pi, std::hypot(lateralMm, axialMm + centre) - centre };
}

class ScanConversion : public testing::TestWithParam<ScanKind>
{
};

TEST_P(ScanConversion, LinearRampReturnsTheRamp)
{
  const ScanGeometry geometry = geometryOf(GetParam());
  const bool linear = geometry.kind == ScanKind::Linear;
  const double sampleMm = 0.1;
  const int sampleCount = 1201;
  const double span = linear ? geometry.widthMm : geometry.sectorDeg;
  const auto ramp = [&](double u, double r) { return u / span + r / geometry.depthMm; }; // -0.5 to 1.5
  std::vector<float> values;
  for (int l = 0; l < geometry.lineCount; ++l)
  {
    for (int s = 0; s < sampleCount; ++s)
    {
      values.push_back(static_cast<float>(ramp(span * (l / (geometry.lineCount - 1.0) - 0.5), s * sampleMm)));
    }
  }
  const PlaneImage image = scanConvert(geometry, values, sampleCount, sampleMm, 0.23);
  ASSERT_EQ(image.value.size(), std::size_t(image.width) * image.height);
  std::size_t inside = 0;
  double worst = 0.0;
  for (int j = 0; j < image.height; ++j)
  {
    for (int i = 0; i < image.width; ++i)
    {
      const std::size_t k = std::size_t(j) * image.width + i;
      const double lateral = image.lateralMinMm + i * image.pixelMm;
      const double axial = image.axialMinMm + j * image.pixelMm;
      const bool apex = GetParam() == ScanKind::PhasedSector && std::hypot(lateral, axial) < 1e-3; // any angle
      if (image.mask[k] == 0)
      {
        EXPECT_EQ(image.value[k], 0.0f);
      }
      else if (!apex)
      {
        const auto [u, r] = polar(geometry, lateral, axial);
        worst = std::max(worst, std::abs(image.value[k] - ramp(u, r)));
        ++inside;
      }
    }
  }
  EXPECT_GT(inside, 50000u);
  EXPECT_LT(worst, 1e-4);
}

TEST_P(ScanConversion, PixelsAgreeWithBeamFromPlane)
{
  const ScanGeometry geometry = geometryOf(GetParam());
  const int sampleCount = 1201;
  const double sampleMm = 0.1;
  const int last = geometry.lineCount - 1;
  std::vector<float> lineNumber, depth;
  for (int l = 0; l <= last; ++l)
  {
    for (int s = 0; s < sampleCount; ++s)
    {
      lineNumber.push_back(static_cast<float>(l));
      depth.push_back(static_cast<float>(s * sampleMm));
    }
  }
  const PlaneImage lines = scanConvert(geometry, lineNumber, sampleCount, sampleMm, 0.37);
  const PlaneImage depths = scanConvert(geometry, depth, sampleCount, sampleMm, 0.37);
  for (std::size_t k = 0; k < lines.value.size(); ++k)
  {
    const double lateral = lines.lateralMinMm + double(k % lines.width) * lines.pixelMm;
    const double axial = lines.axialMinMm + double(k / lines.width) * lines.pixelMm;
    if (std::hypot(lateral, axial) < 0.5)
    {
      continue; // at the apex the line is undefined
    }
    const Vec2f beam = beamFromPlane(geometry, lateral, axial);
    if (lines.mask[k])
    {
      ASSERT_NEAR(lines.value[k], beam.x, 3e-4) << lateral << ' ' << axial;
      ASSERT_NEAR(depths.value[k], beam.y, 1e-4) << lateral << ' ' << axial;
    }
    else
    {
      const bool seen = beam.x > 1e-3f && beam.x < last - 1e-3f && beam.y > 1e-3f && beam.y < geometry.depthMm - 1e-3;
      ASSERT_FALSE(seen) << lateral << ' ' << axial;
    }
  }
}

TEST_P(ScanConversion, MaskHasTheSectorsArea)
{
  const ScanGeometry geometry = geometryOf(GetParam());
  for (const double pixelMm : { 0.23, 0.5 })
  {
    const PlaneImage image = scanConvert(geometry, std::vector<float>(128 * 1201, 1.0f), 1201, 0.1, pixelMm);
    const double area = std::accumulate(image.mask.begin(), image.mask.end(), 0.0) * pixelMm * pixelMm;
    // Steiner: pixel centres on every edge of a rectangle add half its perimeter and one pixel
    const double tolerance = (0.5 * perimeterMm(geometry) + pixelMm) * pixelMm;
    EXPECT_NEAR(area, sectorAreaMm2(geometry), tolerance) << pixelMm;
  }
}

TEST_P(ScanConversion, GridCoversTheSectorTightly)
{
  const ScanGeometry geometry = geometryOf(GetParam());
  const double pixelMm = 0.3;
  const PlaneImage image = scanConvert(geometry, std::vector<float>(128 * 2, 1.0f), 2, 60.0, pixelMm);
  double left = 1e9, right = -1e9, near = 1e9, far = -1e9;
  for (double f = 0.0; f <= 1.0; f += 1.0 / 64.0)
  {
    for (const double r : { 0.0, geometry.depthMm })
    {
      const Vec2f p = planeFromBeam(geometry, f * (geometry.lineCount - 1), r);
      left = std::min(left, double(p.x));
      right = std::max(right, double(p.x));
      near = std::min(near, double(p.y));
      far = std::max(far, double(p.y));
    }
  }
  const double imageRight = image.lateralMinMm + (image.width - 1) * pixelMm;
  const double imageFar = image.axialMinMm + (image.height - 1) * pixelMm;
  const double rounding = 1e-4;
  EXPECT_LE(image.lateralMinMm, left + rounding);
  EXPECT_GT(image.lateralMinMm, left - pixelMm);
  EXPECT_GE(imageRight, right - rounding);
  EXPECT_LT(imageRight, right + pixelMm);
  EXPECT_NEAR(image.axialMinMm, near, rounding);
  EXPECT_GE(imageFar, far - rounding);
  EXPECT_LT(imageFar, far + pixelMm);
}

TEST_P(ScanConversion, OneLineIsAColumn)
{
  ScanGeometry geometry = geometryOf(GetParam());
  geometry.lineCount = 1;
  geometry.depthMm = 10.0;
  std::vector<float> ramp(101);
  std::iota(ramp.begin(), ramp.end(), 0.0f);
  const PlaneImage image = scanConvert(geometry, ramp, 101, 0.1, 0.25);
  ASSERT_EQ(image.width, 1);
  ASSERT_EQ(image.height, 41);
  EXPECT_EQ(image.lateralMinMm, 0.0);
  for (int j = 0; j < image.height; ++j)
  {
    EXPECT_EQ(image.mask[j], 1);
    EXPECT_NEAR(image.value[j], 2.5 * j, 1e-4);
  }
}

TEST_P(ScanConversion, OneSampleFillsItsDepth)
{
  ScanGeometry geometry = geometryOf(GetParam());
  const PlaneImage image = scanConvert(geometry, std::vector<float>(128, 3.0f), 1, 30.0, 0.5);
  for (std::size_t k = 0; k < image.value.size(); ++k)
  {
    const auto [u, r] = polar(geometry, image.lateralMinMm + double(k % image.width) * 0.5,
                              image.axialMinMm + double(k / image.width) * 0.5);
    EXPECT_EQ(image.value[k], image.mask[k] ? 3.0f : 0.0f);
    if (r > 30.01)
    {
      EXPECT_EQ(image.mask[k], 0) << u << ' ' << r;
    }
  }
  EXPECT_GT(std::count(image.mask.begin(), image.mask.end(), 1), 1000);
}

TEST_P(ScanConversion, MirroredLinesGiveAMirroredImage)
{
  const ScanGeometry geometry = geometryOf(GetParam());
  const int sampleCount = 300;
  const auto values = rayleighEnvelope(std::size_t(geometry.lineCount) * sampleCount, 3);
  std::vector<float> mirrored;
  for (int l = geometry.lineCount - 1; l >= 0; --l)
  {
    mirrored.insert(mirrored.end(), values.begin() + l * sampleCount, values.begin() + (l + 1) * sampleCount);
  }
  const PlaneImage a = scanConvert(geometry, values, sampleCount, 0.4, 0.23);
  const PlaneImage b = scanConvert(geometry, mirrored, sampleCount, 0.4, 0.23);
  for (int j = 0; j < a.height; ++j)
  {
    for (int i = 0; i < a.width; ++i)
    {
      const std::size_t k = std::size_t(j) * a.width;
      ASSERT_EQ(a.mask[k + i], b.mask[k + a.width - 1 - i]);
      ASSERT_NEAR(a.value[k + i], b.value[k + a.width - 1 - i], 1e-3);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllKinds, ScanConversion,
                         testing::Values(ScanKind::Linear, ScanKind::PhasedSector, ScanKind::Curvilinear),
                         [](const auto& info) {
                           return info.param == ScanKind::Linear         ? "Linear"
                                  : info.param == ScanKind::PhasedSector ? "PhasedSector"
                                                                         : "Curvilinear";
                         });

TEST(ScanConvert, RefusesWhatMakesNoSense)
{
  const ScanGeometry geometry = geometryOf(ScanKind::PhasedSector);
  const std::vector<float> values(128 * 2, 1.0f);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expectError([&] { scanConvert(geometry, values, 2, 60.0, 0.0); }, "pixelMm");
  expectError([&] { scanConvert(geometry, values, 2, 60.0, nan); }, "pixelMm");
  expectError([&] { scanConvert(geometry, values, 2, 60.0, 1e-4); }, "pixelMm");
  expectError([&] { scanConvert(geometry, values, 2, 60.0, 1e-300); }, "pixelMm");
  expectError([&] { scanConvert(geometry, values, 0, 60.0, 0.5); }, "sampleCount");
  expectError([&] { scanConvert(geometry, values, 3, 60.0, 0.5); }, "values");
  expectError([&] { scanConvert(geometry, values, 2, 0.0, 0.5); }, "sampleMm");
  EXPECT_THROW(
    {
      ScanGeometry none = geometry;
      none.lineCount = 0;
      scanConvert(none, {}, 2, 60.0, 0.5);
    },
    Error);
}

TEST(Image, DoesNotDependOnTheNumberOfThreads)
{
  const ScanGeometry geometry = geometryOf(ScanKind::PhasedSector);
  const int sampleCount = 2000;
  const auto envelope = rayleighEnvelope(std::size_t(geometry.lineCount) * sampleCount, 11);
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const BModeLines lines = makeBMode(envelope, geometry.lineCount, sampleCount, 0.06, BModeSettings{});
    return std::make_pair(lines.referenceAmplitude, scanConvert(geometry, lines.grey, sampleCount, 0.06, 0.23).value);
  };
  EXPECT_EQ(run(1), run(4));
}

} // namespace
