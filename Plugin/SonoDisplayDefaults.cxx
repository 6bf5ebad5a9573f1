#include "SonoDisplayDefaults.h"

#include "SonoFirstPose.h"
#include "SonoGreyColors.h"
#include "SonoLabelColors.h"
#include "SonoLayout.h"
#include "SonoPythonRecord.h"
#include "SonoUltrasoundHere.h"

#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkPVRepresentedArrayListSettings.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionClient.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSettings.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSMTransferFunctionProxy.h"
#include "vtkSonoUltrasound.h"

#include <cstring>
#include <set>
#include <string>

namespace {

bool equal(const char* a, const char* b)
{
  return a && b && std::strcmp(a, b) == 0;
}

/// Whether an output is that of a stage, be it the stage's own or the one that Simulate Ultrasound passes on.
bool isOutput(vtkSMSourceProxy* source, unsigned int port, const char* stage, unsigned int portOfAll)
{
  return equal(source->GetXMLName(), stage) || (sonoIsUltrasound(source) && port == portOfAll);
}

void showTranslucent(vtkSMProxy* representation, vtkSMSourceProxy* scene, unsigned int port)
{
  const bool hasColors = scene->GetDataInformation(port)->GetArrayInformation("Color", vtkDataObject::CELL);
  if (hasColors && representation->GetProperty("MapScalars") && representation->GetProperty("Opacity"))
  {
    vtkSMPropertyHelper(representation, "MapScalars").Set(0); // the colours themselves
    vtkSMPropertyHelper(representation, "Opacity").Set(0.2);
    // Where two structures touch, the surfaces of both lie in one place and would flicker through each other.
    constexpr int cullBackface = 401;
    vtkSMPropertyHelper(representation, "BackfaceRepresentation", true).Set(cullBackface);
    vtkSMPVRepresentationProxy::SetScalarColoring(representation, "Color", vtkDataObject::CELL);
    representation->UpdateVTKObjects();
  }
}

/// Grey from 1 on, nothing where the image is 0, outside the scanned area.
void hideUnscanned(vtkSMSessionProxyManager* manager)
{
  vtkNew<vtkSMTransferFunctionManager> tables;
  vtkSMProxy* colors = sonoGreyColors("BMode", manager);
  vtkSMProxy* opacity = tables->GetOpacityTransferFunction("BMode", manager);
  const double points[] = { 0.0, 0.0, 0.5, 0.0, 1.0, 1.0, 0.5, 0.0, 255.0, 1.0, 0.5, 0.0 };
  vtkSMPropertyHelper(opacity, "Points").Set(points, 12);
  opacity->UpdateVTKObjects();
  vtkSMTransferFunctionProxy::RescaleTransferFunction(colors, 0.0, 255.0);
  vtkSMPropertyHelper(colors, "ScalarOpacityFunction").Set(opacity);
  vtkSMPropertyHelper(colors, "EnableOpacityMapping").Set(1);
  colors->UpdateVTKObjects();
}

/// Nothing where an error map is not a number, outside the scanned area.
void showErrors(vtkSMProxy* colors)
{
  vtkSMPropertyHelper(colors, "NanOpacity").Set(0.0);
  colors->UpdateVTKObjects();
}

/// Paths and hits over the 80 dB below the transducer's intensity; what is fainter hardly sounds.
void scaleIntensities(vtkSMProxy* colors)
{
  vtkSMTransferFunctionProxy::RescaleTransferFunction(colors, -80.0, 0.0);
  vtkSMPropertyHelper(colors, "AutomaticRescaleRangeMode").Set(-1); // never
  colors->UpdateVTKObjects();
}

/// Whether an output is the tracer's ray paths or boundary hits.
bool isRays(vtkSMSourceProxy* source, unsigned int port)
{
  if (equal(source->GetXMLName(), "SonoRayTracer"))
  {
    return port >= 2;
  }
  return sonoIsUltrasound(source) && (port == vtkSonoUltrasound::RAY_PATHS || port == vtkSonoUltrasound::BOUNDARY_HITS);
}

void showRays(vtkSMProxy* representation)
{
  vtkSMPropertyHelper(representation, "PointSize", true).Set(4.0);
  vtkSMPropertyHelper(representation, "Ambient", true).Set(1.0); // the colours themselves, whatever the light
  vtkSMPropertyHelper(representation, "Diffuse", true).Set(0.0);
  representation->UpdateVTKObjects();
}

/// Whether it draws onto a flat image, in colours of its own.
bool isFlatDrawing(const char* name)
{
  return equal(name, "SonoFlatScale") || equal(name, "SonoFlatLabels") || equal(name, "SonoCaliper") ||
         equal(name, "SonoVentricleVolume");
}

/// The colours themselves, whatever the light.
void showDrawing(vtkSMProxy* representation, vtkSMSourceProxy* drawing)
{
  vtkSMPropertyHelper(representation, "MapScalars", true).Set(0);
  vtkSMPropertyHelper(representation, "Ambient", true).Set(1.0);
  vtkSMPropertyHelper(representation, "Diffuse", true).Set(0.0);
  vtkSMPropertyHelper(representation, "LineWidth", true).Set(equal(drawing->GetXMLName(), "SonoFlatScale") ? 1.0 : 2.0);
  vtkSMPVRepresentationProxy::SetScalarColoring(representation, "Color", vtkDataObject::CELL);
  representation->UpdateVTKObjects();
}

/// Where a fan leaves room.
void showText(vtkSMProxy* representation)
{
  constexpr int upperRight = 5;
  constexpr int right = 2;
  const double lightGrey[] = { 0.85, 0.85, 0.85 };
  vtkSMPropertyHelper(representation, "WindowLocation", true).Set(upperRight);
  vtkSMPropertyHelper(representation, "Justification", true).Set(right);
  vtkSMPropertyHelper(representation, "FontSize", true).Set(12);
  vtkSMPropertyHelper(representation, "Color", true).Set(lightGrey, 3);
  vtkSMPropertyHelper(representation, "Interactivity", true).Set(0);
  representation->UpdateVTKObjects();
}

/// A second as wide as a scanner's sweep shows it; the data stay in s.
void stretchTime(vtkSMProxy* representation)
{
  const double mmPerS[] = { 100.0, 1.0, 1.0 };
  vtkSMPropertyHelper(representation, "Scale", true).Set(mmPerS, 3);
  representation->UpdateVTKObjects();
}

/// On its way from a server ParaView 5.11 loses how an image is turned, but not where a surface's points lie.
void keepInPlace(vtkSMProxy* representation)
{
  if (vtkSMSessionClient::SafeDownCast(representation->GetSession()))
  {
    vtkSMRepresentationProxy::SetRepresentationType(representation, "Surface");
    vtkSMPropertyHelper(representation, "Ambient", true).Set(1.0); // the greys themselves, whatever the light
    vtkSMPropertyHelper(representation, "Diffuse", true).Set(0.0);
    // Between colours, not values: the value 0 would fall out of the table at places and be opaque.
    vtkSMPropertyHelper(representation, "InterpolateScalarsBeforeMapping", true).Set(0);
    representation->UpdateVTKObjects();
  }
}

/// Whether there is one of our sources, whose worlds are in mm.
bool hasUltrasound(vtkSMSessionProxyManager* manager)
{
  vtkNew<vtkSMProxyIterator> sources;
  sources->SetSessionProxyManager(manager);
  sources->SetModeToOneGroup();
  for (sources->Begin("sources"); !sources->IsAtEnd(); sources->Next())
  {
    if (std::strncmp(sources->GetProxy()->GetXMLName(), "Sono", 4) == 0)
    {
      return true;
    }
  }
  return false;
}

/// ParaView's ruler knows no unit.
void measureInMm(vtkSMProxy* representation)
{
  vtkSMPropertyHelper(representation, "LabelFormat", true).Set("%.1f mm");
  representation->UpdateVTKObjects();
}

/// Whether a bar shows the labels' own colours or grey, which need none.
bool isNeedless(vtkSMProxy* bar)
{
  vtkSMProxy* colors = vtkSMPropertyHelper(bar, "LookupTable", true).GetAsProxy();
  const char* name = colors ? bar->GetSessionProxyManager()->GetProxyName("lookup_tables", colors) : nullptr;
  const bool isLabels = name && std::strstr(name, "Labels.PVLookupTable") &&
                        vtkSMPropertyHelper(colors, "Discretize").GetAsInt() == 0; // by sonoShowLabelColors
  return name && (isLabels || std::strstr(name, "Color.PVLookupTable") || std::strstr(name, "BMode"));
}

/// Takes a needless bar away when ParaView shows it by itself for the first time, by either of its two switches.
class HideOnce : public vtkCommand
{
public:
  static HideOnce* New() { return new HideOnce; }
  void Execute(vtkObject* bar, unsigned long, void* property) override
  {
    const auto* name = static_cast<const char*>(property);
    if ((equal(name, "Visibility") || equal(name, "Enabled")) && this->Seen.count(name) == 0)
    {
      vtkSMPropertyHelper shown(vtkSMProxy::SafeDownCast(bar), name);
      if (shown.GetAsInt() == 1)
      {
        this->Seen.insert(name);
        shown.Set(0);
      }
    }
  }

private:
  std::set<std::string> Seen;
};

/// Looks at each new representation, colour bar and Simulate Ultrasound.
class DisplayDefaults : public vtkCommand
{
public:
  static DisplayDefaults* New() { return new DisplayDefaults; }
  void Execute(vtkObject*, unsigned long, void* data) override
  {
    const auto* registered = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(data);
    if (registered->Type != vtkSMProxyManager::RegisteredProxyInformation::PROXY ||
        registered->Proxy->GetSessionProxyManager()->GetInLoadXMLState())
    {
      return;
    }
    auto* source = vtkSMSourceProxy::SafeDownCast(registered->Proxy);
    if (equal(registered->GroupName, "sources") && sonoIsUltrasound(source))
    {
      sonoSetFirstPose(source);
    }
    if (equal(registered->GroupName, "scalar_bars") && isNeedless(registered->Proxy))
    {
      for (const char* shown : { "Visibility", "Enabled" })
      {
        vtkSMPropertyHelper(registered->Proxy, shown).Set(0); // so that switching it on is a change
      }
      vtkNew<HideOnce> hide;
      registered->Proxy->AddObserver(vtkCommand::PropertyModifiedEvent, hide);
    }
    if (equal(registered->GroupName, "lookup_tables") && std::strstr(registered->ProxyName, "ErrorPercent"))
    {
      showErrors(registered->Proxy);
    }
    if (equal(registered->GroupName, "lookup_tables") && std::strstr(registered->ProxyName, "IntensityDb"))
    {
      scaleIntensities(registered->Proxy);
    }
    if (!equal(registered->GroupName, "representations"))
    {
      return;
    }
    const vtkSMPropertyHelper helper(registered->Proxy, "Input", true);
    auto* input = vtkSMSourceProxy::SafeDownCast(helper.GetAsProxy());
    if (!input)
    {
      return;
    }
    const unsigned int port = helper.GetOutputPort();
    sonoShowLabelColors(input, port);
    if (isOutput(input, port, "SonoSceneBuilder", vtkSonoUltrasound::ANATOMY) ||
        equal(input->GetXMLName(), "SonoSceneReader"))
    {
      showTranslucent(registered->Proxy, input, port);
    }
    else if (isOutput(input, port, "SonoScanConverter", vtkSonoUltrasound::IMAGE) ||
             isOutput(input, port, "SonoScanConverter", vtkSonoUltrasound::FLAT_IMAGE))
    {
      hideUnscanned(registered->Proxy->GetSessionProxyManager());
      keepInPlace(registered->Proxy);
    }
    else if (equal(input->GetXMLName(), "SonoMMode"))
    {
      hideUnscanned(registered->Proxy->GetSessionProxyManager());
      stretchTime(registered->Proxy);
    }
    else if (isOutput(input, port, "SonoErrorMap", vtkSonoUltrasound::ERROR_MAP))
    {
      keepInPlace(registered->Proxy);
    }
    else if (equal(input->GetXMLName(), "Ruler") && hasUltrasound(input->GetSessionProxyManager()))
    {
      measureInMm(registered->Proxy);
    }
    else if (isFlatDrawing(input->GetXMLName()))
    {
      showDrawing(registered->Proxy, input);
    }
    else if (equal(input->GetXMLName(), "SonoFlatText"))
    {
      showText(registered->Proxy);
    }
    else if (isRays(input, port))
    {
      showRays(registered->Proxy);
    }
    else if (isOutput(input, port, "SonoProbeSource", vtkSonoUltrasound::PROBE))
    {
      vtkSMPropertyHelper(registered->Proxy, "LineWidth", true).Set(3.0);
      registered->Proxy->UpdateVTKObjects();
    }
  }
};

/// Looks at what a state file has brought.
class StateLoaded : public vtkCommand
{
public:
  static StateLoaded* New() { return new StateLoaded; }
  void Execute(vtkObject*, unsigned long, void*) override
  {
    if (vtkSMSessionProxyManager* manager = vtkSMProxyManager::GetProxyManager()->GetActiveSessionProxyManager())
    {
      sonoDrawEasily(manager);
    }
  }
};

/// Field arrays of our outputs, which say how they were made: nothing to colour by.
const std::string notColors =
  "^(A4CAxial|A4CLateral|A4CPositionMm|ApertureMm|AssumedSoundSpeedMPerS|BoundaryEcho|"
  "CentreFrequencyMHz|CompoundFans|CompoundSpanDeg|DepthMm|DepthOffsetMm|DynamicRangeDb|"
  "ElementCount|ElementWidthMm|ElevationApertureMm|ElevationFocusMm|ElevationLineCount|"
  "ElevationSectorDeg|FacePressureKPa|FractionalBandwidth|GainDb|ImagingMode|IsCatheter|IsVolume|"
  "FrameOfReference|KerfMm|LabelCodes|LabelColors|LabelIds|LabelNames|LabelTissues|LineCount|LinesApart|"
  "MovingLabels|PoseAxial|PoseLateral|PosePositionMm|PrepareInteraction|Preview|"
  "ProbeAxial|ProbeLateral|ProbePositionMm|RadialBinMm|RadiusMm|ReferenceAmplitude|Reverberation|"
  "ReverberationError|ReverberationNpPerMHz|RodDiameterMm|SamplingMHz|ScanKind|SectorDeg|SonoResult|SonoScene|"
  "TgcDbPerCm|TracedPaths|TransmitFocusMm|WidthMm|ErrorDb|PixelMm)$";

/// ParaView takes settings when it starts; what is loaded later has to tell the list itself.
void hideFromColors(const std::string& expression)
{
  vtkPVRepresentedArrayListSettings* list = vtkPVRepresentedArrayListSettings::GetInstance();
  const int count = list->GetNumberOfFilterExpressions();
  for (int i = 0; i < count; ++i)
  {
    if (expression == list->GetFilterExpression(i))
    {
      return;
    }
  }
  list->SetNumberOfFilterExpressions(count + 1);
  list->SetFilterExpression(count, expression.c_str());
}

} // namespace

