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

/// With a part that it has not yet.
void complete(vtkSMProxy* colors, const char* property, vtkSMProxy* part)
{
  vtkSMPropertyHelper helper(colors, property);
  if (!helper.GetAsProxy())
  {
    helper.Set(part);
    colors->UpdateVTKObjects();
  }
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
    controller->RegisterColorTransferFunctionProxy(colors, nameOf(array).c_str());
    colors->UpdateVTKObjects();
  }
  vtkSMProxy* shown = tables->GetColorTransferFunction(array, manager);
  // As ParaView does for its own: its Color Map Editor crashes where a map has no opacity.
  complete(shown, "ScalarOpacityFunction", tables->GetOpacityTransferFunction(array, manager));
  complete(shown, "TransferFunction2D", tables->GetTransferFunction2D(array, manager));
  return shown;
}
