#include "ErrorText.h"
#include "Folders.h"
#include "Probe/ScanGeometry.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

namespace fs = std::filesystem;
using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

const double root3 = std::sqrt(3.0);

void expectNear(const Vec3d& a, const Vec3d& b)
{
  EXPECT_LE(glm::length(a - b), 1e-12) << "(" << a.x << ", " << a.y << ", " << a.z << ") for (" << b.x << ", " << b.y
                                       << ", " << b.z << ")";
}

ScanGeometry geometryOf(ScanKind kind)
{
  ScanGeometry geometry;
  geometry.kind = kind;
  geometry.lineCount = 3;
  geometry.depthMm = 100.0;
  geometry.sectorDeg = 60.0;
  geometry.radiusMm = 50.0;
  geometry.widthMm = 38.0;
  return geometry;
}

/// Axial to +y, lateral to +x, so that elevation = axial x lateral points to -z.
ProbePose poseAlongY()
{
  ProbePose pose;
  pose.positionMm = { 1.0, 2.0, 3.0 };
  pose.axial = { 0.0, 5.0, 0.0 };
  pose.lateral = { 2.0, 1.0, 0.0 }; // not yet at a right angle
  return pose;
}

void expectLine(const ScanLine& line, const Vec3d& origin, const Vec3d& axis, const Vec3d& lateral)
{
  expectNear(line.originMm, origin);
  expectNear(line.axis, axis);
  expectNear(line.lateral, lateral);
  expectNear(line.elevation, { 0.0, 0.0, -1.0 });
}

const ScanKind allKinds[] = { ScanKind::Linear, ScanKind::PhasedSector, ScanKind::Curvilinear };

} // namespace

TEST(ProbePose, IsMadeOrthonormal)
{
  const ProbePose pose = poseAlongY().orthonormalized();
  expectNear(pose.axial, { 0.0, 1.0, 0.0 });
  expectNear(pose.lateral, { 1.0, 0.0, 0.0 });
  expectNear(pose.positionMm, { 1.0, 2.0, 3.0 });
}

TEST(ProbePose, RefusesWhatIsNoFrame)
{
  ProbePose pose;
  pose.lateral = { 0.0, 0.0, -2.0 };
  expectContains(errorOf([&] { pose.orthonormalized(); }), "parallel");
  pose.lateral = { 0.0, 0.0, 0.0 };
  expectContains(errorOf([&] { pose.orthonormalized(); }), "zero");
  pose.lateral = { std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0 };
  expectContains(errorOf([&] { pose.orthonormalized(); }), "not finite");
}

TEST(ScanGeometry, LinearLines)
{
  const auto lines = makeScanLines(geometryOf(ScanKind::Linear), poseAlongY());
  ASSERT_EQ(lines.size(), 3u);
  expectLine(lines[0], { -18.0, 2.0, 3.0 }, { 0.0, 1.0, 0.0 }, { 1.0, 0.0, 0.0 });
  expectLine(lines[1], { 1.0, 2.0, 3.0 }, { 0.0, 1.0, 0.0 }, { 1.0, 0.0, 0.0 });
  expectLine(lines[2], { 20.0, 2.0, 3.0 }, { 0.0, 1.0, 0.0 }, { 1.0, 0.0, 0.0 });
}

TEST(ScanGeometry, SectorLines)
{
  const auto lines = makeScanLines(geometryOf(ScanKind::PhasedSector), poseAlongY());
  ASSERT_EQ(lines.size(), 3u);
  expectLine(lines[0], { 1.0, 2.0, 3.0 }, { -0.5, root3 / 2.0, 0.0 }, { root3 / 2.0, 0.5, 0.0 });
  expectLine(lines[1], { 1.0, 2.0, 3.0 }, { 0.0, 1.0, 0.0 }, { 1.0, 0.0, 0.0 });
  expectLine(lines[2], { 1.0, 2.0, 3.0 }, { 0.5, root3 / 2.0, 0.0 }, { root3 / 2.0, -0.5, 0.0 });
}

TEST(ScanGeometry, CurvilinearLines)
{
  // The outer lines start at 50 (sin 30, cos 30 - 1) from the face's centre.
  const auto lines = makeScanLines(geometryOf(ScanKind::Curvilinear), poseAlongY());
  ASSERT_EQ(lines.size(), 3u);
  const double back = 2.0 + 25.0 * root3 - 50.0;
  expectLine(lines[0], { -24.0, back, 3.0 }, { -0.5, root3 / 2.0, 0.0 }, { root3 / 2.0, 0.5, 0.0 });
  expectLine(lines[1], { 1.0, 2.0, 3.0 }, { 0.0, 1.0, 0.0 }, { 1.0, 0.0, 0.0 });
  expectLine(lines[2], { 26.0, back, 3.0 }, { 0.5, root3 / 2.0, 0.0 }, { root3 / 2.0, -0.5, 0.0 });
}

