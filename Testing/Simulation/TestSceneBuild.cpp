#include "ErrorText.h"
#include "Scene/LabelMask.h"
#include "Scene/NanoConvert.h"
#include "TestScenes.h"

#include <cmath>
#include <set>

using namespace sono;
using namespace sono::test;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

/// Blocks of labels of a hash of the position, some of them single voxels, with ids up to 65535.
LabelVolume scattered(const Vec3i& size, int labelCount)
{
  LabelVolume volume;
  volume.placement.size = size;
  volume.placement.spacingMm = { 0.8, 1.0, 1.6 };
  for (int k = 0; k < size.z; ++k)
  {
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i)
      {
        const unsigned block = unsigned(i / 3) * 73856093u ^ unsigned(j / 4) * 19349663u ^ unsigned(k / 5) * 83492791u;
        const unsigned label = (block * 2654435761u >> 16) % unsigned(labelCount);
        volume.voxels.push_back(std::uint16_t(label == 0 ? 0 : 65536 - label * 300));
      }
    }
  }
  volume.collectLabels();
  return volume;
}

std::unique_ptr<Scene> sceneOf(LabelVolume volume)
{
  TissueTable table;
  table.add(makeTissue("any", 1.5, 1540.0, 0.5));
  for (LabelInfo& label : volume.labels)
  {
    label.tissue = "any";
  }
  return std::make_unique<Scene>(std::move(volume), table, "none");
}

} // namespace

TEST(SceneBuild, LabelGridHoldsEveryVoxel)
{
  for (const Vec3i size : { Vec3i(37, 21, 19), Vec3i(130, 9, 8), Vec3i(1, 1, 1), Vec3i(20, 1, 30) })
  {
    LabelVolume volume = scattered(size, 200);
    if (size.x > 8 && size.y > 8 && size.z > 8)
    {
      // The only voxel of its leaf that differs is the last one.
      volume.voxels[7 + std::size_t(size.x) * (7 + std::size_t(size.y) * 7)] = 12345;
    }
    volume.collectLabels();
    const auto scene = sceneOf(volume);
    const LabelGrid& grid = scene->labelGrid();
    std::size_t at = 0;
    for (int k = 0; k < size.z; ++k)
    {
      for (int j = 0; j < size.y; ++j)
      {
        for (int i = 0; i < size.x; ++i)
        {
          ASSERT_EQ(grid.at({ i, j, k }), volume.voxels[at++]);
        }
      }
    }
    EXPECT_EQ(grid.at({ -1, 0, 0 }), 0);
    EXPECT_EQ(grid.at({ size.x, 0, 0 }), 0);
    EXPECT_EQ(voxelsOf(grid, size), volume.voxels);
  }
}

TEST(SceneBuild, BoxesAreTheSmallest)
{
  const LabelVolume volume = scattered({ 40, 30, 20 }, 50);
  const std::vector<VoxelBox> boxes = labelBoxes(volume);
  ASSERT_EQ(boxes.size(), volume.labels.size());
  for (std::size_t n = 0; n < boxes.size(); ++n)
  {
    std::set<int> along[3];
    std::size_t at = 0;
    for (int k = 0; k < 20; ++k)
    {
      for (int j = 0; j < 30; ++j)
      {
        for (int i = 0; i < 40; ++i)
        {
          if (volume.voxels[at++] == volume.labels[n].id)
          {
            along[0].insert(i);
            along[1].insert(j);
            along[2].insert(k);
          }
        }
      }
    }
    for (int a = 0; a < 3; ++a)
    {
      EXPECT_EQ(boxes[n].first[a], *along[a].begin());
      EXPECT_EQ(boxes[n].last[a], *along[a].rbegin() + 1);
    }
  }
}

TEST(SceneBuild, AllAtOnceIsOneByOne)
{
  const LabelVolume volume = scattered({ 50, 40, 30 }, 200);
  const auto together = sceneOf(volume);
  const auto single = sceneOf(volume);
  together->buildAll();
  for (const LabelInfo& label : volume.labels)
  {
    const SurfaceField& a = together->surface(label.id);
    const SurfaceField& b = single->surface(label.id);
    EXPECT_EQ(a.box, b.box);
    EXPECT_EQ(a.sdf.bytes(), b.sdf.bytes());
    for (int n = 0; n < 500; ++n)
    {
      const Vec3i at(n * 7 % 50, n * 11 % 40, n * 13 % 30);
      ASSERT_EQ(a.at(at), b.at(at));
    }
  }
}

TEST(SceneBuild, StopsOnRequest)
{
  const auto scene = sceneOf(scattered({ 50, 40, 30 }, 20));
  EXPECT_THROW(scene->buildAll([](double) { return false; }), Aborted);
  EXPECT_NO_THROW(scene->buildAll());
}

TEST(SceneBuild, AHollowShellHasTwoSurfaces)
{
  // A wall of 3 voxels around a cavity: two closed surfaces, so V - E + F = 4 with E = 3 F / 2.
  for (const Vec3d spacing : { Vec3d(1.0), Vec3d(0.7, 0.7, 2.1) })
  {
    const Vec3d centre(30.0, 30.0, 30.0);
    const Vec3i size(60.0 / spacing);
    const double wallMm = 3.0 * std::cbrt(spacing.x * spacing.y * spacing.z);
    const auto scene = makeScene(size, spacing, { makeTissue("a", 1.5, 1500, 0.5), makeTissue("b", 1.7, 1600, 0.5) },
                                 [&](const Vec3d& p) {
                                   const double r = glm::length(p - centre);
                                   return r < 22.0 && r > 22.0 - wallMm ? 1 : 0;
                                 });
    const TriangleSurface mesh = meshSurface(scene->volume(), scene->surface(1));
    const long faces = long(mesh.triangles.size());
    EXPECT_EQ(long(mesh.points.size()) - 3 * faces / 2 + faces, 4);
    double outer = 0.0, inner = 1e9;
    for (const auto& p : mesh.points)
    {
      const double r = glm::length(Vec3d(p[0], p[1], p[2]) - centre);
      outer = std::max(outer, r);
      inner = std::min(inner, r);
    }
    EXPECT_NEAR(outer, 22.0, 0.5 * spacing.z);
    EXPECT_NEAR(inner, 22.0 - wallMm, 0.5 * spacing.z);
  }
}

TEST(SceneBuild, MasksHoldTheirLabel)
{
  const LabelVolume volume = scattered({ 37, 29, 23 }, 9);
  const std::vector<VoxelBox> boxes = labelBoxes(volume);
  for (std::size_t n = 0; n < boxes.size(); ++n)
  {
    const int id = volume.labels[n].id;
    const auto mask = openvdb::gridPtrCast<openvdb::MaskGrid>(openFromNano(buildLabelMask(volume, id, boxes[n])));
    EXPECT_EQ(mask->getName(), "voxels_" + std::to_string(id));
    std::size_t count = 0;
    std::size_t at = 0;
    for (int k = 0; k < 23; ++k)
    {
      for (int j = 0; j < 29; ++j)
      {
        for (int i = 0; i < 37; ++i)
        {
          const bool has = volume.voxels[at++] == id;
          count += has;
          ASSERT_EQ(mask->tree().isValueOn(openvdb::Coord(i, j, k)), has);
        }
      }
    }
    EXPECT_EQ(mask->activeVoxelCount(), count);
  }
}
