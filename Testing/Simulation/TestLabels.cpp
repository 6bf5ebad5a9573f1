#include "ErrorText.h"
#include "Folders.h"
#include "LabelFolder.h"
#include "Labels/LabelVolume.h"
#include "Labels/ReadLabelMap.h"
#include "NiftiBytes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numeric>

namespace fs = std::filesystem;
using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;
using sono::testing::NiftiBytes;

namespace {

constexpr std::int16_t uint8Type = 2, int16Type = 4, int32Type = 8, float32Type = 16, float64Type = 64, rgbType = 128;

void expectNear(const Vec3d& a, const Vec3d& b, double tolerance)
{
  EXPECT_LE(glm::length(a - b), tolerance)
    << "(" << a.x << ", " << a.y << ", " << a.z << ") for (" << b.x << ", " << b.y << ", " << b.z << ")";
}

class LabelFiles : public sono::testing::LabelFolder
{
protected:
  /// A 2 x 1 x 1 NIfTI file of one number type.
  template<class T>
  std::string pair(const std::string& name, std::int16_t type, T first, T second) const
  {
    NiftiBytes({ 3, 2, 1, 1, 1, 1, 1, 1 }, type, sizeof(T)).voxels<T>({ first, second }).write(file(name));
    return file(name);
  }
};

fs::path sharedData(const std::string& name)
{
  return fs::path(sharedDataFolder()) / name;
}

} // namespace

TEST(GridPlacement, ObliqueIsAsComputedByHand)
{
  // i turned by 30 degrees toward y, spacing 2, 3, 4: voxel (1, 2, 3) lies at
  // (10 + 2 cos30 - 6 sin30, 20 + 2 sin30 + 6 cos30, 30 + 12).
  const double c = std::sqrt(3.0) / 2.0, s = 0.5;
  GridPlacement grid;
  grid.size = { 4, 4, 4 };
  grid.originMm = { 10.0, 20.0, 30.0 };
  grid.spacingMm = { 2.0, 3.0, 4.0 };
  grid.direction = Mat3d(Vec3d(c, s, 0.0), Vec3d(-s, c, 0.0), Vec3d(0.0, 0.0, 1.0));
  const Vec3d world(10.0 + 2.0 * c - 3.0, 20.0 + 1.0 + 6.0 * c, 42.0);
  expectNear(grid.worldFromIndex({ 1.0, 2.0, 3.0 }), world, 1e-12);
  expectNear(grid.indexFromWorld(world), { 1.0, 2.0, 3.0 }, 1e-12);
  EXPECT_NO_THROW(grid.validate("grid"));
}

TEST(GridPlacement, LeftHandedIsAllowedAndShearIsNot)
{
  const GridPlacement left = placementFromAffine(
    { 5, 5, 5 }, Mat3d(Vec3d(0.0, 2.0, 0.0), Vec3d(3.0, 0.0, 0.0), Vec3d(0.0, 0.0, 4.0)), { 1.0, 2.0, 3.0 }, "left");
  EXPECT_LT(glm::determinant(left.direction), 0.0);
  expectNear(left.worldFromIndex({ 1.0, 2.0, 3.0 }), { 7.0, 4.0, 15.0 }, 1e-12);
  expectNear(left.indexFromWorld({ 7.0, 4.0, 15.0 }), { 1.0, 2.0, 3.0 }, 1e-12);

  const Mat3d sheared(Vec3d(1.0, 0.0, 0.0), Vec3d(0.01, 1.0, 0.0), Vec3d(0.0, 0.0, 1.0));
  expectContains(errorOf([&] { placementFromAffine({ 2, 2, 2 }, sheared, Vec3d(0.0), "s.nii"); }), "'s.nii'");
  expectContains(errorOf([&] { placementFromAffine({ 2, 2, 2 }, sheared, Vec3d(0.0), "s.nii"); }), "resample");
}

