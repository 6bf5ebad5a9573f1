#include "Image/BModeSettings.h"

#include "Core/Require.h"
#include "Kernel/FastMath.h"

#include <cmath>

namespace sono {

namespace {

bool within(double value, double low, double high)
{
  return value >= low && value <= high; // false for NaN
}

} // namespace

void BModeSettings::validate() const
{
  requireInRange(within(tgcDbPerCm, -100.0, 100.0), "tgcDbPerCm", tgcDbPerCm, "in [-100, 100] dB/cm");
  requireInRange(within(gainDb, -300.0, 300.0), "gainDb", gainDb, "in [-300, 300] dB");
  requireInRange(automaticReference ||
                   (referenceAmplitude >= smallestNormalFloat && referenceAmplitude <= largestFiniteFloat),
                 "referenceAmplitude", referenceAmplitude, "in [1.2e-38, 3.4e38]");
  requireInRange(dynamicRangeDb > 0.0 && dynamicRangeDb <= 300.0, "dynamicRangeDb", dynamicRangeDb, "in (0, 300] dB");
  requireInRange(rejectDb >= 0.0 && rejectDb < dynamicRangeDb, "rejectDb", rejectDb, "in [0, dynamicRangeDb) dB");
  requireInRange(greyMap == GreyMap::Linear || greyMap == GreyMap::SquareRoot || greyMap == GreyMap::Sigmoid, "greyMap",
                 double(int(greyMap)), "linear (0), square root (1) or sigmoid (2)");
  requireInRange(noiseDb <= 200.0, "noiseDb", noiseDb, "at most 200 dB, or minus infinity for none");
  double previousMm = -std::numeric_limits<double>::infinity();
  for (const auto& [depthMm, gain] : tgcCurve)
  {
    requireInRange(std::isfinite(depthMm) && depthMm > previousMm, "A depth of tgcCurve", depthMm,
                   "finite and greater than the depth before it, in mm");
    requireInRange(within(gain, -300.0, 300.0), "A gain of tgcCurve", gain, "in [-300, 300] dB");
    previousMm = depthMm;
  }
}

} // namespace sono
