// Landmarks where a picture shows them: against the labels that it shows, and against circles in closed form.
#include "Folders.h"
#include "TemporaryFolder.h"

#include "DataSets/DataSetImager.h"
#include "DataSets/ImageLandmarks.h"
#include "DataSets/MitralLine.h"
#include "Image/LabelSlice.h"
#include "Image/ShownPlace.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

using namespace sono;

namespace {

using Json = nlohmann::json;

/// Every voxel is a label of its own.
LabelVolume numbered()
{
  LabelVolume volume;
  volume.placement = { Vec3i(40), { -29.25, 0.75, -29.25 }, Vec3d(1.5), Mat3d(1.0), {} };
  for (int n = 0; n < 64000; ++n)
  {
    volume.voxels.push_back(std::uint16_t(1 + n));
  }
  return volume;
}

double distanceToMask(const DataSetImage& image, int value, const Json& point, bool otherThan = false)
{
  double nearest = 1e9;
  for (int row = 0; row < image.height; ++row)
  {
    for (int column = 0; column < image.width; ++column)
    {
      if ((image.mask[std::size_t(row * image.width + column)] == value) != otherThan)
      {
        nearest =
          std::min(nearest, std::hypot(column - point["column"].get<double>(), row - point["row"].get<double>()));
      }
    }
  }
  return nearest * image.pixelMm;
}

/// The bundled thorax, held as it ought to be.
DataSetImage apicalImage(const std::string& path, const std::string& view)
{
  Json json;
  std::ifstream(dataFile("datasets/apical.json")) >> json;
  json.erase("jitter");
  json.erase("tissues");
  json["patients"][0].update(
    { { "spacingMm", 1.5 }, { "copies", 1 }, { "stretch", 1 }, { "views", { { { "name", view } } } } });
  json["probe"].update({ { "depthMm", 150 }, { "sectorDeg", 80 }, { "centreFrequencyMHz", 2.5 }, { "lineCount", 64 } });
  json["tracing"]["pathsPerLine"] = 40;
  json["echo"]["samplingMHz"] = 12;
  std::ofstream(path) << json.dump();
  return DataSetImager(std::make_shared<const DataSetPlan>(readDataSet(path, dataFolder())), Device::Cpu).make(0);
}

} // namespace

/// A ventricle above, an atrium below, and leaflets that open into the ventricle with the atrium's blood between them.
TEST(MitralLine, DividesByAStraightLineBetweenTheHinges)
{
  constexpr int width = 60;
  enum Label : std::uint16_t
  {
    Nothing,
    Ventricle,
    Atrium,
    Valve,
    Outflow
  };
  std::vector<std::uint16_t> labels;
  std::vector<std::uint8_t> mask; // 1 ventricle with its outflow, 2 atrium
  for (int row = 0; row < width; ++row)
  {
    for (int column = 0; column < width; ++column)
    {
      const double funnel = std::abs(column - 30.0) - (10.0 - 0.7 * (30.0 - row)); // < 0 within it
      Label label = row < 30 ? Ventricle : Atrium;
      label = row < 30 && row > 18 && funnel < 0.0 ? Atrium : label;
      label = row < 30 && row > 18 && std::abs(funnel) < 1.5 ? Valve : label;
      label = column < 10 || column > 50 ? Nothing : label;
      label = row >= 30 && column < 18 && column >= 10 ? Outflow : label;
      labels.push_back(label);
      mask.push_back(label == Ventricle || label == Outflow ? 1 : label == Atrium ? 2 : 0);
    }
  }
  std::vector<bool> isValve(5, false);
  isValve[Valve] = true;
  const auto point = [](double column, double row) {
    ImagePoint p;
    p.column = column;
    p.row = row;
    return p;
  };
  for (const bool isSwapped : { false, true })
  {
    std::vector<std::uint8_t> divided = mask;
    const ImagePoint left = point(20.0, 29.0);
    const ImagePoint right = point(40.0, 31.0);
    divideAtHinges(isSwapped ? right : left, isSwapped ? left : right, point(31.0, 2.0), { 1, 2, &isValve },
                   labels.data(), width, divided);
    for (std::size_t at = 0; at < mask.size(); ++at)
    {
      const int column = int(at % width);
      const int row = int(at / width);
      const double along = 20.0 * (column - 20.0) + 2.0 * (row - 29.0);
      const bool isBetween = along >= 0.0 && along <= 404.0;
      const int expected = !isBetween || labels[at] == Nothing ? mask[at] : row <= 29.0 + 0.1 * (column - 20.0) ? 1 : 2;
      ASSERT_EQ(divided[at], expected) << column << ", " << row;
    }
  }
}