TEST(GridPlacement, RefusesWhatIsNoGrid)
{
  const Mat3d unit(1.0);
  expectContains(errorOf([&] { placementFromAffine({ 0, 2, 2 }, unit, Vec3d(0.0), "x"); }), "no voxels");
  expectContains(errorOf([&] { placementFromAffine({ 2, 2, 2 }, Mat3d(0.0), Vec3d(0.0), "x"); }), "spacing");
  expectContains(errorOf([&] { placementFromAffine({ 2, 2, 2 }, unit, Vec3d(NAN), "x"); }), "origin");
}

TEST(LabelVolume, CollectsWhatOccurs)
{
  LabelVolume volume;
  volume.voxels = { 7, 0, 65535, 7 };
  LabelInfo named, absent;
  named.id = 7;
  named.name = "liver";
  named.tissue = "liver";
  absent.id = 9;
  volume.labels = { absent, named };
  volume.collectLabels();
  ASSERT_EQ(volume.labels.size(), 3u);
  EXPECT_EQ(volume.labels[0].name, "background");
  EXPECT_EQ(volume.labels[1].name, "liver");
  EXPECT_EQ(volume.labels[1].tissue, "liver");
  EXPECT_EQ(volume.labels[2].name, "label_65535");
  EXPECT_EQ(volume.find(7)->name, "liver");
  EXPECT_EQ(volume.find(9), nullptr);
}

TEST_F(LabelFiles, SformIsFlippedFromRasToLps)
{
  // A NIfTI voxel (i,j,k) at RAS (5 + 2i, 6 + 3j, 7 + 4k) lies at LPS (-5 - 2i, -6 - 3j, 7 + 4k). The qform disagrees.
  std::vector<std::uint8_t> values(24);
  std::iota(values.begin(), values.end(), std::uint8_t(0));
  NiftiBytes({ 3, 2, 3, 4, 1, 1, 1, 1 }, uint8Type, 1)
    .qform({ 0, 0, 0 }, { 100, 100, 100 }, 1)
    .sform({ 2, 0, 0, 5, 0, 3, 0, 6, 0, 0, 4, 7 })
    .voxels(values)
    .writeGz(file("a.nii.gz"));
  const LabelVolume volume = readLabelMap(file("a.nii.gz"));
  expectNear(volume.placement.worldFromIndex({ 1.0, 2.0, 3.0 }), { -7.0, -12.0, 19.0 }, 1e-6);
  EXPECT_EQ(volume.placement.size, Vec3i(2, 3, 4));
  EXPECT_EQ(volume.voxels[1 + 2 * (2 + 3 * 3)], 23);
  EXPECT_EQ(volume.labels.size(), 24u);
}

TEST_F(LabelFiles, QformPlacesWhenThereIsNoSform)
{
  // A quarter turn about z (b = c = 0, d = sin 45) sends i to +A and j to -R in RAS; qfac -1 turns k to inferior.
  NiftiBytes({ 3, 2, 1, 1, 1, 1, 1, 1 }, uint8Type, 1)
    .spacing(2, 3, 4)
    .qform({ 0, 0, std::sqrt(0.5f) }, { 10, 20, 30 }, -1)
    .voxels<std::uint8_t>({ 1, 2 })
    .write(file("q.nii"));
  const LabelVolume volume = readLabelMap(file("q.nii"));
  expectNear(volume.placement.worldFromIndex({ 1.0, 0.0, 0.0 }), { -10.0, -22.0, 30.0 }, 1e-5);
  expectNear(volume.placement.worldFromIndex({ 0.0, 1.0, 0.0 }), { -7.0, -20.0, 30.0 }, 1e-5);
  expectNear(volume.placement.worldFromIndex({ 0.0, 0.0, 1.0 }), { -10.0, -20.0, 26.0 }, 1e-5);
}

