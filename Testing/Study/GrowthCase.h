#pragma once

#include <string>
#include <vector>

namespace sono::study {

/// What is made larger, and how large it is in turn.
struct GrowthAxis
{
  std::string name;  ///< one word
  std::string label; ///< with its unit
  std::vector<double> values;
};

/// labels, volume, lines, depth, elevations, cores.
std::vector<GrowthAxis> growthAxes(bool quick);

/// What one value costs.
struct GrowthCost
{
  /// By the wall, and of all cores together, which other programs hardly touch.
  struct Seconds
  {
    double wall = 0.0;
    double core = 0.0;
  };
  Seconds scene;       ///< from the label map to the scene
  Seconds first;       ///< its first picture, which lays out what the fan reaches
  Seconds next;        ///< one more with other paths, median of three
  double peakMb = 0.0; ///< largest resident memory of the process, 10^6 bytes
};

/// Builds the scene and makes the pictures through the Simulator. Peak memory is that of all this process has done: one
/// case a process.
GrowthCost runGrowthCase(const std::string& axis, double value, bool quick);

} // namespace sono::study
