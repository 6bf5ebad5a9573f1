#include "ErrorText.h"
#include "Image/ScanConvert.h"
#include "Image/ScanConvertVolume.h"
#include "Kernel/PixelMath.h"
#include "Probe/ScanGeometry.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

constexpr double pi = 3.141592653589793;

ScanGeometry matrix()
{
  ScanGeometry geometry;
  geometry.kind = ScanKind::Matrix;
  geometry.lineCount = 25;
  geometry.elevationLineCount = 17;
  geometry.depthMm = 60.0;
  geometry.sectorDeg = 80.0;
  geometry.elevationSectorDeg = 50.0;
  return geometry;
}

ScanGeometry radial(double sectorDeg)
{
  ScanGeometry geometry;
  geometry.kind = ScanKind::Radial;
  geometry.lineCount = 200;
  geometry.depthMm = 40.0;
  geometry.radiusMm = 3.0;
  geometry.sectorDeg = sectorDeg;
  return geometry;
}

void expectNear(const Vec3d& a, const Vec3d& b, double tolerance)
{
  EXPECT_LE(glm::length(a - b), tolerance)
    << a.x << ' ' << a.y << ' ' << a.z << " for " << b.x << ' ' << b.y << ' ' << b.z;
}

} // namespace

TEST(MatrixScan, LinesByHand)
{
  ScanGeometry geometry = matrix();
  geometry.lineCount = 3;
  geometry.elevationLineCount = 3;
  geometry.sectorDeg = 60.0;
  geometry.elevationSectorDeg = 90.0;
  const auto lines = makeScanLines(geometry, ProbePose()); // axial z, lateral x, elevation y
  ASSERT_EQ(lines.size(), 9u);
  const double root3 = std::sqrt(3.0);
  const double root2 = std::sqrt(2.0);
  expectNear(lines[4].axis, { 0.0, 0.0, 1.0 }, 1e-12);
  expectNear(lines[3].axis, { -0.5, 0.0, root3 / 2.0 }, 1e-12);
  expectNear(lines[7].axis, { 0.0, root2 / 2.0, root2 / 2.0 }, 1e-12);
  expectNear(lines[8].axis, { 0.5, root3 * root2 / 4.0, root3 * root2 / 4.0 }, 1e-12);
  expectNear(lines[1].axis, { 0.0, -root2 / 2.0, root2 / 2.0 }, 1e-12);
  for (const ScanLine& line : lines)
  {
    expectNear(line.originMm, Vec3d(0.0), 0.0);
    expectNear(glm::cross(line.axis, line.lateral), line.elevation, 1e-12);
    EXPECT_NEAR(glm::length(line.elevation), 1.0, 1e-12);
    EXPECT_NEAR(glm::dot(line.axis, line.lateral), 0.0, 1e-12);
  }
}

TEST(MatrixScan, VolumeAndBeamAreInverse)
{
  const ScanGeometry geometry = matrix();
  const auto lines = makeScanLines(geometry, ProbePose());
  for (int e = 0; e < geometry.elevationLineCount; ++e)
  {
    for (int l = 0; l < geometry.lineCount; ++l)
    {
      const Vec3d point = 37.0 * lines[std::size_t(e * geometry.lineCount + l)].axis;
      expectNear(volumeFromBeam(geometry, l, e, 37.0), point, 1e-12);
      expectNear(beamFromVolume(geometry, point), { l, e, 37.0 }, 1e-10);
    }
  }
  expectNear(beamFromVolume(geometry, volumeFromBeam(geometry, 3.7, 11.2, 5.0)), { 3.7, 11.2, 5.0 }, 1e-10);
  EXPECT_TRUE(std::isnan(beamFromVolume(geometry, { 0.0, 0.0, 60.1 }).x));
  EXPECT_TRUE(std::isnan(beamFromVolume(geometry, { 0.0, 0.0, -5.0 }).y));
  EXPECT_TRUE(std::isnan(beamFromVolume(geometry, { 30.0 * std::tan(41.0 * pi / 180.0), 0.0, 30.0 }).x));
  EXPECT_TRUE(std::isnan(beamFromVolume(geometry, { 0.0, 30.0 * std::tan(26.0 * pi / 180.0), 30.0 }).z));
}

