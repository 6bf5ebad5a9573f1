#include "Probe/AcousticWindow.h"

#include "ErrorText.h"
#include "Folders.h"
#include "Labels/AssignTissues.h"
#include "Labels/BodyFill.h"
#include "Phantoms/ThoraxPhantom.h"
#include "TestScenes.h"
#include "WindowCuts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
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
const Tissue skin = makeTissue("skin", 1.87, 1655.0, 1.0);
const Tissue liver = makeTissue("liver", 1.65, 1595.0, 0.5);
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

AcousticWindow bestWindow(const Scene& scene, const std::string& target = "")
{
  return findAcousticWindows(scene, windowTarget(scene, target), ProbeSettings(), 1).front();
}

TEST(AcousticWindow, LooksThroughTheHoleInTheBone)
{
  for (const Vec3d hole : { Vec3d(0.0, -1.0, 0.0), Vec3d(0.6, -0.7, 0.4), Vec3d(-1.0, 0.0, 0.0) })
  {
    const auto scene = ballWithHole(hole);
    const ProbePose pose = bestWindow(*scene).pose;
    EXPECT_GT(glm::dot(-pose.axial, glm::normalize(hole)), std::cos(0.5)) << hole.x << " " << hole.y << " " << hole.z;
    EXPECT_NEAR(glm::distance(pose.positionMm, Vec3d(80.0)), 60.0, 3.0); // on the skin
    EXPECT_NEAR(glm::length(glm::cross(Vec3d(80.0) - pose.positionMm, pose.axial)), 0.0, 1e-6);
  }
}

TEST(AcousticWindow, ImageHasThePatientsLeftOrFeetAtItsRight)
{
  const auto front = ballWithHole(Vec3d(0.0, -1.0, 0.0));
  EXPECT_GT(bestWindow(*front).pose.lateral.x, 0.85);
  const auto side = ballWithHole(Vec3d(-1.0, 0.0, 0.0));
  EXPECT_LT(bestWindow(*side).pose.lateral.z, -0.9);
}

TEST(AcousticWindow, NeverFromBehind)
{
  const auto scene = ballWithHole(Vec3d(0.0, 1.0, 0.0));
  for (const AcousticWindow& window : findAcousticWindows(*scene, windowTarget(*scene, ""), ProbeSettings()))
  {
    EXPECT_GT(window.pose.axial.y, -0.51);
  }
}

/// In one tissue the numbers have closed forms: a ball of radius 25 mm 60 mm below the skin is seen whole, its largest
/// section, through 35 to 85 mm of 0.54 dB/(cm MHz).
TEST(AcousticWindow, SaysWhatItSees)
{
  const auto scene = makeScene(
    Vec3i(160), Vec3d(1.0), { air, soft, makeTissue("liver", 1.63, 1540.0, 0.54) },
    [](const Vec3d& p) {
      const double r = glm::distance(p, Vec3d(80.0));
      return r > 60.0 ? 0 : r < 25.0 ? 2 : 1;
    },
    "air");
  ProbeSettings probe;
  probe.centreFrequencyMHz = 3.0;
  const auto windows = findAcousticWindows(*scene, windowTarget(*scene, "label 2"), probe);
  ASSERT_EQ(windows.size(), 5u);
  EXPECT_NEAR(windows[0].seenPercent, 100.0, 8.0);
  EXPECT_NEAR(windows[0].lossDb, 0.54 * 3.0 * 6.0, 0.7);
  EXPECT_NEAR(windows[0].insidePercent, 100.0, 0.5);
  EXPECT_EQ(windows[0].depthMm, 100.0);
  for (std::size_t i = 1; i < windows.size(); ++i)
  {
    EXPECT_GE(windows[i - 1].score, windows[i].score);
    for (std::size_t other = 0; other < i; ++other)
    {
      EXPECT_GE(glm::distance(windows[i].pose.positionMm, windows[other].pose.positionMm), 40.0);
    }
  }
  const std::string sentence = describe(windows[0], windowTarget(*scene, "label 2"));
  expectContains(sentence, "of the label 2's largest section, 10 dB lost");
  expectContains(sentence, "100 % of the image inside");
}

