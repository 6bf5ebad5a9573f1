#include "SonoOutputFilter.h"

#include "vtkNew.h"
#include "vtkSMParaViewPipelineController.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"

#include <cstring>

vtkSMSourceProxy* sonoFindFilterOf(vtkSMSourceProxy* source, unsigned int port, const char* kind)
{
  vtkNew<vtkSMProxyIterator> sources;
  sources->SetSessionProxyManager(source->GetSessionProxyManager());
  sources->SetModeToOneGroup();
  for (sources->Begin("sources"); !sources->IsAtEnd(); sources->Next())
  {
    vtkSMProxy* filter = sources->GetProxy();
    if (std::strcmp(filter->GetXMLName(), kind) != 0)
    {
      continue;
    }
    const vtkSMPropertyHelper input(filter, "Input");
    if (input.GetAsProxy() == source && (input.GetOutputPort() == port || !filter->GetProperty("Line")))
    {
      return vtkSMSourceProxy::SafeDownCast(filter);
    }
  }
  return nullptr;
}

vtkSmartPointer<vtkSMSourceProxy> sonoFilterOf(vtkSMSourceProxy* source, unsigned int port, const char* kind)
{
  if (vtkSMSourceProxy* there = sonoFindFilterOf(source, port, kind))
  {
    return there;
  }
  vtkNew<vtkSMParaViewPipelineController> controller;
  auto made = vtkSmartPointer<vtkSMSourceProxy>::Take(
    vtkSMSourceProxy::SafeDownCast(source->GetSessionProxyManager()->NewProxy("filters", kind)));
  controller->PreInitializeProxy(made);
  vtkSMPropertyHelper(made, "Input").Set(source, port);
  if (made->GetProperty("Line"))
  {
    vtkSMPropertyHelper(made, "Line").Set(vtkSMPropertyHelper(source, "LineCount").GetAsInt() / 2);
  }
  controller->PostInitializeProxy(made);
  controller->RegisterPipelineProxy(made);
  made->UpdatePipeline();
  return made;
}
