#include "ErrorText.h"
#include "Folders.h"
#include "Labels/AssignTissues.h"
#include "Phantoms/CalibrationPhantom.h"
#include "Phantoms/TestObjects.h"
#include "Scene/Scene.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

namespace {

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

std::vector<PhantomTarget> bundledTargets()
{
  return readPhantomTargets(dataFile("phantom_040gse.csv"));
}

TissueTable bundledTissues()
{
  return TissueTable::read(dataFile("tissues.csv"));
}

int voxelsOf(const LabelVolume& volume, const std::string& name)
{
  const auto label =
    std::find_if(volume.labels.begin(), volume.labels.end(), [&](const LabelInfo& l) { return l.name == name; });
  return label == volume.labels.end()
           ? 0
           : int(std::count(volume.voxels.begin(), volume.voxels.end(), std::uint16_t(label->id)));
}

double volumeOf(const TargetSurface& surface)
{
  double six = 0.0;
  for (const auto& t : surface.triangles)
  {
    const auto p = [&](int i) { return surface.pointsMm[std::size_t(t[std::size_t(i)])]; };
    six += glm::dot(p(0), glm::cross(p(1), p(2)));
  }
  return std::fabs(six) / 6.0;
}

TEST(CalibrationPhantom, TableHoldsThreeViewsOfThreeGroups)
{
  std::map<std::pair<int, std::string>, int> groups;
  int wires = 0;
  for (const PhantomTarget& t : bundledTargets())
  {
    if (t.kind == PhantomTargetKind::Wire)
    {
      ++groups[{ t.view, t.name }];
      ++wires;
    }
    EXPECT_NE(bundledTissues().find(t.tissue), nullptr) << t.tissue;
  }
  EXPECT_GE(wires, 60);
  EXPECT_EQ(groups.size(), 9u);
}

TEST(CalibrationPhantom, GreyLevelsOfItsTissuesAreWhatTheirNamesSay)
{
  const TissueTable table = bundledTissues();
  const double gel = table.find("phantom_gel")->scattererSigma;
  const std::map<std::string, double> levels{ { "m9", -9.0 }, { "m6", -6.0 }, { "m3", -3.0 },
                                              { "p3", 3.0 },  { "p6", 6.0 },  { "p15", 15.0 } };
  for (const auto& [name, db] : levels)
  {
    const Tissue* tissue = table.find("phantom_" + name);
    ASSERT_NE(tissue, nullptr) << name;
    EXPECT_NEAR(20.0 * std::log10(tissue->scattererSigma / gel), db, 0.005) << name;
    EXPECT_EQ(tissue->scattererMean, 0.0);
    EXPECT_EQ(tissue->scattererProbability, table.find("phantom_gel")->scattererProbability);
  }
}

TEST(CalibrationPhantom, CylindersHaveTheAreaOfTheirCircles)
{
  CalibrationPhantomSettings settings;
  settings.thicknessMm = 1.0;
  const LabelVolume volume = makeCalibrationPhantom(bundledTargets(), settings);
  const double layers = volume.placement.size.y;
  const double voxelMm2 = settings.spacingMm * settings.spacingMm;
  EXPECT_NEAR(voxelsOf(volume, "phantom_p15") / layers * voxelMm2, M_PI * 25.0, 1.0);
  double anechoicMm2 = 0.0;
  for (const PhantomTarget& t : bundledTargets())
  {
    anechoicMm2 += t.tissue == "phantom_anechoic" ? 0.25 * M_PI * t.diameterMm * t.diameterMm : 0.0;
  }
  EXPECT_NEAR(voxelsOf(volume, "phantom_anechoic") / layers * voxelMm2, anechoicMm2, 3.0);
  EXPECT_EQ(voxelsOf(volume, "phantom_nylon"), 0);
}

TEST(CalibrationPhantom, AWireAsVoxelsIsOneColumn)
{
  CalibrationPhantomSettings settings;
  settings.thicknessMm = 1.0;
  settings.wiresAsVoxels = true;
  const LabelVolume volume = makeCalibrationPhantom(bundledTargets(), settings);
  EXPECT_EQ(voxelsOf(volume, "phantom_nylon"), 75 * volume.placement.size.y);
}

TEST(CalibrationPhantom, WiresAreClosedSurfacesOfTheirVolume)
{
  const CalibrationPhantomSettings settings;
  const TargetSurface wires = phantomWireSurface(bundledTargets(), settings, bundledTissues());
  EXPECT_EQ(wires.tissue.name, "phantom_nylon");
  EXPECT_NEAR(volumeOf(wires), 75.0 * M_PI * 0.05 * 0.05 * (settings.thicknessMm - 0.02), 1e-6);
  EXPECT_EQ(localTriangles({ wires }, Mat3d(1.0), Vec3d(0.0)).size(), wires.triangles.size()); // throws unless closed
}

TEST(CalibrationPhantom, WireScatterersAddUpAlongTheWire)
{
  CalibrationPhantomSettings settings;
  settings.thicknessMm = 20.0;
  const std::vector<PhantomTarget> one{ { PhantomTargetKind::Wire, 3, "far", -10.0, 95.0, 0.1, "phantom_nylon" } };
  const auto points = phantomWireScatterers(one, settings, 0.5);
  double sum = 0.0;
  double middle = 0.0;
  for (const PointScatterer& p : points)
  {
    EXPECT_EQ(p.positionMm.x, 35.0);
    EXPECT_EQ(p.positionMm.z, 95.0);
    sum += p.amplitude;
    middle += p.positionMm.y;
  }
  EXPECT_NEAR(sum, 0.5 * 20.0, 1e-4);
  EXPECT_NEAR(middle, 0.0, 1e-9);
}

TEST(CalibrationPhantom, MakesAScene)
{
  CalibrationPhantomSettings settings;
  settings.spacingMm = 1.0;
  settings.thicknessMm = 2.0;
  LabelVolume volume = makeCalibrationPhantom(bundledTargets(), settings);
  const TissueTable tissues = bundledTissues();
  const auto unmatched = assignTissues(volume, LabelTissueMap::read(dataFile("label_tissues.csv")), tissues, "air");
  EXPECT_TRUE(unmatched.empty());
  for (const LabelInfo& label : volume.labels)
  {
    EXPECT_EQ(label.name, label.tissue);
  }
  const Scene scene(std::move(volume), tissues, "air");
  EXPECT_EQ(scene.tissues().size(), 8u); // gel, six levels, anechoic
}

TEST(CalibrationPhantom, BadInputIsOneSentence)
{
  CalibrationPhantomSettings settings;
  settings.spacingMm = 0.01;
  expectContains(errorOf([&] { makeCalibrationPhantom(bundledTargets(), settings); }), "voxel size of the phantom");
  settings = {};
  settings.thicknessMm = 0.0;
  expectContains(errorOf([&] { makeCalibrationPhantom(bundledTargets(), settings); }), "thickness of the phantom");
  settings = {};
  settings.viewPitchMm = 89.0;
  expectContains(errorOf([&] { makeCalibrationPhantom(bundledTargets(), settings); }), "reaches out of the block");
  settings = {};
  settings.spacingMm = 0.1;
  settings.thicknessMm = 127.0;
  expectContains(errorOf([&] { makeCalibrationPhantom(bundledTargets(), settings); }), "400 million");
  expectContains(errorOf([&] { phantomViewPose({}, 4); }), "1 to 3");
  expectContains(errorOf([&] { phantomWireSurface({}, {}, bundledTissues()); }), "no wires");
  expectContains(errorOf([&] { phantomWireSurface(bundledTargets(), {}, TissueTable()); }), "phantom_nylon");
}

TEST(CalibrationPhantom, BadTablesNameLineAndColumn)
{
  const sono::testing::TemporaryFolder folder;
  const std::string path = folder.file("targets.csv");
  const auto errorFor = [&](const std::string& row) {
    std::ofstream(path) << "kind,view,name,lateral_mm,depth_mm,diameter_mm,tissue\n" << row << "\n";
    return errorOf([&] { readPhantomTargets(path); });
  };
  EXPECT_EQ(errorFor("wire,1,near,0,45,0.1,phantom_nylon"), "no error");
  expectContains(errorFor("ball,1,near,0,45,0.1,phantom_nylon"), "line 2");
  expectContains(errorFor("wire,4,near,0,45,0.1,phantom_nylon"), "'view'");
  expectContains(errorFor("wire,1.5,near,0,45,0.1,phantom_nylon"), "whole number");
  expectContains(errorFor("wire,1,near,here,45,0.1,phantom_nylon"), "'lateral_mm'");
  expectContains(errorFor("wire,1,near,0,-5,0.1,phantom_nylon"), "'depth_mm'");
  expectContains(errorFor("wire,1,near,0,45,0,phantom_nylon"), "'diameter_mm'");
  expectContains(errorFor("wire,1,near,0,45,0.1,"), "'tissue'");
  expectContains(errorFor(""), "no targets");
}

TEST(TestObjects, SpheresHaveTheirVolumeAndTheCubeItsSide)
{
  TestObjectSettings settings;
  settings.spacingMm = 1.0;
  const double ball = M_PI / 6.0 * std::pow(settings.diameterMm, 3);
  EXPECT_NEAR(voxelsOf(makeTestObject(TestObject::EnhancementSphere, settings), "water"), ball, 0.02 * ball);
  EXPECT_NEAR(voxelsOf(makeTestObject(TestObject::ShadowSphere, settings), "cortical_bone"), ball, 0.02 * ball);
  EXPECT_EQ(voxelsOf(makeTestObject(TestObject::SpeckleCube, settings), "phantom_speckle"), 40 * 40 * 40);
}

TEST(TestObjects, TheRibLiesInMuscleBesideTheAxis)
{
  TestObjectSettings settings;
  settings.spacingMm = 0.5;
  const LabelVolume volume = makeTestObject(TestObject::Rib, settings);
  std::set<std::string> names;
  for (const LabelInfo& label : volume.labels)
  {
    names.insert(label.name);
  }
  EXPECT_EQ(names, (std::set<std::string>{ "skin", "fat", "muscle", "liver", "cortical_bone" }));
  const double rib = M_PI * 6.5 * 4.0 * 60.0;
  EXPECT_NEAR(voxelsOf(volume, "cortical_bone") * 0.125, rib, 0.02 * rib);
}

TEST(TestObjects, BadInputIsOneSentence)
{
  TestObjectSettings settings;
  settings.diameterMm = 90.0;
  expectContains(errorOf([&] { makeTestObject(TestObject::ShadowSphere, settings); }), "diameter of the sphere");
  settings = {};
  settings.depthMm = 5.0;
  expectContains(errorOf([&] { makeTestObject(TestObject::ShadowSphere, settings); }), "depth of the sphere");
  settings = {};
  settings.spacingMm = 20.0;
  expectContains(errorOf([&] { makeTestObject(TestObject::Rib, settings); }), "voxel size");
}

} // namespace