/// Of a ball a slab of 30 mm, as a few slices are: only planes along the slices lie within it. Across them it would be
/// a third.
TEST(AcousticWindow, LooksAlongAFewSlices)
{
  const auto scene = makeScene(
    Vec3i(80, 80, 15), Vec3d(2.0), { air, soft, heart },
    [](const Vec3d& p) {
      const double r = glm::distance(p, Vec3d(80.0, 80.0, 15.0));
      return r > 60.0 ? 0 : r < 20.0 ? 2 : 1;
    },
    "air");
  for (const AcousticWindow& window : findAcousticWindows(*scene, windowTarget(*scene, ""), ProbeSettings()))
  {
    EXPECT_NEAR(glm::distance(window.pose.positionMm, Vec3d(80.0, 80.0, 15.0)), 60.0, 3.0);
    EXPECT_LT(std::abs(window.pose.lateral.z), 0.15);
    EXPECT_GT(window.insidePercent, 90.0);
  }
}

/// The belly's surface is air; what is around an airway is no skin, nor a surface without skin in a map that has some.
TEST(AcousticWindow, OnlyOnSkin)
{
  const auto scene = makeScene(
    Vec3i(90, 90, 60), Vec3d(2.0), { air, soft, skin, heart },
    [](const Vec3d& p) {
      const double r = std::hypot(p.x - 90.0, p.y - 90.0);
      const bool isAirway = std::hypot(p.x - 90.0, p.y - 60.0) < 14.0;
      const bool isHeart = glm::distance(p, Vec3d(90.0, 85.0, 60.0)) < 15.0;
      return r > 70.0 || isAirway ? 0 : r > 66.0 && p.x > 90.0 ? 2 : isHeart ? 3 : 1;
    },
    "air");
  for (const AcousticWindow& window : findAcousticWindows(*scene, windowTarget(*scene, ""), ProbeSettings()))
  {
    EXPECT_NEAR(std::hypot(window.pose.positionMm.x - 90.0, window.pose.positionMm.y - 90.0), 70.0, 3.0);
    EXPECT_GT(window.pose.positionMm.x, 82.0);
  }
}

TEST(AcousticWindow, SaysWhenThereIsNoSkin)
{
  const auto full = makeScene(
    Vec3i(20), Vec3d(4.0), { air, soft }, [](const Vec3d&) { return 1; }, "air");
  expectContains(errorOf([&] { bestWindow(*full); }), "by hand");
  const auto empty = makeScene(
    Vec3i(10), Vec3d(4.0), { air }, [](const Vec3d&) { return 0; }, "air");
  expectContains(errorOf([&] { (void)windowTarget(*empty, ""); }), "nothing but");
  const auto ball = ballWithHole(Vec3d(0.0, -1.0, 0.0));
  const auto beyond = [&] { findAcousticWindows(*ball, windowTarget(Vec3d(900.0)), ProbeSettings()); };
  expectContains(errorOf(beyond), "by hand");
}

/// Labels with these names, a voxel each, in soft tissue.
std::unique_ptr<Scene> namedScene(const std::vector<std::string>& names)
{
  LabelVolume volume;
  volume.placement.size = Vec3i(int(names.size()) + 1, 1, 1);
  TissueTable table;
  table.add(soft);
  table.add(air);
  for (std::size_t i = 0; i <= names.size(); ++i)
  {
    volume.voxels.push_back(std::uint16_t(i));
    LabelInfo label;
    label.id = int(i);
    label.name = i == 0 ? "background" : names[i - 1];
    label.tissue = i == 0 ? "air" : "soft_tissue";
    volume.labels.push_back(label);
  }
  return std::make_unique<Scene>(std::move(volume), table, "air");
}

