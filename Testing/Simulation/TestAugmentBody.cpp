// Label maps that are warped, made stouter and mirrored: against closed forms, and voxel by voxel.
#include "DataSets/AugmentBody.h"
#include "DataSets/DataSetImager.h"
#include "ErrorText.h"
#include "Folders.h"
#include "Labels/AddFat.h"
#include "Labels/LabelContacts.h"
#include "Phantoms/CheckThorax.h"
#include "Phantoms/DrawThorax.h"
#include "Phantoms/ThoraxPhantom.h"
#include "TemporaryFolder.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

constexpr double largestMm = 10.0; // at a wavelength of 140, as steep as a warp may be
constexpr double shortestMm = 140.0;

Vec3i indexOf(const Vec3i& size, std::size_t i)
{
  return { int(i % size.x), int(i / size.x % size.y), int(i / size.x / size.y) };
}

std::uint16_t labelAt(const LabelVolume& volume, const Vec3d& world)
{
  const Vec3i size = volume.placement.size;
  const Vec3i v(glm::round(volume.placement.indexFromWorld(world)));
  return v.x < 0 || v.y < 0 || v.z < 0 || v.x >= size.x || v.y >= size.y || v.z >= size.z
           ? 0
           : volume.voxels[(std::size_t(v.z) * size.y + v.y) * size.x + v.x];
}

/// A volume whose voxel of 1 mm at p has the label that `labelOf` gives it, in a box around the origin.
template<class LabelOf>
LabelVolume drawn(const Vec3i& size, const LabelOf& labelOf)
{
  LabelVolume volume;
  volume.placement.size = size;
  volume.placement.originMm = -0.5 * Vec3d(size - 1);
  volume.voxels.resize(volume.placement.voxelCount());
  for (std::size_t i = 0; i < volume.voxels.size(); ++i)
  {
    volume.voxels[i] = labelOf(volume.placement.worldFromIndex(Vec3d(indexOf(size, i))));
  }
  volume.collectLabels();
  const char* const tissues[] = { "air", "skin", "muscle" };
  for (LabelInfo& label : volume.labels)
  {
    label.tissue = tissues[label.id];
  }
  return volume;
}

double countOf(const LabelVolume& volume, int id)
{
  return double(std::count(volume.voxels.begin(), volume.voxels.end(), std::uint16_t(id)));
}

TEST(SmoothWarp, FoldsNowhereAndStaysWithinItsAmplitude)
{
  const double strain = 2.0 * M_PI / SmoothWarp::leastWavelengths;
  for (std::uint64_t seed = 0; seed < 40; ++seed)
  {
    const SmoothWarp warp(largestMm, shortestMm, seed);
    for (std::uint32_t n = 0; n < 200; ++n)
    {
      const Vec3d place(13.7 * n, -7.1 * n + 3.0 * seed, 150.0 * std::sin(double(n)));
      const Vec3d original = warp.originalPlaceMm(place);
      EXPECT_LE(glm::distance(original, place), largestMm);
      EXPECT_NEAR(glm::distance(warp.placeMm(original), place), 0.0, 1e-9);
      Mat3d differences(1.0);
      for (int axis = 0; axis < 3; ++axis)
      {
        Vec3d step(0.0);
        step[axis] = 1e-4;
        differences[axis] = (warp.originalPlaceMm(place + step) - warp.originalPlaceMm(place - step)) / 2e-4;
        EXPECT_NEAR(glm::distance(differences[axis], warp.originalSlope(place)[axis]), 0.0, 1e-7);
      }
      EXPECT_GE(glm::determinant(differences), std::pow(1.0 - strain, 3));
    }
  }
}

TEST(SmoothWarp, WhatCouldFoldIsRefused)
{
  expectContains(errorOf([] { SmoothWarp(10.0, 139.0, 1); }), "could fold the body");
  expectContains(errorOf([] { SmoothWarp(-1.0, 139.0, 1); }), "could fold the body");
  EXPECT_EQ(SmoothWarp(0.0, 1.0, 1).originalPlaceMm({ 1.0, 2.0, 3.0 }), Vec3d(1.0, 2.0, 3.0));
}

