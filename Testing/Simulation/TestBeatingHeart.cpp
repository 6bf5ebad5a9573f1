#include "Phantoms/BeatingHeart.h"
#include "Phantoms/ThoraxPhantom.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace sono;

double blood(const LabelVolume& v)
{
  const auto id = std::find_if(v.labels.begin(), v.labels.end(), [](const LabelInfo& l) {
                    return l.name == "left_ventricle_blood";
                  })->id;
  return double(std::count(v.voxels.begin(), v.voxels.end(), std::uint16_t(id)));
}

/// Derivatives of the resting place, by differences.
Mat3d slopeAt(const Vec3d& p, double phase)
{
  Mat3d slope(1.0);
  for (int a = 0; a < 3; ++a)
  {
    Vec3d step(0.0);
    step[a] = 1e-4;
    slope[a] = (heartRestingPlaceMm(p + step, phase) - heartRestingPlaceMm(p - step, phase)) / 2e-4;
  }
  return slope;
}

TEST(BeatingHeart, StandsStillAtTheEndOfDiastole)
{
  EXPECT_EQ(contractionAt(0.0), 0.0);
  EXPECT_NEAR(contractionAt(0.35), 1.0, 1e-12);
  EXPECT_NEAR(contractionAt(0.999999), 0.0, 1e-9);
  EXPECT_EQ(heartRestingPlaceMm({ 20.0, 3.0, 70.0 }, 1.0), Vec3d(20.0, 3.0, 70.0));
}

TEST(BeatingHeart, KeepsTheWallsVolume)
{
  for (const double angle : { 0.0, 1.0, 2.0, 3.0, 4.0, 5.0 })
  {
    for (const double z : { 45.0, 60.0, 75.0, 90.0 })
    {
      const double R = 27.0 * std::sqrt(1.0 - std::pow((z - 87.0) / 58.0, 2));
      const Vec3d rest(5.0 + R * std::cos(angle), -0.5 + R * std::sin(angle), z);
      const Vec3d now = heartPlaceMm(rest, 0.35);
      EXPECT_NEAR(glm::distance(heartRestingPlaceMm(now, 0.35), rest), 0.0, 1e-8);
      // E changes along z, which shears but keeps volumes.
      EXPECT_NEAR(glm::determinant(slopeAt(now, 0.35)), 1.0, 1e-3) << angle << " " << z;
    }
  }
}

TEST(BeatingHeart, FoldsNowhere)
{
  double least = 1e9;
  for (double x = -110.0; x < 80.0; x += 3.0)
  {
    for (double y = -80.0; y < 80.0; y += 3.0)
    {
      for (double z = 5.0; z < 190.0; z += 3.0)
      {
        least = std::min(least, glm::determinant(slopeAt({ x, y, z }, 0.35)));
      }
    }
  }
  EXPECT_GT(least, 0.05);
}

TEST(BeatingHeart, EjectsAsAHealthyOne)
{
  const double before = blood(makeThoraxPhantom(2.0));
  const double after = blood(makeBeatingThorax(2.0, 0.35));
  const double percent = 100.0 * (1.0 - after / before);
  RecordProperty("ejection_percent", std::to_string(percent));
  EXPECT_GE(percent, 55.0);
  EXPECT_LE(percent, 65.0);
}

TEST(BeatingHeart, MovesTheAnnulusTowardsTheApex)
{
  const Vec3d annulus = heartPlaceMm({ 16.0, 0.0, 113.0 }, 0.35);
  EXPECT_NEAR(113.0 - annulus.z, 12.5, 1.0);
}

} // namespace