TEST(AcousticWindow, TargetsByName)
{
  using Ids = std::vector<int>;
  const auto scene = namedScene({ "kidney_left", "Right Kidney", "kidney_cyst_left", "gallbladder", "urinary_bladder",
                                  "liver", "left_ventricle_blood", "heart_myocardium", "common_carotid_artery_right",
                                  "rib_left_6", "ribs-left-7" });
  const auto ids = [&](const std::string& name) { return windowTarget(*scene, name).labels; };
  const auto preset = [&](const std::string& name) { return windowTarget(*scene, name).preset; };
  EXPECT_EQ(ids("right kidney"), Ids{ 2 });
  EXPECT_EQ(ids("Kidney, left"), Ids{ 1 });
  EXPECT_EQ(ids("kidneys"), (Ids{ 1, 2 }));
  EXPECT_EQ(ids("kidney cyst"), Ids{ 3 });
  EXPECT_EQ(ids("gallbladder"), Ids{ 4 });
  EXPECT_EQ(ids("gall bladder"), Ids{ 4 });
  EXPECT_EQ(ids("bladder"), Ids{ 5 });
  EXPECT_EQ(ids("heart"), (Ids{ 7, 8 }));
  EXPECT_EQ(ids(""), (Ids{ 7, 8 }));
  EXPECT_EQ(ids("left rib 6"), Ids{ 10 });
  EXPECT_EQ(ids("Rib 7 (left)"), Ids{ 11 });
  EXPECT_EQ(preset("heart"), "phased_p4-2");
  EXPECT_EQ(preset("left ventricle"), "phased_p4-2");
  EXPECT_EQ(preset("liver"), "curvilinear_c5-2");
  EXPECT_EQ(preset("right carotid"), "linear_l14");
  EXPECT_EQ(preset("left rib 6"), "curvilinear_c5-2");
  const std::string refusal = errorOf([&] { ids("thyroid"); });
  for (const char* there : { "no 'thyroid'", "heart", "right kidney", "urinary_bladder", "rib_left_6" })
  {
    expectContains(refusal, there);
  }
  EXPECT_EQ(refusal.find("background"), std::string::npos);
}

/// A heart that the box cuts through is not what a first picture should look for, where the liver is whole or the heart
/// is but a tip.
TEST(AcousticWindow, TheTargetByItselfIsWhole)
{
  const auto target = [](double heartMm, bool isLiverCut) {
    const auto scene = makeScene(
      Vec3i(40), Vec3d(4.0), { air, soft, liver, heart },
      [=](const Vec3d& p) {
        const bool isHeart = glm::distance(p, Vec3d(80.0, 80.0, heartMm)) < 30.0;
        const bool isLiver = glm::distance(p, Vec3d(isLiverCut ? 5.0 : 60.0, 80.0, 50.0)) < 30.0;
        return isHeart ? 3 : isLiver ? 2 : 1;
      },
      "air");
    return windowTarget(*scene, "").name;
  };
  EXPECT_EQ(target(120.0, false), "heart");
  EXPECT_EQ(target(155.0, false), "liver");
  EXPECT_EQ(target(155.0, true), "heart");
  EXPECT_EQ(target(183.0, true), "liver");
}

/// Of a liver that is cut less than of a kidney: some slices below it.
TEST(AcousticWindow, AKidneyInsteadOfALiversTip)
{
  const auto target = [](double liverMm) {
    LabelVolume volume;
    volume.placement.size = Vec3i(40);
    volume.placement.spacingMm = Vec3d(4.0);
    for (int n = 0; n < 40 * 40 * 40; ++n)
    {
      const Vec3d p = 4.0 * Vec3d(n % 40, n / 40 % 40, n / 1600);
      const bool isLiver = glm::distance(p, Vec3d(50.0, 80.0, liverMm)) < 40.0;
      const bool isKidney = glm::distance(p, Vec3d(120.0, 80.0, 60.0)) < 25.0;
      volume.voxels.push_back(isLiver ? 1 : isKidney ? 2 : 0);
    }
    volume.collectLabels();
    const char* names[] = { "background", "liver", "kidney_right" };
    const char* tissues[] = { "air", "liver", "soft_tissue" };
    for (LabelInfo& label : volume.labels)
    {
      label.name = names[label.id];
      label.tissue = tissues[label.id];
    }
    TissueTable table;
    for (const Tissue& tissue : { air, soft, liver })
    {
      table.add(tissue);
    }
    const Scene scene(std::move(volume), table, "air");
    return windowTarget(scene, "").name;
  };
  EXPECT_EQ(target(100.0), "liver");
  EXPECT_EQ(target(160.0), "liver"); // half of it
  EXPECT_EQ(target(185.0), "right kidney");
}

std::unique_ptr<Scene> thoraxScene()
{
  LabelVolume volume = makeThoraxPhantom(2.0);
  const auto table = TissueTable::read(dataFile("tissues.csv"));
  assignTissues(volume, LabelTissueMap::read(dataFile("label_tissues.csv")), table, "soft_tissue");
  return std::make_unique<Scene>(std::move(volume), table, "air");
}

