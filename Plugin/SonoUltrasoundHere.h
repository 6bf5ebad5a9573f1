#pragma once

#include "vtkSMProxy.h"
#include "vtkSonoUltrasound.h"

/// The filter of a Simulate Ultrasound that runs in ParaView's own process; null: it does not, or is another.
inline vtkSonoUltrasound* sonoUltrasoundHere(vtkSMProxy* source)
{
  return vtkSonoUltrasound::SafeDownCast(source->GetClientSideObject());
}
