#include "ErrorText.h"
#include "Folders.h"
#include "Labels/BodyFill.h"
#include "Labels/DistanceField.h"
#include "Labels/ReadLabelMap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

namespace fs = std::filesystem;
using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

constexpr double halfWidthMm = 170.0, halfDepthMm = 110.0;

/// Depth below the skin of the generated torso, to first order.
double torsoDepth(const Vec3d& p)
{
  const Vec3d q(p.x / halfWidthMm, p.y / halfDepthMm, 0.0);
  const Vec3d g(p.x / (halfWidthMm * halfWidthMm), p.y / (halfDepthMm * halfDepthMm), 0.0);
  const double level = glm::length(q);
  return level < 1e-6 ? halfDepthMm : (1.0 - level) * level / glm::length(g);
}

/// What of the torso has a label: ribs 10 mm below the skin every 25 mm with a gap in front, spine, lungs, sternum.
int torsoLabel(const Vec3d& p)
{
  const double depth = torsoDepth(p);
  const double alongRib = std::fmod(p.z + 1000.0 - 0.2 * p.y, 25.0) - 12.5;
  const bool front = p.y > 0.0 && std::abs(p.x) < 30.0;
  if (std::hypot(depth - 15.0, alongRib) < 5.0 && !front)
  {
    return 3;
  }
  if (front && std::abs(depth - 15.0) < 5.0 && std::abs(p.x) < 20.0)
  {
    return 4;
  }
  if (std::hypot(p.x, p.y + 80.0) < 18.0)
  {
    return 7;
  }
  const double lung = std::hypot((std::abs(p.x) - 80.0) / 50.0, p.y / 65.0);
  return lung < 1.0 ? 9 : 0;
}

/// The torso in a volume of which the centre is (0, 0, 0), with the speck of a table beside it.
LabelVolume torso(const Vec3i& size, const Vec3d& spacing, const Vec3d& shiftMm)
{
  LabelVolume volume;
  volume.placement.size = size;
  volume.placement.spacingMm = spacing;
  volume.placement.originMm = shiftMm - 0.5 * Vec3d(size - 1) * spacing;
  for (int k = 0; k < size.z; ++k)
  {
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i)
      {
        volume.voxels.push_back(std::uint16_t(torsoLabel(volume.placement.worldFromIndex({ i, j, k }))));
      }
    }
  }
  volume.collectLabels();
  return volume;
}

/// Twice the common part of the body and the torso over the sum of both.
double diceWithTorso(const LabelVolume& volume)
{
  std::size_t both = 0, filled = 0, truth = 0;
  std::size_t at = 0;
  for (int k = 0; k < volume.placement.size.z; ++k)
  {
    for (int j = 0; j < volume.placement.size.y; ++j)
    {
      for (int i = 0; i < volume.placement.size.x; ++i, ++at)
      {
        const double depth = torsoDepth(volume.placement.worldFromIndex({ i, j, k }));
        const bool body = volume.voxels[at] != 0;
        filled += body;
        truth += depth > 0.0;
        both += body && depth > 0.0;
      }
    }
  }
  return 2.0 * double(both) / double(filled + truth);
}

} // namespace

TEST(DistanceField, IsTheNearestMarkedVoxel)
{
  const Vec3i size(11, 7, 9);
  const Vec3d spacing(0.7, 3.0, 1.3);
  std::mt19937 random(3);
  for (const double density : { 0.002, 0.02, 0.3 })
  {
    std::vector<char> mask(std::size_t(size.x * size.y * size.z));
    std::vector<Vec3d> marked;
    std::size_t at = 0;
    const auto forVoxels = [&](const auto& visit) {
      at = 0;
      for (int k = 0; k < size.z; ++k)
      {
        for (int j = 0; j < size.y; ++j)
        {
          for (int i = 0; i < size.x; ++i, ++at)
          {
            visit(Vec3d(i, j, k) * spacing);
          }
        }
      }
    };
    forVoxels([&](const Vec3d& p) {
      mask[at] = std::uniform_real_distribution<>()(random) < density || at == 350 ? 1 : 0;
      if (mask[at])
      {
        marked.push_back(p);
      }
    });
    const std::vector<float> distance = distanceTo(mask, size, spacing);
    forVoxels([&](const Vec3d& p) {
      double nearest = HUGE_VAL;
      for (const Vec3d& m : marked)
      {
        nearest = std::min(nearest, glm::length(p - m));
      }
      ASSERT_NEAR(distance[at], nearest, 1e-5 * (1.0 + nearest));
    });
  }
  EXPECT_GT(distanceTo(std::vector<char>(6, 0), { 3, 2, 1 }, Vec3d(1.0))[4], 1e5f);
}

