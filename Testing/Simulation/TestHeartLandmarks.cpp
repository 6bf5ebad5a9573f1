#include "Probe/HeartLandmarks.h"

#include "ErrorText.h"
#include "Folders.h"
#include "Labels/AssignTissues.h"
#include "Phantoms/ThoraxLandmarks.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Probe/PlaneFit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

constexpr const char* names[] = { "background", "left_ventricle", "LV wall", "heart atrium left", "right ventricle",
                                  "RA",         "aorta" };

/// Bodies with closed forms: the left ventricle half of an ellipsoid, apex at (0, 0, -56), base at z = 20 with two
/// round holes, one of 12 mm to the atrium around (0, 4), one of 5 mm to the aorta around (0, -12.5). The right
/// ventricle beside it ends at z = 14 with a hole of 13 mm around (-45, 0).
int bodyAt(const Vec3d& p)
{
  const auto isIn = [&p](const Vec3d& centre, const Vec3d& radii) { return glm::length((p - centre) / radii) < 1.0; };
  const auto isAround = [&p](double x, double y, double radius) { return std::hypot(p.x - x, p.y - y) < radius; };
  if (isIn(Vec3d(0.0), Vec3d(20.0, 20.0, 56.0)) && p.z < 20.0)
  {
    return 1;
  }
  if (p.z > 20.0 && (isAround(0.0, 4.0, 12.0) ? p.z < 30.0 : isIn(Vec3d(0.0, 10.0, 45.0), Vec3d(22.0, 18.0, 18.0))))
  {
    return 3;
  }
  if (p.z > 20.0 && p.z < 60.0 && isAround(0.0, -12.5, 5.0))
  {
    return 6;
  }
  if (isIn(Vec3d(0.0), Vec3d(29.0, 29.0, 65.0)) && p.z < 26.0)
  {
    return 2;
  }
  if (isIn(Vec3d(-42.0, 0.0, -8.0), Vec3d(26.0, 28.0, 40.0)) && p.z < 14.0)
  {
    return 4;
  }
  return p.z > 14.0 && p.z < 40.0 && isAround(-45.0, 0.0, 13.0) ? 5 : 0;
}

void nameAll(LabelVolume& volume)
{
  const std::string data = dataFolder();
  assignTissues(volume, LabelTissueMap::read(data + "/label_tissues.csv"), TissueTable::read(data + "/tissues.csv"),
                "soft_tissue");
}

/// `toBody` turns the world into the body's frame.
LabelVolume sampled(const Mat3d& toBody, const Vec3d& spacingMm)
{
  LabelVolume volume;
  volume.placement.size = Vec3i(glm::round(Vec3d(170.0) / spacingMm));
  volume.placement.spacingMm = spacingMm;
  volume.placement.originMm = -0.5 * Vec3d(volume.placement.size - 1) * spacingMm;
  for (int k = 0; k < volume.placement.size.z; ++k)
  {
    for (int j = 0; j < volume.placement.size.y; ++j)
    {
      for (int i = 0; i < volume.placement.size.x; ++i)
      {
        volume.voxels.push_back(std::uint16_t(bodyAt(toBody * volume.placement.worldFromIndex(Vec3d(i, j, k)))));
      }
    }
  }
  volume.collectLabels();
  for (LabelInfo& label : volume.labels)
  {
    label.name = names[label.id];
  }
  nameAll(volume);
  return volume;
}

Mat3d turned(double a, double b)
{
  const Mat3d aboutZ(Vec3d(std::cos(a), std::sin(a), 0.0), Vec3d(-std::sin(a), std::cos(a), 0.0), Vec3d(0.0, 0.0, 1.0));
  const Mat3d aboutX(Vec3d(1.0, 0.0, 0.0), Vec3d(0.0, std::cos(b), std::sin(b)), Vec3d(0.0, -std::sin(b), std::cos(b)));
  return aboutZ * aboutX;
}

LabelInfo labelOf(const char* name, const char* tissue)
{
  LabelInfo label;
  label.name = name;
  label.tissue = tissue;
  return label;
}