TEST(ScanGeometry, OneLinePointsAlongAxial)
{
  for (const ScanKind kind : allKinds)
  {
    ScanGeometry geometry = geometryOf(kind);
    geometry.lineCount = 1;
    const auto lines = makeScanLines(geometry, poseAlongY());
    ASSERT_EQ(lines.size(), 1u);
    expectLine(lines[0], { 1.0, 2.0, 3.0 }, { 0.0, 1.0, 0.0 }, { 1.0, 0.0, 0.0 });
    EXPECT_EQ(beamFromPlane(geometry, 0.0, 40.0), Vec2f(0.0f, 40.0f));
    EXPECT_TRUE(std::isnan(beamFromPlane(geometry, 5.0, 40.0).x));
  }
}

TEST(ScanGeometry, PlaneAndLinesAgree)
{
  // With axial = z and lateral = x at the origin, the plane's coordinates are the world's (x, z).
  for (const ScanKind kind : allKinds)
  {
    ScanGeometry geometry = geometryOf(kind);
    geometry.lineCount = 17;
    const auto lines = makeScanLines(geometry, ProbePose());
    for (std::size_t n = 0; n < lines.size(); ++n)
    {
      const Vec3d point = lines[n].originMm + 73.0 * lines[n].axis;
      const Vec2f plane = planeFromBeam(geometry, double(n), 73.0);
      EXPECT_NEAR(plane.x, point.x, 1e-5);
      EXPECT_NEAR(plane.y, point.z, 1e-5);
      EXPECT_NEAR(point.y, 0.0, 1e-12);
    }
  }
}

TEST(ScanGeometry, PlaneAndBeamAreInverse)
{
  for (const ScanKind kind : allKinds)
  {
    for (const int lineCount : { 2, 128, 4096 })
    {
      for (const double sectorDeg : { 1.0, 90.0, 179.0 })
      {
        ScanGeometry geometry = geometryOf(kind);
        geometry.lineCount = lineCount;
        geometry.sectorDeg = sectorDeg;
        for (const double fraction : { 0.0, 0.123, 0.5, 0.987, 1.0 })
        {
          for (const double r : { 1.0, 37.7, 100.0 })
          {
            const double line = fraction * (lineCount - 1);
            const Vec2f plane = planeFromBeam(geometry, line, r);
            const Vec2f beam = beamFromPlane(geometry, double(plane.x), double(plane.y));
            // Single precision of 100 mm is 4e-6 mm; one line in 4096 of a 1 degree fan is 4e-6 rad.
            const double lineStep =
              kind == ScanKind::Linear ? 38.0 / (lineCount - 1) : sectorDeg * 3.14159 / 180.0 / (lineCount - 1) * r;
            EXPECT_NEAR(beam.x, line, 1e-5 / lineStep + 2.5e-4) << int(kind) << " " << lineCount << " " << sectorDeg;
            EXPECT_NEAR(beam.y, r, 2e-5);
          }
        }
      }
    }
  }
}

TEST(ScanGeometry, PointsThatNoLineSees)
{
  const ScanGeometry linear = geometryOf(ScanKind::Linear);
  EXPECT_TRUE(std::isnan(beamFromPlane(linear, 19.1, 10.0).x));
  EXPECT_TRUE(std::isnan(beamFromPlane(linear, 0.0, -0.1).y));
  EXPECT_TRUE(std::isnan(beamFromPlane(linear, 0.0, 100.1).x));
  EXPECT_EQ(beamFromPlane(linear, 19.0, 100.0), Vec2f(2.0f, 100.0f));
  const ScanGeometry sector = geometryOf(ScanKind::PhasedSector);
  EXPECT_TRUE(std::isnan(beamFromPlane(sector, 30.1 * std::tan(0.5235987756), 30.0).x));
  EXPECT_TRUE(std::isnan(beamFromPlane(sector, 0.0, -10.0).x));
  const ScanGeometry curved = geometryOf(ScanKind::Curvilinear);
  EXPECT_TRUE(std::isnan(beamFromPlane(curved, 20.0, -7.0).x)); // behind the face
  EXPECT_FALSE(std::isnan(beamFromPlane(curved, 25.0, 25.0 * root3 - 50.0).x));
}

