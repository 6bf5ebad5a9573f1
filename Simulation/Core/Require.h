#pragma once

#include "Core/Error.h"

#include <sstream>
#include <string>

namespace sono {

/// Throws Error naming the setting, its value and its range when `ok` does not hold.
inline void requireInRange(bool ok, const std::string& parameter, double value, const std::string& range)
{
  if (!ok)
  {
    std::ostringstream sentence;
    sentence << parameter << " is " << value << ": it must be " << range;
    throw Error(sentence.str());
  }
}

} // namespace sono