TEST(HeartParts, ByNameAndTissue)
{
  const auto part = [](const char* name, const char* tissue) { return HeartParts({ labelOf(name, tissue) }).of(0); };
  EXPECT_EQ(part("heart_ventricle_left", "blood"), HeartPart::LeftVentricle);
  EXPECT_EQ(part("LV", "blood"), HeartPart::LeftVentricle);
  EXPECT_EQ(part("papillary_muscle_lv_anterolateral", "myocardium"), HeartPart::LeftVentricle);
  EXPECT_EQ(part("Right Ventricle Blood Cavity", "blood"), HeartPart::RightVentricle);
  EXPECT_EQ(part("papillary_muscles_rv", "myocardium"), HeartPart::RightVentricle);
  EXPECT_EQ(part("left atrium", "blood"), HeartPart::LeftAtrium);
  EXPECT_EQ(part("atrial_appendage_left", "blood"), HeartPart::None);
  EXPECT_EQ(part("RA", "blood"), HeartPart::RightAtrium);
  EXPECT_EQ(part("right_atrium_wall", "myocardium"), HeartPart::None);
  EXPECT_EQ(part("heart_myocardium", "myocardium"), HeartPart::LeftWall);
  EXPECT_EQ(part("interventricular_septum", "myocardium"), HeartPart::LeftWall);
  EXPECT_EQ(part("right_ventricle_myocardium", "myocardium"), HeartPart::RightWall);
  EXPECT_EQ(part("aorta", "blood"), HeartPart::Aorta);
  EXPECT_EQ(part("aortic_valve", "valve"), HeartPart::AorticValve);
  EXPECT_EQ(part("mitral_valve", "valve"), HeartPart::MitralValve);
  EXPECT_EQ(part("inferior_vena_cava", "blood"), HeartPart::InferiorVenaCava);
  EXPECT_EQ(part("pulmonary_vein_left", "blood"), HeartPart::None);
  EXPECT_EQ(part("lung_left", "lung"), HeartPart::None);
}

TEST(PlaneFit, FindsThePlaneOfAnEllipse)
{
  const Mat3d axes = turned(0.7, 1.1);
  std::vector<Vec3d> points;
  for (int i = 0; i < 60; ++i)
  {
    const double turn = i * 2.0 * 3.14159265358979323846 / 60.0;
    points.push_back(Vec3d(3.0, -5.0, 8.0) + axes * Vec3d(4.0 * std::cos(turn), 0.0, 10.0 * std::sin(turn)));
  }
  const PlaneFit fit = fitPlane(points);
  EXPECT_NEAR(glm::distance(fit.middleMm, Vec3d(3.0, -5.0, 8.0)), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(glm::dot(fit.normal(), axes[1])), 1.0, 1e-12);
  EXPECT_NEAR(std::abs(glm::dot(fit.axes[2], axes[2])), 1.0, 1e-12);
  EXPECT_NEAR(fit.spreadMm2.y, 8.0, 1e-9); // half the squares of the half axes
  EXPECT_NEAR(fit.spreadMm2.z, 50.0, 1e-9);
}

TEST(HeartLandmarks, OfBodiesWithClosedForms)
{
  for (const Vec3d& spacingMm : { Vec3d(1.0), Vec3d(1.5, 1.5, 2.5) })
  {
    for (const Mat3d& axes : { Mat3d(1.0), turned(0.9, -0.8), turned(2.5, 0.4) })
    {
      const HeartLandmarks found = findHeartLandmarks(sampled(axes, spacingMm));
      const Mat3d toBody = axes;
      const double tolerance = spacingMm.z > 2.0 ? 2.5 : 1.5;
      const auto expectAt = [&](const Vec3d& worldMm, const Vec3d& bodyMm, const char* what) {
        const Vec3d at = toBody * worldMm;
        EXPECT_NEAR(glm::distance(at, bodyMm), 0.0, tolerance)
          << what << " at " << at.x << " " << at.y << " " << at.z << ", spacing " << spacingMm.z;
      };
      expectAt(found.apexMm, Vec3d(0.0, -0.4, -56.0), "apex");
      expectAt(found.mitral.centreMm, Vec3d(0.0, 4.0, 20.0), "mitral");
      ASSERT_TRUE(found.aortic && found.tricuspid && found.rightAtriumMm);
      expectAt(found.aortic->centreMm, Vec3d(0.0, -12.5, 20.0), "aortic");
      expectAt(found.tricuspid->centreMm, Vec3d(-45.0, 0.0, 14.0), "tricuspid");
      EXPECT_NEAR(found.mitral.radiusMm, 12.0, tolerance);
      EXPECT_NEAR(found.tricuspid->radiusMm, 13.0, tolerance);
      EXPECT_GT((toBody * found.mitral.normal).z, std::cos(0.1));
      EXPECT_GT((toBody * found.aortic->normal).z, std::cos(0.25));
      EXPECT_LT((toBody * found.septal()).x, -0.97);
      EXPECT_NEAR(glm::dot(found.septal(), found.longAxis()), 0.0, 1e-12);
    }
  }
}

