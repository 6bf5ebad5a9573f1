#include "ErrorText.h"
#include "Folders.h"
#include "LabelFolder.h"
#include "Labels/AssignTissues.h"
#include "Labels/LabelTable.h"
#include "Labels/ReadLabelMap.h"
#include "Labels/ReadNifti.h"
#include "NiftiBytes.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace fs = std::filesystem;
using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;
using sono::testing::NiftiBytes;

namespace {

void expectNear(const Vec3d& a, const Vec3d& b, double tolerance)
{
  EXPECT_LE(glm::length(a - b), tolerance)
    << "(" << a.x << ", " << a.y << ", " << a.z << ") for (" << b.x << ", " << b.y << ", " << b.z << ")";
}

class LabelFormats : public sono::testing::LabelFolder
{
};

std::string metaText(const std::string& fields, const std::string& data, const std::string& size = "2 1 1",
                     const std::string& type = "MET_UCHAR")
{
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\n" + fields + "DimSize = " + size +
         "\nElementType = " + type + "\nElementDataFile = LOCAL\n" + data;
}

std::string deflated(const std::string& data)
{
  uLongf size = compressBound(uLong(data.size()));
  std::string out(size, '\0');
  compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(data.data()),
           uLong(data.size()));
  out.resize(size);
  return out;
}

/// One grid in the three formats: i runs along (0.6, 0.8, 0), j along (0.8, -0.6, 0), k along (0, 0, 1) in LPS, which
/// is oblique and left-handed; voxels of 2 x 3 x 4 mm; the first at (10, 20, 30). So (1, 2, 3) lies at (10 + 2 0.6 + 6
/// 0.8, 20 + 2 0.8 - 6 0.6, 30 + 12) = (16, 18, 42).
struct Formats
{
  std::string nifti, nrrd, meta;
};

} // namespace

TEST_F(LabelFormats, ObliqueAndLeftHandedIsTheSamePlaceInEveryFormat)
{
  std::string data;
  for (int n = 0; n < 24; ++n)
  {
    data += char(n);
  }
  Formats formats;
  formats.nifti = file("a.nii");
  NiftiBytes({ 3, 2, 3, 4, 1, 1, 1, 1 }, 2, 1)
    .sform({ -1.2f, -2.4f, 0, -10, -1.6f, 1.8f, 0, -20, 0, 0, 4, 30 })
    .voxels(std::vector<std::uint8_t>(data.begin(), data.end()))
    .write(formats.nifti);
  formats.nrrd = text("a.nrrd", "NRRD0004\ntype: unsigned char\nencoding: raw\ndimension: 3\nsizes: 2 3 4\n"
                                "space: left-posterior-superior\nspace directions: (1.2,1.6,0) (2.4,-1.8,0) (0,0,4)\n"
                                "space origin: (10,20,30)\n\n" +
                                  data);
  formats.meta = text("a.mha", metaText("TransformMatrix = 0.6 0.8 0 0.8 -0.6 0 0 0 1\nOffset = 10 20 30\n"
                                        "AnatomicalOrientation = RAI\nElementSpacing = 2 3 4\n",
                                        data, "2 3 4"));
  for (const std::string& path : { formats.nifti, formats.nrrd, formats.meta })
  {
    const LabelVolume volume = readLabelMap(path);
    EXPECT_LT(glm::determinant(volume.placement.direction), 0.0) << path;
    expectNear(volume.placement.worldFromIndex({ 0.0, 0.0, 0.0 }), { 10.0, 20.0, 30.0 }, 1e-5);
    expectNear(volume.placement.worldFromIndex({ 1.0, 2.0, 3.0 }), { 16.0, 18.0, 42.0 }, 1e-5);
    EXPECT_EQ(volume.placement.size, Vec3i(2, 3, 4)) << path;
    EXPECT_EQ(volume.voxels[1 + 2 * (2 + 3 * 3)], 23) << path; // (1, 2, 3), i fastest
    EXPECT_EQ(volume.labels.size(), 24u) << path;
  }
}

