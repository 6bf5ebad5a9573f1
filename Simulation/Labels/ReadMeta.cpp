#include "Labels/ReadMeta.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"
#include "Labels/LabelConversion.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace sono {

namespace {

namespace fs = std::filesystem;

constexpr double maxVoxels = 4294967296.0;

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
  throw Error("cannot read '" + path + "': " + why + ".");
}

/// The `key = value` lines of a header, which ends with ElementDataFile.
struct Header
{
  std::string path;
  std::map<std::string, std::string> values;
  std::uint64_t bytes = 0; ///< of the header

  std::string text(const std::initializer_list<const char*>& keys, const std::string& otherwise = {}) const
  {
    for (const char* key : keys)
    {
      const auto at = values.find(key);
      if (at != values.end())
      {
        return at->second;
      }
    }
    return otherwise;
  }
  bool flag(const std::initializer_list<const char*>& keys) const
  {
    const std::string value = text(keys, "False");
    return !value.empty() && (value[0] == 'T' || value[0] == 't' || value[0] == '1');
  }
  /// `count` numbers of a key; empty when it is absent.
  std::vector<double> numbers(const std::initializer_list<const char*>& keys, std::size_t count) const
  {
    const std::string value = text(keys);
    std::vector<double> list;
    std::istringstream words(value);
    for (std::string word; words >> word;)
    {
      const auto number = parseNumber(word);
      if (!number)
      {
        refuse(path, "its header has '" + word + "' for a number of " + *keys.begin() + "; correct it");
      }
      list.push_back(*number);
    }
    if (!value.empty() && list.size() != count)
    {
      refuse(path, "its header has " + std::to_string(list.size()) + " numbers for " + *keys.begin() + " where " +
                     std::to_string(count) + " belong; correct it");
    }
    return list;
  }
};

std::string trimmed(const std::string& text)
{
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

Header readHeader(const std::string& path)
{
  constexpr std::uint64_t longest = 1 << 20;
  Header header;
  header.path = path;
  std::ifstream stream(path, std::ios::binary);
  for (std::string line; header.bytes < longest && std::getline(stream, line);)
  {
    header.bytes += line.size() + 1;
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos)
    {
      break;
    }
    const std::string key = trimmed(line.substr(0, equals));
    header.values[key] = trimmed(line.substr(equals + 1));
    if (key == "ElementDataFile")
    {
      return header;
    }
  }
  refuse(path, "it is no MetaImage file, or its header ends too early");
}

GridPlacement placementOf(const Header& header)
{
  const auto dimensions = header.numbers({ "NDims" }, 1);
  if (dimensions.empty() || dimensions[0] != 3.0)
  {
    refuse(header.path, "it has " + header.text({ "NDims" }, "no") + " axes; a label map has three");
  }
  const auto sizes = header.numbers({ "DimSize" }, 3);
  if (sizes.empty())
  {
    refuse(header.path, "its header lacks DimSize");
  }
  Vec3i size(0);
  for (int a = 0; a < 3; ++a)
  {
    if (!(sizes[std::size_t(a)] >= 0.0 && sizes[std::size_t(a)] <= 65535.0))
    {
      refuse(header.path, "its header claims " + header.text({ "DimSize" }) + " voxels; correct it");
    }
    size[a] = int(sizes[std::size_t(a)]);
  }
  if (sizes[0] * sizes[1] * sizes[2] > maxVoxels)
  {
    refuse(header.path, "its header claims " + header.text({ "DimSize" }) + " voxels, more than a label map may have");
  }
  auto spacing = header.numbers({ "ElementSpacing", "ElementSize" }, 3);
  auto offset = header.numbers({ "Offset", "Position", "Origin" }, 3);
  auto matrix = header.numbers({ "TransformMatrix", "Rotation", "Orientation" }, 9);
  spacing = spacing.empty() ? std::vector<double>(3, 1.0) : spacing;
  offset = offset.empty() ? std::vector<double>(3, 0.0) : offset;
  matrix = matrix.empty() ? std::vector<double>{ 1, 0, 0, 0, 1, 0, 0, 0, 1 } : matrix;
  Mat3d columns(0.0);
  Vec3d origin(0.0);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    origin[int(axis)] = offset[axis];
    for (std::size_t row = 0; row < 3; ++row)
    {
      columns[int(axis)][int(row)] = matrix[3 * axis + row] * spacing[axis];
    }
  }
  return placementFromAffine(size, columns, origin, header.path);
}

struct ElementType
{
  std::size_t bytes;
  void (*append)(const LabelConversion&, std::vector<std::uint16_t>&, const void*, std::size_t);
};

template<class T>
ElementType elementType()
{
  return { sizeof(T), [](const LabelConversion& conversion, std::vector<std::uint16_t>& labels, const void* data,
                         std::size_t count) { conversion.append(labels, static_cast<const T*>(data), count); } };
}

