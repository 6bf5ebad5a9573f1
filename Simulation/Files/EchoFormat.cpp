#include "Files/EchoFormat.h"

#include "Core/EndsWith.h"
#include "Core/Error.h"

namespace sono {

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