/// The straight way from the chest to the heart of the bundled thorax meets neither rib nor lung, and starts at the
/// skin.
TEST(AcousticWindow, FindsAWindowOfTheThorax)
{
  const auto scene = thoraxScene();
  const AcousticWindow window = bestWindow(*scene, "heart");
  const ProbePose& pose = window.pose;
  std::set<std::string> met;
  for (double r = 0.0; r < 80.0; r += 0.5)
  {
    const Vec3d index = scene->placement().indexFromWorld(pose.positionMm + r * pose.axial);
    const Vec3i size = scene->placement().size;
    const Vec3i v(std::lround(index.x), std::lround(index.y), std::lround(index.z));
    const std::size_t at = (std::size_t(v.z) * size.y + v.y) * size.x + v.x;
    met.insert(scene->tissues()[scene->tissueVoxels()[at]].name);
    EXPECT_FALSE(r == 0.0 && !met.count("skin")) << *met.begin();
  }
  EXPECT_TRUE(met.count("myocardium"));
  for (const char* inTheWay : { "cortical_bone", "lung", "air", "cartilage" })
  {
    EXPECT_FALSE(met.count(inTheWay)) << inTheWay;
  }
  EXPECT_GT(window.seenPercent, 50.0);
  EXPECT_GT(window.insidePercent, 90.0);
}

TEST(AcousticWindow, TheSameAtEachCall)
{
  const auto scene = ballWithHole(Vec3d(0.6, -0.7, 0.4));
  const auto find = [&] { return findAcousticWindows(*scene, windowTarget(*scene, ""), ProbeSettings()); };
  const auto first = find();
  for (int i = 0; i < 3; ++i)
  {
    const auto again = find();
    ASSERT_EQ(again.size(), first.size());
    for (std::size_t j = 0; j < first.size(); ++j)
    {
      EXPECT_EQ(again[j].pose.positionMm, first[j].pose.positionMm);
      EXPECT_EQ(again[j].pose.lateral, first[j].pose.lateral);
      EXPECT_EQ(again[j].score, first[j].score);
    }
  }
}

/// Measured at a larger scale by measure.sh labels.
TEST(AcousticWindow, NeverOnACutFace)
{
  CutFigures figures;
  WindowCuts(makeThoraxPhantom(3.0), false, dataFolder(), 7).run(60, { "heart", "liver", "" }, figures);
  EXPECT_EQ(figures.onCutFaces, 0);
  EXPECT_GT(figures.windows, 100);
}

/// A ball without skin, filled. What the measure says of cut faces must itself be right.
TEST(AcousticWindow, CutFacesOfAFilledBodyAreSeenAsSuch)
{
  LabelVolume ball;
  ball.placement.size = { 60, 60, 60 };
  ball.placement.spacingMm = Vec3d(3.0);
  LabelInfo liver;
  liver.id = 1;
  liver.name = "liver";
  ball.labels = { liver };
  const Vec3d middle(88.5, 88.5, 86.0); // in the half's last slice
  for (int n = 0; n < 60 * 60 * 60; ++n)
  {
    const Vec3d at = 3.0 * Vec3d(n % 60, n / 60 % 60, n / 3600);
    ball.voxels.push_back(glm::distance(at, middle) < 50.0 ? 1 : 0);
  }
  LabelVolume half = ball;
  half.placement.size.z = 30;
  half.voxels.resize(half.placement.voxelCount());
  const WindowCuts cuts(ball, true, dataFolder(), 1);
  fillBody(half);
  const auto radiusMm = [&](const Vec3d& outward) { // of the half's own skin
    double r = 0.0;
    const auto idAt = [&](const Vec3d& at) {
      const Vec3i v(glm::round(at / 3.0));
      return half.voxels[(std::size_t(v.z) * 60 + v.y) * 60 + v.x];
    };
    for (; idAt(middle + r * outward) != 0; r += 0.5)
    {
    }
    return r;
  };
  const Vec3d front(0.0, -1.0, 0.0);
  const Vec3d low = glm::normalize(Vec3d(0.0, -1.0, -1.0));
  for (const Vec3d& outward : { front - Vec3d(0, 0, 0.4), low, Vec3d(-0.8, 0.0, -0.6) })
  {
    const Vec3d n = glm::normalize(outward);
    EXPECT_TRUE(cuts.isOnSkin(half, middle + radiusMm(n) * n, n));
  }
  const Vec3d up(0.0, 0.0, 1.0);
  EXPECT_FALSE(cuts.isOnSkin(half, middle, up));                                 // in the middle of the cut
  EXPECT_FALSE(cuts.isOnSkin(half, middle + radiusMm(front) * front, up));       // at its edge, looking down
  EXPECT_FALSE(cuts.isOnSkin(half, middle + (radiusMm(low) - 15.0) * low, low)); // inside
}

} // namespace
