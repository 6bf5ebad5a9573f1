#include "Image/BModeSettings.h"

#include "Core/Require.h"
#include "Kernel/GreyLevel.h"

#include <cmath>

namespace sono {

void BModeSettings::validate() const
{
  requireInRange(*this);
  requireInRange(automaticReference ||
                   (referenceAmplitude >= smallestNormalFloat && referenceAmplitude <= largestFiniteFloat),
                 "referenceAmplitude", referenceAmplitude, "in [1.2e-38, 3.4e38]");
  requireInRange(rejectDb < dynamicRangeDb, "rejectDb", rejectDb, "below dynamicRangeDb");
  requireInRange(pulseSigmaMm > 0.0 && std::isfinite(pulseSigmaMm), "pulseSigmaMm", pulseSigmaMm, "above 0 and finite");
  requireInRange(frequencyMHz > 0.0 && std::isfinite(frequencyMHz), "frequencyMHz", frequencyMHz, "above 0 and finite");
  requireInRange(hazeGrowthPerMm >= 0.0 && std::isfinite(hazeGrowthPerMm), "hazeGrowthPerMm", hazeGrowthPerMm,
                 "at least 0 and finite");
  requireInRange(linesAcross >= 0, "linesAcross", linesAcross, "at least 0");
  requireInRange(greyMap.size() != 1, "The number of greyMap's values", 1, "0 or at least 2");
  for (const float grey : greyMap)
  {
    requireInRange(grey >= 0.0f && grey <= 1.0f, "A value of greyMap", grey, "in [0, 1]");
  }
}

} // namespace sono