TEST_F(LabelFormats, MetaImageNumbersAndCompression)
{
  EXPECT_EQ(readLabelMap(text("u.mha", metaText("", std::string("\1\2", 2)))).voxels,
            (std::vector<std::uint16_t>{ 1, 2 }));
  // 300 and 65535 with the high byte first.
  EXPECT_EQ(readLabelMap(text("m.mha", metaText("BinaryDataByteOrderMSB = True\n", std::string("\1\x2C\xFF\xFF", 4),
                                                "2 1 1", "MET_USHORT")))
              .voxels,
            (std::vector<std::uint16_t>{ 300, 65535 }));
  std::string floats(8, '\0');
  const float numbers[2] = { 7.0f, 60000.0f };
  std::memcpy(floats.data(), numbers, 8);
  EXPECT_EQ(readLabelMap(text("f.mha", metaText("", floats, "2 1 1", "MET_FLOAT"))).voxels[1], 60000);
  const std::string long1(1000, '\5');
  EXPECT_EQ(readLabelMap(
              text("z.mha", metaText("CompressedData = True\nCompressedDataSize = 17\n", deflated(long1), "10 10 10")))
              .voxels,
            std::vector<std::uint16_t>(1000, 5));

  text("d.raw", "xx\3\4");
  const std::string head = "NDims = 3\nBinaryData = True\nDimSize = 2 1 1\nElementType = MET_UCHAR\n";
  EXPECT_EQ(readLabelMap(text("d.mhd", head + "HeaderSize = -1\nElementDataFile = d.raw\n")).voxels[1], 4);
  EXPECT_EQ(readLabelMap(text("e.mhd", head + "HeaderSize = 1\nElementDataFile = d.raw\n")).voxels[1], 3);
}

TEST_F(LabelFormats, MetaImagesThatAreNoLabelMapsAreRefused)
{
  const std::string data("\1\2", 2);
  const auto refused = [&](const std::string& content) {
    text("x.mha", content);
    return refusal("x.mha");
  };
  expectContains(refused("no header here"), "no MetaImage file");
  expectContains(refused(metaText("", "\1")), "end too early");
  expectContains(
    refused(metaText("CompressedData = True\n", deflated(std::string(1000, '\5')).substr(0, 9), "10 10 10")),
    "end too early");
  expectContains(refused(metaText("CompressedData = True\n", "no zlib data", "10 10 10")), "end too early");
  expectContains(refused(metaText("ElementNumberOfChannels = 3\n", data)), "3 channels");
  expectContains(refused(metaText("", data, "2 1 1", "MET_STRING")), "MET_STRING");
  expectContains(refused(metaText("", data, "2 1")), "DimSize");
  expectContains(refused(metaText("", data, "2 x 1")), "'x'");
  expectContains(refused(metaText("", data, "0 1 1")), "no voxels");
  expectContains(refused(metaText("", data, "-2 1 1")), "claims");
  expectContains(refused(metaText("", data, "60000 60000 60000")), "more than a label map");
  expectContains(refused(metaText("TransformMatrix = 1 0 0 0.2 1 0 0 0 1\n", data)), "resample");
  expectContains(refused(metaText("ElementSpacing = 0 1 1\n", data)), "spacing");
  expectContains(refused(metaText("", "\377\377", "2 1 1", "MET_CHAR")), "holds -1 at voxel (0,0,0)");
  expectContains(refused("NDims = 2\nDimSize = 2 1\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" + data),
                 "it has 2 axes");
  expectContains(refused("NDims = 3\nBinaryData = False\nDimSize = 2 1 1\nElementType = MET_UCHAR\n"
                         "ElementDataFile = LOCAL\n1 2"),
                 "text");
  expectContains(refused("NDims = 3\nBinaryData = True\nDimSize = 2 1 1\nElementType = MET_UCHAR\n"
                         "ElementDataFile = none.raw\n"),
                 "none.raw");
  expectContains(refused("NDims = 3\nBinaryData = True\nDimSize = 2 1 1\nElementType = MET_UCHAR\n"
                         "ElementDataFile = s%03d.raw 1 2 1\n"),
                 "several files");
}

