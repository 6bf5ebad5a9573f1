#pragma once

#include <algorithm>
#include <chrono>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace sono {

/// A stage of `measure`: a function that prints its figures. The file stages/<name>.cpp defines one and registers it by
/// a `const Stage` of that name; its first line is a comment that says what is measured.
class Stage
{
public:
  using Run = void (*)();
  Stage(const std::string& name, Run run) { all().emplace(name, run); }
  static std::map<std::string, Run>& all();
};

/// Prints one line, `name value unit`, with what is asked of it, if anything, behind: `(asked: at most 1)`.
void printFigure(const std::string& name, double value, const std::string& unit, const std::string& asked = "");

/// Largest resident memory of this process so far, in MB of 10^6 bytes.
double peakMegabytes();

/// Resident memory of this process now, the same unit.
double residentMegabytes();

inline double medianOf(std::vector<double> values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Seconds since the last lap or the construction.
class Stopwatch
{
public:
  double lap()
  {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

/// Of seven runs, in seconds.
template<class Work>
double medianSeconds(const Work& work)
{
  std::vector<double> seconds(7);
  for (double& each : seconds)
  {
    Stopwatch watch;
    work();
    each = watch.lap();
  }
  return medianOf(std::move(seconds));
}

} // namespace sono
