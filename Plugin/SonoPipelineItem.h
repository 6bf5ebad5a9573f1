#pragma once

#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"

class vtkSMProxy;

/// What the pipeline browser has of a source; null: nothing.
inline pqPipelineSource* sonoPipelineItem(vtkSMProxy* source)
{
  return pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineSource*>(source);
}
