#pragma once

#include "pqApplicationCore.h"
#include "pqProxy.h"
#include "pqServerManagerModel.h"

#include <QVariant>

/// Of a source: whether its picture stays as it is while the probe moves. The display's settings still change it. It is
/// the scanner panel's alone, and neither undo nor a state file knows it.
inline constexpr const char* sonoFrozen = "SonoFrozen";

inline bool sonoIsFrozen(vtkSMProxy* proxy)
{
  const auto* source = pqApplicationCore::instance()->getServerManagerModel()->findItem<pqProxy*>(proxy);
  return source && source->property(sonoFrozen).toBool();
}
