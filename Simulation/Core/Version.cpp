#include "Core/Version.h"

namespace sono {

const char* version()
{
  return SONOVDB_VERSION;
}

} // namespace sono