TEST_F(LabelFiles, SpacingAloneAndUnitsOfMetres)
{
  NiftiBytes({ 3, 2, 1, 1, 1, 1, 1, 1 }, uint8Type, 1)
    .spacing(0.002f, 0.003f, 0.004f)
    .unit(1)
    .voxels<std::uint8_t>({ 1, 2 })
    .write(file("m.nii"));
  expectNear(readLabelMap(file("m.nii")).placement.worldFromIndex({ 1.0, 1.0, 1.0 }), { 2.0, 3.0, 4.0 }, 1e-6);
}

TEST_F(LabelFiles, ShearedNiftiIsRefused)
{
  NiftiBytes({ 3, 2, 1, 1, 1, 1, 1, 1 }, uint8Type, 1)
    .sform({ 1, 0.1f, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 })
    .voxels<std::uint8_t>({ 1, 2 })
    .write(file("s.nii"));
  expectContains(refusal("s.nii"), "resample");
}

TEST_F(LabelFiles, NumberTypesAndScaling)
{
  EXPECT_EQ(readLabelMap(pair<std::int16_t>("i16.nii", int16Type, 3, 300)).voxels[1], 300);
  EXPECT_EQ(readLabelMap(pair<std::int32_t>("i32.nii", int32Type, 3, 65535)).voxels[1], 65535);
  EXPECT_EQ(readLabelMap(pair<float>("f32.nii", float32Type, 3.0f, 117.0f)).voxels[1], 117);
  EXPECT_EQ(readLabelMap(pair<double>("f64.nii", float64Type, 3.0, 104.0)).voxels[1], 104);
  NiftiBytes({ 5, 2, 1, 1, 1, 1, 1, 1 }, uint8Type, 1)
    .scale(0.1f, 4.0f)
    .voxels<std::uint8_t>({ 0, 30 })
    .write(file("scaled.nii"));
  EXPECT_EQ(readLabelMap(file("scaled.nii")).voxels, (std::vector<std::uint16_t>{ 4, 7 }));
}

TEST_F(LabelFiles, NumbersThatAreNoLabelsAreNamed)
{
  pair<float>("half.nii", float32Type, 1.0f, 2.5f);
  expectContains(refusal("half.nii"), "holds 2.5 at voxel (1,0,0); a label map holds whole numbers 0..65535");
  pair<float>("nan.nii", float32Type, 1.0f, NAN);
  expectContains(refusal("nan.nii"), "holds nan at voxel (1,0,0)");
  pair<std::int16_t>("negative.nii", int16Type, -1, 0);
  expectContains(refusal("negative.nii"), "holds -1 at voxel (0,0,0)");
  pair<std::int32_t>("large.nii", int32Type, 0, 65536);
  expectContains(refusal("large.nii"), "holds 65536 at voxel (1,0,0)");
  NiftiBytes({ 3, 1, 1, 1, 1, 1, 1, 1 }, rgbType, 3).voxels<std::uint8_t>({ 1, 2, 3 }).write(file("rgb.nii"));
  expectContains(refusal("rgb.nii"), "RGB");
}

TEST_F(LabelFiles, NiftiHasPhasesAlongItsFourthAxis)
{
  for (const std::string name : { "beat.nii", "beat.nii.gz" })
  {
    NiftiBytes({ 4, 2, 1, 1, 3, 1, 1, 1 }, uint8Type, 1).voxels<std::uint8_t>({ 1, 2, 3, 4, 5, 6 }).write(file(name));
    const LabelPhases phases = readLabelPhases(file(name));
    EXPECT_EQ(phases.count, 3);
    EXPECT_EQ(phases.stepS, 1.0);
    for (int phase = 0; phase < 3; ++phase)
    {
      const LabelVolume volume = readLabelMap(file(name), phase);
      EXPECT_EQ(volume.placement.size, Vec3i(2, 1, 1));
      EXPECT_EQ(volume.voxels,
                (std::vector<std::uint16_t>{ std::uint16_t(2 * phase + 1), std::uint16_t(2 * phase + 2) }));
    }
    expectContains(errorOf([&] { readLabelMap(file(name), 3); }), "has 3 phases");
  }
}

