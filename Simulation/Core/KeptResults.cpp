#include "Core/KeptResults.h"

#include "Core/Hash64.h"
#include "Core/WholeFile.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace sono {

namespace {

namespace fs = std::filesystem;

constexpr char magic[] = "sonovdb kept 1\n";
constexpr std::size_t magicBytes = sizeof(magic) - 1;
constexpr std::size_t hashBytes = sizeof(std::uint64_t);

fs::path pathOf(const std::string& folder, const std::string& kind, const std::string& key)
{
  return fs::path(folder) / (kind + '_' + hashDigits(hash64(key.data(), key.size())) + ".kept");
}

void append(const std::string& part, std::string& bytes)
{
  const std::uint64_t count = part.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof(count));
  bytes += part;
}

/// The parts of a file's content, the key first; none where it is damaged.
std::optional<std::vector<std::string>> partsOf(const std::string& bytes)
{
  constexpr std::size_t start = magicBytes + hashBytes;
  std::uint64_t hash = 0;
  if (bytes.size() < start || std::memcmp(bytes.data(), magic, magicBytes) != 0)
  {
    return std::nullopt;
  }
  std::memcpy(&hash, bytes.data() + magicBytes, hashBytes);
  if (hash != hash64(bytes.data() + start, bytes.size() - start))
  {
    return std::nullopt;
  }
  std::vector<std::string> parts;
  for (std::size_t at = start; at < bytes.size();)
  {
    std::uint64_t count = 0;
    if (bytes.size() - at < sizeof(count))
    {
      return std::nullopt;
    }
    std::memcpy(&count, bytes.data() + at, sizeof(count));
    at += sizeof(count);
    if (count > bytes.size() - at)
    {
      return std::nullopt;
    }
    parts.emplace_back(bytes, at, count);
    at += count;
  }
  return parts;
}

/// `<kind>_<16 digits>.kept` or `<16 digits>.nvdb`: others' files are left alone.
bool isOurs(const fs::path& path)
{
  const std::string stem = path.stem().string();
  const bool isScene = path.extension() == ".nvdb" && stem.size() == hashDigitCount;
  const bool isKept =
    path.extension() == ".kept" && stem.size() > hashDigitCount + 1 && stem[stem.size() - hashDigitCount - 1] == '_';
  return (isScene || isKept) &&
         stem.find_first_not_of("0123456789abcdef", stem.size() - hashDigitCount) == std::string::npos;
}

} // namespace

std::string userCacheFolder()
{
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  const char* const home = std::getenv("HOME");
  if (cache && *cache)
  {
    return (fs::path(cache) / "sonovdb").string();
  }
  return home && *home ? (fs::path(home) / ".cache" / "sonovdb").string() : std::string();
}

std::optional<std::vector<std::string>> findKept(const std::string& folder, const std::string& kind,
                                                 const std::string& key)
{
  const fs::path path = pathOf(folder, kind, key);
  std::ifstream stream(path, std::ios::binary);
  if (folder.empty() || !stream)
  {
    return std::nullopt;
  }
  auto parts = partsOf(std::string(std::istreambuf_iterator<char>(stream), {}));
  if (!parts || parts->empty() || parts->front() != key)
  {
    return std::nullopt;
  }
  markUsed(path.string());
  parts->erase(parts->begin());
  return parts;
}

void keep(const std::string& folder, const std::string& kind, const std::string& key,
          const std::vector<std::string>& parts)
{
  std::error_code error;
  fs::create_directories(folder, error);
  std::string content;
  append(key, content);
  for (const std::string& part : parts)
  {
    append(part, content);
  }
  const std::uint64_t hash = hash64(content.data(), content.size());
  const bool isKept = writeWholeFile(pathOf(folder, kind, key).string(), [&](std::ostream& stream) {
    stream.write(magic, magicBytes);
    stream.write(reinterpret_cast<const char*>(&hash), hashBytes);
    stream.write(content.data(), std::streamsize(content.size()));
  });
  if (isKept)
  {
    trimCacheFolder(folder);
  }
}

void markUsed(const std::string& path)
{
  std::error_code error;
  fs::last_write_time(path, fs::file_time_type::clock::now(), error);
}

void trimCacheFolder(const std::string& folder, std::uint64_t bytes)
{
  struct File
  {
    fs::file_time_type used;
    std::uint64_t bytes;
    fs::path path;
  };
  std::vector<File> files;
  std::uint64_t all = 0;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
  {
    if (isOurs(entry.path()) && entry.is_regular_file(error))
    {
      files.push_back({ entry.last_write_time(error), entry.file_size(error), entry.path() });
      all += files.back().bytes;
    }
  }
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.used < b.used; });
  const std::size_t most = bytes > 0 && !files.empty() ? files.size() - 1 : files.size();
  for (std::size_t n = 0; n < most && all > bytes; ++n)
  {
    fs::remove(files[n].path, error);
    all -= files[n].bytes;
  }
}

} // namespace sono
