#pragma once

#include "Echo/ScattererView.h"
#include "Kernel/EchoSplat.h"

#include <vector>

namespace sono {

/// A line's scatterer sum before the pulse: sample s holds the sum of w a exp(-i 2 k (r - r_s)), each scatterer split
/// linearly between the two samples around its depth r, with its exact phase in both.
struct LineSum
{
  std::vector<float> iq; ///< re, im of each sample
  float sampleMm = 0.0f;
  double radPerMm = 0.0; ///< 2 k; 2 k sampleMm is below pi (Nyquist)

  int sampleCount() const { return int(iq.size() / 2); }
};

/// The grid of a sum's samples.
inline LineGrid lineGrid(const LineSum& sum)
{
  return makeLineGrid(sum.sampleMm, sum.radPerMm, sum.sampleCount());
}

/// Adds the scatterers at depths in [0, last sample). Beyond its last depth a field stays as it is there. `grid` is
/// that of the sum.
void splat(const ScattererView& scatterers, const Beam& beam, const LineGrid& grid, LineSum& sum);

} // namespace sono
