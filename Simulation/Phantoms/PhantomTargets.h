#pragma once

#include <string>
#include <vector>

namespace sono {

enum class PhantomTargetKind
{
  Wire,    ///< a thin cylinder, whose centre an image is measured against
  Cylinder ///< a region of another echo level
};

/// A target of a calibration phantom: a cylinder along the elevation axis, in one of the phantom's views.
struct PhantomTarget
{
  PhantomTargetKind kind = PhantomTargetKind::Wire;
  int view = 1;            ///< 1 to phantomViewCount
  std::string name;        ///< of a wire, the group it belongs to
  double lateralMm = 0.0;  ///< of the centre, from the middle of the view
  double depthMm = 0.0;    ///< of the centre, from the phantom's surface, > 0
  double diameterMm = 0.0; ///< > 0
  std::string tissue;      ///< a row of the tissue table
};

constexpr int phantomViewCount = 3;

/// Reads targets from a CSV file with the columns kind ("wire" or "cylinder"), view, name, lateral_mm, depth_mm,
/// diameter_mm and tissue. Throws Error naming file, line and column for a missing or bad value, and for a file
/// without targets.
std::vector<PhantomTarget> readPhantomTargets(const std::string& path);

} // namespace sono
