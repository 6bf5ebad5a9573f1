#pragma once

#include "Core/Error.h"

#include <functional>

namespace sono {

/// Called by long loops with the fraction done in [0, 1]; returning false asks the loop to stop.
/// May be empty. It is called from one thread at a time, not necessarily the caller's.
using Progress = std::function<bool(double)>;

/// The part [from, to] of a whole's progress.
inline Progress partOf(const Progress& whole, double from, double to)
{
  return whole ? Progress([=](double fraction) { return whole(from + fraction * (to - from)); }) : Progress{};
}

/// Reports `fraction`; throws Aborted when the callback asks to stop.
inline void report(const Progress& progress, double fraction)
{
  if (progress && !progress(fraction))
  {
    throw Aborted();
  }
}

} // namespace sono