/// A ball's volume afterwards is the integral of the Jacobian of the way there, which is taken by differences.
TEST(SmoothWarp, VolumesChangeByTheJacobian)
{
  constexpr double radiusMm = 32.0;
  const LabelVolume ball =
    drawn(Vec3i(90), [](const Vec3d& p) { return std::uint16_t(glm::length(p) < radiusMm ? 2 : 0); });
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
  {
    const SmoothWarp warp(largestMm, shortestMm, seed);
    double integral = 0.0;
    constexpr double stepMm = 4.0;
    int cells = 0;
    for (double x = -34.0; x <= 34.0; x += stepMm)
    {
      for (double y = -34.0; y <= 34.0; y += stepMm)
      {
        for (double z = -34.0; z <= 34.0; z += stepMm)
        {
          const Vec3d p(x, y, z);
          if (glm::length(p) < radiusMm)
          {
            Mat3d slope(1.0);
            for (int axis = 0; axis < 3; ++axis)
            {
              Vec3d step(0.0);
              step[axis] = 1e-3;
              slope[axis] = (warp.placeMm(p + step) - warp.placeMm(p - step)) / 2e-3;
            }
            integral += glm::determinant(slope);
            ++cells;
          }
        }
      }
    }
    const double expected = integral / cells; // mean over the ball
    EXPECT_NEAR(countOf(warped(ball, warp), 2) / countOf(ball, 2) / expected, 1.0, 0.01) << "seed " << seed;
  }
}

std::set<std::pair<int, int>> contactsOf(const LabelVolume& volume)
{
  std::set<std::pair<int, int>> contacts;
  const Vec3i n = volume.placement.size;
  for (std::size_t i = 0; i < volume.voxels.size(); ++i)
  {
    const Vec3i v = indexOf(n, i);
    std::size_t step = 1;
    for (int axis = 0; axis < 3; ++axis)
    {
      if (v[axis] + 1 < n[axis])
      {
        contacts.insert(std::minmax(int(volume.voxels[i]), int(volume.voxels[i + step])));
      }
      step *= std::size_t(n[axis]);
    }
  }
  return contacts;
}

TEST(SmoothWarp, NoChamberOfTheThoraxOpens)
{
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
  {
    const ThoraxParameters parameters = seed > 10 ? drawThoraxParameters(seed) : ThoraxParameters{};
    const LabelVolume body = makeThoraxPhantom(2.0, parameters);
    const LabelVolume after = warped(body, SmoothWarp(largestMm, shortestMm, seed));
    const ThoraxFaults faults = checkThorax(after, parameters);
    EXPECT_EQ(faults.open, 0) << "seed " << seed;
    EXPECT_EQ(faults.apart, 0) << "seed " << seed;
    EXPECT_EQ(after.labels.size(), body.labels.size());
    const auto before = contactsOf(body);
    const auto now = contactsOf(after);
    EXPECT_TRUE(std::includes(before.begin(), before.end(), now.begin(), now.end())) << "seed " << seed;
  }
}

/// Two rooms that a wall of one voxel parts, in which the warp would leave holes.
TEST(SmoothWarp, AWallOfOneVoxelStaysClosed)
{
  const LabelVolume rooms = drawn(Vec3i(80), [](const Vec3d& p) {
    return std::uint16_t(std::abs(p.x + p.y - 0.3 * p.z) < 1.0 ? 1 : p.x + p.y < 0.3 * p.z ? 0 : 2);
  });
  ASSERT_FALSE(LabelContacts(rooms).touch(0, 2));
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
  {
    EXPECT_FALSE(LabelContacts(warped(rooms, SmoothWarp(largestMm, shortestMm, seed))).touch(0, 2)) << seed;
  }
}

