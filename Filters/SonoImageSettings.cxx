#include "SonoImageSettings.h"

#include "SonoProbeField.h"
#include "vtkSonoBMode.h"
#include "vtkSonoImageFormation.h"
#include "vtkSonoRayTracer.h"

namespace sono {

ImageSettings imageSettings(const ProbeField& probe, const vtkSonoRayTracer& tracer,
                            const vtkSonoImageFormation& formation, const vtkSonoBMode& bmode, double pixelMm)
{
  ImageSettings settings;
  settings.geometry = probe.geometry;
  settings.tracing = tracer.Settings(probe);
  settings.echo = formation.Settings(probe, tracer.RfSamplingMHz(probe));
  settings.setDevice(settings.tracing.device);
  settings.bmode = bmode.Settings(probe);
  settings.pixelMm = pixelMm;
  return settings;
}

} // namespace sono