void sonoInstallDisplayDefaults()
{
  if (!vtkSMProxyManager::IsInitialized())
  {
    return;
  }
  // The colour map that an array gets when it is first shown, and the reader that a file gets without a question: of a
  // segmentation ParaView's own would lose names and place; what is not offered to colour by. A person's own settings
  // have a higher priority.
  const std::string settings =
    R"json({"standard_presets": {"BMode": "Grayscale", "BModeFlat": "Grayscale", "Envelope": "Grayscale",
      "ErrorPercent": "Viridis (matplotlib)", "IntensityDb": "Inferno (matplotlib)"},
      "settings": {"RepresentedArrayListSettings":
        {"ReaderDetails": ["*.seg.nrrd", "sources", "SonoLabelMapReader"], "FilterExpressions": [")json" +
    notColors + R"json("]}}})json";
  vtkSMSettings::GetInstance()->AddCollectionFromString(settings, 0.0);
  hideFromColors(notColors);
  sonoInstallPythonRecord();
  vtkNew<DisplayDefaults> defaults;
  vtkSMProxyManager::GetProxyManager()->AddObserver(vtkCommand::RegisterEvent, defaults);
  vtkNew<StateLoaded> loaded;
  vtkSMProxyManager::GetProxyManager()->AddObserver(vtkCommand::LoadStateEvent, loaded);
}