TEST(BodyFill, FillsATorsoOfKnownShape)
{
  for (const Vec3d spacing : { Vec3d(2.0), Vec3d(1.5, 1.5, 5.0) })
  {
    LabelVolume volume = torso(Vec3i(Vec3d(400.0, 290.0, 200.0) / spacing), spacing, Vec3d(0.0));
    const std::vector<std::uint16_t> before = volume.voxels;
    volume.voxels[5] = 3; // a speck of another object outside
    const BodyFill fill = fillBody(volume);
    EXPECT_EQ(fill.skinId, 10);
    EXPECT_EQ(fill.softTissueId, 11);
    EXPECT_EQ(volume.find(10)->name, "skin");
    EXPECT_EQ(volume.find(11)->name, "soft_tissue");
    EXPECT_GT(diceWithTorso(volume), 0.98);
    // The skin's volume over its area: the ellipse's girth (Ramanujan's first approximation) times the height.
    const double girth = M_PI * (3.0 * (halfWidthMm + halfDepthMm) -
                                 std::sqrt((3.0 * halfWidthMm + halfDepthMm) * (halfWidthMm + 3.0 * halfDepthMm)));
    const double skinMm3 = double(fill.skinVoxels) * spacing.x * spacing.y * spacing.z;
    EXPECT_NEAR(skinMm3 / (girth * 200.0), 2.0, 0.2);
    std::size_t changed = 0;
    for (std::size_t n = 0; n < before.size(); ++n)
    {
      changed += n != 5 && before[n] != 0 && volume.voxels[n] != before[n];
    }
    EXPECT_EQ(changed, 0u);
    EXPECT_EQ(volume.voxels[0], 0);
    EXPECT_EQ(volume.voxels[6], 0);
  }
}

TEST(BodyFill, ACroppedScanHasNoSkinAlongTheCut)
{
  // The left third of the torso and its back are cut off.
  LabelVolume volume = torso({ 150, 110, 60 }, Vec3d(2.0), { 60.0, 30.0, 0.0 });
  const BodyFill fill = fillBody(volume);
  EXPECT_GT(diceWithTorso(volume), 0.98);
  const Vec3i n = volume.placement.size;
  std::size_t skinAlongCut = 0;
  for (int k = 0; k < n.z; ++k)
  {
    for (int j = 40; j < 70; ++j)
    {
      skinAlongCut += volume.voxels[std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k)] == fill.skinId;
    }
  }
  EXPECT_EQ(skinAlongCut, 0u);
}

