#include "SonoLayout.h"

#include "SonoDrawNow.h"
#include "SonoGreyColors.h"
#include "SonoOutputFilter.h"
#include "SonoTimersWait.h"
#include "SonoUltrasoundHere.h"

#include "vtkNew.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionClient.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSettingsProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSMTransferFunctionProxy.h"
#include "vtkSMViewLayoutProxy.h"
#include "vtkSmartPointer.h"
#include "vtkSonoUltrasound.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

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

/// From now on a view's own: it no longer follows ParaView's settings, which overwrite it in all views whenever a view
/// is made.
void keepOwn(vtkSMProxy* view, std::initializer_list<const char*> names)
{
  auto* settings =
    vtkSMSettingsProxy::SafeDownCast(view->GetSessionProxyManager()->GetProxy("settings", "RenderViewSettings"));
  for (const char* name : names)
  {
    if (settings && settings->GetSourcePropertyName(view, name))
    {
      settings->RemoveLink(name, view, name);
    }
  }
}

/// A server draws its views itself, if it can: their pictures cross the link, not the meshes they are drawn from, nor
/// an image as a mesh.
void drawOnServer(vtkSMProxy* view)
{
  if (vtkSMSessionClient::SafeDownCast(view->GetSession()))
  {
    keepOwn(view, { "RemoteRenderThreshold" });
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", view);
    vtkSMPropertyHelper(view, "RemoteRenderThreshold", true).Set(0.0); // from no megabytes on
    view->UpdateVTKObjects();
  }
}

/// A view of the anatomy.
void drawEasily(vtkSMProxy* view)
{
  keepOwn(view, { "LODResolution", "MaximumNumberOfPeels" });
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", view);
  // While the view is turned or a probe moves; those of ParaView's 0.5 take twice as long to make.
  constexpr double fewTriangles = 0.1;
  vtkSMPropertyHelper(view, "LODResolution", true).Set(fewTriangles);
  // Each draws all triangles once more, and two order the nearest and the farthest pair of surfaces at each pixel.
  constexpr int peels = 2;
  vtkSMPropertyHelper(view, "MaximumNumberOfPeels", true).Set(peels);
  view->UpdateVTKObjects();
}

/// Anatomy, probe and image from the patient's front, a little from the left and from above.
void fillSolidView(vtkSMViewProxy* view, vtkSMSourceProxy* ultrasound, Controller* controller)
{
  drawOnServer(view);
  drawEasily(view);
  for (unsigned int port : { vtkSonoUltrasound::ANATOMY, vtkSonoUltrasound::PROBE, vtkSonoUltrasound::IMAGE })
  {
    showQuietly(ultrasound, port, view, controller);
  }
  setCamera(view, { 0.5, -1.0, 0.35 }, { 0.0, 0.0, 1.0 });
}

/// Shows lines or letters in a colour of their own, whatever the light.
void showPlainly(vtkSMSourceProxy* source, unsigned int port, std::initializer_list<double> color, double width,
                 vtkSMViewProxy* view, Controller* controller)
{
  vtkSMProxy* representation = controller->Show(source, static_cast<int>(port), view);
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", representation);
  vtkSMPVRepresentationProxy::SetScalarColoring(representation, nullptr, 0);
  for (const char* name : { "AmbientColor", "DiffuseColor" })
  {
    vtkSMPropertyHelper(representation, name, true).Set(color.begin(), 3);
  }
  vtkSMPropertyHelper(representation, "Ambient", true).Set(1.0);
  vtkSMPropertyHelper(representation, "Diffuse", true).Set(0.0);
  vtkSMPropertyHelper(representation, "LineWidth", true).Set(width);
  representation->UpdateVTKObjects();
}

/// In greys of its own, without opacity: on black there is nothing to see through what is not scanned, and ParaView
/// takes longer to look up how opaque each pixel is than to draw the image.
void showOpaque(vtkSMProxy* representation)
{
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", representation);
  vtkSMProxy* greys = sonoGreyColors("BModeFlat", representation->GetSessionProxyManager());
  vtkSMTransferFunctionProxy::RescaleTransferFunction(greys, 0.0, 255.0);
  vtkSMPropertyHelper(representation, "LookupTable").Set(greys);
  representation->UpdateVTKObjects();
}

