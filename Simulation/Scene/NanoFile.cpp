#include "Scene/NanoFile.h"

#include "Core/Hash64.h"
#include "Core/ParallelFor.h"
#include "Core/WholeFile.h"
#include "Scene/NanoGridStorage.h"

#include <nanovdb/util/GridChecksum.h>
#include <nanovdb/util/IO.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace sono {

namespace {

namespace fs = std::filesystem;
namespace io = nanovdb::io;
using Buffer = nanovdb::HostBuffer;
using Handle = nanovdb::GridHandle<Buffer>;

constexpr char blindName[] = "sonovdb";
constexpr std::size_t headerBytes = sizeof(nanovdb::GridData);
constexpr std::uint32_t longestName = 256;

const nanovdb::GridData& headerOf(const Handle& handle)
{
  return *reinterpret_cast<const nanovdb::GridData*>(handle.data());
}

/// Bytes of header and tree, without blind data.
std::size_t treeEnd(const Handle& handle)
{
  const nanovdb::GridData& header = headerOf(handle);
  return header.mBlindMetadataCount > 0 ? std::size_t(header.mBlindMetadataOffset) : handle.size();
}

std::string fingerprint(const Handle& handle)
{
  std::ostringstream text;
  text << std::hex << hash64(handle.data() + headerBytes, treeEnd(handle) - headerBytes);
  return text.str();
}

/// A copy of a grid with `text` as its only blind data.
Handle withText(const Handle& handle, const std::string& text)
{
  const std::size_t tree = treeEnd(handle);
  const std::size_t payload = sizeof(std::uint64_t) + text.size();
  const std::size_t padded = (payload + NANOVDB_DATA_ALIGNMENT - 1) / NANOVDB_DATA_ALIGNMENT * NANOVDB_DATA_ALIGNMENT;
  const std::size_t size = tree + sizeof(nanovdb::GridBlindMetaData) + padded;
  Handle copy(Buffer::create(size));
  std::memcpy(copy.data(), handle.data(), tree);
  std::memset(copy.data() + tree, 0, size - tree);
  auto* header = reinterpret_cast<nanovdb::GridData*>(copy.data());
  header->mGridSize = size;
  header->mBlindMetadataOffset = std::int64_t(tree);
  header->mBlindMetadataCount = 1;
  auto* blind = reinterpret_cast<nanovdb::GridBlindMetaData*>(copy.data() + tree);
  blind->mByteOffset = sizeof(nanovdb::GridBlindMetaData); // from here, as getBlindData has it
  blind->mElementCount = payload;
  blind->mSemantic = nanovdb::GridBlindDataSemantic::Unknown;
  blind->mDataClass = nanovdb::GridBlindDataClass::Unknown;
  blind->mDataType = nanovdb::GridType::Unknown;
  std::memcpy(blind->mName, blindName, sizeof(blindName));
  auto* data = copy.data() + tree + sizeof(nanovdb::GridBlindMetaData);
  const std::uint64_t hash = hash64(text.data(), text.size());
  std::memcpy(data, &hash, sizeof(hash));
  std::memcpy(data + sizeof(hash), text.data(), text.size());
  if (auto* grid = copy.grid<std::int32_t>())
  {
    nanovdb::updateChecksum(*grid); // it covers the header
  }
  return copy;
}

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
  throw Error("cannot read '" + path + "': " + why + ".");
}

const std::string damaged = "it is damaged; write or copy it again";

/// The segment's header, checked against the file's size before anything is allocated after it.
io::Segment readSegment(const std::string& path, std::ifstream& stream, std::uint64_t fileBytes)
{
  io::Segment segment;
  stream.read(reinterpret_cast<char*>(&segment.header), sizeof(segment.header));
  if (!stream || segment.header.magic != NANOVDB_MAGIC_NUMBER)
  {
    refuse(path, "it is no NanoVDB file; choose a scene that SonoVDB wrote");
  }
  const std::uint32_t major = segment.header.version.getMajor();
  if (major != NANOVDB_MAJOR_VERSION_NUMBER)
  {
    refuse(path, "it was written with NanoVDB " + std::to_string(major) + ", this program reads NanoVDB " +
                   std::to_string(NANOVDB_MAJOR_VERSION_NUMBER) + "; write the scene again");
  }
  if (segment.header.codec != io::Codec::NONE)
  {
    refuse(path, "it is compressed; write it without compression");
  }
  std::uint64_t bytes = sizeof(segment.header);
  segment.meta.resize(segment.header.gridCount);
  for (io::GridMetaData& meta : segment.meta)
  {
    stream.read(reinterpret_cast<char*>(static_cast<io::MetaData*>(&meta)), sizeof(io::MetaData));
    if (!stream || meta.nameSize == 0 || meta.nameSize > longestName || meta.fileSize != meta.gridSize ||
        meta.gridSize > fileBytes || meta.gridSize < headerBytes)
    {
      refuse(path, stream ? damaged : "it ends too early; copy it again");
    }
    meta.gridName.resize(meta.nameSize);
    stream.read(meta.gridName.data(), meta.nameSize);
    meta.gridName.resize(meta.nameSize - 1);
    bytes += sizeof(io::MetaData) + meta.nameSize + meta.fileSize;
  }
  if (bytes != fileBytes)
  {
    refuse(path, bytes > fileBytes ? "it ends too early; copy it again" : damaged);
  }
  return segment;
}

