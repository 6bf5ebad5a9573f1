#include "DicomBytes.h"
#include "ErrorText.h"
#include "Folders.h"
#include "LabelFolder.h"
#include "Labels/MatchedScan.h"
#include "Labels/ReadIntensities.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <random>

namespace fs = std::filesystem;
using namespace sono;
using sono::testing::DicomBytes;
using sono::testing::errorOf;
using sono::testing::expectContains;
using sono::testing::SegFrame;

namespace {

class DicomFiles : public sono::testing::LabelFolder
{
protected:
  std::string refusedScan(const std::string& name) const
  {
    return errorOf([&] { readIntensities(name.empty() ? fs::path(file("x")).parent_path().string() : file(name)); });
  }
  void slice(const std::string& name, const std::string& position, std::uint16_t word,
             const std::string& series = "1.2.3")
  {
    DicomBytes("CT", 2, 1)
      .bits(16, 12, false)
      .put(DCM_SeriesInstanceUID, series)
      .put(DCM_RescaleSlope, "2")
      .put(DCM_RescaleIntercept, "-1024")
      .slice(position, { word, std::uint16_t(0xF000 | word) }) // an overlay above the twelve bits
      .write(file(name));
  }
};

/// Two segments of 5 x 3 pixels, so that frames begin within a byte: 1 covers all of slices 0 and 2, 2 two pixels of 2.
std::vector<SegFrame> twoSegments(std::uint8_t one)
{
  std::vector<std::uint8_t> all(15, one);
  std::vector<std::uint8_t> two(15, 0);
  two[7] = two[11] = one;
  return { { 1, "10\\20\\38", all }, { 2, "10\\20\\38", two }, { 1, "10\\20\\30", all } };
}

} // namespace

TEST_F(DicomFiles, SegmentsHaveNamesCodesColoursAndAPlace)
{
  DicomBytes("SEG", 5, 3)
    .segment(1, "Leber \xFC", "10200004", { 65535, 32896, 32896 }) // L = 100, a = b = 0: white
    .segment(2, "Vene", "32764006")
    .frames("BINARY", twoSegments(1))
    .write(file("s.dcm"));
  const LabelVolume volume = readLabelMap(file("s.dcm"));
  // i (2 mm) along +y, j (3 mm) along -x, k along their cross product, +z.
  EXPECT_EQ(volume.placement.size, Vec3i(5, 3, 3));
  EXPECT_LT(glm::length(volume.placement.worldFromIndex({ 1.0, 1.0, 1.0 }) - Vec3d(7.0, 22.0, 34.0)), 1e-9);
  EXPECT_EQ(readLabelPlacement(file("s.dcm")).size, Vec3i(5, 3, 3));
  for (std::size_t n = 0; n < 45; ++n)
  {
    const bool isVein = n == 30 + 7 || n == 30 + 11; // the smaller one counts
    EXPECT_EQ(volume.voxels[n], n / 15 == 1 ? 0 : isVein ? 2 : 1) << n;
  }
  expectContains(volume.notice, "overlap in 2 voxels");
  ASSERT_EQ(volume.labels.size(), 3u);
  EXPECT_EQ(volume.labels[1].name, "Leber \xC3\xBC"); // in UTF-8
  EXPECT_EQ(volume.labels[1].code, "SCT 10200004");
  EXPECT_TRUE(volume.labels[1].hasColor);
  for (const float channel : volume.labels[1].color)
  {
    EXPECT_NEAR(channel, 1.0f, 0.005f);
  }
  EXPECT_FALSE(volume.labels[2].hasColor);
}

TEST_F(DicomFiles, RunsOfEveryLengthAndPlaceInTheirBytesAreThere)
{
  // 19 x 13 pixels, so that each frame begins elsewhere in a byte; runs of 1 to 40 pixels.
  std::mt19937 random(7);
  std::vector<SegFrame> frames;
  std::vector<std::uint16_t> expected;
  for (int k = 0; k < 16; ++k)
  {
    std::vector<std::uint8_t> pixels;
    for (std::uint8_t value = std::uint8_t(k % 2); pixels.size() < 247; value = std::uint8_t(1 - value))
    {
      pixels.insert(pixels.end(), 1 + random() % 40, value);
    }
    pixels.resize(247);
    expected.insert(expected.end(), pixels.begin(), pixels.end());
    frames.push_back({ 1, "10\\20\\" + std::to_string(4 * k), pixels });
  }
  DicomBytes("SEG", 19, 13).segment(1, "a", "1").frames("BINARY", frames).write(file("r.dcm"));
  EXPECT_EQ(readLabelMap(file("r.dcm")).voxels, expected);
}

