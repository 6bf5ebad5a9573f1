#pragma once

#include "Progress.h"

#include <string>

namespace sono {

/// Throws Error naming the setting, its value and its range when `ok` does not hold.
inline void requireInRange(bool ok, const std::string& parameter, double value, const std::string& range)
{
  if (!ok)
  {
    throw Error(parameter + " is " + std::to_string(value) + ": it must be " + range);
  }
}

} // namespace sono