TEST(MatrixScan, LinearRampReturnsTheRamp)
{
  const ScanGeometry geometry = matrix();
  const double sampleMm = 0.2;
  const int sampleCount = 301;
  // theta, phi and r shares of their spans, from -1 to 2
  const auto ramp = [&](double theta, double phi, double r) { return theta / 80.0 + phi / 50.0 + r / 60.0; };
  std::vector<float> values;
  for (int e = 0; e < 17; ++e)
  {
    for (int l = 0; l < 25; ++l)
    {
      for (int s = 0; s < sampleCount; ++s)
      {
        values.push_back(float(ramp(80.0 * (l / 24.0 - 0.5), 50.0 * (e / 16.0 - 0.5), s * sampleMm)));
      }
    }
  }
  const double voxelMm = 0.7;
  const VolumeImage image = scanConvertVolume(geometry, values, sampleCount, sampleMm, voxelMm);
  ASSERT_EQ(image.value.size(), image.voxelCount());
  double worst = 0.0;
  double inside = 0.0;
  for (std::size_t n = 0; n < image.value.size(); ++n)
  {
    const std::size_t nx = std::size_t(image.size.x), ny = std::size_t(image.size.y);
    const Vec3d p = image.minMm + voxelMm * Vec3d(double(n % nx), double(n / nx % ny), double(n / nx / ny));
    if (image.mask[n] == 0)
    {
      ASSERT_EQ(image.value[n], 0.0f);
    }
    else if (glm::length(p) > 1e-3) // at the apex the angles are undefined
    {
      const double theta = std::asin(p.x / glm::length(p)) * 180.0 / pi;
      const double phi = std::atan(p.y / p.z) * 180.0 / pi;
      worst = std::max(worst, std::abs(image.value[n] - ramp(theta, phi, glm::length(p))));
      inside += 1.0;
    }
  }
  EXPECT_LT(worst, 1e-4);
  // integral of r^2 cos(theta) over the scanned angles and depths
  const double exact = std::pow(60.0, 3) / 3.0 * 2.0 * std::sin(40.0 * pi / 180.0) * 50.0 * pi / 180.0;
  EXPECT_NEAR(inside * voxelMm * voxelMm * voxelMm / exact, 1.0, 0.01);
}

TEST(MatrixScan, OneElevationIsThePlaneInTheMiddle)
{
  ScanGeometry geometry = matrix();
  geometry.elevationLineCount = 3;
  std::vector<float> values(3 * 25 * 61, 1e4f);
  const auto middle = values.begin() + 25 * 61;
  std::iota(middle, middle + 25 * 61, 0.0f);
  const VolumeImage volume = scanConvertVolume(geometry, values, 61, 1.0, 0.5);
  expectContains(errorOf([&] { scanConvert(geometry, values, 61, 1.0, 0.5); }), "scanConvertVolume");
  const auto lines = makeScanLines(geometry, ProbePose());

  geometry.elevationLineCount = 1;
  const std::vector<float> ofPlane(middle, middle + 25 * 61);
  const PlaneImage plane = scanConvert(geometry, ofPlane, 61, 1.0, 0.5);
  const int row = volume.size.y / 2;
  EXPECT_EQ(volume.minMm.y + row * 0.5, 0.0);
  ASSERT_EQ(volume.size.x, plane.width);
  ASSERT_EQ(volume.size.z, plane.height);
  for (int k = 0; k < plane.height; ++k)
  {
    for (int i = 0; i < plane.width; ++i)
    {
      const std::size_t inVolume = std::size_t(i + plane.width * (row + volume.size.y * k));
      const std::size_t inPlane = std::size_t(i + plane.width * k);
      ASSERT_EQ(volume.mask[inVolume], plane.mask[inPlane]) << i << ' ' << k;
      ASSERT_NEAR(volume.value[inVolume], plane.value[inPlane], 2e-3) << i << ' ' << k; // values up to 1525
    }
  }
  expectContains(errorOf([&] { scanConvertVolume(geometry, ofPlane, 61, 1.0, 0.5); }), "scanConvert");
  const auto planeLines = makeScanLines(geometry, ProbePose());
  ASSERT_EQ(planeLines.size(), 25u);
  for (std::size_t n = 0; n < 25; ++n)
  {
    expectNear(planeLines[n].axis, lines[25 + n].axis, 1e-12);
    expectNear(planeLines[n].elevation, lines[25 + n].elevation, 1e-12);
  }
}

TEST(MatrixScan, DoesNotDependOnTheNumberOfThreads)
{
  const ScanGeometry geometry = matrix();
  std::vector<float> values(25 * 17 * 100);
  std::iota(values.begin(), values.end(), 0.0f);
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return scanConvertVolume(geometry, values, 100, 0.6, 1.0).value;
  };
  EXPECT_EQ(run(1), run(4));
  EXPECT_THROW(scanConvertVolume(geometry, values, 100, 0.6, 1.0, [](double) { return false; }), Aborted);
}

