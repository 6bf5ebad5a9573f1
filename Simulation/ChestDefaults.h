#pragma once

#include "Image/BModeSettings.h"
#include "Trace/TraceSettings.h"

namespace sono {

/// What vtkSonoUltrasound starts with otherwise than its stages, for C++ and for ParaView's properties. A chest's walls
/// spread a beam by a few degrees, and sixteen centimetres of it cross more than seven boundaries.
inline void setChestDefaults(TraceSettings& settings)
{
  settings.maxCollisions = 20;
  settings.coherenceMm = 20.0;
  settings.lobeSigmaDeg = 6.0;
}

inline void setChestDefaults(BModeSettings& settings)
{
  settings.tgcDbPerCm = 3.0;
}

} // namespace sono
