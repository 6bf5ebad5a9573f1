#include "ErrorText.h"
#include "Folders.h"
#include "Labels/AssignTissues.h"
#include "Phantoms/CheckThorax.h"
#include "Phantoms/DrawThorax.h"
#include "Phantoms/ThoraxBody.h"
#include "Phantoms/ThoraxLandmarks.h"
#include "Phantoms/ThoraxPhantom.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

std::array<double, 4> chambersMl(const LabelVolume& volume)
{
  const Vec3d s = volume.placement.spacingMm;
  std::array<double, 4> volumes{};
  for (const std::uint16_t id : volume.voxels)
  {
    if (id >= LeftVentricleBlood && id <= RightAtriumBlood)
    {
      volumes[id - LeftVentricleBlood] += s.x * s.y * s.z / 1000.0;
    }
  }
  return volumes;
}

/// Voxels of one label that lie in a region of the heart's frame become another.
template<class Region>
LabelVolume replaced(LabelVolume volume, const HeartFrame& frame, ThoraxLabel from, ThoraxLabel to, Region&& region)
{
  const Vec3i n = volume.placement.size;
  for (std::size_t i = 0; i < volume.voxels.size(); ++i)
  {
    const Vec3d index(double(i % n.x), double(i / n.x % n.y), double(i / n.x / n.y));
    if (volume.voxels[i] == from && region(frame.fromWorld(volume.placement.worldFromIndex(index))))
    {
      volume.voxels[i] = to;
    }
  }
  return volume;
}

/// The map's figures from before it was one of a family.
TEST(ThoraxBodies, TheDefaultIsTheBundledThorax)
{
  const LabelVolume volume = makeThoraxPhantom(1.0, ThoraxParameters{});
  EXPECT_EQ(volume.placement.size, Vec3i(292, 212, 250));
  const std::array<double, 4> before{ 91.583, 108.198, 51.209, 73.278 };
  const std::array<double, 4> now = chambersMl(volume);
  for (std::size_t chamber = 0; chamber < 4; ++chamber)
  {
    EXPECT_NEAR(now[chamber], before[chamber], 0.002);
  }
}

/// Rows share what is worked out once, and leave out what is far away.
TEST(ThoraxBodies, TheLabelsOfAGridAreThoseOfItsPoints)
{
  for (int seed = 0; seed <= 6; ++seed)
  {
    const ThoraxParameters parameters = seed == 0 ? ThoraxParameters{} : drawThoraxParameters(std::uint64_t(seed));
    const ThoraxBody body(parameters);
    const LabelVolume volume = makeThoraxPhantom(3.0, parameters);
    const Vec3i n = volume.placement.size;
    int differ = 0;
    for (std::size_t i = 0; i < volume.voxels.size(); ++i)
    {
      const Vec3d index(double(i % n.x), double(i / n.x % n.y), double(i / n.x / n.y));
      differ += body.sample(volume.placement.worldFromIndex(index)) == volume.voxels[i] ? 0 : 1;
    }
    EXPECT_EQ(differ, 0) << "of " << volume.voxels.size() << " voxels, seed " << seed;
  }
}

TEST(ThoraxBodies, BoundsOfTheDistanceToAHeartHoldAroundAPoint)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> side(-1.0, 1.0);
  const auto drawn = [&] { return Vec3d(side(random), side(random), side(random)); };
  for (int seed = 1; seed <= 10; ++seed)
  {
    const Heart heart(ThoraxBody(drawThoraxParameters(std::uint64_t(seed))).heart());
    int isOutside = 0;
    int isInside = 0;
    for (int n = 0; n < 20000; ++n)
    {
      const Vec3d p = heartSphereCentreMm() + 130.0 * drawn();
      const double aroundMm = 5.0 * (side(random) + 1.0);
      const DistanceBounds bounds = heart.outsideMm(p, aroundMm);
      const Vec3d offset = drawn();
      const double length = glm::length(offset);
      const double outsideMm = heart.sample(p + aroundMm * (length > 1.0 ? offset / length : offset)).outsideMm;
      ASSERT_LE(bounds.leastMm, outsideMm);
      ASSERT_GE(bounds.mostMm, outsideMm);
      isOutside += bounds.leastMm > 0.0 ? 1 : 0;
      isInside += bounds.mostMm <= 0.0 ? 1 : 0;
    }
    EXPECT_GT(isOutside, 12000); // they say something
    EXPECT_GT(isInside, 200);
  }
}