/// Black, and looked at without turning it.
void makeFlat(vtkSMViewProxy* view)
{
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", view);
  const double black[3] = { 0.0, 0.0, 0.0 };
  vtkSMPropertyHelper(view, "UseColorPaletteForBackground", true).Set(0);
  vtkSMPropertyHelper(view, "Background", true).Set(black, 3);
  vtkSMPropertyHelper(view, "OrientationAxesVisibility", true).Set(0);
  vtkSMPropertyHelper(view, "InteractionMode", true).Set(1); // 2D
  view->UpdateVTKObjects();
}

/// Grey on black, the transducer on top, with what a scanner draws and writes beside it.
void fillFlatView(vtkSMViewProxy* view, vtkSMSourceProxy* ultrasound, Controller* controller)
{
  drawOnServer(view);
  makeFlat(view);
  showOpaque(showQuietly(ultrasound, vtkSonoUltrasound::FLAT_IMAGE, view, controller));
  for (const char* beside : { "SonoFlatScale", "SonoFlatText" })
  {
    controller->Show(sonoFilterOf(ultrasound, vtkSonoUltrasound::FLAT_IMAGE, beside), 0, view);
  }
  // From the side where x, lateral, runs to the right and y, depth, down.
  setCamera(view, { 0.0, 0.0, -1.0 }, { 0.0, -1.0, 0.0 });
}

/// Whether a view has shown an output.
bool hasShown(vtkSMViewProxy* view, vtkSMSourceProxy* ultrasound, unsigned int port)
{
  return view && view->FindRepresentation(ultrasound, static_cast<int>(port));
}

/// The view with the anatomy of a layout that this filter has already; null: none.
vtkSMViewProxy* laidOut(vtkSMSourceProxy* ultrasound, vtkSMSessionProxyManager* manager)
{
  vtkNew<vtkSMProxyIterator> layouts;
  layouts->SetSessionProxyManager(manager);
  layouts->SetModeToOneGroup();
  for (layouts->Begin("layouts"); !layouts->IsAtEnd(); layouts->Next())
  {
    const std::vector<vtkSMViewProxy*> views = vtkSMViewLayoutProxy::SafeDownCast(layouts->GetProxy())->GetViews();
    const auto shows = [&](unsigned int port) {
      return std::find_if(views.begin(), views.end(),
                          [&](vtkSMViewProxy* view) { return hasShown(view, ultrasound, port); });
    };
    const auto solid = shows(vtkSonoUltrasound::ANATOMY);
    if (solid != views.end() && shows(vtkSonoUltrasound::FLAT_IMAGE) != views.end())
    {
      return *solid;
    }
  }
  return nullptr;
}

/// Of a tab: these words, with a number where there is one already.
std::string freeName(const std::string& words, vtkSMSessionProxyManager* manager)
{
  std::string name = words;
  for (int number = 2; manager->GetProxy("layouts", name.c_str()); ++number)
  {
    name = words + " " + std::to_string(number);
  }
  return name;
}

vtkSmartPointer<vtkSMViewLayoutProxy> makeLayout(const std::string& words, Controller* controller,
                                                 vtkSMSessionProxyManager* manager)
{
  auto layout = vtkSmartPointer<vtkSMViewLayoutProxy>::Take(
    vtkSMViewLayoutProxy::SafeDownCast(manager->NewProxy("misc", "ViewLayout")));
  controller->InitializeProxy(layout);
  controller->RegisterLayoutProxy(layout, freeName(words, manager).c_str());
  return layout;
}

constexpr std::array<double, 3> rfColor{ 0.2, 0.55, 0.25 };
constexpr std::array<double, 3> envelopeColor{ 0.15, 0.4, 0.7 };

