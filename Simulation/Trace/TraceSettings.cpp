#include "Trace/TraceSettings.h"

#include "Core/Require.h"

#include <cmath>

namespace sono {

void TraceSettings::validate() const
{
  requireInRange(*this);
  requireInRange(aperture);
  requireInRange(lobeMinDeg < lobeMaxDeg, "lobeMinDeg", lobeMinDeg, "below lobeMaxDeg");
  requireInRange(frequencyMHz > 0.0 && std::isfinite(frequencyMHz), "frequency (MHz)", frequencyMHz, "more than 0");
  requireInRange(facePressureKPa > 0.0 && std::isfinite(facePressureKPa), "face pressure (kPa)", facePressureKPa,
                 "more than 0");
  if (imagingMode == ImagingMode::Harmonic && model == InterfaceModel::Amadou2024)
  {
    throw Error("the interface model Amadou 2024 knows no second harmonic: set Interface Model to Acoustic, or the "
                "probe's Imaging Mode to Fundamental");
  }
  requireInRange(depthMm > 0.0 && depthMm <= 1000.0, "depth (mm)", depthMm, "more than 0 and at most 1000");
  requireInRange(radialBinMm <= depthMm && depthMm / radialBinMm <= 1e5, "radialBinMm", radialBinMm,
                 "at most the depth and at least 1/100,000 of it");
  requireInRange(echoSampleMm > 0.0 && depthMm / echoSampleMm <= 1e6, "echo sample (mm)", echoSampleMm,
                 "more than 0 and at least a millionth of the depth");
}

bool TraceSettings::startApart() const
{
  return model == InterfaceModel::Acoustic && !deterministic && aperture.isNamed();
}

int TraceSettings::binCount() const
{
  return int(std::ceil(pathDepthMm() / radialBinMm - 1e-9));
}

int TraceSettings::echoCount() const
{
  return rangeIsTime() && !reverberates() ? 0 : int(std::floor(depthMm / echoSampleMm)) + 1;
}

} // namespace sono