TEST(ThoraxBodies, SinesAreThoseOfTheLibrary)
{
  for (int n = -200000; n <= 200000; ++n)
  {
    for (const double x : { 0.005 * n, 1.5707963267948966 * (n % 600) })
    {
      ASSERT_NEAR(shapes::sine(x), std::sin(x), 1e-13);
    }
  }
}

TEST(ThoraxBodies, ASeedGivesTheSameBodyOnEveryPlatform)
{
  const ThoraxParameters drawn = drawThoraxParameters(7);
  const std::vector<double> known{ 106.784299016, 99.143105447, 50.782354772, 59.564087391, 12.762989759, 0.484433955,
                                   -0.291145059,  0.478381974,  -3.364707600, 0.600698072,  1.043950364,  29.200596690,
                                   10.145078897,  0.423161638,  0.602345586,  0.134070456,  60.861917853 };
  std::size_t i = 0;
  ThoraxParameters::visit(drawn, [&](double value, const Parameter& parameter) {
    ASSERT_LT(i, known.size());
    EXPECT_NEAR(value, known[i++], 1e-6) << parameter.name;
  });
  EXPECT_EQ(i, known.size());
}

TEST(ThoraxBodies, DrawsAreWithinTheRanges)
{
  int turned = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed)
  {
    const ThoraxParameters drawn = drawThoraxParameters(seed);
    EXPECT_NO_THROW(requireInRange(drawn)) << seed;
    turned += drawn.leftLateral >= 0.6 ? 1 : 0;
  }
  EXPECT_NEAR(turned, 1960, 5 * std::sqrt(2000 * 0.98 * 0.02)); // five standard deviations
}

/// Where the left lung begins beside the middle, straight behind the chest wall and above the heart.
double lungEdgeMm(const ThoraxBody& body)
{
  double x = 4.0;
  while (x < 140.0 && body.sample(Vec3d(x, -75.0, 65.0)) != LungLeft)
  {
    x += 0.5;
  }
  return x;
}

/// Published: the apex goes by 15 mm and the base stays; the lung's edge lies 25 mm beside the sternum.
TEST(ThoraxBodies, OnTheLeftSideTheApexSwingsAndTheLungGivesWay)
{
  const ThoraxBody supine{ ThoraxParameters{} };
  ThoraxParameters parameters;
  parameters.leftLateral = 1.0;
  const ThoraxBody turned(parameters);
  const HeartLandmarks before = thoraxLandmarks(supine);
  const HeartLandmarks after = thoraxLandmarks(turned);
  EXPECT_NEAR(glm::distance(before.apexMm, after.apexMm), 15.0, 0.5);
  EXPECT_GT(after.apexMm.x - before.apexMm.x, 7.5);
  EXPECT_LT(glm::distance(before.aortic->centreMm, after.aortic->centreMm), 1e-9);
  EXPECT_LT(glm::distance(before.mitral.centreMm, after.mitral.centreMm), 3.0);
  constexpr double sternumEdgeMm = 15.0;
  EXPECT_LT(lungEdgeMm(supine), sternumEdgeMm);
  EXPECT_NEAR(lungEdgeMm(turned), sternumEdgeMm + 25.0, 2.0);
  EXPECT_TRUE(checkThorax(makeThoraxPhantom(2.0, parameters), parameters).none());
}

std::string faultsOf(const LabelVolume& volume, const ThoraxParameters& parameters)
{
  const ThoraxFaults faults = checkThorax(volume, parameters);
  return faults.none() ? ""
                       : std::to_string(faults.open) + " open, " + std::to_string(faults.apart) + " apart, " +
                           std::to_string(faults.volumes) + " volumes";
}

/// Valid, with the volumes that were asked for at the end of diastole, its landmarks where the label map's are.
TEST(ThoraxBodies, DrawsAreValid)
{
  const std::string data = dataFolder();
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
  {
    const ThoraxParameters parameters = drawThoraxParameters(seed);
    ThoraxParameters filled = parameters;
    filled.phase = 0.0;
    const LabelVolume before = makeThoraxPhantom(2.0, filled);
    EXPECT_EQ(faultsOf(before, filled), "") << "seed " << seed;
    LabelVolume volume = makeThoraxPhantom(2.0, parameters);
    EXPECT_EQ(faultsOf(volume, parameters), "") << "seed " << seed;
    const std::array<double, 4> asked{ parameters.leftVentricleMl, parameters.rightVentricleMl, parameters.leftAtriumMl,
                                       parameters.rightAtriumMl };
    const std::array<double, 4> counted = chambersMl(before);
    for (std::size_t chamber = 0; chamber < 4; ++chamber)
    {
      EXPECT_NEAR(counted[chamber] / asked[chamber], 1.0, 0.05) << "seed " << seed << ", chamber " << chamber;
    }
    assignTissues(volume, LabelTissueMap::read(data + "/label_tissues.csv"), TissueTable::read(data + "/tissues.csv"),
                  "soft_tissue");
    const HeartLandmarks found = findHeartLandmarks(volume);
    const HeartLandmarks drawn = thoraxLandmarks(ThoraxBody(parameters));
    EXPECT_LT(glm::distance(found.apexMm, drawn.apexMm), 5.0) << "seed " << seed;
    EXPECT_LT(glm::distance(found.mitral.centreMm, drawn.mitral.centreMm), 5.0) << "seed " << seed;
    EXPECT_LT(glm::distance(found.tricuspid->centreMm, drawn.tricuspid->centreMm), 5.0) << "seed " << seed;
    EXPECT_LT(glm::distance(found.aortic->centreMm, drawn.aortic->centreMm), 5.0) << "seed " << seed;
  }
}