TEST_F(DicomFiles, FractionsCountFromOneHalfAndMayBeCompressed)
{
  std::vector<SegFrame> frames = twoSegments(100); // of 200
  frames[0].pixels[0] = 99;
  for (const E_TransferSyntax syntax : { EXS_LittleEndianExplicit, EXS_LittleEndianImplicit, EXS_RLELossless })
  {
    DicomBytes("SEG", 5, 3)
      .segment(1, "a", "1")
      .segment(2, "b", "2")
      .frames("FRACTIONAL", frames)
      .write(file("f.dcm"), syntax);
    const LabelVolume volume = readLabelMap(file("f.dcm"));
    EXPECT_EQ(volume.voxels[30], 0);
    EXPECT_EQ(volume.voxels[31], 1);
    EXPECT_EQ(volume.voxels[37], 2);
  }
  DicomBytes("SEG", 5, 3)
    .segment(1, "a", "1")
    .segment(2, "b", "2")
    .frames("LABELMAP", { { 0, "0\\0\\0", { 0, 1, 2, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2 } } })
    .write(file("l.dcm"));
  EXPECT_EQ(readLabelMap(file("l.dcm")).voxels,
            (std::vector<std::uint16_t>{ 0, 1, 2, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2 }));
}

TEST_F(DicomFiles, SegmentationsThatAreNoneAreRefused)
{
  const auto seg = [&](const std::vector<SegFrame>& frames) {
    return DicomBytes("SEG", 5, 3).segment(1, "a", "1").segment(2, "b", "2").frames("BINARY", frames);
  };
  auto frames = twoSegments(1);
  frames[0].segment = 3;
  seg(frames).write(file("x.dcm"));
  expectContains(refusal("x.dcm"), "segment 3, which it does not list");
  frames = twoSegments(1);
  frames[1].position = "10\\20\\39.5";
  seg(frames).write(file("x.dcm"));
  expectContains(refusal("x.dcm"), "slices are missing");
  frames[1].position = "11\\20\\34";
  seg(frames).write(file("x.dcm"));
  expectContains(refusal("x.dcm"), "shifted");
  seg(twoSegments(1)).put(DCM_NumberOfFrames, "4").write(file("x.dcm"));
  expectContains(refusal("x.dcm"), "describes 3 of its frames only");
  seg(twoSegments(1)).number(DCM_Rows, 3000).write(file("x.dcm"));
  expectContains(refusal("x.dcm"), "end too early");
  DicomBytes("SEG", 5, 3).frames("BINARY", twoSegments(1)).write(file("x.dcm"));
  expectContains(refusal("x.dcm"), "no segments");
  slice("ct.dcm", "0\\0\\0", 1);
  expectContains(refusal("ct.dcm"), "modality 'CT', no segmentation");
  fs::resize_file(file("ct.dcm"), 300);
  expectContains(refusal("ct.dcm"), "ct.dcm");
}

TEST_F(DicomFiles, ASeriesIsSortedByItsPositions)
{
  slice("c", "10\\20\\38", 3);
  slice("a", "10\\20\\34", 2);
  slice("b.dcm", "10\\20\\30", 1);
  slice("other.dcm", "10\\20\\30", 9, "1.2.4");
  text("notes.txt", "no DICOM");
  const IntensityVolume volume = readIntensities(file("a"));
  EXPECT_EQ(volume.placement.size, Vec3i(2, 1, 3));
  EXPECT_LT(glm::length(volume.placement.worldFromIndex({ 1.0, 0.0, 2.0 }) - Vec3d(12.0, 20.0, 38.0)), 1e-9);
  EXPECT_EQ(volume.values, (std::vector<float>{ -1022.0f, -1022.0f, -1020.0f, -1020.0f, -1018.0f, -1018.0f }));
  EXPECT_EQ(volume.modality, "CT");

  expectContains(refusedScan(""), "holds 2 series");
  fs::remove(file("other.dcm"));
  EXPECT_EQ(readIntensities(fs::path(file("x")).parent_path().string()).values, volume.values);

  DicomBytes("MR", 2, 1).bits(16, 16, true).slice("10\\20\\42", { 0xFFFF, 5 }).write(file("d"), EXS_RLELossless);
  EXPECT_EQ(readIntensities(file("a")).values[6], -1.0f);
  EXPECT_EQ(readIntensities(file("a")).values[7], 5.0f);
}

TEST_F(DicomFiles, AnIncompleteSeriesIsRefused)
{
  expectContains(refusedScan(""), "no DICOM images");
  for (int n = 0; n < 6; ++n)
  {
    slice("s" + std::to_string(n), "0\\0\\" + std::to_string(4 * n), 1);
  }
  EXPECT_EQ(readIntensities(file("s0")).placement.size.z, 6);
  fs::remove(file("s3"));
  expectContains(refusedScan("s0"),
                 "slices are missing: two neighbours lie 8.00 mm apart where others lie 4.00 mm apart");
  slice("s3", "0\\0\\8", 1);
  fs::remove(file("s5"));
  fs::remove(file("s4"));
  expectContains(refusedScan("s0"), "at one place");
  slice("s3", "5\\0\\12", 1);
  expectContains(refusedScan("s0"), "shifted");
  DicomBytes("CT", 2, 2).bits(16, 16, true).slice("0\\0\\12", { 1, 2, 3, 4 }).write(file("s3"));
  expectContains(refusedScan("s0"), "another size");
  DicomBytes("CT", 2, 1)
    .bits(16, 16, true)
    .slice("0\\0\\12", { 1, 2 })
    .number(DCM_SamplesPerPixel, 3)
    .write(file("s3"));
  expectContains(refusedScan("s0"), "colour image");
  DicomBytes("CT", 2, 1).bits(16, 16, true).slice("0\\0\\12", { 1 }).write(file("s3"));
  expectContains(refusedScan("s0"), "end too early");
}