TEST(MitralLine, OfAnImageRunsThroughItsHinges)
{
  const sono::testing::TemporaryFolder folder;
  const DataSetImage image = apicalImage(folder.file("set.json"), "A4C");
  const Json annulus = Json::parse(image.info)["landmarks"]["mitralAnnulus"];
  ASSERT_EQ(annulus["hinges"].size(), 2u);
  const Json& a = annulus["hinges"][0];
  const Json& b = annulus["hinges"][1];
  const double slope =
    (b["row"].get<double>() - a["row"].get<double>()) / (b["column"].get<double>() - a["column"].get<double>());
  int columns = 0;
  for (int column = int(a["column"].get<double>()) + 3; column < int(b["column"].get<double>()) - 2;
       ++column, ++columns)
  {
    const double line = a["row"].get<double>() + slope * (column - a["column"].get<double>());
    const auto above = image.mask[std::size_t(int(line) - 2) * std::size_t(image.width) + std::size_t(column)];
    const auto below = image.mask[std::size_t(int(line) + 3) * std::size_t(image.width) + std::size_t(column)];
    EXPECT_EQ(above, 1) << column;
    EXPECT_EQ(below, 3) << column;
  }
  EXPECT_GT(columns, 30);
}

/// The labels of a picture say which voxel each pixel shows; a voxel's middle is shown in the middle of these.
TEST(ShownPlace, IsWhereTheLabelsAre)
{
  const LabelVolume volume = numbered();
  const ProbePose pose = ProbePose{ { 2.0, -3.0, 1.0 }, { 0.1, 1.0, -0.2 }, { 1.0, -0.1, 0.3 } }.orthonormalized();
  for (const ScanKind kind : { ScanKind::PhasedSector, ScanKind::Curvilinear, ScanKind::Linear })
  {
    ScanGeometry geometry;
    geometry.kind = kind;
    geometry.lineCount = 40;
    geometry.depthMm = 55.0;
    geometry.radiusMm = 20.0;
    geometry.sectorDeg = 70.0;
    geometry.assumedSoundSpeedMPerS = 1600.0;
    const int bins = 120;
    std::vector<float> offsetMm; // as behind a lens of fat and a rib
    for (int line = 0; line < geometry.lineCount; ++line)
    {
      for (int bin = 0; bin < bins; ++bin)
      {
        offsetMm.push_back(2.5f * std::sin(0.05f * float(bin)) +
                           0.03f * float(line) * std::min(1.0f, 0.05f * float(bin)));
      }
    }
    const double pixelMm = 0.1;
    const PlaneImage image = scanConvert(geometry, std::vector<float>(40, 1.0f), 1, geometry.rangeMm(), pixelMm);
    const auto labels = sliceLabels(volume, geometry, pose, image, { &offsetMm, bins, 0.5 });
    const PlaneScan scan = offsetScan(geometry, bins, 0.5, pixelMm);
    int seen = 0;
    int beside = 0;
    for (std::size_t n = 0; n < labels.size(); n += 997)
    {
      if (labels[n] == 0)
      {
        continue;
      }
      const int voxel = labels[n] - 1;
      const Vec3d world =
        volume.placement.worldFromIndex(Vec3d(double(voxel % 40), double(voxel / 40 % 40), double(voxel / 1600)));
      const ShownPlace place = shownPlace(scan, offsetMm.data(), pose, world);
      EXPECT_LE(std::abs(place.offPlaneMm), 1.3); // half a voxel's diagonal
      if (!place.inSector)                        // its middle lies just beside the picture
      {
        ++beside;
        continue;
      }
      const double column = double(n % std::size_t(image.width));
      const double row = double(n / std::size_t(image.width));
      const double offMm = std::hypot(place.lateralMm - image.lateralMinMm - pixelMm * column,
                                      place.axialMm - image.axialMinMm - pixelMm * row);
      EXPECT_LE(offMm, 1.45) << "voxel " << voxel; // the same, 10 % stretched by the offsets' slope
      ++seen;
    }
    EXPECT_GT(seen, 100);
    EXPECT_LT(beside, 0.1 * seen);
  }
}