/// How far it is through the wall of the left ventricle, voxel by voxel on rays from its axis.
double meanWallMm(const LabelVolume& volume, const HeartFrame& frame)
{
  const Vec3i n = volume.placement.size;
  constexpr int rays = 72;
  constexpr double stepMm = 0.1;
  int inWall = 0;
  for (int ray = 0; ray < rays; ++ray)
  {
    const double turn = ray * 2.0 * 3.14159265358979323846 / rays;
    for (double r = 0.0; r < 70.0; r += stepMm)
    {
      const Vec3d world = frame.toWorld(Vec3d(5.0 + r * std::cos(turn), -0.5 + r * std::sin(turn), 80.0));
      const Vec3i v(glm::round(volume.placement.indexFromWorld(world)));
      const int id = volume.voxels[(std::size_t(v.z) * n.y + v.y) * n.x + v.x];
      const bool isWall = id == LeftVentricleMyocardium || id == InterventricularSeptum;
      const bool isCavity = id == LeftVentricleBlood || id == PapillaryMuscleAnterolateral ||
                            id == PapillaryMusclePosteromedial || id == MitralValve || id == LeftAtriumBlood;
      inWall += isWall ? 1 : 0;
      if (!isWall && !isCavity)
      {
        break;
      }
    }
  }
  return inWall * stepMm / rays;
}

TEST(ThoraxBodies, WallsAreAsThickAsAsked)
{
  for (const double wallMm : { 7.0, 10.0, 14.0 })
  {
    ThoraxParameters parameters;
    parameters.wallThicknessMm = wallMm;
    const LabelVolume volume = makeThoraxPhantom(1.0, parameters);
    EXPECT_NEAR(meanWallMm(volume, heartFrame(parameters)), wallMm, 1.0);
  }
}

TEST(ThoraxBodies, ABadParameterIsOneSentence)
{
  const ThoraxParameters defaults;
  ThoraxParameters::visit(defaults, [&](double, const Parameter& wanted) {
    for (const double bad :
         { wanted.range.low - 1.0, wanted.range.high + 1.0, std::numeric_limits<double>::quiet_NaN() })
    {
      ThoraxParameters parameters;
      ThoraxParameters::visit(parameters, [&](double& value, const Parameter& parameter) {
        value = std::string(parameter.name) == wanted.name ? bad : value;
      });
      expectContains(errorOf([&] { makeThoraxPhantom(5.0, parameters); }), std::string(wanted.name) + " is ");
    }
  });
}

TEST(ThoraxBodies, PlantedFaultsAreFound)
{
  const ThoraxParameters defaults;
  const HeartFrame frame = heartFrame(defaults);
  const LabelVolume whole = makeThoraxPhantom(2.0);
  EXPECT_TRUE(checkThorax(whole, defaults).none());
  const auto isHole = [](const Vec3d& q) { return glm::distance(q, Vec3d(31.0, 0.0, 80.0)) < 9.0; };
  EXPECT_GT(checkThorax(replaced(whole, frame, LeftVentricleMyocardium, LungLeft, isHole), defaults).open, 0);
  const auto isAcross = [](const Vec3d& q) { return q.z > 60.0 && q.z < 63.0; };
  const ThoraxFaults divided =
    checkThorax(replaced(whole, frame, LeftVentricleBlood, LeftVentricleMyocardium, isAcross), defaults);
  EXPECT_EQ(divided.apart, 1);
  const auto everywhere = [](const Vec3d&) { return true; };
  const ThoraxFaults missing =
    checkThorax(replaced(whole, frame, RightAtriumBlood, RightAtriumWall, everywhere), defaults);
  EXPECT_EQ(missing.volumes, 1);
}

} // namespace
