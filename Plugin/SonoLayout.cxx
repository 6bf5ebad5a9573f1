#include "SonoLayout.h"

#include "vtkNew.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewLayoutProxy.h"
#include "vtkSmartPointer.h"
#include "vtkSonoUltrasound.h"

#include <cstring>
#include <initializer_list>
#include <utility>

namespace {

using Controller = vtkSMParaViewPipelineControllerWithRendering;

vtkSmartPointer<vtkSMViewProxy> makeView(const char* type, Controller* controller, vtkSMSessionProxyManager* manager)
{
  auto view = vtkSmartPointer<vtkSMViewProxy>::Take(vtkSMViewProxy::SafeDownCast(manager->NewProxy("views", type)));
  controller->InitializeProxy(view);
  controller->RegisterViewProxy(view);
  return view;
}

vtkSMProxy* showQuietly(vtkSMSourceProxy* source, unsigned int port, vtkSMViewProxy* view, Controller* controller)
{
  vtkSMProxy* representation = controller->Show(source, static_cast<int>(port), view);
  if (vtkSMPVRepresentationProxy::GetUsingScalarColoring(representation) &&
      vtkSMPropertyHelper(representation, "LookupTable").GetAsProxy())
  {
    vtkSMPVRepresentationProxy::SetScalarBarVisibility(representation, view, false);
  }
  return representation;
}

void setCamera(vtkSMProxy* view, std::initializer_list<double> position, std::initializer_list<double> up)
{
  vtkSMPropertyHelper(view, "CameraPosition").Set(position.begin(), 3);
  const double origin[3] = { 0.0, 0.0, 0.0 };
  vtkSMPropertyHelper(view, "CameraFocalPoint").Set(origin, 3);
  vtkSMPropertyHelper(view, "CameraViewUp").Set(up.begin(), 3);
  view->UpdateVTKObjects();
  vtkSMRenderViewProxy::SafeDownCast(view)->ResetCamera(true);
}

/// Anatomy, probe and image from the patient's front, a little from the left and from above.
void fillSolidView(vtkSMViewProxy* view, vtkSMSourceProxy* ultrasound, Controller* controller)
{
  for (unsigned int port : { vtkSonoUltrasound::ANATOMY, vtkSonoUltrasound::PROBE, vtkSonoUltrasound::IMAGE })
  {
    showQuietly(ultrasound, port, view, controller);
  }
  setCamera(view, { 0.5, -1.0, 0.35 }, { 0.0, 0.0, 1.0 });
}

/// Grey on black, the transducer on top, a grid's ticks as the scale.
void fillFlatView(vtkSMViewProxy* view, vtkSMSourceProxy* ultrasound, Controller* controller)
{
  const double black[3] = { 0.0, 0.0, 0.0 };
  vtkSMPropertyHelper(view, "UseColorPaletteForBackground", true).Set(0);
  vtkSMPropertyHelper(view, "Background", true).Set(black, 3);
  vtkSMPropertyHelper(view, "OrientationAxesVisibility", true).Set(0);
  vtkSMPropertyHelper(view, "InteractionMode", true).Set(1); // 2D
  if (vtkSMProxy* grid = vtkSMPropertyHelper(view, "AxesGrid", true).GetAsProxy())
  {
    vtkSMPropertyHelper(grid, "Visibility", true).Set(1);
    vtkSMPropertyHelper(grid, "XTitle", true).Set("Lateral (cm)");
    vtkSMPropertyHelper(grid, "YTitle", true).Set("Depth (cm)");
    vtkSMPropertyHelper(grid, "ZTitle", true).Set("");
    for (const char* size : { "XTitleFontSize", "YTitleFontSize", "XLabelFontSize", "YLabelFontSize" })
    {
      vtkSMPropertyHelper(grid, size, true).Set(14);
    }
    grid->UpdateVTKObjects();
  }
  view->UpdateVTKObjects();
  showQuietly(ultrasound, vtkSonoUltrasound::FLAT_IMAGE, view, controller);
  // From the side where x, lateral, runs to the right and y, depth, down.
  setCamera(view, { 0.0, 0.0, -1.0 }, { 0.0, -1.0, 0.0 });
  const double scale = vtkSMPropertyHelper(view, "CameraParallelScale").GetAsDouble();
  vtkSMPropertyHelper(view, "CameraParallelScale").Set(1.15 * scale); // room for the numbers
  view->UpdateVTKObjects();
}

/// The marker of the probe's lateral side, at the upper right as on a scanner set for hearts.
void addMarker(vtkSMViewProxy* view, Controller* controller, vtkSMSessionProxyManager* manager)
{
  auto text =
    vtkSmartPointer<vtkSMSourceProxy>::Take(vtkSMSourceProxy::SafeDownCast(manager->NewProxy("sources", "TextSource")));
  controller->PreInitializeProxy(text);
  vtkSMPropertyHelper(text, "Text").Set("S");
  controller->PostInitializeProxy(text);
  controller->RegisterPipelineProxy(text, "ProbeMarker");
  vtkSMProxy* representation = controller->Show(text, 0, view);
  vtkSMPropertyHelper(representation, "WindowLocation", true).Set(5); // upper right
  vtkSMPropertyHelper(representation, "FontSize", true).Set(28);
  vtkSMPropertyHelper(representation, "Bold", true).Set(1);
  representation->UpdateVTKObjects();
}

/// The A-Line that the RF lines have already, or a new one.
vtkSmartPointer<vtkSMSourceProxy> lineOf(vtkSMSourceProxy* ultrasound, Controller* controller,
                                         vtkSMSessionProxyManager* manager)
{
  vtkNew<vtkSMProxyIterator> sources;
  sources->SetSessionProxyManager(manager);
  sources->SetModeToOneGroup();
  for (sources->Begin("sources"); !sources->IsAtEnd(); sources->Next())
  {
    vtkSMProxy* source = sources->GetProxy();
    if (std::strcmp(source->GetXMLName(), "SonoALine") == 0 &&
        vtkSMPropertyHelper(source, "Input").GetAsProxy() == ultrasound)
    {
      return vtkSMSourceProxy::SafeDownCast(source);
    }
  }
  auto line =
    vtkSmartPointer<vtkSMSourceProxy>::Take(vtkSMSourceProxy::SafeDownCast(manager->NewProxy("filters", "SonoALine")));
  controller->PreInitializeProxy(line);
  vtkSMPropertyHelper(line, "Input").Set(ultrasound, vtkSonoUltrasound::RF_LINES);
  vtkSMPropertyHelper(line, "Line").Set(vtkSMPropertyHelper(ultrasound, "LineCount").GetAsInt() / 2);
  controller->PostInitializeProxy(line);
  controller->RegisterPipelineProxy(line);
  line->UpdatePipeline();
  return line;
}

/// Over the depth, RF to the left axis and the envelope in dB to the right one.
void fillChart(vtkSMViewProxy* view, vtkSMSourceProxy* line, Controller* controller)
{
  vtkSMPropertyHelper(view, "ChartTitle", true).Set("");
  vtkSMPropertyHelper(view, "BottomAxisTitle", true).Set("Depth (cm)");
  vtkSMPropertyHelper(view, "LeftAxisTitle", true).Set("RF");
  vtkSMPropertyHelper(view, "RightAxisTitle", true).Set("Envelope (dB)");
  view->UpdateVTKObjects();
  vtkSMProxy* plot = controller->Show(line, 0, view);
  vtkSMPropertyHelper(plot, "UseIndexForXAxis", true).Set(0);
  vtkSMPropertyHelper(plot, "XArrayName", true).Set("Depth (cm)");
  vtkSMPropertyHelper shown(plot, "SeriesVisibility", true);
  for (const auto& [name, visible] :
       { std::pair("Depth (cm)", 0), std::pair("RF", 1), std::pair("Envelope", 0), std::pair("Envelope (dB)", 1) })
  {
    shown.SetStatus(name, visible);
  }
  vtkSMPropertyHelper(plot, "SeriesPlotCorner", true).SetStatus("Envelope (dB)", 1);
  plot->UpdateVTKObjects();
}

} // namespace

