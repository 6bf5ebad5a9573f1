#include "Labels/HeartByShape.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <map>

namespace {

using namespace sono;

enum Part
{
  Outside,
  Left,   ///< ventricle
  Wall,   ///< of the left ventricle
  Right,  ///< ventricle, beside the wall
  Atrium, ///< above the left ventricle, behind a valve of 3 mm without a label
  Far     ///< elsewhere
};

/// A left ventricle 40 mm wide and 76 mm long with a wall of 9 mm, cut at z = 20, its apex below.
Part heart(const Vec3d& p)
{
  const auto level = [&](double widthMm, double lengthMm) {
    return glm::length(Vec3d(p.x / widthMm, p.y / widthMm, p.z / lengthMm));
  };
  if (p.z < 20.0)
  {
    const bool isBeside = glm::length(Vec3d((p.x - 20.0) / 34.0, p.y / 30.0, p.z / 40.0)) < 1.0;
    return level(20.0, 56.0) < 1.0 ? Left : level(29.0, 65.0) < 1.0 ? Wall : isBeside ? Right : Outside;
  }
  return glm::distance(p, Vec3d(0.0, 0.0, 40.0)) < 22.0 && p.z > 23.0 ? Atrium : Outside;
}

/// Voxels of `spacingMm`, 120 mm wide, 150 mm high, the middle at 0. `ids`: of the parts.
LabelVolume volumeOf(const std::function<int(const Vec3d&)>& partAt, const std::array<int, 6>& ids,
                     const Vec3d& spacingMm)
{
  LabelVolume volume;
  volume.placement.size = Vec3i(glm::round(Vec3d(120.0, 120.0, 150.0) / spacingMm));
  volume.placement.spacingMm = spacingMm;
  volume.placement.originMm = -0.5 * Vec3d(volume.placement.size - 1) * spacingMm;
  for (int k = 0; k < volume.placement.size.z; ++k)
  {
    for (int j = 0; j < volume.placement.size.y; ++j)
    {
      for (int i = 0; i < volume.placement.size.x; ++i)
      {
        const int part = partAt(volume.placement.worldFromIndex(Vec3d(i, j, k)));
        volume.voxels.push_back(std::uint16_t(ids[std::size_t(part)]));
      }
    }
  }
  volume.collectLabels();
  return volume;
}

std::string tissueOf(const LabelVolume& volume, int id)
{
  return volume.find(id)->tissue;
}

TEST(HeartByShape, InWhateverOrderTheLabelsAre)
{
  // Left ventricle, wall, right ventricle, atrium; 0 where a data set has none.
  for (const std::array<int, 6>& ids : { std::array<int, 6>{ 0, 3, 2, 1, 0, 0 },
                                         { 0, 1, 2, 0, 3, 0 },
                                         { 0, 1, 3, 2, 0, 0 },
                                         { 0, 1, 5, 2, 3, 0 },
                                         { 0, 4, 1, 0, 0, 0 } })
  {
    for (const Vec3d& spacingMm : { Vec3d(1.5), Vec3d(1.5, 1.5, 10.0) })
    {
      LabelVolume volume = volumeOf(heart, ids, spacingMm);
      const std::string sentence = guessHeart(volume);
      EXPECT_NE(sentence.find("label_" + std::to_string(ids[Wall]) + " lies around"), std::string::npos) << sentence;
      for (const Part part : { Left, Wall, Right, Atrium })
      {
        const int id = ids[part];
        const char* wanted = part == Wall ? "myocardium" : "blood";
        EXPECT_TRUE(id == 0 || tissueOf(volume, id) == wanted) << "label " << id << ", part " << part;
        EXPECT_TRUE(id == 0 || volume.find(id)->guessed);
      }
      EXPECT_EQ(tissueOf(volume, 0), "");
    }
  }
}

/// Slices that end where the ventricle's do.
TEST(HeartByShape, CutAtBothEnds)
{
  LabelVolume volume = volumeOf([](const Vec3d& p) { return heart(Vec3d(p.x, p.y, 0.2 * p.z)); }, { 0, 3, 2, 1, 0, 0 },
                                { 2.0, 2.0, 10.0 });
  EXPECT_NE(guessHeart(volume), "");
  EXPECT_EQ(tissueOf(volume, 2), "myocardium");
  EXPECT_EQ(tissueOf(volume, 3), "blood");
}

TEST(HeartByShape, WhatIsFarFromItIsNoChamber)
{
  const auto withFar = [](const Vec3d& p) {
    return glm::distance(p, Vec3d(-45.0, -45.0, 60.0)) < 9.0 ? Far : heart(p);
  };
  LabelVolume volume = volumeOf(withFar, { 0, 1, 2, 0, 0, 3 }, Vec3d(1.5));
  EXPECT_NE(guessHeart(volume), "");
  EXPECT_EQ(tissueOf(volume, 3), "");
  EXPECT_FALSE(volume.find(3)->guessed);
}

TEST(HeartByShape, WhatAPersonChoseStays)
{
  LabelVolume volume = volumeOf(heart, { 0, 1, 2, 0, 0, 0 }, Vec3d(2.0));
  volume.labels[1].tissue = "water";
  EXPECT_NE(guessHeart(volume), "");
  EXPECT_EQ(tissueOf(volume, 1), "water");
  EXPECT_FALSE(volume.labels[1].guessed);
  EXPECT_EQ(tissueOf(volume, 2), "myocardium");
}

TEST(HeartByShape, NamesAndOtherShapesAreLeftAlone)
{
  const auto isNothing = [](const std::function<int(const Vec3d&)>& partAt, const std::string& name) {
    LabelVolume volume = volumeOf(partAt, { 0, 1, 2, 3, 4, 5 }, Vec3d(2.0));
    volume.labels.back().name = name.empty() ? volume.labels.back().name : name;
    const bool said = !guessHeart(volume).empty();
    return !said && tissueOf(volume, volume.labels.back().id).empty();
  };
  EXPECT_FALSE(isNothing(heart, ""));
  EXPECT_FALSE(isNothing(heart, "skin")); // a fill's
  EXPECT_TRUE(isNothing(heart, "liver"));
  const auto balls = [](double innerMm, double outerMm) {
    return [=](const Vec3d& p) { return glm::length(p) < innerMm ? 1 : glm::length(p) < outerMm ? 2 : 0; };
  };
  EXPECT_TRUE(isNothing(balls(14.0, 58.0), "")); // a lesion in an organ
  EXPECT_TRUE(isNothing(balls(6.0, 9.0), ""));   // too small
  EXPECT_TRUE(isNothing([](const Vec3d& p) { return std::abs(p.z) > 30.0 ? 0 : p.x < 0.0 ? 1 : 2; }, ""));
  EXPECT_TRUE(isNothing([](const Vec3d& p) { return glm::length(p) < 40.0 ? 1 : 0; }, ""));
}

} // namespace
