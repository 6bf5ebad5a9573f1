#pragma once

#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"

#include <algorithm>

/// Whether a source waits for Apply, apart from one.
inline bool sonoAnyWaits(const vtkSMProxy* apart = nullptr)
{
  const auto sources = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>();
  return std::any_of(sources.begin(), sources.end(), [apart](pqPipelineSource* source) {
    return source->getProxy() != apart && source->modifiedState() != pqProxy::UNMODIFIED;
  });
}
