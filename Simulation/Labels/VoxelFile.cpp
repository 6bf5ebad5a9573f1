#include "Labels/VoxelFile.h"

#include "Labels/ReadMeta.h"
#include "Labels/ReadNifti.h"
#include "Labels/ReadNrrd.h"

#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace sono {

std::size_t bytesOf(NumberType type)
{
  switch (type)
  {
    case NumberType::Int8:
    case NumberType::UInt8:
      return 1;
    case NumberType::Int16:
    case NumberType::UInt16:
      return 2;
    case NumberType::Int32:
    case NumberType::UInt32:
    case NumberType::Float32:
      return 4;
    case NumberType::Int64:
    case NumberType::UInt64:
    case NumberType::Float64:
      break;
  }
  return 8;
}

void swapBytes(void* numbers, std::size_t bytesEach, std::size_t count)
{
  char* const bytes = static_cast<char*>(numbers);
  for (std::size_t n = 0; bytesEach > 1 && n < count; ++n)
  {
    std::reverse(bytes + n * bytesEach, bytes + (n + 1) * bytesEach);
  }
}

std::string voxelFileEnding(const std::string& path)
{
  std::string lower = path;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  for (const std::string ending : { ".nii.gz", ".nii", ".seg.nrrd", ".nrrd", ".nhdr", ".mha", ".mhd" })
  {
    if (lower.size() > ending.size() && lower.compare(lower.size() - ending.size(), ending.size(), ending) == 0)
    {
      return ending;
    }
  }
  return {};
}

bool isDicomFile(const std::string& path)
{
  char magic[4] = {};
  std::ifstream stream(path, std::ios::binary);
  stream.seekg(128);
  stream.read(magic, sizeof(magic));
  return stream && std::memcmp(magic, "DICM", sizeof(magic)) == 0;
}

void needVoxelFile(const std::string& path, int phase)
{
  const std::string ending = voxelFileEnding(path);
  if (ending.empty())
  {
    throw Error("cannot read '" + path +
                "': its name ends in none of .nii, .nii.gz, .nrrd, .nhdr, .seg.nrrd, .mha, .mhd, and it is neither "
                "DICOM nor a folder of "
                "masks; convert it.");
  }
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || !std::ifstream(path))
  {
    throw Error("cannot read '" + path + "': no such file, or no permission to read it.");
  }
  if (phase != 0 && !isNiftiName(path))
  {
    throw Error("'" + path + "' holds one volume, so phase " + std::to_string(phase) + " is not in it; choose 0.");
  }
}

bool isNiftiName(const std::string& path)
{
  return voxelFileEnding(path).compare(0, 4, ".nii") == 0;
}

bool isMetaName(const std::string& path)
{
  return voxelFileEnding(path).compare(0, 3, ".mh") == 0;
}

VoxelFile openVoxels(const std::string& path, int phase)
{
  needVoxelFile(path, phase);
  if (isMetaName(path))
  {
    return openMeta(path);
  }
  return isNiftiName(path) ? openNifti(path, phase) : openNrrd(path);
}

} // namespace sono