/// A chin and a chest 80 mm apart stand out 60 mm further than the neck between them, which the closing of 50 mm alone
/// would bridge.
TEST(BodyFill, TheSkinIsCloseToAThyroid)
{
  const auto tissueBeforeIt = [](const char* name) {
    LabelVolume volume;
    volume.placement.size = { 50, 70, 70 };
    volume.placement.spacingMm = Vec3d(3.0);
    volume.placement.originMm = Vec3d(-73.5, -150.0, -103.5);
    for (int n = 0; n < 50 * 70 * 70; ++n)
    {
      const Vec3d p = volume.placement.worldFromIndex(Vec3d(n % 50, n / 50 % 70, n / 3500));
      const bool isIn = std::abs(p.x) < 50.0;
      const bool isChinOrChest = isIn && std::abs(p.z) > 40.0 && p.y > -80.0 && p.y < 40.0;
      const bool isNeck = isIn && std::abs(p.x) < 40.0 && p.y > 0.0 && p.y < 40.0;
      const bool isThyroid = std::abs(p.x) < 30.0 && std::abs(p.z) < 15.0 && p.y > -20.0 && p.y <= 0.0;
      volume.voxels.push_back(isChinOrChest ? 1 : isNeck ? 2 : isThyroid ? 3 : 0);
    }
    volume.collectLabels();
    volume.labels.back().name = name;
    const BodyFill fill = fillBody(volume);
    int skin = 0;
    int tissue = 0;
    for (int j = 0; j < 43; ++j) // to the thyroid's front
    {
      const int id = volume.voxels[std::size_t((35 * 70 + j) * 50 + 25)];
      tissue += id != 0 ? 1 : 0;
      skin += id == fill.skinId ? 1 : 0;
    }
    EXPECT_GE(skin, 1) << name;
    return 3.0 * tissue;
  };
  EXPECT_GT(tissueBeforeIt("label_3"), 40.0);
  EXPECT_GT(tissueBeforeIt("thyroid_cartilage"), 40.0);
  EXPECT_NEAR(tissueBeforeIt("thyroid_gland"), 10.0, 4.0);
  EXPECT_NEAR(tissueBeforeIt("Thyroid (left)"), 10.0, 4.0);
}

TEST(BodyFill, RefusesWhatItCannotFill)
{
  LabelVolume empty;
  empty.placement.size = { 4, 4, 4 };
  empty.voxels.assign(64, 0);
  expectContains(errorOf([&] { fillBody(empty); }), "nothing but 0");
  LabelVolume some = torso({ 20, 20, 20 }, Vec3d(15.0), Vec3d(0.0));
  BodyFillSettings settings;
  settings.skinMm = NAN;
  expectContains(errorOf([&] { fillBody(some, settings); }), "skin");
  settings = {};
  settings.closingMm = -1.0;
  expectContains(errorOf([&] { fillBody(some, settings); }), "closing");

  LabelVolume high = some;
  high.voxels[0] = 65535;
  const BodyFill fill = fillBody(high);
  EXPECT_EQ(fill.skinId, 1);
  EXPECT_EQ(fill.softTissueId, 2);

  EXPECT_THROW(fillBody(some, {}, [](double) { return false; }), Aborted);
  EXPECT_EQ(some.labels.back().id, 9);
}

TEST(BodyFill, AgreesWithTheFittedThorax)
{
  // thorax_heart was made from the same subject by other means and has its fat and skin labelled.
  const fs::path data = sharedDataFolder();
  const fs::path sparse = data / "totalseg_s0327/s0327_total_v2_labelmap.nii.gz";
  const fs::path whole = data / "thorax_heart/thorax_heart.nii.gz";
  if (!fs::exists(sparse) || !fs::exists(whole))
  {
    GTEST_SKIP() << "the totalseg_s0327 and thorax_heart data are not there";
  }
  LabelVolume volume = readLabelMap(sparse.string());
  const LabelVolume reference = readLabelMap(whole.string());
  fillBody(volume);
  std::size_t both = 0, filled = 0, truth = 0;
  const Vec3i n = reference.placement.size;
  for (int k = 0; k < n.z; k += 2)
  {
    for (int j = 0; j < n.y; j += 2)
    {
      for (int i = 0; i < n.x; i += 2)
      {
        const Vec3d index = volume.placement.indexFromWorld(reference.placement.worldFromIndex({ i, j, k }));
        const Vec3i at(glm::round(index));
        if (glm::any(glm::lessThan(at, Vec3i(0))) || glm::any(glm::greaterThanEqual(at, volume.placement.size)))
        {
          continue;
        }
        const Vec3i m = volume.placement.size;
        const bool a = volume.voxels[at.x + std::size_t(m.x) * (at.y + std::size_t(m.y) * at.z)] != 0;
        const bool b = reference.voxels[i + std::size_t(n.x) * (j + std::size_t(n.y) * k)] != 0;
        filled += a;
        truth += b;
        both += a && b;
      }
    }
  }
  const double dice = 2.0 * double(both) / double(filled + truth);
  EXPECT_GT(dice, 0.94); // 0.950: the back, cut at the table, and the belly are guesses
}