TEST(ScanGeometry, ErrorsNameTheParameter)
{
  const auto refusal = [](ScanKind kind, const std::function<void(ScanGeometry&)>& change) {
    ScanGeometry geometry = geometryOf(kind);
    change(geometry);
    return errorOf([&] { geometry.validate(); });
  };
  const auto sector = ScanKind::PhasedSector;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expectContains(refusal(sector, [](ScanGeometry& g) { g.lineCount = 0; }), "lineCount is 0");
  expectContains(refusal(sector, [](ScanGeometry& g) { g.lineCount = 4097; }), "between 1 and 4096");
  expectContains(refusal(sector, [](ScanGeometry& g) { g.depthMm = 0.0; }), "depthMm is 0");
  expectContains(refusal(sector, [nan](ScanGeometry& g) { g.depthMm = nan; }), "depthMm");
  expectContains(refusal(sector, [](ScanGeometry& g) { g.sectorDeg = 180.0; }), "sectorDeg is 180");
  expectContains(refusal(ScanKind::Curvilinear, [](ScanGeometry& g) { g.radiusMm = -1.0; }), "radiusMm is -1");
  expectContains(refusal(ScanKind::Curvilinear, [](ScanGeometry& g) { g.sectorDeg = 0.0; }), "sectorDeg is 0");
  expectContains(refusal(ScanKind::Linear, [](ScanGeometry& g) { g.widthMm = 0.0; }), "widthMm is 0");
  EXPECT_EQ(refusal(ScanKind::Linear, [](ScanGeometry& g) { g.sectorDeg = 0.0; }), "no error");
  expectContains(refusal(ScanKind(7), [](ScanGeometry&) {}), "scan kind");
}

TEST(ProbePreset, BundledPresets)
{
  const ProbePreset phased = readProbePreset(dataFile("probes/phased_p4-2.json"));
  EXPECT_EQ(phased.geometry.kind, ScanKind::PhasedSector);
  EXPECT_EQ(phased.elementCount, 64);
  EXPECT_NEAR(phased.elementWidthMm + phased.kerfMm, 0.32, 1e-9);
  EXPECT_DOUBLE_EQ(phased.centreFrequencyMHz, 3.6);
  const ProbePreset linear = readProbePreset(dataFile("probes/linear_l14.json"));
  EXPECT_EQ(linear.geometry.kind, ScanKind::Linear);
  EXPECT_NEAR(linear.geometry.widthMm, 127 * (linear.elementWidthMm + linear.kerfMm), 1e-6);
  const ProbePreset curved = readProbePreset(dataFile("probes/curvilinear_c5-2.json"));
  EXPECT_EQ(curved.geometry.kind, ScanKind::Curvilinear);
  const double arcMm = curved.geometry.radiusMm * curved.geometry.sectorDeg * std::acos(-1.0) / 180.0;
  EXPECT_NEAR(arcMm, 127 * (curved.elementWidthMm + curved.kerfMm), 0.01);
  for (const ProbePreset& preset : { phased, linear, curved })
  {
    EXPECT_NO_THROW(preset.geometry.validate());
    EXPECT_FALSE(preset.name.empty());
  }
}

TEST(ProbePreset, ErrorsNameFileAndKey)
{
  std::ifstream stream(dataFile("probes/phased_p4-2.json"));
  const std::string good((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const sono::testing::TemporaryFolder folder;
  const std::string path = folder.file("preset.json");
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string content = good;
    content.replace(content.find(from), from.size(), to);
    std::ofstream(path) << content;
    const std::string error = errorOf([&] { readProbePreset(path); });
    expectContains(error, "preset.json");
    return error;
  };
  expectContains(refusal("\"depthMm\"", "\"depth\""), "lacks 'depthMm'");
  expectContains(refusal("\"value\": 64", "\"value\": 6.5"), "'elementCount' is out of range");
  expectContains(refusal("\"value\": 160", "\"value\": -1"), "'depthMm' is out of range");
  expectContains(refusal("\"value\": 75", "\"value\": 180"), "'sectorDeg' is out of range");
  expectContains(refusal("\"value\": 14", "\"value\": \"14\""), "'elementHeightMm' is not of the form");
  expectContains(refusal("\"source\": \"chosen\"", "\"source\": \"\""), "'numberOfLines' is not of the form");
  expectContains(refusal("phased_sector", "round"), "'scan' is out of range");
  expectContains(refusal("\"name\"", "\"widthMm\": 1, \"name\""), "'widthMm' means nothing");
  expectContains(refusal("{", "["), "not a JSON object");
  fs::remove(path);
  expectContains(errorOf([&] { readProbePreset(path); }), "no such file");
}