TEST_F(LabelFiles, BrokenFilesAreErrors)
{
  expectContains(refusal("missing.nii.gz"), "missing.nii.gz': no such file");
  expectContains(errorOf([&] { readLabelMap(text("a.txt", "x")); }), "ends in none of");
  expectContains(errorOf([&] { readLabelMap(text("a.nii", "no header here")); }), "not a NIfTI file");
  expectContains(errorOf([&] { readLabelMap(text("a.nii.gz", "")); }), "not a NIfTI file");
  expectContains(errorOf([&] { readLabelMap(text("a.nrrd", "no header here")); }), "no complete NRRD");

  NiftiBytes({ 5, 1, 1, 1, 1, 2, 1, 1 }, uint8Type, 1).voxels<std::uint8_t>({ 1, 2 }).write(file("vectors.nii"));
  expectContains(refusal("vectors.nii"), "more than three dimensions");
  for (std::int16_t axis = 1; axis <= 3; ++axis)
  {
    std::array<std::int16_t, 8> dim{ 3, 2, 2, 2, 1, 1, 1, 1 };
    dim[std::size_t(axis)] = 0;
    NiftiBytes(dim, uint8Type, 1).voxels<std::uint8_t>({ 1, 2, 3, 4 }).write(file("zero.nii"));
    expectContains(refusal("zero.nii"), "no voxels");
  }
}

TEST_F(LabelFiles, TruncatedDataAreErrors)
{
  std::vector<std::uint8_t> values(64 * 64 * 64);
  for (std::size_t n = 0; n < values.size(); ++n)
  {
    values[n] = std::uint8_t((n * 2654435761u) >> 13);
  }
  const NiftiBytes whole = NiftiBytes({ 3, 64, 64, 64, 1, 1, 1, 1 }, uint8Type, 1).voxels(values);
  for (const std::string name : { "t.nii", "t.nii.gz" })
  {
    name == "t.nii" ? whole.write(file(name)) : whole.writeGz(file(name));
    EXPECT_NO_THROW(readLabelMap(file(name)));
    const auto bytes = fs::file_size(file(name));
    for (const std::uintmax_t kept : { bytes - 1, bytes / 2, std::uintmax_t(400) })
    {
      fs::resize_file(file(name), kept);
      expectContains(refusal(name), "cannot read");
    }
  }
}

TEST_F(LabelFiles, NamesFromAnExtension)
{
  NiftiBytes({ 3, 3, 1, 1, 1, 1, 1, 1 }, uint8Type, 1)
    .extension(30, "<CaretExtension><LabelTable>\n<Label Key=\"1\" Red=\"0.5\" Green=\"1\" Blue=\"0\" Alpha=\"1\">"
                   "<![CDATA[left <& right]]></Label><Label Key=\"2\">fat &amp; skin</Label></LabelTable>")
    .voxels<std::uint8_t>({ 0, 1, 2 })
    .write(file("x.nii"));
  text("x.csv", "id,name,tissue_class,r,g,b\n1,table,liver,255,0,0\n2,table,,,,\n0,\"air, outside\",,0,51,255\n");
  const LabelVolume volume = readLabelMap(file("x.nii"));
  ASSERT_EQ(volume.labels.size(), 3u);
  EXPECT_EQ(volume.labels[0].name, "air, outside");
  EXPECT_FLOAT_EQ(volume.labels[0].color[1], 0.2f);
  EXPECT_EQ(volume.labels[1].name, "left <& right");
  EXPECT_TRUE(volume.labels[1].hasColor);
  EXPECT_FLOAT_EQ(volume.labels[1].color[0], 0.5f);
  EXPECT_EQ(volume.labels[2].name, "fat & skin");
  EXPECT_FALSE(volume.labels[2].hasColor);
  EXPECT_TRUE(volume.labels[1].tissue.empty());
}

