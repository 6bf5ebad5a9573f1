#include "TestScenes.h"

#include "Trace/ProbeContact.h"

#include <gtest/gtest.h>

namespace {

using namespace sono;
using namespace sono::test;

/// From x = 20 mm on: 20 mm of soft tissue, bone, lung; air before that, which is the outside.
std::unique_ptr<Scene> makeLayers()
{
  return makeScene(
    Vec3i(80, 20, 20), Vec3d(1.0),
    { makeTissue("air", 0.0004, 343, 7.5), makeTissue("soft", 1.63, 1540, 0.5), makeTissue("bone", 7.8, 4080, 5.0),
      makeTissue("lung", 0.18, 600, 40.0) },
    [](const Vec3d& p) { return int(p.x / 20.0); }, "air");
}

std::string at(double x, const Vec3d& axis = { 1.0, 0.0, 0.0 })
{
  return probeContactWarning(*makeLayers(), { makeLine({ x, 10.0, 10.0 }, axis) });
}

TEST(ProbeContact, OnAndInTheBodyThereIsNothingToSay)
{
  EXPECT_EQ(at(19.5), "");
  EXPECT_EQ(at(20.5), "");
  EXPECT_EQ(at(35.0), ""); // as a catheter's
}

TEST(ProbeContact, InsideBoneAndLung)
{
  EXPECT_NE(at(50.0).find("inside 'label_2' (bone)"), std::string::npos) << at(50.0);
  EXPECT_NE(at(70.0).find("inside 'label_3' (lung)"), std::string::npos) << at(70.0);
  EXPECT_NE(at(50.0).find("move the probe onto the skin"), std::string::npos);
}

TEST(ProbeContact, OffTheBody)
{
  EXPECT_EQ(at(12.0), "");
  EXPECT_NE(at(5.0).find("15 mm off the body"), std::string::npos) << at(5.0);
  EXPECT_NE(at(-35.0).find("55 mm off the body"), std::string::npos) << at(-35.0); // beyond the volume
}

TEST(ProbeContact, LookingAwayIsTheTracersToSay)
{
  EXPECT_EQ(at(5.0, { -1.0, 0.0, 0.0 }), "");
}

TEST(ProbeContact, MostOfTheFaceDecides)
{
  const auto scene = makeLayers();
  const ScanLine inSoft = makeLine({ 30.0, 10.0, 10.0 }, { 1.0, 0.0, 0.0 });
  const ScanLine inBone = makeLine({ 50.0, 10.0, 10.0 }, { 1.0, 0.0, 0.0 });
  EXPECT_EQ(probeContactWarning(*scene, { inSoft, inBone }), "");
  EXPECT_NE(probeContactWarning(*scene, { inSoft, inBone, inBone }), "");
}

/// A block of soft tissue, 100 x 100 x 100 mm, in front of 40 mm of air.
std::unique_ptr<Scene> makeBlock()
{
  return makeScene(
    Vec3i(70, 50, 50), Vec3d(2.0), { makeTissue("air", 0.0004, 343, 7.5), makeTissue("soft", 1.63, 1540, 0.5) },
    [](const Vec3d& p) { return p.x > 40.0 ? 1 : 0; }, "air");
}

std::string placeOf(ScanGeometry geometry, const Vec3d& position)
{
  return probePlaceWarning(*makeBlock(), geometry, { position, { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 } });
}

TEST(ProbeContact, SaysThatAFaceLiesInsideTheBody)
{
  ScanGeometry geometry;
  geometry.depthMm = 40.0;
  EXPECT_EQ(placeOf(geometry, { 40.5, 50.0, 50.0 }), "");
  EXPECT_EQ(placeOf(geometry, { 50.0, 50.0, 50.0 }), "");
  const std::string warning = placeOf(geometry, { 70.5, 50.0, 50.0 });
  EXPECT_NE(warning.find("31 mm inside the body"), std::string::npos) << warning;
  EXPECT_NE(warning.find("Find Window"), std::string::npos);
  geometry.kind = ScanKind::Radial; // a catheter belongs there
  geometry.radiusMm = 2.0;
  EXPECT_EQ(placeOf(geometry, { 70.5, 50.0, 50.0 }), "");
}

/// Parallel lines of 300 mm, of which 100 run through the volume.
TEST(ProbeContact, SaysHowLittleOfTheImageIsInTheVolume)
{
  ScanGeometry geometry;
  geometry.kind = ScanKind::Linear;
  geometry.widthMm = 40.0;
  geometry.depthMm = 300.0;
  const std::string warning = placeOf(geometry, { 40.0, 50.0, 50.0 });
  EXPECT_NE(warning.find("Only 33 % of the image"), std::string::npos) << warning;
  EXPECT_NE(warning.find("Find Window"), std::string::npos);
  geometry.depthMm = 190.0;
  EXPECT_EQ(placeOf(geometry, { 40.0, 50.0, 50.0 }), "");
}

} // namespace