bool headerAgrees(const Handle& handle, const io::GridMetaData& meta)
{
  const nanovdb::GridData& header = headerOf(handle);
  const auto size = std::int64_t(handle.size());
  return header.mMagic == NANOVDB_MAGIC_NUMBER && header.mGridSize == handle.size() && header.mGridCount == 1 &&
         header.mGridIndex == 0 && header.mGridType == meta.gridType &&
         (header.mBlindMetadataCount == 0 ||
          (header.mBlindMetadataOffset >= std::int64_t(headerBytes) && header.mBlindMetadataOffset <= size));
}

/// The text of ours; empty when the grid has none.
std::string textOf(const std::string& path, const Handle& handle)
{
  const std::size_t tree = treeEnd(handle);
  const std::size_t dataAt = tree + sizeof(nanovdb::GridBlindMetaData);
  if (headerOf(handle).mBlindMetadataCount != 1 || dataAt + sizeof(std::uint64_t) > handle.size())
  {
    return {};
  }
  const auto* blind = reinterpret_cast<const nanovdb::GridBlindMetaData*>(handle.data() + tree);
  if (std::memcmp(blind->mName, blindName, sizeof(blindName)) != 0)
  {
    return {};
  }
  std::uint64_t hash = 0;
  if (blind->mElementCount < sizeof(hash) || blind->mElementCount > handle.size() - dataAt)
  {
    refuse(path, damaged);
  }
  const auto* data = reinterpret_cast<const char*>(handle.data() + dataAt);
  std::memcpy(&hash, data, sizeof(hash));
  std::string text(data + sizeof(hash), blind->mElementCount - sizeof(hash));
  if (hash64(text.data(), text.size()) != hash)
  {
    refuse(path, damaged);
  }
  return text;
}

} // namespace

void writeNanoFile(const std::string& path, const std::vector<const NanoGrid*>& grids, const std::string& text,
                   const std::vector<std::uint8_t>& bytes)
{
  std::vector<std::string> prints(grids.size());
  parallelFor(int(grids.size()), {},
              [&](int n) { prints[std::size_t(n)] = fingerprint(grids[std::size_t(n)]->storage->handle); });
  std::string whole;
  for (const std::string& print : prints)
  {
    whole += print + " ";
  }
  whole += "\n" + text;
  if (!bytes.empty())
  {
    whole += '\n';
    whole.append(bytes.begin(), bytes.end());
  }
  const Handle first = withText(grids.front()->storage->handle, whole);

  io::Segment segment(io::Codec::NONE);
  for (std::size_t n = 0; n < grids.size(); ++n)
  {
    segment.add(n == 0 ? first : grids[n]->storage->handle);
    segment.meta.back().fileSize = segment.meta.back().gridSize;
  }
  const bool isWritten = writeWholeFile(path, [&](std::ostream& stream) {
    segment.write(stream);
    for (std::size_t n = 0; n < grids.size(); ++n)
    {
      const Handle& handle = n == 0 ? first : grids[n]->storage->handle;
      stream.write(reinterpret_cast<const char*>(handle.data()), std::streamsize(handle.size()));
    }
  });
  if (!isWritten)
  {
    throw Error("cannot write '" + path + "': the folder is missing or protected, or the disk is full.");
  }
}

NanoFile readNanoFile(const std::string& path)
{
  std::error_code error;
  std::ifstream stream(path, std::ios::binary);
  if (!stream || !fs::is_regular_file(path, error))
  {
    refuse(path, "no such file, or no permission to read it");
  }
  const std::uint64_t fileBytes = fs::file_size(path, error);
  const io::Segment segment = readSegment(path, stream, fileBytes);

  NanoFile file;
  std::vector<std::uint64_t> start{ std::uint64_t(stream.tellg()) };
  for (const io::GridMetaData& meta : segment.meta)
  {
    start.push_back(start.back() + meta.fileSize);
    file.names.push_back(meta.gridName);
    file.grids.emplace_back();
  }
  std::vector<std::string> prints(segment.meta.size());
  parallelFor(int(segment.meta.size()), {}, [&](int n) {
    const io::GridMetaData& meta = segment.meta[std::size_t(n)];
    NanoGrid& grid = file.grids[std::size_t(n)];
    grid.storage = std::make_unique<NanoGrid::Storage>();
    Handle& handle = grid.storage->handle;
    handle = Handle(Buffer::create(meta.gridSize));
    std::ifstream part(path, std::ios::binary);
    part.seekg(std::streamoff(start[std::size_t(n)]));
    part.read(reinterpret_cast<char*>(handle.data()), std::streamsize(meta.gridSize));
    if (!part || !headerAgrees(handle, meta))
    {
      refuse(path, damaged);
    }
    prints[std::size_t(n)] = fingerprint(handle);
  });

  const std::string whole = file.grids.empty() ? "" : textOf(path, file.grids.front().storage->handle);
  if (whole.empty())
  {
    refuse(path, "it is a NanoVDB file but no scene of SonoVDB; choose one that SonoVDB wrote");
  }
  std::string expected;
  for (const std::string& print : prints)
  {
    expected += print + " ";
  }
  const std::size_t lineEnd = std::min(whole.find('\n'), whole.size());
  if (whole.compare(0, lineEnd, expected) != 0)
  {
    refuse(path, damaged);
  }
  const std::size_t textAt = std::min(lineEnd + 1, whole.size());
  const std::size_t textEnd = std::min(whole.find('\n', textAt), whole.size());
  file.text = whole.substr(textAt, textEnd - textAt);
  file.bytes.assign(whole.begin() + std::ptrdiff_t(std::min(textEnd + 1, whole.size())), whole.end());
  return file;
}

} // namespace sono
