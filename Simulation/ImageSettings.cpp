#include "ImageSettings.h"

namespace sono {

void ImageSettings::matchStages()
{
  tracing.depthMm = geometry.depthMm;
  echo.depthMm = geometry.depthMm;
  tracing.frequencyMHz = echo.centreFrequencyMHz;
  tracing.echoSampleMm = echo.sampleMm();
}

void ImageSettings::setDevice(Device device)
{
  tracing.device = device;
  echo.device = device;
}

} // namespace sono
