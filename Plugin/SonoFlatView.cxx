#include "SonoFlatView.h"

#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkSonoUltrasound.h"

#include <string>

SonoImageKind sonoImageKind(vtkSMProxy* source, unsigned int port)
{
  const std::string name = source->GetXMLName();
  if (name == "SonoScanConverter" || name == "SonoErrorMap")
  {
    return port == 0 ? SonoImageKind::InWorld : SonoImageKind::Flat;
  }
  if (name == "SonoUltrasound")
  {
    return port == vtkSonoUltrasound::FLAT_IMAGE                                      ? SonoImageKind::Flat
           : port == vtkSonoUltrasound::IMAGE || port == vtkSonoUltrasound::ERROR_MAP ? SonoImageKind::InWorld
                                                                                      : SonoImageKind::None;
  }
  return SonoImageKind::None;
}

SonoShownImage sonoFlatImageOf(vtkSMProxy* view)
{
  constexpr int twoDimensional = 1;
  if (!view->GetProperty("InteractionMode") ||
      vtkSMPropertyHelper(view, "InteractionMode").GetAsInt() != twoDimensional)
  {
    return {};
  }
  const vtkSMPropertyHelper representations(view, "Representations");
  for (unsigned int i = 0; i < representations.GetNumberOfElements(); ++i)
  {
    vtkSMProxy* shown = representations.GetAsProxy(i);
    const vtkSMPropertyHelper input(shown, "Input", true);
    if (input.GetAsProxy() && vtkSMPropertyHelper(shown, "Visibility", true).GetAsInt() == 1 &&
        sonoImageKind(input.GetAsProxy(), input.GetOutputPort()) == SonoImageKind::Flat)
    {
      return { vtkSMSourceProxy::SafeDownCast(input.GetAsProxy()), input.GetOutputPort() };
    }
  }
  return {};
}

bool sonoIsFlatView(vtkSMProxy* view)
{
  return sonoFlatImageOf(view).source != nullptr;
}
