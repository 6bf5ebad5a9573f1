#include "Probe/AcousticWindow.h"

#include "ErrorText.h"
#include "Labels/AssignTissues.h"
#include "Phantoms/ThoraxPhantom.h"
#include "TestScenes.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace {

using namespace sono;
using namespace sono::test;
using sono::testing::errorOf;
using sono::testing::expectContains;

const Tissue air = makeTissue("air", 0.0004, 343.0, 7.5);
const Tissue soft = makeTissue("soft_tissue", 1.63, 1540.0, 0.54);
const Tissue bone = makeTissue("cortical_bone", 7.8, 4080.0, 5.0);
const Tissue heart = makeTissue("myocardium", 1.69, 1586.0, 0.52);

/// A ball of soft tissue, radius 60 mm, around (80, 80, 80) with a heart in the middle and a shell of bone that has one
/// hole of 40 degrees around `hole`.
std::unique_ptr<Scene> ballWithHole(const Vec3d& hole, double radiusMm = 60.0)
{
  return makeScene(
    Vec3i(80), Vec3d(2.0), { air, soft, bone, heart },
    [=](const Vec3d& p) {
      const Vec3d from = p - Vec3d(80.0);
      const double r = glm::length(from);
      const bool inHole = glm::dot(from, glm::normalize(hole)) > r * std::cos(0.7);
      return r > radiusMm ? 0 : r < 15.0 ? 3 : r > 40.0 && r < 46.0 && !inHole ? 2 : 1;
    },
    "air");
}

TEST(AcousticWindow, LooksThroughTheHoleInTheBone)
{
  for (const Vec3d hole : { Vec3d(0.0, -1.0, 0.0), Vec3d(0.6, -0.7, 0.4), Vec3d(-1.0, 0.0, 0.0) })
  {
    const auto scene = ballWithHole(hole);
    const Vec3d target = defaultTarget(*scene);
    EXPECT_NEAR(glm::distance(target, Vec3d(80.0)), 0.0, 1e-9);
    const ProbePose pose = findAcousticWindow(*scene, target, 2.5);
    EXPECT_GT(glm::dot(-pose.axial, glm::normalize(hole)), std::cos(0.5)) << hole.x << " " << hole.y << " " << hole.z;
    EXPECT_NEAR(glm::distance(pose.positionMm, Vec3d(80.0)), 60.0, 3.0); // on the skin
    EXPECT_NEAR(glm::length(target - pose.positionMm - glm::distance(target, pose.positionMm) * pose.axial), 0.0, 1e-6);
  }
}

TEST(AcousticWindow, ImageHasThePatientsLeftOrFeetAtItsRight)
{
  const auto front = ballWithHole(Vec3d(0.0, -1.0, 0.0));
  EXPECT_GT(findAcousticWindow(*front, Vec3d(80.0), 2.5).lateral.x, 0.85);
  const auto side = ballWithHole(Vec3d(-1.0, 0.0, 0.0));
  EXPECT_LT(findAcousticWindow(*side, Vec3d(80.0), 2.5).lateral.z, -0.9);
}

TEST(AcousticWindow, NeverFromBehind)
{
  const auto scene = ballWithHole(Vec3d(0.0, 1.0, 0.0));
  EXPECT_GT(findAcousticWindow(*scene, Vec3d(80.0), 2.5).axial.y, -0.51);
}

TEST(AcousticWindow, SaysWhenThereIsNoSkin)
{
  const auto full = makeScene(
    Vec3i(10), Vec3d(4.0), { air, soft }, [](const Vec3d&) { return 1; }, "air");
  expectContains(errorOf([&] { findAcousticWindow(*full, defaultTarget(*full), 2.5); }), "by hand");
  const auto empty = makeScene(
    Vec3i(10), Vec3d(4.0), { air }, [](const Vec3d&) { return 0; }, "air");
  expectContains(errorOf([&] { (void)defaultTarget(*empty); }), "nothing but");
}

/// The straight way from the chest to the heart of the bundled thorax meets neither rib nor lung, and starts at the
/// skin.
TEST(AcousticWindow, FindsAWindowOfTheThorax)
{
  LabelVolume volume = makeThoraxPhantom(2.0);
  const auto table = TissueTable::read(std::string(SONOVDB_DATA_DIR) + "/tissues.csv");
  assignTissues(volume, LabelTissueMap::read(std::string(SONOVDB_DATA_DIR) + "/label_tissues.csv"), table,
                "soft_tissue");
  const Scene scene(std::move(volume), table, "air");
  const Vec3d target = defaultTarget(scene);
  const ProbePose pose = findAcousticWindow(scene, target, 2.5);
  std::set<std::string> met;
  for (double r = 0.0; r < glm::distance(target, pose.positionMm); r += 0.5)
  {
    const Vec3d index = scene.placement().indexFromWorld(pose.positionMm + r * pose.axial);
    const Vec3i size = scene.placement().size;
    const Vec3i v(std::lround(index.x), std::lround(index.y), std::lround(index.z));
    const std::size_t at = (std::size_t(v.z) * size.y + v.y) * size.x + v.x;
    met.insert(scene.tissues()[scene.tissueVoxels()[at]].name);
    EXPECT_FALSE(r == 0.0 && !met.count("skin")) << *met.begin();
  }
  EXPECT_TRUE(met.count("myocardium"));
  for (const char* inTheWay : { "cortical_bone", "lung", "air", "cartilage" })
  {
    EXPECT_FALSE(met.count(inTheWay)) << inTheWay;
  }
}

} // namespace
