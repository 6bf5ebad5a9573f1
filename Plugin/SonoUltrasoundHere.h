#pragma once

#include "vtkSMProxy.h"
#include "vtkSonoUltrasound.h"

#include <cstring>

/// Whether there is one, and it is a Simulate Ultrasound.
inline bool sonoIsUltrasound(vtkSMProxy* source)
{
  return source && std::strcmp(source->GetXMLName(), "SonoUltrasound") == 0;
}

/// The filter of a Simulate Ultrasound that runs in ParaView's own process; null: it does not, or is another.
inline vtkSonoUltrasound* sonoUltrasoundHere(vtkSMProxy* source)
{
  return vtkSonoUltrasound::SafeDownCast(source->GetClientSideObject());
}