void nameAxes(vtkSMViewProxy* view)
{
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", view);
  vtkSMPropertyHelper(view, "ChartTitle", true).Set("");
  vtkSMPropertyHelper(view, "BottomAxisTitle", true).Set("Depth (mm)");
  vtkSMPropertyHelper(view, "LeftAxisTitle", true).Set("RF");
  vtkSMPropertyHelper(view, "RightAxisTitle", true).Set("Envelope (dB)");
  for (const char* axis : { "Left", "Bottom", "Right" })
  {
    vtkSMPropertyHelper(view, (std::string(axis) + "AxisTitleFontSize").c_str(), true).Set(12);
    vtkSMPropertyHelper(view, (std::string(axis) + "AxisLabelFontSize").c_str(), true).Set(10);
  }
  vtkSMPropertyHelper(view, "ShowLegend", true).Set(0); // the axes' titles have the curves' colours
  vtkSMPropertyHelper(view, "LeftAxisTitleColor", true).Set(rfColor.begin(), 3);
  vtkSMPropertyHelper(view, "RightAxisTitleColor", true).Set(envelopeColor.begin(), 3);
  vtkSMPropertyHelper(view, "RightAxisUseCustomRange", true).Set(1);
  vtkSMPropertyHelper(view, "RightAxisRangeMinimum", true).Set(-100.0);
  vtkSMPropertyHelper(view, "RightAxisRangeMaximum", true).Set(0.0);
  view->UpdateVTKObjects();
}

/// Over the depth, RF to the left axis and the envelope in dB to the right one.
void fillChart(vtkSMViewProxy* view, vtkSMSourceProxy* line, Controller* controller)
{
  nameAxes(view);
  vtkSMProxy* plot = controller->Show(line, 0, view);
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", plot);
  vtkSMPropertyHelper(plot, "UseIndexForXAxis", true).Set(0);
  vtkSMPropertyHelper(plot, "XArrayName", true).Set("Depth (mm)");
  vtkSMPropertyHelper shown(plot, "SeriesVisibility", true);
  for (const auto& [name, visible] :
       { std::pair("Depth (mm)", 0), std::pair("RF", 1), std::pair("Envelope", 0), std::pair("Envelope (dB)", 1) })
  {
    shown.SetStatus(name, visible);
  }
  vtkSMPropertyHelper(plot, "SeriesPlotCorner", true).SetStatus("Envelope (dB)", 1);
  vtkSMPropertyHelper colors(plot, "SeriesColor", true);
  for (auto [name, color] : { std::pair("RF", rfColor), std::pair("Envelope (dB)", envelopeColor) })
  {
    colors.SetStatus(name, color.data(), 3);
  }
  plot->UpdateVTKObjects();
}

} // namespace

vtkSMViewProxy* sonoShowLayout(vtkSMSourceProxy* ultrasound)
{
  const SonoTimersWait waiting; // ParaView looks at events where a layout is made
  vtkNew<Controller> controller;
  vtkSMSessionProxyManager* manager = ultrasound->GetSessionProxyManager();
  ultrasound->UpdatePipeline();
  if (vtkSMViewProxy* there = laidOut(ultrasound, manager))
  {
    return there;
  }

  const auto layout = makeLayout("Ultrasound", controller, manager);
  const int right = layout->SplitHorizontal(0, 0.5) + 1;
  const int upper = layout->SplitVertical(right, 0.62);
  const auto solid = makeView("RenderView", controller, manager);
  const auto flat = makeView("RenderView", controller, manager);
  const auto chart = makeView("XYChartView", controller, manager);
  layout->AssignView(right - 1, solid);
  layout->AssignView(upper, flat);
  layout->AssignView(upper + 1, chart);

  // What a kept picture suffices for comes first: whoever asks for other outputs waits for the simulation.
  fillFlatView(flat, ultrasound, controller);
  sonoDrawNow(flat);
  const auto line = sonoFilterOf(ultrasound, vtkSonoUltrasound::RF_LINES, "SonoALine");
  fillSolidView(solid, ultrasound, controller);
  const std::initializer_list<double> yellow{ 1.0, 0.85, 0.2 };
  showPlainly(line, 2, yellow, 2.0, solid, controller);
  sonoDrawNow(solid);
  showPlainly(line, 1, yellow, 1.0, flat, controller);
  sonoDrawNow(flat);
  fillChart(chart, line, controller);
  sonoDrawNow(chart);
  return solid;
}

