#include "ErrorText.h"
#include "Scene/SceneFile.h"
#include "Scene/SceneText.h"
#include "TemporaryFolder.h"
#include "TestScenes.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace fs = std::filesystem;
using namespace sono;
using namespace sono::test;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

/// A box, a one-voxel block at a leaf's last corner and a ball, oblique and left-handed in the world.
LabelVolume smallVolume()
{
  LabelVolume volume;
  const double c = std::cos(0.4), s = std::sin(0.4);
  volume.placement.size = { 37, 29, 41 };
  volume.placement.spacingMm = { 0.7, 1.1, 1.9 };
  volume.placement.originMm = { -100.5, 20.25, 1300.125 };
  volume.placement.direction = Mat3d(Vec3d(c, s, 0.0), Vec3d(s, -c, 0.0), Vec3d(0.0, 0.0, 1.0));
  for (int k = 0; k < 41; ++k)
  {
    for (int j = 0; j < 29; ++j)
    {
      for (int i = 0; i < 37; ++i)
      {
        const bool box = i >= 4 && i < 30 && j >= 3 && j < 25 && k >= 2 && k < 36;
        const bool ball = (i - 16) * (i - 16) + (j - 14) * (j - 14) + (k - 18) * (k - 18) < 49;
        volume.voxels.push_back(i == 7 && j == 7 && k == 7 ? 65535 : (ball ? 300 : (box ? 2 : 0)));
      }
    }
  }
  volume.collectLabels();
  const char* names[] = { "outside", "body, \"big\"", "Herz \xC3\xBC", "one" };
  for (std::size_t n = 0; n < 4; ++n)
  {
    volume.labels[n].name = names[n];
    volume.labels[n].tissue = n == 0 ? "air" : (n == 1 ? "fat" : "blood");
  }
  volume.labels[1].hasColor = true;
  volume.labels[1].color = { 0.1f, 0.2f, 1.0f };
  return volume;
}

TissueTable smallTable(double bloodImpedance = 1.61)
{
  TissueTable table;
  table.add(makeTissue("air", 0.0004, 343.0, 7.5));
  table.add(makeTissue("fat", 1.38, 1450.0, 0.63));
  table.add(makeTissue("blood", bloodImpedance, 1570.0, 0.18));
  return table;
}

class SceneFiles : public ::testing::Test
{
protected:
  std::string file(const std::string& name) const { return folder_.file(name); }
  std::string folder() const { return folder_.path(); }

  static std::string bytesOf(const std::string& path)
  {
    std::ifstream stream(path, std::ios::binary);
    return { std::istreambuf_iterator<char>(stream), {} };
  }
  static void write(const std::string& path, const std::string& bytes)
  {
    std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
  }
  std::string refusalOf(const std::string& bytes) const
  {
    write(file("bad.nvdb"), bytes);
    return errorOf([&] { readScene(file("bad.nvdb")); });
  }

private:
  sono::testing::TemporaryFolder folder_;
};

void expectSameScene(const Scene& a, const Scene& b)
{
  EXPECT_EQ(a.volume().voxels, b.volume().voxels);
  EXPECT_EQ(a.placement().size, b.placement().size);
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_EQ(a.placement().originMm[axis], b.placement().originMm[axis]); // to the last bit
    EXPECT_EQ(a.placement().spacingMm[axis], b.placement().spacingMm[axis]);
    EXPECT_EQ(a.placement().direction[axis], b.placement().direction[axis]);
  }
  ASSERT_EQ(a.volume().labels.size(), b.volume().labels.size());
  for (std::size_t n = 0; n < a.volume().labels.size(); ++n)
  {
    const LabelInfo& one = a.volume().labels[n];
    const LabelInfo& two = b.volume().labels[n];
    EXPECT_EQ(one.id, two.id);
    EXPECT_EQ(one.name, two.name);
    EXPECT_EQ(one.tissue, two.tissue);
    EXPECT_EQ(one.hasColor, two.hasColor);
    EXPECT_EQ(one.color, two.color);
    const SurfaceField& s = a.surface(one.id);
    const SurfaceField& t = b.surface(one.id);
    EXPECT_EQ(s.bandMm, t.bandMm);
    EXPECT_EQ(s.box, t.box);
    for (int k = 0; k < 41; ++k)
    {
      for (int i = 0; i < 37; ++i)
      {
        ASSERT_EQ(s.at({ i, 14, k }), t.at({ i, 14, k }));
      }
    }
  }
  EXPECT_EQ(a.tissueVoxels(), b.tissueVoxels());
}

} // namespace

