#include "Core/WholeFile.h"

#include <filesystem>
#include <fstream>
#include <random>

namespace sono {

bool writeWholeFile(const std::string& path, const std::function<void(std::ostream&)>& write)
{
  const std::string partial = path + "." + std::to_string(std::random_device()()) + ".part";
  std::ofstream stream(partial, std::ios::binary | std::ios::trunc);
  if (!stream)
  {
    return false;
  }
  write(stream);
  stream.close();
  std::error_code error;
  if (stream)
  {
    std::filesystem::rename(partial, path, error);
  }
  if (stream && !error)
  {
    return true;
  }
  std::filesystem::remove(partial, error);
  return false;
}

} // namespace sono
