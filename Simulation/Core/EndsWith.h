#pragma once

#include <string>

namespace sono {

/// Whether a name has this ending, and something before it.
inline bool endsWith(const std::string& name, const std::string& ending)
{
  return name.size() > ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

} // namespace sono
