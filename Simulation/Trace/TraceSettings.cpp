#include "Trace/TraceSettings.h"

#include "Core/Require.h"

#include <cmath>

namespace sono {

void TraceSettings::validate() const
{
  requireInRange(pathsPerLine >= 1 && pathsPerLine <= 10000000, "paths per line", pathsPerLine, "1 to 10,000,000");
  requireInRange(maxCollisions >= 0 && maxCollisions <= 1000, "maximum collisions", maxCollisions, "0 to 1000");
  requireInRange(coherenceMm >= 0.0 && std::isfinite(coherenceMm), "beam coherence C0 (mm)", coherenceMm, "0 or more");
  requireInRange(std::isfinite(lobeMeanRad), "lobe mean (rad)", lobeMeanRad, "a finite angle");
  requireInRange(lobeSigmaRad >= 0.0 && std::isfinite(lobeSigmaRad), "lobe sigma (rad)", lobeSigmaRad, "0 or more");
  requireInRange(lobeMinRad >= 0.0 && lobeMinRad < lobeMaxRad, "lobe minimum (rad)", lobeMinRad,
                 "0 or more and below the maximum");
  requireInRange(lobeMaxRad <= 1.5708, "lobe maximum (rad)", lobeMaxRad, "at most pi/2");
  requireInRange(frequencyMHz > 0.0 && std::isfinite(frequencyMHz), "frequency (MHz)", frequencyMHz, "more than 0");
  requireInRange(depthMm > 0.0 && depthMm <= 1000.0, "depth (mm)", depthMm, "more than 0 and at most 1000");
  requireInRange(radialBinMm > 0.0 && radialBinMm <= depthMm, "radial bin (mm)", radialBinMm,
                 "more than 0 and at most the depth");
  requireInRange(depthMm / radialBinMm <= 1e5, "radial bin (mm)", radialBinMm, "at least 1/100,000 of the depth");
  requireInRange(echoSampleMm > 0.0 && depthMm / echoSampleMm <= 1e6, "echo sample (mm)", echoSampleMm,
                 "more than 0 and at least a millionth of the depth");
  requireInRange(rouletteDb <= 0.0 && rouletteDb >= -1000.0, "roulette threshold (dB)", rouletteDb, "-1000 to 0");
}

int TraceSettings::binCount() const
{
  return int(std::ceil(depthMm / radialBinMm - 1e-9));
}

int TraceSettings::echoCount() const
{
  return int(std::floor(depthMm / echoSampleMm)) + 1;
}

} // namespace sono