ElementType typeOf(const Header& header)
{
  // MetaIO's long is 32 bits wide everywhere.
  static const std::map<std::string, ElementType> types = {
    { "MET_CHAR", elementType<std::int8_t>() },
    { "MET_UCHAR", elementType<std::uint8_t>() },
    { "MET_SHORT", elementType<std::int16_t>() },
    { "MET_USHORT", elementType<std::uint16_t>() },
    { "MET_INT", elementType<std::int32_t>() },
    { "MET_UINT", elementType<std::uint32_t>() },
    { "MET_LONG", elementType<std::int32_t>() },
    { "MET_ULONG", elementType<std::uint32_t>() },
    { "MET_LONG_LONG", elementType<std::int64_t>() },
    { "MET_ULONG_LONG", elementType<std::uint64_t>() },
    { "MET_FLOAT", elementType<float>() },
    { "MET_DOUBLE", elementType<double>() },
  };
  const auto type = types.find(header.text({ "ElementType" }));
  if (type == types.end() || header.text({ "ElementNumberOfChannels" }, "1") != "1")
  {
    refuse(header.path, "its voxels are '" + header.text({ "ElementType" }) + "' with " +
                          header.text({ "ElementNumberOfChannels" }, "1") +
                          " channels; a label map holds whole numbers 0..65535");
  }
  return type->second;
}

/// Bytes of the data file from the data's beginning to the file's end.
std::vector<char> storedBytes(const Header& header, std::uint64_t dataBytes)
{
  const std::string name = header.text({ "ElementDataFile" });
  const bool local = name == "LOCAL" || name == "Local" || name == "local";
  if (name.find('%') != std::string::npos || name.compare(0, 4, "LIST") == 0)
  {
    refuse(header.path, "its voxels are spread over several files; save it as one");
  }
  const std::string path = local ? header.path : (fs::path(header.path).parent_path() / name).string();
  std::error_code error;
  std::ifstream stream(path, std::ios::binary);
  if (!stream || !fs::is_regular_file(path, error))
  {
    refuse(header.path, "its data file '" + name + "' is missing; put it beside the header");
  }
  const std::uint64_t fileBytes = fs::file_size(path, error);
  const auto skip = header.numbers({ "HeaderSize" }, 1);
  std::uint64_t start = local ? header.bytes : 0;
  if (!skip.empty() && !local)
  {
    // -1: the data are the file's last bytes.
    start = skip[0] >= 0.0 ? std::uint64_t(skip[0]) : (fileBytes > dataBytes ? fileBytes - dataBytes : 0);
  }
  std::vector<char> bytes(fileBytes > start ? fileBytes - start : 0);
  stream.seekg(std::streamoff(start));
  stream.read(bytes.data(), std::streamsize(bytes.size()));
  return bytes;
}

std::vector<char> inflated(const std::vector<char>& stored, std::uint64_t dataBytes, const std::string& truncated)
{
  std::vector<char> data(dataBytes);
  z_stream stream{};
  inflateInit2(&stream, 15 + 32); // zlib or gzip, by its first bytes
  std::size_t given = 0;
  std::size_t taken = 0;
  int status = Z_OK;
  while (status == Z_OK)
  {
    constexpr std::size_t chunk = std::size_t(1) << 30; // zlib counts in 32 bits
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(stored.data() + given));
    stream.avail_in = uInt(std::min(chunk, stored.size() - given));
    stream.next_out = reinterpret_cast<Bytef*>(data.data() + taken);
    stream.avail_out = uInt(std::min(chunk, data.size() - taken));
    const uInt in = stream.avail_in;
    const uInt out = stream.avail_out;
    status = inflate(&stream, Z_NO_FLUSH);
    given += in - stream.avail_in;
    taken += out - stream.avail_out;
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END || taken != dataBytes)
  {
    throw Error(truncated);
  }
  return data;
}

} // namespace

LabelVolume readMeta(const std::string& path)
{
  const Header header = readHeader(path);
  LabelVolume volume;
  volume.placement = placementOf(header);
  const ElementType type = typeOf(header);
  if (!header.flag({ "BinaryData" }))
  {
    refuse(path, "its voxels are written as text; save it as binary data");
  }
  const std::size_t count = volume.placement.voxelCount();
  const std::uint64_t dataBytes = std::uint64_t(count) * type.bytes;
  const std::string truncated =
    "cannot read '" + path + "': its voxel data end too early or are damaged; copy it again.";
  std::vector<char> data = storedBytes(header, dataBytes);
  if (header.flag({ "CompressedData" }))
  {
    data = inflated(data, dataBytes, truncated);
  }
  if (data.size() < dataBytes)
  {
    throw Error(truncated);
  }
  if (header.flag({ "BinaryDataByteOrderMSB", "ElementByteOrderMSB" }))
  {
    for (std::size_t n = 0; n < count; ++n)
    {
      std::reverse(data.begin() + std::ptrdiff_t(n * type.bytes), data.begin() + std::ptrdiff_t((n + 1) * type.bytes));
    }
  }
  LabelConversion conversion;
  conversion.path = path;
  conversion.size = volume.placement.size;
  volume.voxels.reserve(count);
  type.append(conversion, volume.voxels, data.data(), count);
  return volume;
}

} // namespace sono
