#include "Labels/ReadMeta.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"
#include "Labels/LabelConversion.h"
#include "Labels/VoxelFile.h"

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

NumberType typeOf(const Header& header)
{
  // MetaIO's long is 32 bits wide everywhere.
  static const std::map<std::string, NumberType> types = {
    { "MET_CHAR", NumberType::Int8 },       { "MET_UCHAR", NumberType::UInt8 },
    { "MET_SHORT", NumberType::Int16 },     { "MET_USHORT", NumberType::UInt16 },
    { "MET_INT", NumberType::Int32 },       { "MET_UINT", NumberType::UInt32 },
    { "MET_LONG", NumberType::Int32 },      { "MET_ULONG", NumberType::UInt32 },
    { "MET_LONG_LONG", NumberType::Int64 }, { "MET_ULONG_LONG", NumberType::UInt64 },
    { "MET_FLOAT", NumberType::Float32 },   { "MET_DOUBLE", NumberType::Float64 },
  };
  const auto type = types.find(header.text({ "ElementType" }));
  const std::string channels = header.text({ "ElementNumberOfChannels" }, "1");
  if (channels != "1")
  {
    refuse(header.path, "it is a colour image or a field of vectors with " + channels +
                          " channels; choose the segmentation or scan that it was made from");
  }
  if (type == types.end())
  {
    refuse(header.path,
           "its voxels are '" + header.text({ "ElementType" }) + "'; convert it to whole numbers or floats");
  }
  return type->second;
}

/// The data file, or the part of the header's own file, at its first voxel.
ByteStream dataOf(const Header& header, std::uint64_t dataBytes)
{
  const std::string name = header.text({ "ElementDataFile" });
  const bool local = name == "LOCAL" || name == "Local" || name == "local";
  if (name.find('%') != std::string::npos || name.compare(0, 4, "LIST") == 0)
  {
    refuse(header.path, "its voxels are spread over several files; save it as one");
  }
  const std::string path = local ? header.path : (fs::path(header.path).parent_path() / name).string();
  std::error_code error;
  if (!fs::is_regular_file(path, error) || !std::ifstream(path))
  {
    refuse(header.path, "its data file '" + name + "' is missing; put it beside the header");
  }
  const auto skip = header.numbers({ "HeaderSize" }, 1);
  std::uint64_t start = local ? header.bytes : 0;
  if (!skip.empty() && !local)
  {
    if (!(skip[0] < 9.0e15))
    {
      refuse(header.path, "its header has " + header.text({ "HeaderSize" }) + " for HeaderSize; correct it");
    }
    // -1: the data are the file's last bytes.
    const std::uint64_t fileBytes = fs::file_size(path, error);
    start = skip[0] >= 0.0 ? std::uint64_t(skip[0]) : (fileBytes > dataBytes ? fileBytes - dataBytes : 0);
  }
  const bool deflated = header.flag({ "CompressedData" });
  return ByteStream(path, start, deflated ? ByteStream::Packing::Deflate : ByteStream::Packing::None, header.path);
}

} // namespace

VoxelFile openMeta(const std::string& path)
{
  const Header header = readHeader(path);
  const GridPlacement placement = placementOf(header);
  const NumberType type = typeOf(header);
  if (!header.flag({ "BinaryData" }))
  {
    refuse(path, "its voxels are written as text; save it as binary data");
  }
  const bool mostSignificantFirst = header.flag({ "BinaryDataByteOrderMSB", "ElementByteOrderMSB" });
  return { path,
           placement,
           type,
           mostSignificantFirst,
           1.0,
           0.0,
           1,
           false,
           dataOf(header, std::uint64_t(placement.voxelCount()) * bytesOf(type)) };
}

LabelVolume readMeta(const std::string& path, const Progress& progress)
{
  VoxelFile file = openMeta(path);
  LabelVolume volume;
  volume.placement = file.placement;
  volume.voxels = readLabelNumbers(file, progress);
  return volume;
}

} // namespace sono
