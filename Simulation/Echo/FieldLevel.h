#pragma once

#include "Probe/PulseEchoField.h"

#include <vector>

namespace sono {

/// How strongly a beam echoes what is wider than itself. Scatterers all over a depth, or a rough surface across it, add
/// up as A(z) = integral of w^2 over the lateral and elevational axes: their rms echo goes with its root. On its axis
/// alone a beam falls faster behind its focus, since it widens there. Data/docs/physics.md section 4.4.
class FieldLevel
{
public:
  /// Throws Error when the field is zero on its whole axis.
  explicit FieldLevel(const PulseEchoField& field);

  /// A(z) at the focus: the depth where the weight on the axis is largest.
  double focusAreaMm2() const { return focusAreaMm2_; }
  double focusMm() const { return focusMm_; }
  /// Root of A(z) over that of the focus, linear between the table's depths; 0 in front of the first, behind the last
  /// as there.
  double at(double depthMm) const;

private:
  FieldAxis depth_;
  double focusAreaMm2_ = 0.0;
  double focusMm_ = 0.0;
  std::vector<double> level_; // at each depth of the table
};

} // namespace sono
