#include "SonoTracePoint.h"

#include "SonoFlatView.h"

#include "pqUndoStack.h"
#include "vtkRenderer.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"

#include <QCoreApplication>

#include <cstring>
#include <utility>

bool sonoTracePoint(vtkSMSourceProxy* volume, vtkSMRenderViewProxy* view, int x, int y)
{
  if (!volume || std::strcmp(volume->GetXMLName(), "SonoVentricleVolume") != 0 ||
      vtkSMPropertyHelper(volume, "Contour").GetAsInt() != 0)
  {
    return false;
  }
  const SonoShownImage image = sonoFlatImageOf(view);
  for (const auto& [input, points] :
       { std::pair("Input", "FourChamberPoints"), std::pair("TwoChamber", "TwoChamberPoints") })
  {
    const vtkSMPropertyHelper of(volume, input);
    if (image.source && of.GetNumberOfElements() > 0 && of.GetAsProxy() == image.source &&
        of.GetOutputPort() == image.port)
    {
      vtkRenderer* renderer = view->GetRenderer();
      renderer->SetDisplayPoint(x, y, 0.0);
      renderer->DisplayToWorld();
      const double* at = renderer->GetWorldPoint();
      BEGIN_UNDO_SET(QCoreApplication::translate("pqSonoLinePicker", "Trace Contour"));
      {
        SM_SCOPED_TRACE(PropertiesModified).arg("proxy", volume);
        vtkSMPropertyHelper traced(volume, points);
        const unsigned int count = traced.GetNumberOfElements();
        traced.SetNumberOfElements(count + 2);
        traced.Set(count, at[0] / at[3]);
        traced.Set(count + 1, at[1] / at[3]);
        volume->UpdateVTKObjects();
      }
      END_UNDO_SET();
      return true;
    }
  }
  return false;
}