TEST(MatrixScan, RefusesWhatMakesNoSense)
{
  const std::vector<float> values(25 * 17 * 2);
  expectContains(errorOf([&] { scanConvertVolume(matrix(), values, 2, 30.0, 0.0); }), "voxelMm");
  expectContains(errorOf([&] { scanConvertVolume(matrix(), values, 2, 30.0, 1e-3); }), "voxelMm");
  expectContains(errorOf([&] { scanConvertVolume(matrix(), values, 2, -1.0, 1.0); }), "sampleMm");
  expectContains(errorOf([&] { scanConvertVolume(matrix(), values, 0, 30.0, 1.0); }), "sampleCount");
  expectContains(errorOf([&] { scanConvertVolume(matrix(), values, 3, 30.0, 1.0); }), "must have elevations");
  const auto refusal = [](const std::function<void(ScanGeometry&)>& change) {
    ScanGeometry geometry = matrix();
    change(geometry);
    return errorOf([&] { makeScanLines(geometry, ProbePose()); });
  };
  expectContains(refusal([](auto& g) { g.elevationLineCount = 0; }), "elevationLineCount is 0");
  expectContains(refusal([](auto& g) { g.elevationLineCount = g.lineCount = 1000; }), "between 1 and 65536");
  expectContains(refusal([](auto& g) { g.elevationSectorDeg = 180.0; }), "elevationSectorDeg is 180");
  expectContains(refusal([](auto& g) { g.sectorDeg = 200.0; }), "sectorDeg is 200");
  EXPECT_EQ(errorOf([] { radial(360.0).validate(); }), "no error");
  expectContains(errorOf([] { radial(361.0).validate(); }), "sectorDeg is 361");
  ScanGeometry needle = radial(90.0);
  needle.radiusMm = 0.0;
  expectContains(errorOf([&] { needle.validate(); }), "radiusMm is 0");
}

TEST(MatrixScan, VoxelsFitAtTheDefaults)
{
  ScanGeometry geometry;
  geometry.kind = ScanKind::Matrix;
  const double voxelMm = voxelMmThatFits(geometry, 0.23);
  const std::size_t voxels = volumeImageLayout(geometry, voxelMm).voxelCount();
  EXPECT_LE(voxels, std::size_t(1) << 25);
  EXPECT_GT(double(voxels), 0.98 * (1 << 25));
  EXPECT_EQ(voxelMmThatFits(geometry, 0.8), 0.8); // what fits stays
  EXPECT_THROW(voxelMmThatFits(geometry, 0.0), Error);
}

TEST(RadialScan, AngleAgreesWithAtan2)
{
  for (int k = -1999; k <= 2000; ++k)
  {
    const double angle = k * (pi / 2000.0);
    const auto y = float(43.0 * std::sin(angle));
    const auto x = float(43.0 * std::cos(angle));
    EXPECT_NEAR(fastAtan2(y, x), std::atan2(double(y), double(x)), 4e-7) << k;
  }
}

TEST(RadialScan, LinesGoRoundTheCatheter)
{
  ScanGeometry geometry = radial(360.0);
  geometry.lineCount = 4;
  const auto lines = makeScanLines(geometry, ProbePose());
  const Vec3d axes[] = { { 0, 0, -1 }, { -1, 0, 0 }, { 0, 0, 1 }, { 1, 0, 0 } };
  for (int n = 0; n < 4; ++n)
  {
    const ScanLine& line = lines[std::size_t(n)];
    expectNear(line.axis, axes[n], 1e-12);
    expectNear(line.originMm, 3.0 * axes[n], 1e-12);
    expectNear(line.elevation, { 0.0, 1.0, 0.0 }, 1e-12);
    expectNear(glm::cross(line.axis, line.lateral), line.elevation, 1e-12);
  }
  geometry.sectorDeg = 180.0;
  geometry.lineCount = 3;
  const auto half = makeScanLines(geometry, ProbePose());
  expectNear(half[0].axis, { -1.0, 0.0, 0.0 }, 1e-12);
  expectNear(half[1].axis, { 0.0, 0.0, 1.0 }, 1e-12);
  expectNear(half[2].axis, { 1.0, 0.0, 0.0 }, 1e-12);
}