TEST(AddFat, ABallGrowsByAShell)
{
  const LabelVolume before = drawn(Vec3i(90), [](const Vec3d& p) {
    const double r = glm::length(p);
    return std::uint16_t(r < 38.0 ? 2 : r < 40.0 ? 1 : 0);
  });
  LabelVolume after = before;
  addFat(after, 10.0, "air");
  EXPECT_EQ(after.placement.size, Vec3i(110));
  const auto fat = std::find_if(after.labels.begin(), after.labels.end(),
                                [](const LabelInfo& label) { return label.name == "subcutaneous_fat"; });
  ASSERT_NE(fat, after.labels.end());
  EXPECT_EQ(fat->tissue, "fat");
  EXPECT_EQ(countOf(after, 2), countOf(before, 2));
  // Of the surfaces, within half a voxel.
  const auto radiusMm = [](double voxels) { return std::cbrt(0.75 * voxels / M_PI); };
  const double inside = countOf(after, 2) + countOf(after, fat->id);
  EXPECT_NEAR(radiusMm(inside), 48.0, 0.5);
  EXPECT_NEAR(radiusMm(inside + countOf(after, 1)), 50.0, 0.5);
  for (std::size_t i = 0; i < before.voxels.size(); i += 7)
  {
    const Vec3d world = before.placement.worldFromIndex(Vec3d(indexOf(before.placement.size, i)));
    EXPECT_TRUE(before.voxels[i] != 2 || labelAt(after, world) == 2);
  }
}

TEST(AddFat, NothingGrowsOutOfACut)
{
  const LabelVolume before = drawn(Vec3i(70, 70, 30), [](const Vec3d& p) {
    const double r = std::hypot(p.x, p.y);
    return std::uint16_t(std::abs(r) < 5.0 ? 0 : r < 28.0 ? 2 : r < 30.0 ? 1 : 0); // with air inside
  });
  LabelVolume after = before;
  addFat(after, 6.0, "air");
  EXPECT_EQ(after.placement.size, Vec3i(82, 82, 30));
  EXPECT_EQ(labelAt(after, Vec3d(0.5, 0.5, 0.5)), 0);
  const double area = 82.0 * 82.0 - countOf(after, 0) / 30.0; // without the air inside
  EXPECT_NEAR(std::sqrt(area / M_PI + 25.0), 36.0, 0.5);
}

TEST(AddFat, AMapWithoutSkinIsRefused)
{
  LabelVolume bare = drawn(Vec3i(20), [](const Vec3d& p) { return std::uint16_t(glm::length(p) < 5.0 ? 2 : 0); });
  expectContains(errorOf([&] { addFat(bare, 5.0, "air"); }), "has no skin");
  addFat(bare, 0.0, "air");
  EXPECT_EQ(bare.placement.size, Vec3i(20));
}

/// Everything at once: what lies at a place of a pose lies there afterwards, on a mirrored body on the other side.
TEST(AugmentBody, PosesMoveWithTheAnatomy)
{
  const LabelVolume before = makeThoraxPhantom(2.0);
  const ProbePose pose = thoraxPhantomA4C();
  for (const bool isMirrored : { false, true })
  {
    BodyAugmentation augmentation;
    augmentation.stretch = Vec3d(1.05, 0.95, 1.1);
    augmentation.isMirrored = isMirrored;
    const LabelVolume linear = augmented(before, augmentation);
    const ProbePose moved = augmented(pose, before.placement, augmentation);
    EXPECT_NEAR(glm::dot(moved.axial, moved.lateral), 0.0, 1e-9);
    // The heart's chambers along the axis and at both sides.
    for (const Vec3d& q : { Vec3d(5.0, 0.0, 80.0), Vec3d(-45.0, 0.0, 75.0), Vec3d(2.0, 0.0, 135.0) })
    {
      const double side = isMirrored ? -1.0 : 1.0;
      EXPECT_EQ(labelAt(linear, moved.positionMm + q.z * moved.axial + side * q.x * moved.lateral),
                labelAt(before, pose.positionMm + q.z * pose.axial + q.x * pose.lateral));
    }
    augmentation.warpAmplitudeMm = largestMm;
    augmentation.warpWavelengthMm = shortestMm;
    augmentation.warpSeed = 3;
    const LabelVolume all = augmented(before, augmentation);
    int same = 0;
    int asked = 0;
    for (double z = 0.0; z < 160.0; z += 3.0)
    {
      for (double x = -60.0; x < 50.0; x += 5.0, ++asked)
      {
        ProbePose there = pose;
        there.positionMm += z * pose.axial + x * pose.lateral;
        const Vec3d place = augmented(there, before.placement, augmentation).positionMm;
        same += labelAt(all, place) == labelAt(before, there.positionMm) ? 1 : 0;
      }
    }
    EXPECT_GT(same, 0.9 * asked); // the others lie at an edge of voxels of 2 mm
  }
}