TEST_F(LabelFiles, LabelTables)
{
  LabelVolume volume = readLabelMap(pair<std::int16_t>("x.nii", int16Type, 1, 2));
  readLabelTable(text("t.csv", "\xEF\xBB\xBF# note\r\nname,id\r\n\"a \"\"b\"\"\",2\r\nnone,5\r\n"), volume);
  EXPECT_EQ(volume.labels[0].name, "label_1");
  EXPECT_EQ(volume.labels[1].name, "a \"b\"");
  expectContains(errorOf([&] { readLabelTable(text("n.csv", "number,name\n1,a\n"), volume); }),
                 "n.csv' has no column 'id'");
  expectContains(errorOf([&] { readLabelTable(text("b.csv", "id,name\n1,a\nx,b\n"), volume); }), "b.csv' line 3");
  expectContains(errorOf([&] { readLabelTable(text("c.csv", "id,name\n1,a,b\n"), volume); }), "c.csv' line 2");
  expectContains(errorOf([&] { readLabelTable(text("q.csv", "id,name\n1,\"a\n"), volume); }), "quote");
  expectContains(errorOf([&] { readLabelTable(file("no.csv"), volume); }), "no such file");
  text("labels.csv", "some,other,table\n1,2,3\n");
  EXPECT_EQ(readLabelMap(file("x.nii")).labels[0].name, "label_1");
  text("labels.csv", "id,name\n1,one\n");
  EXPECT_EQ(readLabelMap(file("x.nii")).labels[0].name, "one");
}

TEST_F(LabelFiles, RoundTrip)
{
  const double c = std::cos(0.3), s = std::sin(0.3);
  for (const double handed : { 1.0, -1.0 })
  {
    LabelVolume volume;
    volume.placement.size = { 3, 2, 2 };
    volume.placement.originMm = { -12.5, 33.25, 400.0 };
    volume.placement.spacingMm = { 0.5, 1.25, 3.0 };
    volume.placement.direction = Mat3d(Vec3d(c, s, 0.0), Vec3d(-s * c, c * c, s), handed * Vec3d(s * s, -s * c, c));
    volume.voxels = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 65535 };
    volume.collectLabels();
    volume.labels[1].name = "left, \"big\" # one";
    volume.labels[1].color = { 1.0f, 0.2f, 0.0f };
    volume.labels[1].hasColor = true;
    for (const std::string name : { "r.nii", "r.nii.gz" })
    {
      writeLabelMap(file(name), volume);
      const LabelVolume back = readLabelMap(file(name));
      EXPECT_EQ(back.voxels, volume.voxels);
      expectNear(back.placement.spacingMm, volume.placement.spacingMm, 1e-6);
      for (const Vec3d corner : { Vec3d(0.0), Vec3d(2.0, 0.0, 0.0), Vec3d(0.0, 1.0, 0.0), Vec3d(0.0, 0.0, 1.0) })
      {
        expectNear(back.placement.worldFromIndex(corner), volume.placement.worldFromIndex(corner), 1e-4);
      }
      ASSERT_EQ(back.labels.size(), volume.labels.size());
      EXPECT_EQ(back.labels[1].name, volume.labels[1].name);
      EXPECT_EQ(back.labels[1].color, volume.labels[1].color);
      EXPECT_FALSE(back.labels[2].hasColor);
    }
    // The qform alone must say the same as the sform: wipe sform_code (bytes 254, 255).
    std::fstream patch(file("r.nii"), std::ios::in | std::ios::out | std::ios::binary);
    patch.seekp(254).write("\0\0", 2);
    patch.close();
    const LabelVolume byQform = readLabelMap(file("r.nii"));
    expectNear(byQform.placement.worldFromIndex({ 2.0, 1.0, 1.0 }), volume.placement.worldFromIndex({ 2.0, 1.0, 1.0 }),
               1e-4);
  }
  LabelVolume short1;
  short1.placement.size = { 2, 2, 2 };
  expectContains(errorOf([&] { writeLabelMap(file("w.nii"), short1); }), "0 voxels");
  short1.voxels.resize(8);
  expectContains(errorOf([&] { writeLabelMap(file("no/w.nii"), short1); }), "cannot write");
  expectContains(errorOf([&] { writeLabelMap(file("w.nrrd"), short1); }), ".nii.gz");
}

