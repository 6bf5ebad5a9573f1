#pragma once

#include "vtkNew.h"
#include "vtkSMParaViewPipelineController.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSmartPointer.h"

/// Makes a source or filter and hands it to `fill`; it is registered, so that it appears in the pipeline, once that is
/// done. It does not wait for Apply, nor after an undo and a redo, as one of the object builder would.
template<class Fill>
vtkSMSourceProxy* sonoMakeSource(vtkSMSessionProxyManager* manager, const char* group, const char* name,
                                 const Fill& fill)
{
  vtkNew<vtkSMParaViewPipelineController> controller;
  auto proxy = vtkSmartPointer<vtkSMSourceProxy>::Take(vtkSMSourceProxy::SafeDownCast(manager->NewProxy(group, name)));
  controller->PreInitializeProxy(proxy);
  fill(proxy.Get());
  controller->PostInitializeProxy(proxy);
  fill(proxy.Get()); // what was initialized by an input
  proxy->UpdateVTKObjects();
  controller->RegisterPipelineProxy(proxy);
  return proxy;
}
