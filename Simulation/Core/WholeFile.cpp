#include "Core/WholeFile.h"

#include <filesystem>
#include <random>

namespace sono {

WholeFile::WholeFile(const std::string& path)
  : path_(path)
  , part_(path + "." + std::to_string(std::random_device()()) + ".part")
  , stream_(part_, std::ios::binary | std::ios::trunc)
{
}

WholeFile::~WholeFile()
{
  stream_.close();
  if (!isWhole_)
  {
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }
}

bool WholeFile::finish()
{
  stream_.close();
  std::error_code error;
  if (stream_)
  {
    std::filesystem::rename(part_, path_, error);
  }
  isWhole_ = stream_ && !error;
  return isWhole_;
}

bool writeWholeFile(const std::string& path, const std::function<void(std::ostream&)>& write)
{
  WholeFile file(path);
  if (file.stream())
  {
    write(file.stream());
  }
  return file.finish();
}

} // namespace sono