namespace {

/// An attached-header raw NRRD of unsigned chars.
std::string nrrdText(const std::string& fields, const std::string& data)
{
  return "NRRD0004\ntype: unsigned char\nencoding: raw\n" + fields + "\n" + data;
}

} // namespace

TEST_F(LabelFiles, NrrdSpaces)
{
  const std::string axes = "dimension: 3\nsizes: 2 1 1\nspace directions: (0,2,0) (3,0,0) (0,0,4)\n"
                           "space origin: (10,20,30)\n";
  const std::string data("\1\2", 2);
  const std::pair<const char*, Vec3d> cases[] = { { "left-posterior-superior", { 13.0, 22.0, 34.0 } },
                                                  { "RAS", { -13.0, -22.0, 34.0 } },
                                                  { "left-anterior-superior", { 13.0, -22.0, 34.0 } } };
  for (const auto& [space, world] : cases)
  {
    const LabelVolume volume =
      readLabelMap(text("n.nrrd", nrrdText("space: " + std::string(space) + "\n" + axes, data)));
    expectNear(volume.placement.worldFromIndex({ 1.0, 1.0, 1.0 }), world, 1e-9);
    EXPECT_EQ(volume.voxels, (std::vector<std::uint16_t>{ 1, 2 }));
  }
  text("u.nrrd", nrrdText("space dimension: 3\n" + axes, data));
  expectContains(refusal("u.nrrd"), "set its space");

  text("plain.nrrd", nrrdText("dimension: 3\nsizes: 2 1 1\nspacings: 2 3 4\n", data));
  expectNear(readLabelMap(file("plain.nrrd")).placement.worldFromIndex({ 1.0, 1.0, 1.0 }), { 2.0, 3.0, 4.0 }, 1e-12);

  text("d.raw", data);
  text("d.nhdr", "NRRD0004\ntype: unsigned char\nencoding: raw\ndimension: 3\nsizes: 2 1 1\ndata file: d.raw\n");
  EXPECT_EQ(readLabelMap(file("d.nhdr")).voxels[1], 2);

  text("t.nrrd", nrrdText("dimension: 3\nsizes: 2 2 2\n", data));
  expectContains(refusal("t.nrrd"), "no complete NRRD");
  text("flat.nrrd", nrrdText("dimension: 2\nsizes: 2 1\n", data));
  expectContains(refusal("flat.nrrd"), "2 spatial axes");
  text("f.nrrd", "NRRD0004\ntype: float\nencoding: ascii\ndimension: 3\nsizes: 1 2 1\n\n1 1.5\n");
  expectContains(refusal("f.nrrd"), "holds 1.5 at voxel (0,1,0)");
}

TEST_F(LabelFiles, NrrdSegments)
{
  const std::string axes = "dimension: 3\nsizes: 3 1 1\n";
  const std::string data("\0\1\2", 3);
  text("new.seg.nrrd",
       nrrdText(axes + "Segment0_ID:=a\nSegment0_Name:=bone\nSegment0_LabelValue:=2\nSegment0_Color:=1 0.5 0\n", data));
  const LabelVolume named = readLabelMap(file("new.seg.nrrd"));
  EXPECT_EQ(named.find(2)->name, "bone");
  EXPECT_FLOAT_EQ(named.find(2)->color[1], 0.5f);
  EXPECT_EQ(named.find(1)->name, "label_1");
  text("old.seg.nrrd", nrrdText(axes + "Segment0_Name:=one\nSegment1_Name:=two\n", data));
  EXPECT_EQ(readLabelMap(file("old.seg.nrrd")).find(2)->name, "two");

  // Two layers of three voxels, the layer fastest: layer 0 holds 1 1 0, layer 1 holds 0 1 1; segment 0 lies in layer 1.
  const std::string layers = "dimension: 4\nsizes: 2 3 1 1\nspace: LPS\n"
                             "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list domain domain domain\n";
  text("two.seg.nrrd", nrrdText(layers + "Segment0_Name:=under\nSegment0_LabelValue:=1\nSegment0_Layer:=1\n"
                                         "Segment1_Name:=over\nSegment1_LabelValue:=1\nSegment1_Layer:=0\n",
                                std::string("\1\0\1\1\0\1", 6)));
  const LabelVolume flat = readLabelMap(file("two.seg.nrrd"));
  EXPECT_EQ(flat.voxels, (std::vector<std::uint16_t>{ 2, 2, 1 }));
  EXPECT_EQ(flat.find(1)->name, "under");
  EXPECT_EQ(flat.find(2)->name, "over");
  text("none.nrrd", nrrdText(layers, std::string("\1\0\1\1\0\1", 6)));
  expectContains(refusal("none.nrrd"), "more than three dimensions");
}