TEST_F(LabelFormats, TablesOfOtherPrograms)
{
  const auto named = [&](const std::string& table, const std::string& content) {
    text("x.mha", metaText("", std::string("\0\1\2", 3), "3 1 1"));
    const std::string path = text(table, content);
    const LabelVolume volume = readLabelMap(file("x.mha"));
    fs::remove(path);
    return volume.labels;
  };
  const auto snap =
    named("x.label", "################\n# ITK-SnAP Label Description File\n# IDX -R- -G- -B- -A-- VIS MSH\n"
                     "    0     0    0    0        0  0  0    \"Clear Label\"\n"
                     "    1   255    0   51        1  1  0    \"Left \tlung (upper)\"\n"
                     "    2     0  255    0        1  1  1    \"bone\"\r\n");
  EXPECT_EQ(snap[0].name, "background");
  EXPECT_EQ(snap[1].name, "Left \tlung (upper)");
  EXPECT_FLOAT_EQ(snap[1].color[2], 0.2f);
  EXPECT_EQ(snap[2].name, "bone");

  const auto columns = named("x.csv", "label,name\n1,liver\n2,spleen\n");
  EXPECT_EQ(columns[1].name, "liver");
  EXPECT_EQ(columns[2].name, "spleen");
  EXPECT_EQ(named("x.csv", "label,name\nliver,Smith\n")[1].name, "label_1"); // a table of something else

  const auto slicer = named("x.ctbl", "# Color table file x.ctbl\n# 3 values\n0 Background 0 0 0 0\n"
                                      "1 left_lung 255 0 51 255\n2 costal cartilage 7 0 255 0 255\n");
  EXPECT_EQ(slicer[0].name, "Background");
  EXPECT_EQ(slicer[1].name, "left_lung");
  EXPECT_TRUE(slicer[1].hasColor);
  EXPECT_EQ(slicer[2].name, "costal cartilage 7");
  EXPECT_FLOAT_EQ(slicer[2].color[1], 1.0f);

  const auto slicerCsv = named("x.csv", "LabelValue,Name,Color_R,Color_G,Color_B,Color_A\n1,heart,255,0,51,255\n");
  EXPECT_EQ(slicerCsv[1].name, "heart");
  EXPECT_FLOAT_EQ(slicerCsv[1].color[2], 0.2f);

  const auto plain =
    named("x.txt", "missing [] overlap voxels 4486\n0 background 100\n1 spleen 57773\n2 kidney_left\n");
  EXPECT_EQ(plain[1].name, "spleen");
  EXPECT_EQ(plain[2].name, "kidney_left");
  EXPECT_FALSE(plain[1].hasColor);

  EXPECT_EQ(named("x.txt", "A note on this scan, made in 1999.\n")[1].name, "label_1");
  EXPECT_EQ(named("labels.txt", "1 one\n")[1].name, "one");
  EXPECT_EQ(named("other_labels.txt", "1 one\n")[1].name, "label_1");

  expectContains(errorOf([&] { readLabels(text("b.label", "1 255 0 0 1 1 1 \"a\"\n2 900 0 0 1 1 1 \"b\"\n")); }),
                 "b.label' line 2");
  expectContains(errorOf([&] { readLabels(text("c.txt", "1 one\n70000 two\n")); }), "c.txt' line 2");
  expectContains(errorOf([&] { readLabels(text("d.txt", "1 one\n2\n")); }), "d.txt' line 2");
  expectContains(errorOf([&] { readLabels(text("e.txt", "nothing\n")); }), "names no label");
  expectContains(errorOf([&] { readLabels(file("none.txt")); }), "no such file");
}

TEST_F(LabelFormats, ATableOfASeriesNamesAllItsFiles)
{
  const auto write = [&](const std::string& name) { return text(name, metaText("", std::string("\0\1", 2))); };
  text("s1_labels.txt", "1 from_s1\n");
  text("s1_ct_labels.csv", "id,name\n1,from_s1_ct\n");
  EXPECT_EQ(readLabelMap(write("s1_total_v2.mha")).labels[1].name, "from_s1");
  EXPECT_EQ(readLabelMap(write("s1_ct_total.mha")).labels[1].name, "from_s1_ct");
  EXPECT_EQ(readLabelMap(write("s10_total.mha")).labels[1].name, "label_1");
}

