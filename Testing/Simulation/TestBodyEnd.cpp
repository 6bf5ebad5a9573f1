#include "Labels/BodyEnd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace {

using namespace sono;

struct Named
{
  const char* name;
  const char* tissue;
};

/// Label i + 1 has the i-th name; 0 is air. Voxels of 2 mm, 100 mm wide, the middle at 0.
LabelVolume volumeOf(const std::vector<Named>& names, const std::function<int(const Vec3d&)>& labelAt)
{
  LabelVolume volume;
  volume.placement.size = Vec3i(50);
  volume.placement.spacingMm = Vec3d(2.0);
  volume.placement.originMm = Vec3d(-49.0);
  for (int k = 0; k < 50; ++k)
  {
    for (int j = 0; j < 50; ++j)
    {
      for (int i = 0; i < 50; ++i)
      {
        volume.voxels.push_back(std::uint16_t(labelAt(volume.placement.worldFromIndex(Vec3d(i, j, k)))));
      }
    }
  }
  volume.collectLabels();
  for (LabelInfo& label : volume.labels)
  {
    label.name = label.id == 0 ? "background" : names[std::size_t(label.id - 1)].name;
    label.tissue = label.id == 0 ? "air" : names[std::size_t(label.id - 1)].tissue;
  }
  return volume;
}

/// A ball of the first label in one of the second.
int balls(const Vec3d& p)
{
  const double r = glm::length(p);
  return r < 15.0 ? 1 : r < 30.0 ? 2 : 0;
}

TEST(BodyEnd, SkinAndWhatMayLieBareStays)
{
  EXPECT_EQ(bodyEnd(volumeOf({ { "liver", "liver" }, { "skin", "skin" } }, balls), {}), BodyEnd::Skin);
  EXPECT_EQ(bodyEnd(volumeOf({ { "liver", "liver" }, { "torso_fat", "fat" } }, balls), {}), BodyEnd::Skin);
  EXPECT_EQ(bodyEnd(volumeOf({ { "rib", "cortical_bone" }, { "body", "soft_tissue" } }, balls), {}), BodyEnd::Skin);
  EXPECT_EQ(bodyEnd(volumeOf({ { "wire", "phantom_nylon" }, { "gel", "phantom_gel" } }, balls), {}), BodyEnd::Skin);
}

TEST(BodyEnd, OrgansAndBonesThatLieBare)
{
  EXPECT_EQ(bodyEnd(volumeOf({ { "vertebra", "cortical_bone" }, { "liver", "liver" } }, balls), {}), BodyEnd::NoSkin);
  EXPECT_EQ(bodyEnd(volumeOf({ { "vessel", "blood" }, { "liver", "liver" } }, balls), {}), BodyEnd::BareOrgan);
  LabelVolume large = volumeOf({ { "vessel", "blood" }, { "liver", "liver" } }, balls);
  large.placement.spacingMm = Vec3d(8.0); // 240 mm across
  EXPECT_EQ(bodyEnd(large, {}), BodyEnd::NoSkin);
  // Some slices of a body: a bath would lie before what was cut.
  const auto column = [](const Vec3d& p) { return balls(Vec3d(p.x, p.y, 0.0)); };
  EXPECT_EQ(bodyEnd(volumeOf({ { "aorta", "blood" }, { "liver", "liver" } }, column), {}), BodyEnd::NoSkin);
  const auto tips = [](const Vec3d& p) { return glm::length(p) < 50.5 ? 1 : 0; }; // touch either end
  EXPECT_EQ(bodyEnd(volumeOf({ { "liver", "liver" } }, tips), {}), BodyEnd::BareOrgan);
}

TEST(BodyEnd, LabelsWithoutNames)
{
  const std::vector<Named> nameless{ { "label_1", "soft_tissue" }, { "label_2", "soft_tissue" } };
  const std::vector<std::string> guesses{ "label_1", "label_2" };
  EXPECT_EQ(bodyEnd(volumeOf(nameless, balls), guesses), BodyEnd::BareOrgan);
  const auto one = [](const Vec3d& p) { return balls(p) == 2 ? 1 : 0; };
  EXPECT_EQ(bodyEnd(volumeOf(nameless, one), guesses), BodyEnd::Skin); // as any object of one's own
  const auto cut = [](const Vec3d& p) { return balls(p + Vec3d(35.0, 0.0, 0.0)); };
  EXPECT_EQ(bodyEnd(volumeOf(nameless, cut), guesses), BodyEnd::Skin);
}

/// The ball of 30 mm gets a shell of 40 mm around it, skin outermost, whatever the room in the volume; its own voxels
/// stay where they are in the world.
TEST(BodyEnd, ABathAroundAnOrgan)
{
  const LabelVolume bare = volumeOf({ { "vessel", "blood" }, { "liver", "liver" } }, balls);
  LabelVolume volume = bare;
  const BodyFill fill = batheOrgan(volume, {});
  const Vec3i n = volume.placement.size;
  double outermost = 0.0;
  double innermostSkin = 1e9;
  std::size_t at = 0;
  for (int k = 0; k < n.z; ++k)
  {
    for (int j = 0; j < n.y; ++j)
    {
      for (int i = 0; i < n.x; ++i, ++at)
      {
        const Vec3d world = volume.placement.worldFromIndex(Vec3d(i, j, k));
        const double r = glm::length(world);
        const int label = volume.voxels[at];
        outermost = label != 0 ? std::max(outermost, r) : outermost;
        innermostSkin = label == fill.skinId ? std::min(innermostSkin, r) : innermostSkin;
        if (r < 29.0)
        {
          ASSERT_EQ(label, balls(world));
        }
      }
    }
  }
  EXPECT_NEAR(outermost, 70.0, 4.0);
  EXPECT_NEAR(innermostSkin, 68.0, 4.0);
  EXPECT_GT(double(n.x) * 2.0, 2.0 * outermost); // the bath is whole
  EXPECT_EQ(bodyEnd(bare, {}), BodyEnd::BareOrgan);
}

TEST(BodyEnd, AHeartOfOneLabelHasNoChambers)
{
  EXPECT_TRUE(hasHeartWithoutChambers(volumeOf({ { "Heart", "myocardium" }, { "aorta", "blood" } }, balls)));
  EXPECT_FALSE(
    hasHeartWithoutChambers(volumeOf({ { "left_ventricle", "blood" }, { "heart_myocardium", "myocardium" } }, balls)));
  EXPECT_FALSE(hasHeartWithoutChambers(volumeOf({ { "aorta", "blood" }, { "liver", "liver" } }, balls)));
}

} // namespace