TEST_F(SceneFiles, RoundTrip)
{
  const Scene scene(smallVolume(), smallTable(), "air");
  writeScene(file("s.nvdb"), scene);
  const auto back = readScene(file("s.nvdb"));
  expectSameScene(scene, *back);
  ASSERT_EQ(back->tissues().size(), 3u);
  EXPECT_EQ(back->tissues()[2].impedanceMRayl, 1.61);
  EXPECT_EQ(back->outsideIndex(), scene.outsideIndex());
  EXPECT_EQ(back->labelGrid().at({ 7, 7, 7 }), 65535);
  // What was read is written as it was.
  writeScene(file("t.nvdb"), *back);
  expectSameScene(*readScene(file("t.nvdb")), scene);
  EXPECT_EQ(fs::file_size(file("s.nvdb")), fs::file_size(file("t.nvdb")));
}

TEST_F(SceneFiles, FromBeforeTheSecondHarmonicHaveItsDefault)
{
  const Scene scene(smallVolume(), smallTable(), "air");
  scene.buildAll();
  const std::string text = sceneText(scene);
  std::string older = text;
  for (std::size_t at = older.find("\"nonlinearity\":"); at != std::string::npos; at = older.find("\"nonlinearity\":"))
  {
    older.erase(at, older.find(',', at) + 1 - at); // others of its tissue follow
  }
  ASSERT_LT(older.size(), text.size());
  EXPECT_EQ(parseSceneText("n.nvdb", older).tissues.find("fat")->nonlinearity, Tissue().nonlinearity);
}

TEST_F(SceneFiles, ScansDetailComesBack)
{
  LabelVolume volume = smallVolume();
  std::vector<std::uint8_t> detail(volume.voxels.size());
  for (std::size_t n = 0; n < detail.size(); ++n)
  {
    detail[n] = std::uint8_t(n * n % 251); // line feeds and zeros are among them
  }
  const Scene scene(std::move(volume), smallTable(), "air", detail);
  writeScene(file("s.nvdb"), scene);
  EXPECT_EQ(readScene(file("s.nvdb"))->detail(), detail);
  const std::string whole = bytesOf(file("s.nvdb"));
  std::string bytes = whole;
  bytes[whole.find(std::string(detail.begin(), detail.begin() + 20)) + 5] ^= 1;
  expectContains(refusalOf(bytes), "damaged");
  // A cache serves whatever scan comes with the labels.
  EXPECT_EQ(makeCachedScene(smallVolume(), smallTable(), "air", file("cache"), {}, detail)->detail(), detail);
  EXPECT_TRUE(makeCachedScene(smallVolume(), smallTable(), "air", file("cache"))->detail().empty());
}

TEST_F(SceneFiles, OtherProgramsListTheGrids)
{
  const Scene scene(smallVolume(), smallTable(), "air");
  writeScene(file("s.vdb"), scene);
  if (std::system("vdb_print -h > /dev/null 2>&1") != 0)
  {
    GTEST_SKIP() << "vdb_print of OpenVDB's tools is not installed";
  }
  ASSERT_EQ(std::system(("vdb_print " + file("s.vdb") + " > " + file("list.txt")).c_str()), 0);
  const std::string list = bytesOf(file("list.txt"));
  for (const char* name : { "labels", "voxels_0", "voxels_2", "voxels_300", "voxels_65535", "sdf_0", "sdf_2", "sdf_300",
                            "sdf_65535", "int32", "float" })
  {
    expectContains(list, name);
  }
}

TEST_F(SceneFiles, TruncatedFilesAreRefused)
{
  writeScene(file("s.nvdb"), Scene(smallVolume(), smallTable(), "air"));
  const std::string whole = bytesOf(file("s.nvdb"));
  for (const std::size_t kept :
       { std::size_t(0), std::size_t(7), std::size_t(100), std::size_t(700), whole.size() / 2, whole.size() - 1 })
  {
    expectContains(refusalOf(whole.substr(0, kept)), "bad.nvdb'");
  }
  expectContains(refusalOf(whole.substr(0, whole.size() / 2)), "ends too early");
  expectContains(refusalOf(whole + "x"), "damaged");
}