TEST_F(LabelFormats, BidsNamesItsLabelsInATable)
{
  const std::string table = "index\tname\tcolor\tabbreviation\tmapping\r\n1\tGray Matter\t#ff0080\tGM\t1\r\n"
                            "2\t\"quoted, name\tn/a\t\t8\n";
  const std::vector<LabelInfo> labels = readLabels(text("dseg.tsv", table));
  ASSERT_EQ(labels.size(), 2u);
  EXPECT_EQ(labels[0].name, "Gray Matter");
  EXPECT_TRUE(labels[0].hasColor);
  EXPECT_FLOAT_EQ(labels[0].color[2], 128.0f / 255.0f);
  EXPECT_EQ(labels[1].name, "\"quoted, name");
  EXPECT_FALSE(labels[1].hasColor);
  expectContains(errorOf([&] { readLabels(text("bad.tsv", "index\tname\nx\ty\n")); }), "bad.tsv' line 2");

  // For all label maps below that have the parts of its name.
  EXPECT_EQ(labelTableBeside(file("sub-1_dseg")), file("dseg.tsv"));
  fs::create_directories(fs::path(file("derivatives/sub-1/anat")));
  text("derivatives/dataset_description.json", "{}");
  text("derivatives/desc-aseg_dseg.tsv", table);
  EXPECT_EQ(labelTableBeside(file("derivatives/sub-1/anat/sub-1_desc-aseg_dseg")),
            file("derivatives/desc-aseg_dseg.tsv"));
  EXPECT_EQ(labelTableBeside(file("derivatives/sub-1/anat/sub-1_desc-other_dseg")), "");
}

TEST_F(LabelFormats, SlicersColourTablesHaveOtherNames)
{
  const std::string table =
    "# Color table file /home/me/knee.ctbl\n# 3 values\n0 background 0 0 0 0\n1 255 255 255 255\n"
    "2 (none) 0 0 0 0\n3 vastus_lateralis_muscle 10 20 30 255\n";
  const std::string knee = text("knee.ctbl", table);
  const std::vector<LabelInfo> labels = readLabels(knee);
  ASSERT_EQ(labels.size(), 2u);
  EXPECT_EQ(labels[1].id, 3);
  EXPECT_EQ(labels[1].name, "vastus_lateralis_muscle");
  EXPECT_EQ(labelTableBeside(file("seg")), knee) << "the only one";
  text("knee.nrrd", "");
  EXPECT_EQ(labelTableBeside(file("seg")), "") << "another file's";
  EXPECT_EQ(labelTableBeside(file("knee")), knee);
  const std::string lut = text("seg-lut.ctbl", table);
  EXPECT_EQ(labelTableBeside(file("seg")), lut);
  EXPECT_EQ(labelTableBeside(file("segment")), "");
  const std::string exported = text("Segmentation-label_ColorTable.ctbl", table);
  EXPECT_EQ(labelTableBeside(file("Segmentation-label")), exported);
}

TEST_F(LabelFormats, SlicersTablesHaveCodes)
{
  const std::string type = "SegmentedPropertyTypeCodeSequence.";
  const std::vector<LabelInfo> labels = readLabels(text(
    "t.csv", "LabelValue,Name,Color_R,Color_G,Color_B,Color_A," + type + "CodingSchemeDesignator," + type +
               "CodeValue," + type + "CodeMeaning\n1,Segment_1,1,2,3,255,SCT,10200004,Liver\n2,mine,1,2,3,255,,,\n"));
  ASSERT_EQ(labels.size(), 2u);
  EXPECT_EQ(labels[0].code, "SCT 10200004");
  EXPECT_EQ(labels[0].name, "liver");
  EXPECT_EQ(labels[1].code, "");
  EXPECT_EQ(labels[1].name, "mine");
}

TEST_F(LabelFormats, SegmentationsNameTheirRepresentationInTwoWays)
{
  const auto nrrd = [&](const std::string& keys) {
    return text("s.seg.nrrd", "NRRD0004\ntype: unsigned char\nencoding: raw\ndimension: 3\nsizes: 2 1 1\n"
                              "Segment0_ID:=a\nSegment0_Name:=bone\nSegment0_LabelValue:=1\n" +
                                keys + "\n" + std::string("\0\1", 2));
  };
  for (const std::string key : { "Segmentation_MasterRepresentation", "Segmentation_SourceRepresentation" })
  {
    EXPECT_EQ(readLabelMap(nrrd(key + ":=Binary labelmap\n")).labels[1].name, "bone");
    nrrd(key + ":=Fractional labelmap\n");
    expectContains(refusal("s.seg.nrrd"), "Fractional labelmap");
  }
}

