#include "ErrorText.h"
#include "LabelFolder.h"
#include "Labels/ReadIntensities.h"
#include "NiftiBytes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;
using sono::testing::NiftiBytes;

namespace {

class Intensities : public sono::testing::LabelFolder
{
protected:
  std::string refused(const std::string& name) const
  {
    return errorOf([&] { readIntensities(file(name)); });
  }
  /// Of a file of whole numbers.
  std::vector<std::int16_t> shortsOf(const char* name)
  {
    const IntensityVolume volume = readIntensities(file(name));
    EXPECT_TRUE(volume.values.empty());
    return { volume.shorts.begin(), volume.shorts.end() };
  }
};

} // namespace

TEST_F(Intensities, OfTheThreeFormatsAreScaledAndPlaced)
{
  NiftiBytes({ 3, 2, 1, 2, 1, 1, 1, 1 }, 4, 2)
    .scale(0.5f, -1000.0f)
    .sform({ 2, 0, 0, 5, 0, 3, 0, 6, 0, 0, 4, 7 })
    .voxels<std::int16_t>({ 0, 2000, -50, 32767 })
    .writeGz(file("a.nii.gz"));
  const IntensityVolume nifti = readIntensities(file("a.nii.gz"));
  EXPECT_EQ(nifti.values, (std::vector<float>{ -1000.0f, 0.0f, -1025.0f, 15383.5f }));
  EXPECT_EQ(nifti.placement.size, Vec3i(2, 1, 2));
  EXPECT_LT(glm::length(nifti.placement.worldFromIndex({ 1.0, 0.0, 1.0 }) - Vec3d(-7.0, -6.0, 11.0)), 1e-9);

  // -1000 and 40 with the high byte first; then as text.
  text("a.nrrd", "NRRD0004\ntype: short\nencoding: raw\nendian: big\ndimension: 3\nsizes: 2 1 1\nspacings: 2 3 4\n\n" +
                   std::string("\xFC\x18\0\x28", 4));
  EXPECT_EQ(shortsOf("a.nrrd"), (std::vector<std::int16_t>{ -1000, 40 }));
  text("t.nrrd", "NRRD0004\ntype: float\nencoding: ascii\ndimension: 3\nsizes: 2 1 1\n\n-3.5 7\n");
  EXPECT_EQ(readIntensities(file("t.nrrd")).values, (std::vector<float>{ -3.5f, 7.0f }));
  text("a.mha",
       "NDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = True\nDimSize = 2 1 1\nElementType = MET_SHORT\n"
       "ElementDataFile = LOCAL\n" +
         std::string("\xFC\x18\0\x28", 4));
  EXPECT_EQ(shortsOf("a.mha"), (std::vector<std::int16_t>{ -1000, 40 }));
}

TEST_F(Intensities, BytesAreSkippedAndMembersFollowEachOther)
{
  // A detached file behind four bytes that do not belong to it.
  text("d.raw", "skip\1\2");
  text("d.nhdr", "NRRD0004\ntype: uchar\nencoding: raw\nbyte skip: 4\ndimension: 3\nsizes: 2 1 1\ndata file: d.raw\n");
  EXPECT_EQ(shortsOf("d.nhdr"), (std::vector<std::int16_t>{ 1, 2 }));
  text("e.nhdr", "NRRD0004\ntype: uchar\nencoding: raw\nbyte skip: -1\ndimension: 3\nsizes: 2 1 1\ndata file: d.raw\n");
  EXPECT_EQ(shortsOf("e.nhdr"), (std::vector<std::int16_t>{ 1, 2 }));
  for (const char* const part : { "sk\1", "\2\3\4" })
  {
    const gzFile gz = gzopen(file("m.gz").c_str(), "ab"); // two members
    gzwrite(gz, part, 3);
    gzclose(gz);
  }
  text("m.nhdr", "NRRD0004\ntype: uchar\nencoding: gzip\nbyte skip: 2\ndimension: 3\nsizes: 4 1 1\ndata file: m.gz\n");
  EXPECT_EQ(shortsOf("m.nhdr"), (std::vector<std::int16_t>{ 1, 2, 3, 4 }));
}

