#pragma once

#include "Trace/Trace.h"

#include <string>

namespace sono::test {

/// As figures and tables write it.
inline std::string nameOf(Sampling sampling)
{
  switch (sampling)
  {
    case Sampling::Independent:
      return "independent";
    case Sampling::LowDiscrepancy:
      return "low_discrepancy";
  }
  return "";
}

} // namespace sono::test
