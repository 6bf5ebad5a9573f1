#include "Image/LabelSlice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

using namespace sono;

namespace {

/// Labels that tell where they lie, on an oblique, left-handed, anisotropic grid.
LabelVolume obliqueVolume()
{
  LabelVolume volume;
  const double c = std::cos(0.4), s = std::sin(0.4);
  const double d = std::cos(-0.7), t = std::sin(-0.7);
  Mat3d turn =
    Mat3d(Vec3d(c, s, 0), Vec3d(-s, c, 0), Vec3d(0, 0, 1)) * Mat3d(Vec3d(1, 0, 0), Vec3d(0, d, t), Vec3d(0, -t, d));
  turn[2] = -turn[2];
  volume.placement = { { 40, 30, 25 }, { 12.0, -7.0, 33.0 }, { 1.0, 1.5, 2.5 }, turn, {} };
  for (int n = 0; n < 40 * 30 * 25; ++n)
  {
    volume.voxels.push_back(std::uint16_t(1 + n));
  }
  return volume;
}

ProbePose poseInside(const LabelVolume& volume)
{
  ProbePose pose;
  pose.positionMm = volume.placement.worldFromIndex({ 20.0, 10.0, 3.0 });
  pose.axial = volume.placement.direction * Vec3d(0.1, 0.6, 1.0);
  pose.lateral = { 1.0, 0.3, -0.2 };
  return pose.orthonormalized();
}

/// The label of the voxel whose box holds a world point, by projection onto the grid's axes.
std::uint16_t labelAt(const LabelVolume& volume, const Vec3d& world)
{
  const Mat3d& axes = volume.placement.direction;
  const Vec3d p = world - volume.placement.originMm;
  int index[3];
  for (int a = 0; a < 3; ++a)
  {
    index[a] = int(std::lround(glm::dot(axes[a], p) / volume.placement.spacingMm[a]));
    if (index[a] < 0 || index[a] >= volume.placement.size[a])
    {
      return 0;
    }
  }
  return std::uint16_t(1 + index[0] + 40 * (index[1] + 30 * index[2]));
}

} // namespace

TEST(LabelSlice, EveryPixelCarriesTheVoxelItLiesIn)
{
  const LabelVolume volume = obliqueVolume();
  const ProbePose pose = poseInside(volume);
  for (const ScanKind kind : { ScanKind::PhasedSector, ScanKind::Curvilinear, ScanKind::Linear, ScanKind::Radial })
  {
    ScanGeometry geometry;
    geometry.kind = kind;
    geometry.depthMm = 60.0;
    geometry.radiusMm = 10.0;
    const PlaneImage image = scanConvert(geometry, std::vector<float>(128, 1.0f), 1, 60.0, 0.43);
    const auto labels = sliceLabels(volume, geometry, pose, image);
    ASSERT_EQ(labels.size(), image.value.size());
    std::set<std::uint16_t> seen;
    for (std::size_t n = 0; n < labels.size(); ++n)
    {
      const double lateral = image.lateralMinMm + double(n % std::size_t(image.width)) * image.pixelMm;
      const double axial = image.axialMinMm + double(n / std::size_t(image.width)) * image.pixelMm;
      const Vec3d world = pose.positionMm + lateral * pose.lateral + axial * pose.axial;
      ASSERT_EQ(labels[n], image.mask[n] ? labelAt(volume, world) : 0) << lateral << ' ' << axial;
      seen.insert(labels[n]);
    }
    EXPECT_GT(seen.size(), 300u);
    EXPECT_EQ(seen.count(0), 1u);
  }
}

TEST(LabelSlice, LinesPassThroughTheLabelsOfTheirPixels)
{
  // The lines that a tracer follows and the pixels must agree on the world.
  const LabelVolume volume = obliqueVolume();
  const ProbePose pose = poseInside(volume);
  ScanGeometry geometry;
  geometry.kind = ScanKind::Radial;
  geometry.sectorDeg = 360.0;
  geometry.radiusMm = 2.0;
  geometry.depthMm = 20.0;
  const PlaneImage image = scanConvert(geometry, std::vector<float>(128, 1.0f), 1, 20.0, 0.05);
  const auto labels = sliceLabels(volume, geometry, pose, image);
  int agreeing = 0;
  int all = 0;
  for (const ScanLine& line : makeScanLines(geometry, pose))
  {
    for (double r = 0.5; r < 19.5; r += 0.77)
    {
      const Vec3d world = line.originMm + r * line.axis;
      const double lateral = glm::dot(world - pose.positionMm, pose.lateral);
      const double axial = glm::dot(world - pose.positionMm, pose.axial);
      const auto i = std::size_t(std::lround((lateral - image.lateralMinMm) / 0.05));
      const auto j = std::size_t(std::lround((axial - image.axialMinMm) / 0.05));
      agreeing += labels[j * std::size_t(image.width) + i] == labelAt(volume, world);
      ++all;
    }
  }
  EXPECT_GT(agreeing, 0.93 * all); // half a pixel away, the voxel may be the next one
}

TEST(LabelSlice, MatrixVolumes)
{
  const LabelVolume volume = obliqueVolume();
  const ProbePose pose = poseInside(volume);
  ScanGeometry geometry;
  geometry.kind = ScanKind::Matrix;
  geometry.lineCount = 8;
  geometry.elevationLineCount = 6;
  geometry.depthMm = 40.0;
  const VolumeImage image = scanConvertVolume(geometry, std::vector<float>(48, 1.0f), 1, 40.0, 1.1);
  const auto labels = sliceLabels(volume, geometry, pose, image);
  ASSERT_EQ(labels.size(), image.value.size());
  const Vec3d elevation = glm::cross(pose.axial, pose.lateral);
  std::size_t n = 0;
  for (int k = 0; k < image.size.z; ++k)
  {
    for (int j = 0; j < image.size.y; ++j)
    {
      for (int i = 0; i < image.size.x; ++i, ++n)
      {
        const Vec3d p = image.minMm + 1.1 * Vec3d(i, j, k);
        const Vec3d world = pose.positionMm + p.x * pose.lateral + p.y * elevation + p.z * pose.axial;
        ASSERT_EQ(labels[n], image.mask[n] ? labelAt(volume, world) : 0);
      }
    }
  }
}