TEST_F(Intensities, WhatIsNoScanIsRefused)
{
  NiftiBytes({ 3, 2, 1, 1, 1, 1, 1, 1 }, 16, 4).voxels<float>({ 1.0f, NAN }).write(file("nan.nii"));
  expectContains(refused("nan.nii"), "not finite");
  NiftiBytes({ 3, 2, 1, 1, 1, 1, 1, 1 }, 128, 3).voxels<std::uint8_t>({ 1, 2, 3, 4, 5, 6 }).write(file("rgb.nii"));
  expectContains(refused("rgb.nii"), "colour image");
  NiftiBytes({ 4, 1, 1, 1, 2, 1, 1, 1 }, 2, 1).voxels<std::uint8_t>({ 1, 2 }).write(file("beat.nii"));
  expectContains(refused("beat.nii"), "holds 2 volumes");
  text("rgb.nrrd", "NRRD0004\ntype: uchar\nencoding: raw\ndimension: 4\nsizes: 3 1 1 1\nspace: LPS\n"
                   "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: RGB-color domain domain domain\n\nabc");
  expectContains(refused("rgb.nrrd"), "colour image");
  expectContains(refusal("rgb.nrrd"), "colour image");
  text("picture.nrrd", "\x89PNG\r\n");
  expectContains(refused("picture.nrrd"), "does not begin with NRRD");
  expectContains(refused("none.nii"), "no such file");
}

TEST_F(Intensities, APromiseThatNoFileKeepsTakesNoMemory)
{
  const std::string axes = "dimension: 3\nsizes: 60000 60000 1\n"; // 14 GB of floats
  for (const std::string encoding : { "raw", "gzip", "ascii", "hex" })
  {
    text("p.nrrd", "NRRD0004\ntype: float\nendian: little\nencoding: " + encoding + "\n" + axes + "\n1 2 3\n");
    expectContains(refused("p.nrrd"), "end too early");
  }
  text("p.nrrd",
       "NRRD0004\ntype: float\nencoding: raw\ndimension: 3\nsizes: 4294967296 4294967296 4294967296\n\n1 2\n");
  expectContains(refused("p.nrrd"), "p.nrrd");
  text("p.mha",
       "NDims = 3\nBinaryData = True\nCompressedData = True\nDimSize = 60000 60000 1\nElementType = MET_FLOAT\n"
       "ElementDataFile = LOCAL\nabc");
  expectContains(refused("p.mha"), "end too early");
  NiftiBytes({ 3, 30000, 30000, 4, 1, 1, 1, 1 }, 16, 4).voxels<float>({ 1.0f }).writeGz(file("p.nii.gz"));
  expectContains(refused("p.nii.gz"), "end too early");
}

TEST_F(Intensities, ReadingReportsProgressAndStops)
{
  std::vector<std::int16_t> values(300000);
  for (std::size_t n = 0; n < values.size(); ++n)
  {
    values[n] = std::int16_t((n * 2654435761u) >> 13);
  }
  NiftiBytes({ 3, 300, 100, 10, 1, 1, 1, 1 }, 4, 2).voxels(values).writeGz(file("p.nii.gz"));
  std::vector<double> reported;
  readIntensities(file("p.nii.gz"), [&](double fraction) {
    reported.push_back(fraction);
    return true;
  });
  ASSERT_GT(reported.size(), 5u);
  EXPECT_LT(reported.front(), 1.0);
  EXPECT_GT(reported.back(), 0.99);
  EXPECT_TRUE(std::is_sorted(reported.begin(), reported.end()));
  int calls = 0;
  EXPECT_THROW(readIntensities(file("p.nii.gz"), [&](double) { return ++calls < 3; }), Aborted);
  EXPECT_EQ(calls, 3);
}
