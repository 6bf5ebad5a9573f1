#pragma once

#include "Kernel/BeamField.h"

#include <string>
#include <vector>

namespace sono {

/// Evenly spaced positions minMm + i stepMm, i in [0, count).
struct FieldAxis
{
  double minMm = 0.0;
  double stepMm = 1.0; ///< > 0
  int count = 1;       ///< >= 1; one value stands for half a step to either side

  double at(int i) const { return minMm + i * stepMm; }
  double maxMm() const { return at(count - 1); }
  bool operator==(const FieldAxis& other) const;
};

/// Where a beam's field is known, in the frame of a scan line: origin on the face, depth along the axis.
struct FieldGrid
{
  FieldAxis lateral;     ///< minMm 0: the half of a symmetric field; else minMm < 0 <= maxMm
  FieldAxis elevational; ///< the same
  FieldAxis depth;       ///< minMm >= 0

  std::size_t size() const { return std::size_t(lateral.count) * elevational.count * depth.count; }
  bool operator==(const FieldGrid& other) const;
  /// Throws Error naming the axis, and `what` (a file, or "the field").
  void validate(const std::string& what) const;
};

/// The two-way weight of a beam: what a scatterer at (lateral, elevational, depth) mm from a scan line adds to its RF,
/// as an amplitude. The largest value of the table is 1.
class PulseEchoField
{
public:
  /// `values` are lateral fastest, then elevational, then depth; they are scaled to a largest value of 1. Throws Error
  /// naming `what` and the axis when the grid makes no sense, the count differs, or a value is negative or not finite
  /// or all are zero.
  PulseEchoField(const FieldGrid& grid, std::vector<float> values, const std::string& what = "the pulse-echo field");

  const FieldGrid& grid() const { return grid_; }
  const std::vector<float>& values() const { return values_; }
  /// For lookups while this lives.
  BeamFieldView view() const { return view(values_.data()); }
  /// The same for a copy of the values that lies elsewhere.
  BeamFieldView view(const float* values) const;
  /// Furthest distance from the axis at which the weight is not 0, to find the scatterers that a beam sees.
  double lateralReachMm() const;
  double elevationalReachMm() const;

private:
  FieldGrid grid_;
  std::vector<float> values_;
};

} // namespace sono