/// Two views of the bundled thorax, small.
class AugmentedPictures : public ::testing::Test
{
protected:
  void SetUp() override
  {
    std::ifstream(dataFile("datasets/apical.json")) >> json_;
    json_["exams"] = 1;
    json_["imagesPerExam"] = 2;
    json_["pixelMm"] = 1.0;
    json_["tracing"]["pathsPerLine"] = 4;
    json_.erase("jitter");
    nlohmann::json& patient = json_["patients"][0];
    patient["copies"] = 1;
    patient["spacingMm"] = 2.0;
    patient["views"] = nlohmann::json::parse(R"([{"name": "A4C"}, {"name": "A2C"}])");
  }
  std::vector<DataSetImage> imagesWith(const char* changes)
  {
    nlohmann::json json = json_;
    json["patients"][0].update(nlohmann::json::parse(changes));
    const std::string path = folder_.file("set.json");
    std::ofstream(path) << json.dump();
    DataSetImager imager(std::make_shared<const DataSetPlan>(readDataSet(path, dataFolder())), Device::Cpu);
    return { imager.make(0), imager.make(1) };
  }

  const sono::testing::TemporaryFolder folder_;
  nlohmann::json json_;
};

/// The mask of a mirrored body is the mirror image of the body's own, of a view that is looked for, too.
TEST_F(AugmentedPictures, OfAMirroredBodyAreMirrorImages)
{
  const std::vector<DataSetImage> plain = imagesWith(R"({"mirror": false})");
  const std::vector<DataSetImage> mirrored = imagesWith(R"({"mirror": true})");
  for (const std::size_t view : { std::size_t(0), std::size_t(1) })
  {
    const DataSetImage& a = plain[view];
    const DataSetImage& b = mirrored[view];
    EXPECT_EQ(nlohmann::json::parse(a.info)["patient"]["mirror"], false);
    EXPECT_EQ(nlohmann::json::parse(b.info)["patient"]["mirror"], true);
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    int same = 0;
    int flipped = 0;
    for (int y = 0; y < a.height; ++y)
    {
      for (int x = 0; x < a.width; ++x)
      {
        const std::uint8_t mask = b.mask[std::size_t(y * b.width + x)];
        same += a.mask[std::size_t(y * a.width + x)] == mask ? 1 : 0;
        flipped += a.mask[std::size_t(y * a.width + a.width - 1 - x)] == mask ? 1 : 0;
      }
    }
    EXPECT_GT(flipped, 0.97 * a.width * a.height) << view;
    EXPECT_LT(same, 0.95 * a.width * a.height) << view;
  }
}

TEST_F(AugmentedPictures, StandOnTheNewSkin)
{
  for (const DataSetImage& image : imagesWith(
         R"({"extraFatMm": 12, "mirror": true, "warp": {"amplitudeMm": 8, "wavelengthMm": 140}, "stretch": 1.05})"))
  {
    const auto info = nlohmann::json::parse(image.info);
    EXPECT_EQ(info["patient"]["extraFatMm"], 12.0);
    EXPECT_EQ(info["patient"]["warp"]["amplitudeMm"], 8.0);
    EXPECT_EQ(info["flags"]["faceOnSkin"], true);
    EXPECT_GT(info["masks"]["LV cavity"]["pixels"], 500);
    EXPECT_GT(info["masks"]["left atrium"]["pixels"], 200);
  }
}

} // namespace
