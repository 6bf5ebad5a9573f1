#include "Image/BModeSettings.h"

#include "Core/Require.h"
#include "Kernel/FastMath.h"

#include <cmath>
#include <limits>

namespace sono {

void BModeSettings::validate() const
{
  requireInRange(*this);
  requireInRange(automaticReference ||
                   (referenceAmplitude >= smallestNormalFloat && referenceAmplitude <= largestFiniteFloat),
                 "referenceAmplitude", referenceAmplitude, "in [1.2e-38, 3.4e38]");
  requireInRange(rejectDb < dynamicRangeDb, "rejectDb", rejectDb, "below dynamicRangeDb");
  double previousMm = -std::numeric_limits<double>::infinity();
  for (const auto& [depthMm, gain] : tgcCurve)
  {
    requireInRange(std::isfinite(depthMm) && depthMm > previousMm, "A depth of tgcCurve", depthMm,
                   "finite and greater than the depth before it, in mm");
    requireInRange(gain >= -300.0 && gain <= 300.0, "A gain of tgcCurve", gain, "in [-300, 300] dB");
    previousMm = depthMm;
  }
}

} // namespace sono