void sonoShowLayout(vtkSMSourceProxy* ultrasound)
{
  vtkNew<Controller> controller;
  vtkSMSessionProxyManager* manager = ultrasound->GetSessionProxyManager();
  ultrasound->UpdatePipeline();

  auto layout = vtkSmartPointer<vtkSMViewLayoutProxy>::Take(
    vtkSMViewLayoutProxy::SafeDownCast(manager->NewProxy("misc", "ViewLayout")));
  controller->InitializeProxy(layout);
  controller->RegisterLayoutProxy(layout, "Ultrasound");
  const int right = layout->SplitHorizontal(0, 0.5) + 1;
  const int upper = layout->SplitVertical(right, 0.7);
  const auto solid = makeView("RenderView", controller, manager);
  const auto flat = makeView("RenderView", controller, manager);
  const auto chart = makeView("XYChartView", controller, manager);
  layout->AssignView(right - 1, solid);
  layout->AssignView(upper, flat);
  layout->AssignView(upper + 1, chart);

  fillSolidView(solid, ultrasound, controller);
  fillFlatView(flat, ultrasound, controller);
  addMarker(flat, controller, manager);
  fillChart(chart, lineOf(ultrasound, controller, manager), controller);
  for (const auto& view : { solid, flat, chart })
  {
    view->StillRender();
  }
}
