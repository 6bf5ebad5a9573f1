#include "ImageSettings.h"

#include "Core/Error.h"
#include "Echo/Pulse.h"
#include "Image/Haze.h"

#include <cmath>
#include <string>

namespace sono {

namespace {

void requireAlike(bool same, const char* what)
{
  if (!same)
  {
    throw Error(std::string("the stages disagree about ") + what + ": set it alike for tracing and image formation");
  }
}

} // namespace

bool agree(double a, double b)
{
  return std::abs(a - b) <= 1e-9 * std::abs(b);
}

void ImageSettings::matchStages()
{
  tracing.depthMm = geometry.rangeMm();
  echo.depthMm = geometry.rangeMm();
  tracing.frequencyMHz = echo.sentFrequencyMHz();
  tracing.imagingMode = echo.imagingMode;
  tracing.fractionalBandwidth = echo.fractionalBandwidth;
  tracing.aperture = echo.aperture;
  tracing.echoSampleMm = echo.sampleMm();
  bmode.frequencyMHz = echo.centreFrequencyMHz;
  bmode.pulseSigmaMm = sono::pulseSigmaMm(echo.centreFrequencyMHz, echo.fractionalBandwidth);
  bmode.hazeGrowthPerMm = bodyWallGrowthPerMm(tracing.imagingMode, tracing.frequencyMHz, tracing.facePressureKPa);
  bmode.linesAcross = geometry.lineCount;
  bmode.shownPerRange = geometry.shownPerRange();
}

void ImageSettings::requireMatch() const
{
  requireAlike(agree(tracing.depthMm, geometry.rangeMm()) && agree(echo.depthMm, geometry.rangeMm()), "the depth");
  requireAlike(tracing.imagingMode == echo.imagingMode, "the imaging mode");
  requireAlike(agree(tracing.frequencyMHz, echo.sentFrequencyMHz()), "the frequency");
  requireAlike(tracing.aperture == echo.aperture, "the aperture");
  requireAlike(agree(tracing.echoSampleMm, echo.sampleMm()), "the sampling of echoes");
}

void ImageSettings::setDevice(Device device)
{
  tracing.device = device;
  echo.device = device;
}

} // namespace sono
