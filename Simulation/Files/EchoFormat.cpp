#include "Files/EchoFormat.h"

#include "Core/Error.h"

namespace sono {

namespace {

bool endsWith(const std::string& path, const std::string& ending)
{
  return path.size() > ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

} // namespace

EchoFormat echoFormatOf(const std::string& path)
{
  if (endsWith(path, ".hdf5") || endsWith(path, ".h5"))
  {
    return EchoFormat::Zea;
  }
  if (endsWith(path, ".uff"))
  {
    return EchoFormat::Uff;
  }
  throw Error("cannot write '" + path +
              "': lines and channels go into files that end in .hdf5 (zea) or .uff (USTB); give it such a name.");
}

} // namespace sono