TEST_F(DicomFiles, AnotherFrameOfReferenceIsRefused)
{
  const auto write = [&](const std::string& ofLabels, const std::string& ofScan) {
    DicomBytes("SEG", 5, 3)
      .segment(1, "liver", "10200004")
      .segment(2, "vein", "32764006")
      .put(DCM_FrameOfReferenceUID, ofLabels)
      .frames("BINARY", twoSegments(1))
      .write(file("seg.dcm"));
    for (int n = 0; n < 4; ++n) // around the segments, which i and j of another grid have along y and -x
    {
      DicomBytes("CT", 10, 10)
        .bits(16, 16, true)
        .put(DCM_FrameOfReferenceUID, ofScan)
        .slice("0\\10\\" + std::to_string(28 + 4 * n), std::vector<std::uint16_t>(100, 60))
        .write(file("ct" + std::to_string(n)));
    }
  };
  const auto match = [&] { matchScan(readLabelMap(file("seg.dcm")), readIntensities(file("ct0"))); };
  write("1.2.9.1", "1.2.9.1");
  EXPECT_EQ(readLabelMap(file("seg.dcm")).placement.frameOfReference, "1.2.9.1");
  EXPECT_EQ(readIntensities(file("ct0")).placement.frameOfReference, "1.2.9.1");
  EXPECT_EQ(errorOf(match), "no error");
  write("1.2.9.1", "1.2.9.2");
  const std::string sentence = errorOf(match);
  expectContains(sentence, "another DICOM frame of reference (1.2.9.2) than the label map (1.2.9.1)");
  expectContains(sentence, "connect the scan that was segmented");
  write("1.2.9.1", ""); // an anonymised scan may have lost it
  EXPECT_EQ(errorOf(match), "no error");
}

TEST_F(DicomFiles, AnOrientationThatIsNotAtRightAnglesIsRefused)
{
  for (int n = 0; n < 2; ++n)
  {
    DicomBytes("CT", 2, 1)
      .bits(16, 16, true)
      .slice("0\\0\\" + std::to_string(n), { 1, 2 })
      .put(DCM_ImageOrientationPatient, "1\\0\\0\\0.3\\0.95\\0")
      .write(file("s" + std::to_string(n)));
  }
  expectContains(refusedScan("s0"), "right angles");
}

TEST(DicomData, LiverIsWhatItsNrrdSays)
{
  const fs::path folder = fs::path(sharedDataFolder()) / "dcmqi";
  if (!fs::exists(folder / "liver.dcm"))
  {
    GTEST_SKIP() << "the dcmqi data are not there";
  }
  const LabelVolume dicom = readLabelMap((folder / "liver.dcm").string());
  const LabelVolume nrrd = readLabelMap((folder / "liver_seg.nrrd").string());
  const auto centres = [](const LabelVolume& volume) {
    std::map<std::array<int, 3>, int> set; // world positions in 0.1 mm
    for (std::size_t n = 0; n < volume.voxels.size(); ++n)
    {
      if (volume.voxels[n] != 0)
      {
        const std::size_t sizeX = std::size_t(volume.placement.size.x);
        const std::size_t sizeXy = sizeX * std::size_t(volume.placement.size.y);
        const Vec3d world =
          volume.placement.worldFromIndex({ double(n % sizeX), double(n % sizeXy / sizeX), double(n / sizeXy) });
        set[{ int(std::lround(10.0 * world.x)), int(std::lround(10.0 * world.y)), int(std::lround(10.0 * world.z)) }] =
          1;
      }
    }
    return set;
  };
  const auto a = centres(dicom);
  EXPECT_GT(a.size(), 1000u);
  EXPECT_EQ(a, centres(nrrd));
  ASSERT_EQ(dicom.labels.size(), 2u);
  EXPECT_NE(dicom.labels[1].code, "");
}

TEST(DicomData, OverlapsAreFlattened)
{
  const fs::path path = fs::path(sharedDataFolder()) / "dcmqi/partial_overlaps.dcm";
  if (!fs::exists(path))
  {
    GTEST_SKIP() << "the dcmqi data are not there";
  }
  const LabelVolume volume = readLabelMap(path.string());
  EXPECT_GT(volume.labels.size(), 2u);
  expectContains(volume.notice, "overlap in");
}
