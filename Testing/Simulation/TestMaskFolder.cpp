#include "ErrorText.h"
#include "LabelFolder.h"
#include "Labels/ReadMaskFolder.h"
#include "NiftiBytes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace fs = std::filesystem;
using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;
using sono::testing::NiftiBytes;

namespace {

class MaskFolder : public sono::testing::LabelFolder
{
protected:
  std::string folder() const { return fs::path(file("x")).parent_path().string(); }
  /// Six voxels in a row; 1 where `text` has an x.
  void mask(const std::string& name, const std::string& text)
  {
    std::vector<std::uint8_t> voxels;
    for (const char c : text)
    {
      voxels.push_back(c == 'x' ? 1 : 0);
    }
    const NiftiBytes bytes = NiftiBytes({ 3, std::int16_t(text.size()), 1, 1, 1, 1, 1, 1 }, 2, 1).voxels(voxels);
    name.back() == 'z' ? bytes.writeGz(file(name)) : bytes.write(file(name));
  }
  std::string refused() const
  {
    return errorOf([&] { readLabelMap(folder()); });
  }
};

} // namespace

TEST_F(MaskFolder, NamesAndNumbersComeFromTheFilesNames)
{
  mask("spleen.nii.gz", "....xx");
  mask("aorta.nii.gz", "x.....");
  mask("gallbladder.nii", "......");
  text("liver.nrrd",
       "NRRD0004\ntype: float\nendian: little\nencoding: ascii\ndimension: 3\nsizes: 6 1 1\n\n0 0 255 255 0 0\n");
  text("statistics.json", "{}");
  text(".hidden.nii", "no NIfTI");
  const LabelVolume volume = readLabelMap(folder());
  EXPECT_EQ(volume.voxels, (std::vector<std::uint16_t>{ 1, 0, 3, 3, 4, 4 }));
  ASSERT_EQ(volume.labels.size(), 4u);
  EXPECT_EQ(volume.labels[1].name, "aorta");
  EXPECT_EQ(volume.labels[2].name, "liver");
  EXPECT_EQ(volume.labels[2].id, 3); // the empty gallbladder keeps 2
  EXPECT_EQ(volume.labels[3].name, "spleen");
  EXPECT_EQ(volume.notice, "");
  EXPECT_EQ(readLabelPlacement(folder()).size, Vec3i(6, 1, 1));
  EXPECT_TRUE(mayBeMasks(file("spleen.nii.gz")));
  EXPECT_TRUE(mayBeMasks(folder()));
  EXPECT_FALSE(mayBeMasks(file("statistics.json")));
  EXPECT_EQ(maskFolderOf(file("spleen.nii.gz")), folder());
}

TEST_F(MaskFolder, TheSmallerOfTwoThatOverlapWins)
{
  mask("a_vessel.nii", ".x....");
  mask("liver.nii", "xxxx..");
  mask("organ.nii", "..xxxx");
  mask("z_lesion.nii", "...x..");
  const LabelVolume volume = readLabelMap(folder());
  // Of the liver and the organ, equally large, the later one.
  EXPECT_EQ(volume.voxels, (std::vector<std::uint16_t>{ 2, 1, 3, 4, 3, 3 }));
  expectContains(volume.notice, "overlap in 4 voxels");
  expectContains(volume.notice, "'liver' and 'organ'");
}

TEST_F(MaskFolder, WhatDoesNotBelongTogetherIsRefused)
{
  expectContains(refused(), "holds no masks");
  EXPECT_FALSE(mayBeMasks(folder()));
  fs::create_directory(file("segmentations"));
  mask("segmentations/a.nii", "x");
  expectContains(refused(), "choose its folder 'segmentations'");
  EXPECT_FALSE(mayBeMasks(file("segmentations/a.nii"))); // alone

  mask("a.nii", "xx....");
  mask("b.nii", "xx...");
  expectContains(refused(), "a.nii' and '");
  expectContains(refused(), "b.nii' are not of one patient's grid: they have (6, 1, 1) and (5, 1, 1) voxels");
  NiftiBytes({ 3, 6, 1, 1, 1, 1, 1, 1 }, 2, 1)
    .sform({ -1, 0, 0, 7, 0, -1, 0, 0, 0, 0, 1, 0 })
    .voxels(std::vector<std::uint8_t>(6, 1))
    .write(file("b.nii"));
  expectContains(refused(), "begin at (0, 0, 0) and (-7, ");
  NiftiBytes({ 3, 6, 1, 1, 1, 1, 1, 1 }, 2, 1)
    .spacing(1.5f, 1, 1)
    .voxels(std::vector<std::uint8_t>(6, 1))
    .write(file("b.nii"));
  expectContains(refused(), "voxels of (1, 1, 1) and (1.5, 1, 1) mm");
  NiftiBytes({ 3, 6, 1, 1, 1, 1, 1, 1 }, 4, 2).voxels<std::int16_t>({ 0, 0, 40, 40, -7, 0 }).write(file("b.nii"));
  expectContains(refused(), "b.nii' is no mask: it holds 40 and -7");
  EXPECT_FALSE(mayBeMasks(file("b.nii")));
  NiftiBytes({ 3, 6, 1, 1, 1, 1, 1, 1 }, 16, 4).voxels<float>({ 0, 0, NAN, 0, 0, 0 }).write(file("b.nii"));
  expectContains(refused(), "b.nii' is no mask");
  text("b.nii", "no header");
  expectContains(refused(), "b.nii': it is not a NIfTI file");
}

TEST_F(MaskFolder, LongMasksAreReadInParts)
{
  // Longer than what is read and compared at once, with structures across the parts' ends.
  const std::int16_t size = 300;
  std::vector<std::uint8_t> voxels(std::size_t(size) * size * 2);
  for (std::size_t n = 0; n < voxels.size(); ++n)
  {
    voxels[n] = n % 65536 < 3 || n % 65536 > 65530 || n * 2654435761u % 1009 == 0 ? 1 : 0;
  }
  NiftiBytes({ 3, size, size, 2, 1, 1, 1, 1 }, 2, 1).voxels(voxels).writeGz(file("long.nii.gz"));
  const LabelVolume volume = readLabelMap(folder());
  EXPECT_TRUE(std::equal(voxels.begin(), voxels.end(), volume.voxels.begin(), volume.voxels.end()));
  int calls = 0;
  EXPECT_THROW(readLabelMap(folder(), 0, [&](double) { return ++calls < 2; }), Aborted);
}
