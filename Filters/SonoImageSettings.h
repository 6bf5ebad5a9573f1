#pragma once

#include "ImageSettings.h"

class vtkSonoBMode;
class vtkSonoImageFormation;
class vtkSonoRayTracer;

namespace sono {

struct ProbeField;

/// The settings of an image of this probe, from those of the stages; the ray tracer's device is that of all. Neither
/// pulse nor pulse-echo field. Throws Error for what is out of range.
ImageSettings imageSettings(const ProbeField& probe, const vtkSonoRayTracer& tracer,
                            const vtkSonoImageFormation& formation, const vtkSonoBMode& bmode, double pixelMm);

} // namespace sono