TEST_F(LabelFormats, UnusualVolumes)
{
  // 200 labels and sparse ids up to the largest, in one row, one voxel thick along two axes.
  std::vector<std::int32_t> ids;
  for (int n = 0; n < 200; ++n)
  {
    ids.push_back(n == 199 ? 65535 : n * 320);
  }
  NiftiBytes({ 3, 200, 1, 1, 1, 1, 1, 1 }, 8, 4).voxels(ids).write(file("many.nii"));
  const LabelVolume many = readLabelMap(file("many.nii"));
  EXPECT_EQ(many.labels.size(), 200u);
  EXPECT_EQ(many.find(65535)->name, "label_65535");
  EXPECT_EQ(many.placement.size, Vec3i(200, 1, 1));

  NiftiBytes({ 3, 4, 4, 4, 1, 1, 1, 1 }, 2, 1).voxels(std::vector<std::uint8_t>(64, 0)).write(file("empty.nii"));
  const LabelVolume empty = readLabelMap(file("empty.nii"));
  ASSERT_EQ(empty.labels.size(), 1u);
  EXPECT_EQ(empty.labels[0].name, "background");
  NiftiBytes({ 3, 4, 4, 4, 1, 1, 1, 1 }, 16, 4).voxels(std::vector<float>(64, 51.0f)).write(file("constant.nii"));
  EXPECT_EQ(readLabelMap(file("constant.nii")).labels[0].id, 51);
}

TEST(XmlLabelTable, IsReadAsXmlIs)
{
  const auto labels =
    labelsFromXml("<?xml version='1.0'?>\n<!-- <Label Key='9'>no</Label> --><T><LabelTable>\n"
                  "<Label\n  Key='1' Green = \"0.5\" Red='1' Blue='0'> <![CDATA[a > b]]>\n</Label>"
                  "<Label Key='2'>&#228; &amp;lt;</Label><Label Key='3'/><Label>none</Label>"
                  "<Label Key='70000'>large</Label><Label Key='4'>\n four \n</Label></LabelTable></T>" +
                  std::string(5, '\0'));
  ASSERT_EQ(labels.size(), 4u);
  EXPECT_EQ(labels[0].id, 1);
  EXPECT_EQ(labels[0].name, "a > b");
  EXPECT_TRUE(labels[0].hasColor);
  EXPECT_FLOAT_EQ(labels[0].color[1], 0.5f);
  EXPECT_EQ(labels[1].name, "\xC3\xA4 &lt;");
  EXPECT_FALSE(labels[1].hasColor);
  EXPECT_EQ(labels[2].name, "");
  EXPECT_EQ(labels[3].name, "four");

  EXPECT_EQ(labelsFromXml("<T><Label Key='1'>whole</Label><Label Key='2'>bro").at(0).name, "whole");
  EXPECT_TRUE(labelsFromXml("no XML").empty());
  EXPECT_TRUE(labelsFromXml("").empty());
}

TEST(LabelNames, NumbersAloneNeverNameAnOrgan)
{
  // 51 is a heart in TotalSegmentator v2 and an iliac artery in v1.
  const LabelTissueMap map = LabelTissueMap::read(dataFile("label_tissues.csv"));
  EXPECT_EQ(map.find("heart"), "myocardium");
  EXPECT_EQ(map.find("iliac_artery_left"), "blood");
  EXPECT_EQ(map.find("label_51"), "");
}

TEST(LabelNames, SubjectsNamesComeFromTheTextBesideIt)
{
  const fs::path path = fs::path(sharedDataFolder()) / "totalseg_s0327/s0327_total_v2_labelmap.nii.gz";
  if (!fs::exists(path))
  {
    GTEST_SKIP() << "the totalseg_s0327 data are not there";
  }
  const LabelVolume volume = readLabelMap(path.string());
  // The text also says how many voxels each label has.
  std::vector<std::size_t> count(65536, 0);
  for (const std::uint16_t id : volume.voxels)
  {
    ++count[id];
  }
  std::ifstream text(path.parent_path() / "s0327_labels.txt");
  std::string line;
  std::getline(text, line); // a note
  std::size_t lines = 0;
  int id = 0;
  std::string name;
  for (std::size_t voxels = 0; text >> id >> name >> voxels; ++lines)
  {
    ASSERT_NE(volume.find(id), nullptr) << name;
    EXPECT_EQ(volume.find(id)->name, name);
    EXPECT_EQ(count[std::size_t(id)], voxels) << name;
  }
  EXPECT_EQ(volume.labels.size(), lines);
  const LabelTissueMap map = LabelTissueMap::read(dataFile("label_tissues.csv"));
  for (const LabelInfo& label : volume.labels)
  {
    EXPECT_NE(map.find(label.name), "") << label.name;
  }
}
