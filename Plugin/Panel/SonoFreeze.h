#pragma once

#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

/// Of a Simulate Ultrasound: whether its picture stays as it is while the probe moves (vtkSonoUltrasound::SetFreeze).
/// The display's settings still change it.
inline constexpr const char* sonoFreeze = "Freeze";

inline bool sonoIsFrozen(vtkSMProxy* proxy)
{
  return vtkSMPropertyHelper(proxy, sonoFreeze, true).GetAsInt() == 1;
}