TEST(LabelData, HeartAgreesBetweenNiftiAndNrrd)
{
  const fs::path nifti = sharedData("thorax_heart/thorax_heart.nii.gz");
  const fs::path nrrd = sharedData("thorax_heart/thorax_heart.seg.nrrd");
  if (!fs::exists(nifti) || !fs::exists(nrrd))
  {
    GTEST_SKIP() << "the thorax_heart data are not there";
  }
  const LabelVolume a = readLabelMap(nifti.string());
  const LabelVolume b = readLabelMap(nrrd.string());
  ASSERT_EQ(a.labels.size(), 105u); // 104 structures and the outside
  ASSERT_EQ(b.labels.size(), 105u);
  for (std::size_t n = 0; n < a.labels.size(); ++n)
  {
    EXPECT_EQ(a.labels[n].name, b.labels[n].name);
  }
  // The world label at a voxel centre of one file, looked up in the other.
  std::size_t different = 0;
  const Vec3i size = a.placement.size;
  for (int k = 0; k < size.z; k += 3)
  {
    for (int j = 0; j < size.y; j += 3)
    {
      for (int i = 0; i < size.x; i += 3)
      {
        const Vec3d index = b.placement.indexFromWorld(a.placement.worldFromIndex({ i, j, k }));
        const Vec3i at(std::lround(index.x), std::lround(index.y), std::lround(index.z));
        ASSERT_LT(glm::length(index - Vec3d(at)), 1e-3);
        const std::size_t here = std::size_t(i) + std::size_t(size.x) * (std::size_t(j) + std::size_t(size.y) * k);
        const std::size_t there =
          at.x + std::size_t(b.placement.size.x) * (at.y + std::size_t(b.placement.size.y) * at.z);
        different += a.voxels[here] != b.voxels.at(there);
      }
    }
  }
  EXPECT_EQ(different, 0u);
}

TEST(LabelData, NamesAndLayersOfOtherTools)
{
  const fs::path caret = sharedData("totalsegmentator/example_seg.nii.gz");
  const fs::path layered = sharedData("slicerio/SegmentationOverlapping.seg.nrrd");
  if (!fs::exists(caret) || !fs::exists(layered))
  {
    GTEST_SKIP() << "the totalsegmentator and slicerio data are not there";
  }
  for (const LabelInfo& label : readLabelMap(caret.string()).labels)
  {
    EXPECT_TRUE(label.id == 0 || label.hasColor) << label.name;
    EXPECT_NE(label.name.substr(0, 6), "label_");
  }
  const LabelVolume left = readLabelMap(sharedData("totalsegmentator/example_seg_dicom.nii.gz").string());
  EXPECT_LT(glm::determinant(left.placement.direction), 0.0);
  EXPECT_NO_THROW(readLabelMap(sharedData("totalsegmentator/example_seg_v1_full.nii.gz").string()));

  const LabelVolume flat = readLabelMap(layered.string());
  EXPECT_EQ(flat.placement.size, Vec3i(128, 128, 34));
  for (const LabelInfo& label : flat.labels)
  {
    EXPECT_NE(label.name.substr(0, 6), "label_");
  }
}