TEST(RadialScan, PlaneAndBeamAreInverse)
{
  for (const double sectorDeg : { 45.0, 180.0, 270.0, 359.0, 360.0 })
  {
    const ScanGeometry geometry = radial(sectorDeg);
    for (double line = 0.0; line <= 199.0; line += 7.37)
    {
      const Vec2f plane = planeFromBeam(geometry, line, 20.0);
      EXPECT_NEAR(std::hypot(plane.x, plane.y), 23.0, 1e-5);
      const Vec2f beam = beamFromPlane(geometry, plane.x, plane.y);
      const double turn = std::abs(beam.x - line);
      EXPECT_NEAR(std::min(turn, std::abs(200.0 - turn)), 0.0, 1e-3) << sectorDeg << ' ' << line;
      EXPECT_NEAR(beam.y, 20.0, 1e-5);
    }
    EXPECT_TRUE(std::isnan(beamFromPlane(geometry, 0.0, 2.9).x)); // in the catheter
    EXPECT_TRUE(std::isnan(beamFromPlane(geometry, 0.0, 43.1).x));
    EXPECT_EQ(std::isnan(beamFromPlane(geometry, 0.0, -10.0).x), sectorDeg < 360.0);
  }
  // Between the last line and the first of a closed circle
  const Vec2f seam = planeFromBeam(radial(360.0), 199.5, 10.0);
  EXPECT_NEAR(beamFromPlane(radial(360.0), seam.x, seam.y).x, 199.5, 1e-3);
}

TEST(RadialScan, FullCircleHasNoSeam)
{
  // A function of position that is linear from line to line is not periodic; one harmonic is, and 200 lines sample it
  // to (2 pi / 200)^2 / 8 = 1.2e-4 of its amplitude.
  const ScanGeometry geometry = radial(360.0);
  std::vector<float> values;
  for (int l = 0; l < 200; ++l)
  {
    const double angle = 2.0 * pi * (l / 200.0 - 0.5);
    values.insert(values.end(), 401, float(1.0 + 0.5 * std::sin(angle + 0.3)));
  }
  const PlaneImage image = scanConvert(geometry, values, 401, 0.1, 0.25);
  double worst = 0.0;
  for (int j = 0; j < image.height; ++j)
  {
    for (int i = 0; i < image.width; ++i)
    {
      const double x = image.lateralMinMm + i * 0.25;
      const double z = image.axialMinMm + j * 0.25;
      const double r = std::hypot(x, z) - 3.0;
      const std::uint8_t mask = image.mask[std::size_t(j) * std::size_t(image.width) + std::size_t(i)];
      ASSERT_EQ(mask, r > -1e-5 && r < 40.00001 ? 1 : 0) << x << ' ' << z;
      if (mask)
      {
        const double exact = 1.0 + 0.5 * std::sin(std::atan2(x, z) + 0.3);
        const float value = image.value[std::size_t(j) * std::size_t(image.width) + std::size_t(i)];
        worst = std::max(worst, std::abs(value - exact));
      }
    }
  }
  EXPECT_LT(worst, 1e-4);
}

TEST(RadialScan, RampAndAreaOfAnOpenFan)
{
  for (const double sectorDeg : { 60.0, 180.0, 300.0 })
  {
    const ScanGeometry geometry = radial(sectorDeg);
    std::vector<float> values;
    for (int l = 0; l < 200; ++l)
    {
      for (int s = 0; s < 401; ++s)
      {
        values.push_back(float(l / 199.0 + s / 400.0));
      }
    }
    const double pixelMm = 0.2;
    const PlaneImage image = scanConvert(geometry, values, 401, 0.1, pixelMm);
    double worst = 0.0;
    double inside = 0.0;
    for (std::size_t n = 0; n < image.value.size(); ++n)
    {
      const double x = image.lateralMinMm + double(n % std::size_t(image.width)) * pixelMm;
      const double z = image.axialMinMm + double(n / std::size_t(image.width)) * pixelMm;
      if (image.mask[n])
      {
        const double line = std::atan2(x, z) * 180.0 / pi / sectorDeg + 0.5;
        worst = std::max(worst, std::abs(image.value[n] - (line + (std::hypot(x, z) - 3.0) / 40.0)));
        inside += pixelMm * pixelMm;
      }
    }
    EXPECT_LT(worst, 1e-4) << sectorDeg;
    const double extent = sectorDeg * pi / 180.0;
    const double perimeter = extent * (3.0 + 43.0) + 80.0;
    EXPECT_NEAR(inside, 0.5 * extent * (43.0 * 43.0 - 9.0), (0.5 * perimeter + pixelMm) * pixelMm) << sectorDeg;
  }
}