vtkSMViewProxy* sonoShowSplitLayout(const char* tab, vtkSMSourceProxy* first, vtkSMSourceProxy* second)
{
  const SonoTimersWait waiting;
  vtkNew<Controller> controller;
  vtkSMSessionProxyManager* manager = first->GetSessionProxyManager();
  const auto layout = makeLayout(tab, controller, manager);
  const int flats = layout->SplitVertical(0, 0.62);
  const int left = layout->SplitHorizontal(flats, 0.5);
  const auto solid = makeView("RenderView", controller, manager);
  const auto one = makeView("RenderView", controller, manager);
  const auto other = makeView("RenderView", controller, manager);
  layout->AssignView(flats + 1, solid);
  layout->AssignView(left, one);
  layout->AssignView(left + 1, other);
  // Each takes a second or two; meanwhile the window answers.
  fillFlatView(one, first, controller);
  sonoDrawNow(one);
  fillFlatView(other, second, controller);
  sonoDrawNow(other);
  fillSolidView(solid, first, controller);
  sonoDrawNow(solid);
  return solid;
}

void sonoShowImageInBody(vtkSMSourceProxy* ultrasound, vtkSMViewProxy* body)
{
  vtkNew<Controller> controller;
  showQuietly(ultrasound, vtkSonoUltrasound::IMAGE, body, controller);
}

void sonoDrawEasily(vtkSMSessionProxyManager* manager)
{
  vtkNew<vtkSMProxyIterator> views;
  views->SetSessionProxyManager(manager);
  views->SetModeToOneGroup();
  for (views->Begin("views"); !views->IsAtEnd(); views->Next())
  {
    const vtkSMPropertyHelper shown(views->GetProxy(), "Representations", true);
    for (unsigned int i = 0; i < shown.GetNumberOfElements(); ++i)
    {
      const vtkSMPropertyHelper input(shown.GetAsProxy(i), "Input", true);
      if (sonoIsUltrasound(input.GetAsProxy()) && input.GetOutputPort() == vtkSonoUltrasound::ANATOMY)
      {
        drawEasily(views->GetProxy());
      }
    }
  }
}

vtkSMViewProxy* sonoShowMMode(vtkSMSourceProxy* ultrasound, vtkSMViewProxy* beside)
{
  const SonoTimersWait waiting;
  vtkNew<Controller> controller;
  vtkSMSourceProxy* line = sonoFindFilterOf(ultrasound, vtkSonoUltrasound::RF_LINES, "SonoALine");
  const auto mode = sonoFilterOf(ultrasound, vtkSonoUltrasound::BMODE_LINES, "SonoMMode");
  if (line)
  {
    vtkSMPropertyHelper(mode, "Line").Set(vtkSMPropertyHelper(line, "Line").GetAsInt());
    mode->UpdateVTKObjects();
  }
  const auto view = makeView("RenderView", controller, ultrasound->GetSessionProxyManager());
  vtkSMViewLayoutProxy* layout = vtkSMViewLayoutProxy::FindLayout(beside);
  const int cells = layout->SplitVertical(layout->GetViewLocation(beside), 0.6);
  layout->AssignView(cells + 1, view);
  makeFlat(view);
  showQuietly(mode, 0, view, controller);
  if (vtkSMProxy* axes = vtkSMPropertyHelper(view, "AxesGrid", true).GetAsProxy())
  {
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", axes);
    vtkSMPropertyHelper(axes, "Visibility").Set(1);
    vtkSMPropertyHelper(axes, "XTitle").Set("Time (10 ms)"); // as wide as a mm (SonoDisplayDefaults)
    vtkSMPropertyHelper(axes, "YTitle").Set("Depth (mm)");
    axes->UpdateVTKObjects();
  }
  setCamera(view, { 0.0, 0.0, -1.0 }, { 0.0, -1.0, 0.0 });
  view->StillRender();
  return laidOut(ultrasound, ultrasound->GetSessionProxyManager());
}
