#include "SonoGreyColors.h"

#include "vtkNew.h"
#include "vtkSMParaViewPipelineController.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSMTransferFunctionProxy.h"
#include "vtkSmartPointer.h"

#include <string>

namespace {

constexpr const char* kind = "SonoColorTable";

/// ParaView finds a colour map by this name, whatever its kind.
std::string nameOf(const char* array)
{
  return std::string(array) + "." + kind;
}

bool hasColors(const char* array, vtkSMSessionProxyManager* manager)
{
  return manager->GetProxy("lookup_tables", nameOf(array).c_str()) ||
         manager->GetProxy("lookup_tables", (std::string(array) + ".PVLookupTable").c_str());
}

} // namespace

vtkSMProxy* sonoGreyColors(const char* array, vtkSMSessionProxyManager* manager)
{
  vtkNew<vtkSMTransferFunctionManager> tables;
  if (!hasColors(array, manager))
  {
    auto colors = vtkSmartPointer<vtkSMProxy>::Take(manager->NewProxy("lookup_tables", kind));
    vtkNew<vtkSMParaViewPipelineController> controller;
    controller->InitializeProxy(colors);
    vtkSMTransferFunctionProxy::ApplyPreset(colors, "Grayscale", false);
    // As ParaView does for its own: its Color Map Editor crashes where a map has none of both.
    vtkSMPropertyHelper(colors, "ScalarOpacityFunction").Set(tables->GetOpacityTransferFunction(array, manager));
    vtkSMPropertyHelper(colors, "TransferFunction2D").Set(tables->GetTransferFunction2D(array, manager));
    controller->RegisterColorTransferFunctionProxy(colors, nameOf(array).c_str());
    colors->UpdateVTKObjects();
  }
  return tables->GetColorTransferFunction(array, manager);
}
