#pragma once

#include "Probe/PulseEchoField.h"

#include <vector>

namespace sono {

struct EchoSettings;

/// What the levels of tissues need to know of a beam's weight w, whose peak is 1 at the focus.
class BeamArea
{
public:
  /// Throws Error when the settings' field is zero on its whole axis.
  explicit BeamArea(const EchoSettings& settings);

  /// A_b, the integral of |w| across the beam at the focus, mm^2: 2 pi sL sE for a Gaussian.
  double focusMm2() const { return focusMm2_; }
  /// The resolution cell's area at a depth, mm^2, however strong the beam is there: pi sL sE for a Gaussian, in general
  /// (integral of |w|)^2 / (4 integral of w^2), which is the same.
  double cellMm2(double depthMm) const;

private:
  double focusMm2_ = 0.0;
  FieldAxis depth_;
  std::vector<double> cellMm2_; // at each depth of the field; one value for a Gaussian
};

} // namespace sono
