#include "Phantoms/BeatingHeart.h"
#include "Phantoms/DrawThorax.h"
#include "Phantoms/ThoraxBody.h"
#include "Phantoms/ThoraxPhantom.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace sono;

constexpr double endOfSystole = 0.35;

double voxelsOf(const LabelVolume& volume, ThoraxLabel label)
{
  return double(std::count(volume.voxels.begin(), volume.voxels.end(), std::uint16_t(label)));
}

ThoraxParameters at(double phase, ThoraxParameters parameters = {})
{
  parameters.phase = phase;
  return parameters;
}

/// Derivatives of the resting place, by differences.
Mat3d slopeAt(const HeartBeat& beat, const Vec3d& p)
{
  Mat3d slope(1.0);
  for (int a = 0; a < 3; ++a)
  {
    Vec3d step(0.0);
    step[a] = 1e-4;
    slope[a] = (beat.restingPlaceMm(p + step) - beat.restingPlaceMm(p - step)) / 2e-4;
  }
  return slope;
}

/// Default, dilated with a thin wall, and small with a thick one.
std::vector<HeartShape> shapes()
{
  HeartShape dilated;
  dilated.leftScale = 1.25;
  dilated.wallMm = 7.0;
  HeartShape thick;
  thick.leftScale = 0.9;
  thick.wallMm = 15.0;
  return { HeartShape{}, dilated, thick };
}

TEST(BeatingHeart, StandsStillAtTheEndOfDiastole)
{
  EXPECT_EQ(contractionAt(0.0), 0.0);
  EXPECT_NEAR(contractionAt(endOfSystole), 1.0, 1e-12);
  EXPECT_NEAR(contractionAt(0.999999), 0.0, 1e-9);
  EXPECT_EQ(HeartBeat(HeartShape{}, 60.0, 1.0).restingPlaceMm({ 20.0, 3.0, 70.0 }), Vec3d(20.0, 3.0, 70.0));
}

TEST(BeatingHeart, KeepsTheWallsVolumeWhateverItsShape)
{
  for (const HeartShape& shape : shapes())
  {
    const HeartBeat beat(shape, 55.0, endOfSystole);
    for (const double angle : { 0.0, 1.0, 2.0, 3.0, 4.0, 5.0 })
    {
      for (const double z : { 45.0, 60.0, 75.0, 90.0 })
      {
        const double halfMm = 56.0 * std::sqrt(shape.leftScale) + 0.3 * shape.wallMm;
        const double middleMm = 23.0 * shape.leftScale + 0.45 * shape.wallMm;
        const double R = middleMm * std::sqrt(1.0 - std::pow((z - 87.0) / halfMm, 2));
        const Vec3d rest(5.0 + R * std::cos(angle), -0.5 + R * std::sin(angle), z);
        const Vec3d now = beat.placeMm(rest);
        EXPECT_NEAR(glm::distance(beat.restingPlaceMm(now), rest), 0.0, 1e-8);
        // E changes along z, which shears but keeps volumes.
        EXPECT_NEAR(glm::determinant(slopeAt(beat, now)), 1.0, 1e-3) << angle << " " << z;
      }
    }
  }
}

TEST(BeatingHeart, FoldsNowhere)
{
  std::vector<HeartShape> all = shapes();
  for (const std::uint64_t seed : { 1, 2, 3, 4 })
  {
    all.push_back(ThoraxBody(drawThoraxParameters(seed)).heart());
  }
  for (const HeartShape& shape : all)
  {
    const HeartBeat beat(shape, 62.0, endOfSystole);
    double least = 1e9;
    for (double x = -130.0; x < 90.0; x += 4.0)
    {
      for (double y = -90.0; y < 90.0; y += 4.0)
      {
        for (double z = -5.0; z < 210.0; z += 4.0)
        {
          least = std::min(least, glm::determinant(slopeAt(beat, { x, y, z })));
        }
      }
    }
    EXPECT_GT(least, 0.05);
  }
}

TEST(BeatingHeart, EjectsWhatIsAsked)
{
  std::vector<ThoraxParameters> bodies{ ThoraxParameters{} };
  for (const std::uint64_t seed : { 1, 2, 3, 4, 5, 6 })
  {
    bodies.push_back(drawThoraxParameters(seed));
  }
  for (const ThoraxParameters& body : bodies)
  {
    const double before = voxelsOf(makeThoraxPhantom(2.0, at(0.0, body)), LeftVentricleBlood);
    const double after = voxelsOf(makeThoraxPhantom(2.0, at(endOfSystole, body)), LeftVentricleBlood);
    EXPECT_NEAR(100.0 * (1.0 - after / before), body.ejectionPercent, 5.0);
  }
}

TEST(BeatingHeart, MovesTheAnnulusTowardsTheApex)
{
  const Vec3d annulus = HeartBeat(HeartShape{}, 60.0, endOfSystole).placeMm({ 16.0, 0.0, 113.0 });
  EXPECT_NEAR(113.0 - annulus.z, 12.5, 1.0);
}

/// Voxels' faces between two labels.
int facesBetween(const LabelVolume& volume, ThoraxLabel a, ThoraxLabel b)
{
  const Vec3i n = volume.placement.size;
  int faces = 0;
  for (const std::size_t step : { std::size_t(1), std::size_t(n.x), std::size_t(n.x) * n.y })
  {
    for (std::size_t i = 0; i + step < volume.voxels.size(); ++i)
    {
      const int here = volume.voxels[i];
      const int next = volume.voxels[i + step];
      faces += (here == a && next == b) || (here == b && next == a) ? 1 : 0;
    }
  }
  return faces;
}

TEST(BeatingHeart, ValvesOpenAndCloseInTurn)
{
  const LabelVolume systole = makeThoraxPhantom(1.5, at(0.2));
  EXPECT_EQ(facesBetween(systole, LeftAtriumBlood, LeftVentricleBlood), 0);
  EXPECT_EQ(facesBetween(systole, RightAtriumBlood, RightVentricleBlood), 0);
  EXPECT_GT(facesBetween(systole, LeftVentricleBlood, AortaLumen), 20);
  const LabelVolume filling = makeThoraxPhantom(1.5, at(0.5));
  EXPECT_GT(facesBetween(filling, LeftAtriumBlood, LeftVentricleBlood), 20);
  EXPECT_GT(facesBetween(filling, RightAtriumBlood, RightVentricleBlood), 20);
  EXPECT_EQ(facesBetween(filling, LeftVentricleBlood, AortaLumen), 0);
  // Never both ways at once.
  for (double phase = 0.0; phase < 1.0; phase += 0.001)
  {
    EXPECT_TRUE(inflowOpeningAt(phase) < 1e-9 || outflowOpeningAt(phase) < 1e-9) << phase;
  }
}

} // namespace
