#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace sono {

/// Called by long loops with the fraction done in [0, 1]; returning false asks the loop to stop.
/// May be empty. It is called from one thread at a time, not necessarily the caller's.
using Progress = std::function<bool(double)>;

/// The part [from, to] of a whole's progress.
inline Progress partOf(const Progress& whole, double from, double to)
{
  return whole ? Progress([=](double fraction) { return whole(from + fraction * (to - from)); }) : Progress{};
}

/// Bad input. The message is one sentence that names the file, label or parameter and the way out.
class Error : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Thrown when a Progress callback returned false. Not an error: nothing is wrong with the input.
class Aborted : public std::exception
{
public:
  const char* what() const noexcept override { return "stopped at the user's request"; }
};

/// Reports `fraction`; throws Aborted when the callback asks to stop.
inline void report(const Progress& progress, double fraction)
{
  if (progress && !progress(fraction))
  {
    throw Aborted();
  }
}

} // namespace sono