TEST_F(SceneFiles, DamagedBytesAreRefused)
{
  writeScene(file("s.nvdb"), Scene(smallVolume(), smallTable(), "air"));
  const std::string whole = bytesOf(file("s.nvdb"));
  int refused = 0;
  int read = 0;
  for (std::size_t at = 3; at < whole.size(); at += whole.size() / 150)
  {
    std::string bytes = whole;
    bytes[at] = char(bytes[at] ^ 0x5A);
    refusalOf(bytes) == "no error" ? ++read : ++refused;
  }
  // A few lie in header fields that nobody reads (bounds, names, padding).
  EXPECT_GT(refused, 140);
  EXPECT_LT(read, 12);
}

TEST_F(SceneFiles, ForeignAndNewerFilesAreRefused)
{
  expectContains(refusalOf("just some text that is no grid"), "no NanoVDB file");
  expectContains(errorOf([&] { readScene(file("none.nvdb")); }), "no such file");
  expectContains(errorOf([&] { readScene(folder()); }), "no such file");

  writeScene(file("s.nvdb"), Scene(smallVolume(), smallTable(), "air"));
  std::string newer = bytesOf(file("s.nvdb"));
  newer[11] = char(0x21); // the major version lies in the upper bits of the word at byte 8
  expectContains(refusalOf(newer), "NanoVDB 264");

  std::string foreign = bytesOf(file("s.nvdb"));
  foreign[foreign.find(std::string("sonovdb\0", 8))] = 'x';
  expectContains(refusalOf(foreign), "no scene of SonoVDB");
  expectContains(errorOf([] { parseSceneText("n.nvdb", "{\"sonovdb_format\": 4}"); }), "newer SonoVDB wrote it");
  expectContains(errorOf([] { parseSceneText("n.nvdb", "{\"sonovdb_format\": 2}"); }), "incomplete");
  expectContains(errorOf([] { parseSceneText("n.nvdb", "{\"sonovdb_format\": 1}"); }),
                 "without the tissues' roughness");
  expectContains(errorOf([] { parseSceneText("n.nvdb", "{"); }), "incomplete");

  const Scene scene(smallVolume(), smallTable(), "air");
  expectContains(errorOf([&] { writeScene(file("s.txt"), scene); }), ".nvdb or .vdb");
  expectContains(errorOf([&] { writeScene(file("no/s.nvdb"), scene); }), "cannot write");
  expectContains(errorOf([&] { writeScene(file("no/s.vdb"), scene); }), "cannot write");
}

TEST_F(SceneFiles, CacheIsKeyedByContent)
{
  const std::string cache = file("cache");
  const auto filesThere = [&] { return std::distance(fs::directory_iterator(cache), fs::directory_iterator()); };
  const auto first = makeCachedScene(smallVolume(), smallTable(), "air", cache);
  ASSERT_EQ(filesThere(), 1);
  const fs::path entry = fs::directory_iterator(cache)->path();
  fs::create_hard_link(entry, file("written"));
  fs::last_write_time(entry, fs::file_time_type::clock::now() - std::chrono::hours(1));
  const auto hourAgo = fs::last_write_time(entry);

  const auto second = makeCachedScene(smallVolume(), smallTable(2.5), "air", cache);
  EXPECT_TRUE(fs::equivalent(entry, file("written"))); // not written anew, which makes another file
  EXPECT_GT(fs::last_write_time(entry), hourAgo);      // but used
  expectSameScene(*first, *second);
  EXPECT_EQ(second->tissues()[2].impedanceMRayl, 2.5); // the caller's table, not the file's

  LabelVolume moved = smallVolume();
  moved.placement.originMm.x += 1e-9;
  LabelVolume changed = smallVolume();
  changed.voxels[0] = 2;
  makeCachedScene(moved, smallTable(), "air", cache);
  makeCachedScene(changed, smallTable(), "air", cache);
  EXPECT_EQ(filesThere(), 3);

  // A damaged entry is rebuilt.
  std::string bytes = bytesOf(entry.string());
  bytes[bytes.size() / 2] = char(~bytes[bytes.size() / 2]);
  write(entry.string(), bytes);
  expectSameScene(*first, *makeCachedScene(smallVolume(), smallTable(), "air", cache));
  EXPECT_NO_THROW(readScene(entry.string()));

  write(file("notafolder"), "x");
  expectContains(errorOf([&] { makeCachedScene(smallVolume(), smallTable(), "air", file("notafolder")); }), "cache");
}