/// The bundled thorax has its landmarks from the numbers that draw it.
TEST(HeartLandmarks, OfTheBundledThorax)
{
  const ProbePose pose = thoraxPhantomA4C();
  const HeartLandmarks drawn = thoraxLandmarks(ThoraxBody(ThoraxParameters{}));
  for (const double spacingMm : { 1.0, 2.0 })
  {
    LabelVolume volume = makeThoraxPhantom(spacingMm);
    nameAll(volume);
    const HeartLandmarks found = findHeartLandmarks(volume);
    const auto expectAt = [&](const Vec3d& at, const Vec3d& drawnMm, const char* what) {
      const Vec3d off = at - drawnMm;
      EXPECT_NEAR(glm::length(off), 0.0, 2.5 + 0.75 * spacingMm)
        << what << " off by " << glm::dot(off, pose.lateral) << " lateral, " << glm::dot(off, pose.axial)
        << " axial of " << glm::length(off) << ", at " << spacingMm << " mm";
    };
    expectAt(found.mitral.centreMm, drawn.mitral.centreMm, "mitral");
    expectAt(found.tricuspid->centreMm, drawn.tricuspid->centreMm, "tricuspid");
    expectAt(found.aortic->centreMm, drawn.aortic->centreMm, "aortic");
    expectAt(found.apexMm, drawn.apexMm, "apex");
    EXPECT_LT(glm::dot(found.septal(), pose.lateral), -0.97);
  }
}

TEST(HeartLandmarks, SaysWhatIsMissing)
{
  const LabelVolume whole = sampled(Mat3d(1.0), Vec3d(2.0));
  const auto refusal = [&](int lost, const char* newName) {
    LabelVolume volume = whole;
    for (LabelInfo& label : volume.labels)
    {
      label.name = label.id == lost ? newName : label.name;
      label.tissue = label.id == lost ? "myocardium" : label.tissue;
    }
    return errorOf([&] { findHeartLandmarks(volume); });
  };
  expectContains(refusal(1, "heart"), "no left ventricle, only a 'heart'");
  expectContains(refusal(3, "other"), "no left atrium; standard");
  LabelVolume bare = whole;
  for (std::uint16_t& voxel : bare.voxels)
  {
    voxel = voxel == 0 ? 0 : 1;
  }
  bare.labels = { labelOf("background", "air"), labelOf("heart", "myocardium") };
  bare.labels[1].id = 1;
  expectContains(errorOf([&] { findHeartLandmarks(bare); }),
                 "no left ventricle, no left atrium, no right ventricle, only a 'heart'");

  LabelVolume cut = whole;
  cut.placement.size.z = 50; // up to 15 mm above the middle
  cut.voxels.resize(cut.placement.voxelCount());
  expectContains(errorOf([&] { findHeartLandmarks(cut); }), "label map");
  LabelVolume lower = whole;
  const std::size_t slice = std::size_t(whole.placement.size.x) * whole.placement.size.y;
  lower.voxels.erase(lower.voxels.begin(), lower.voxels.begin() + std::ptrdiff_t(30 * slice)); // the apex is gone
  lower.placement.size.z -= 30;
  expectContains(errorOf([&] { findHeartLandmarks(lower); }), "box cuts the left ventricle");

  LabelVolume without = whole; // optional ones
  for (LabelInfo& label : without.labels)
  {
    label.tissue = label.id >= 5 ? "soft_tissue" : label.tissue;
  }
  const HeartLandmarks found = findHeartLandmarks(without);
  EXPECT_FALSE(found.aortic || found.tricuspid || found.rightAtriumMm);
  EXPECT_LT(found.septal().x, -0.9);
}

} // namespace