TEST(RadialScan, OneLineIsAColumn)
{
  ScanGeometry geometry = radial(360.0);
  geometry.lineCount = 1;
  std::vector<float> ramp(401);
  std::iota(ramp.begin(), ramp.end(), 0.0f);
  const PlaneImage image = scanConvert(geometry, ramp, 401, 0.1, 0.5);
  ASSERT_EQ(image.width, 1);
  ASSERT_EQ(image.height, 81);
  EXPECT_NEAR(image.axialMinMm, 3.0, 1e-12);
  for (int j = 0; j < 81; ++j)
  {
    EXPECT_EQ(image.mask[std::size_t(j)], 1);
    EXPECT_NEAR(image.value[std::size_t(j)], 5.0 * j, 1e-3);
  }
}

TEST(ScanOutline, LiesOnTheBorderOfTheScannedArea)
{
  ScanGeometry sector;
  const auto planar = scanOutline(sector);
  ASSERT_EQ(planar.size(), 2u);
  expectNear(planar[0].front(), planar[0].back(), 0.0);
  expectNear(planar[0].front(), { -160.0 * std::sqrt(0.5), 0.0, 160.0 * std::sqrt(0.5) }, 1e-4);
  ScanGeometry linear;
  linear.kind = ScanKind::Linear;
  const auto box = scanOutline(linear)[0];
  ASSERT_EQ(box.size(), 5u);
  expectNear(box[1], { 19.0, 0.0, 160.0 }, 1e-5);
  expectNear(box[3], { -19.0, 0.0, 0.0 }, 1e-5);

  const auto rings = scanOutline(radial(360.0));
  ASSERT_EQ(rings.size(), 2u);
  for (const Vec3d& p : rings[0])
  {
    EXPECT_NEAR(glm::length(p), 43.0, 1e-5);
  }
  expectNear(rings[0].front(), rings[0].back(), 1e-4);
  expectNear(rings[1].front(), { 0.0, 0.0, -3.0 }, 1e-5);

  const auto volume = scanOutline(matrix());
  ASSERT_EQ(volume.size(), 5u);
  expectNear(volume[0].front(), volume[0].back(), 1e-12);
  for (const Vec3d& p : volume[0])
  {
    EXPECT_NEAR(glm::length(p), 60.0, 1e-9);
    const Vec3d beam = beamFromVolume(matrix(), p);
    EXPECT_LT(std::min({ beam.x, 24.0 - beam.x, beam.y, 16.0 - beam.y }), 1e-9);
  }
}

TEST(ProbePreset, MatrixAndRadial)
{
  const sono::testing::TemporaryFolder folder;
  const std::string path = folder.file("preset.json");
  const auto entry = [](const std::string& key, const std::string& value) {
    return ", \"" + key + "\": {\"value\": " + value + ", \"source\": \"test\"}";
  };
  const auto write = [&](const std::string& scan, const std::string& more) {
    std::string text = "{\"name\": \"n\", \"scan\": \"" + scan + "\"" + entry("numberOfLines", "64") + more;
    for (const char* key : { "depthMm", "centreFrequencyMHz", "fractionalBandwidth", "elementCount", "elementWidthMm",
                             "kerfMm", "elementHeightMm", "elevationFocusMm", "transmitFocusMm" })
    {
      text += entry(key, "1");
    }
    std::ofstream(path) << text << "}";
  };
  write("matrix", entry("sectorDeg", "70") + entry("numberOfElevations", "48") + entry("elevationSectorDeg", "50"));
  const ScanGeometry volume = readProbePreset(path).geometry;
  EXPECT_EQ(volume.kind, ScanKind::Matrix);
  EXPECT_EQ(volume.totalLineCount(), 64 * 48);
  EXPECT_EQ(volume.elevationSectorDeg, 50.0);
  write("matrix", entry("sectorDeg", "70") + entry("numberOfElevations", "2000") + entry("elevationSectorDeg", "50"));
  expectContains(errorOf([&] { readProbePreset(path); }), "between 1 and 65536");
  write("radial", entry("sectorDeg", "360") + entry("radiusMm", "1.2"));
  const ScanGeometry ring = readProbePreset(path).geometry;
  EXPECT_EQ(ring.kind, ScanKind::Radial);
  EXPECT_TRUE(ring.closesCircle());
  write("radial", entry("sectorDeg", "361") + entry("radiusMm", "1.2"));
  expectContains(errorOf([&] { readProbePreset(path); }), "at most 360");
}
