#include "Core/FileContent.h"
#include "Core/KeptResults.h"
#include "Core/KeyText.h"
#include "ErrorText.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;
using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

class KeptResults : public ::testing::Test
{
protected:
  /// That nobody has made yet.
  std::string folder() const { return folder_.file("cache"); }
  fs::path path(const std::string& name) const { return fs::path(folder()) / name; }

  std::vector<fs::path> files() const
  {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder()))
    {
      found.push_back(entry.path());
    }
    return found;
  }
  static std::string bytesOf(const fs::path& path)
  {
    std::ifstream stream(path, std::ios::binary);
    return { std::istreambuf_iterator<char>(stream), {} };
  }
  static void write(const fs::path& path, const std::string& bytes)
  {
    std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
  }
  static void useHoursAgo(const fs::path& path, int hours)
  {
    fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(hours));
  }

private:
  sono::testing::TemporaryFolder folder_;
};

const std::vector<std::string> someParts{ "one", std::string("t\0o\n", 4), "", std::string(100000, 'x') };

} // namespace

TEST_F(KeptResults, ComeBackByTheirKeyAlone)
{
  EXPECT_FALSE(findKept(folder(), "picture", "a"));
  keep(folder(), "picture", "a", someParts);
  const auto found = findKept(folder(), "picture", "a");
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, someParts);
  EXPECT_FALSE(findKept(folder(), "picture", "b"));
  EXPECT_FALSE(findKept(folder(), "window", "a"));
  EXPECT_FALSE(findKept("", "picture", "a"));
  // Another key whose file has this name, as if their hashes were equal.
  const fs::path file = files().at(0);
  keep(folder(), "picture", "c", { "other" });
  for (const fs::path& other : files())
  {
    if (other != file)
    {
      fs::copy_file(other, file, fs::copy_options::overwrite_existing);
    }
  }
  EXPECT_FALSE(findKept(folder(), "picture", "a"));
}

TEST_F(KeptResults, DamagedFilesCountAsNone)
{
  keep(folder(), "picture", "a", { "some", "parts" });
  const fs::path file = files().at(0);
  const std::string whole = bytesOf(file);
  for (std::size_t at = 0; at < whole.size(); ++at)
  {
    std::string bytes = whole;
    bytes[at] = char(bytes[at] ^ 0x5A);
    write(file, bytes);
    EXPECT_FALSE(findKept(folder(), "picture", "a")) << at;
    write(file, whole.substr(0, at));
    EXPECT_FALSE(findKept(folder(), "picture", "a")) << at;
  }
  keep(folder(), "picture", "a", { "some", "parts" });
  EXPECT_TRUE(findKept(folder(), "picture", "a"));
}

TEST_F(KeptResults, WhatWasNotUsedForLongestGoesFirst)
{
  for (const char* key : { "a", "b", "c" })
  {
    keep(folder(), "picture", key, { std::string(1000, 'x') });
  }
  write(path("0123456789abcdef.nvdb"), std::string(1000, 'x'));
  write(path("mine.nvdb"), std::string(1000, 'x'));
  write(path("mine_too.kept"), std::string(1000, 'x'));
  int hours = 1;
  for (const fs::path& file : files())
  {
    useHoursAgo(file, ++hours);
  }
  useHoursAgo(path("0123456789abcdef.nvdb"), 50);
  ASSERT_TRUE(findKept(folder(), "picture", "b")); // is used now
  trimCacheFolder(folder(), 3500);
  EXPECT_FALSE(fs::exists(path("0123456789abcdef.nvdb")));
  EXPECT_EQ(files().size(), 5u);
  trimCacheFolder(folder(), 1);
  EXPECT_TRUE(findKept(folder(), "picture", "b"));
  EXPECT_EQ(files().size(), 3u);
  trimCacheFolder(folder(), 0);
  EXPECT_FALSE(findKept(folder(), "picture", "b"));
  EXPECT_TRUE(fs::exists(path("mine.nvdb")));
  EXPECT_TRUE(fs::exists(path("mine_too.kept")));
}

TEST_F(KeptResults, NothingIsKeptWhereNothingCanBe)
{
  write(folder(), "a file");
  keep(folder(), "picture", "a", someParts);
  EXPECT_FALSE(findKept(folder(), "picture", "a"));
  EXPECT_EQ(bytesOf(folder()), "a file");
}

TEST_F(KeptResults, KeysTellNumbersAndWordsApart)
{
  const auto two = [](const auto& a, const auto& b) { return KeyText().add(a).add(b).text(); };
  EXPECT_NE(two("ab", "c"), two("a", "bc"));
  EXPECT_NE(two(1.0, 2.0), two(2.0, 1.0));
  EXPECT_NE(two(0.1, 0.2), two(0.1, 0.2 + 1e-16));
  EXPECT_EQ(two(0.1, "x"), two(0.1, "x"));
}

TEST_F(KeptResults, FilesAreToldApartByTheirBytes)
{
  fs::create_directories(folder());
  std::string bytes(5000000, 'x');
  write(path("a"), bytes);
  const std::uint64_t hash = fileHash(path("a").string());
  write(path("b"), bytes);
  EXPECT_EQ(fileHash(path("b").string()), hash);
  for (const std::size_t at : { std::size_t(0), std::size_t(2097152), std::size_t(4999999) })
  {
    std::string other = bytes;
    other[at] = 'y';
    write(path("b"), other);
    EXPECT_NE(fileHash(path("b").string()), hash);
  }
  write(path("b"), bytes + "x");
  EXPECT_NE(fileHash(path("b").string()), hash);
  EXPECT_TRUE(fileStamp(path("none").string()).empty());
  expectContains(errorOf([&] { fileHash(path("none").string()); }), "no such file");
}