/// What is deeper than the picture, beside it or behind the probe is not in it.
TEST(ShownPlace, KnowsWhatIsNotInThePicture)
{
  ScanGeometry geometry;
  geometry.depthMm = 100.0;
  geometry.sectorDeg = 60.0;
  const PlaneScan scan = offsetScan(geometry, 0, 0.0, 0.5);
  const ProbePose pose;
  const auto at = [&](double x, double y, double z) { return shownPlace(scan, nullptr, pose, { x, y, z }); };
  EXPECT_TRUE(at(0.0, 0.0, 99.0).inSector);
  EXPECT_FALSE(at(0.0, 0.0, 101.0).inSector);
  EXPECT_FALSE(at(0.0, 0.0, -5.0).inSector);
  EXPECT_TRUE(at(28.0, 0.0, 50.0).inSector);
  EXPECT_FALSE(at(30.0, 0.0, 50.0).inSector);
  EXPECT_DOUBLE_EQ(at(0.0, 3.0, 50.0).offPlaneMm, 3.0); // elevation = axial x lateral
  EXPECT_NEAR(at(-20.0, 3.0, 50.0).lateralMm, -20.0, 1e-4);
  EXPECT_NEAR(at(-20.0, 3.0, 50.0).axialMm, 50.0, 1e-4);
}

TEST(Crossings, LieOnTheCircleAndInThePlane)
{
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3d(normal(random), normal(random), normal(random)); };
  int crossed = 0;
  for (int n = 0; n < 200; ++n)
  {
    const ProbePose pose = ProbePose{ 10.0 * vector(), vector(), vector() }.orthonormalized();
    const Annulus ring{ 10.0 * vector(), glm::normalize(vector()), 15.0 };
    const Vec3d elevation = glm::cross(pose.axial, pose.lateral);
    const std::vector<Vec3d> places = crossings(ring, pose);
    // Brute force: on which sides of the plane the circle's points are.
    const Vec3d u = glm::normalize(glm::cross(ring.normal, Vec3d(0.3, 0.5, -0.8)));
    const Vec3d v = glm::cross(ring.normal, u);
    bool before = false;
    bool behind = false;
    for (int step = 0; step < 3600; ++step)
    {
      const double turn = step * M_PI / 1800.0;
      const Vec3d p = ring.centreMm + 15.0 * (std::cos(turn) * u + std::sin(turn) * v);
      (glm::dot(p - pose.positionMm, elevation) < 0.0 ? before : behind) = true;
    }
    ASSERT_EQ(places.size(), before && behind ? 2u : 0u);
    for (const Vec3d& place : places)
    {
      EXPECT_NEAR(glm::distance(place, ring.centreMm), 15.0, 1e-9);
      EXPECT_NEAR(glm::dot(place - ring.centreMm, ring.normal), 0.0, 1e-9);
      EXPECT_NEAR(glm::dot(place - pose.positionMm, elevation), 0.0, 1e-9);
      ++crossed;
    }
    if (places.size() == 2)
    {
      EXPECT_GT(glm::distance(places[0], places[1]), 0.0);
    }
  }
  EXPECT_GT(crossed, 100);
  EXPECT_TRUE(crossings({ Vec3d(0.0), { 0.0, 1.0, 0.0 }, 10.0 }, ProbePose{}).empty()); // in the plane
}

TEST(ImageLandmarks, LieWhereTheMasksMeetInTheFourChamberView)
{
  const sono::testing::TemporaryFolder folder;
  const DataSetImage image = apicalImage(folder.file("set.json"), "A4C");
  const Json info = Json::parse(image.info);
  const int cavity = info["masks"]["LV cavity"]["value"];
  const int atrium = info["masks"]["left atrium"]["value"];
  const Json& apex = info["landmarks"]["apex"];
  EXPECT_TRUE(apex["inSector"]);
  EXPECT_FALSE(apex["inShadow"]);
  EXPECT_LT(std::abs(apex["offPlaneMm"].get<double>()), 2.0);
  EXPECT_LT(distanceToMask(image, cavity, apex), 2.0);
  EXPECT_LT(distanceToMask(image, cavity, apex, true), 2.0);
  const Json& hinges = info["landmarks"]["mitralAnnulus"]["hinges"];
  ASSERT_EQ(hinges.size(), 2u);
  EXPECT_LT(hinges[0]["column"], hinges[1]["column"]);
  for (const Json& hinge : hinges)
  {
    EXPECT_NEAR(hinge["offPlaneMm"].get<double>(), 0.0, 1e-6);
    EXPECT_LT(distanceToMask(image, cavity, hinge), 3.0);
    EXPECT_LT(distanceToMask(image, atrium, hinge), 3.0);
  }
  for (const char* name : { "tricuspidAnnulus", "aorticAnnulus" })
  {
    EXPECT_GT(info["landmarks"][name]["radiusMm"], 5.0) << name;
  }
  EXPECT_FALSE(info.contains("visibility")); // its pose comes with the body
  EXPECT_GT(info["masks"]["LV cavity"]["visiblePercent"], 90.0);
}
