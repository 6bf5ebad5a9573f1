#include "SonoMovingViews.h"

#include "SonoFlatView.h"
#include "SonoTell.h"
#include "SonoUltrasoundHere.h"

#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "pqView.h"
#include "vtkCommand.h"
#include "vtkImageSliceRepresentation.h"
#include "vtkLight.h"
#include "vtkNew.h"
#include "vtkPVDataRepresentation.h"
#include "vtkRenderer.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSmartPointer.h"
#include "vtkSonoImageMapper.h"

#include <QWidget>

#include <algorithm>
#include <set>
#include <string>

namespace {

constexpr double slowS = 0.1;

/// Keeps an event from those that listen with the usual priority.
class NotPassedOn : public vtkCommand
{
public:
  static NotPassedOn* New() { return new NotPassedOn; }
  void Execute(vtkObject*, unsigned long, void*) override { this->AbortFlagOn(); }
};

/// A representation and those that it is made of.
std::set<vtkObject*> partsOf(vtkSMProxy* representation)
{
  std::set<vtkObject*> parts;
  const auto each = vtkSmartPointer<vtkSMPropertyIterator>::Take(representation->NewPropertyIterator());
  for (each->Begin(); !each->IsAtEnd(); each->Next())
  {
    if (auto* part = vtkPVDataRepresentation::SafeDownCast(each->GetProperty()->GetParent()->GetClientSideObject()))
    {
      parts.insert(part);
    }
  }
  return parts;
}

/// Pictures that a GPU makes and draws stay there.
void drawOnGpu(const pqDataRepresentation* shown)
{
  const pqOutputPort* output = shown->getOutputPortFromInput();
  if (!output || sonoImageKind(output->getSource()->getProxy(), static_cast<unsigned int>(output->getPortNumber())) ==
                   SonoImageKind::None)
  {
    return;
  }
  for (vtkObject* part : partsOf(shown->getProxy()))
  {
    if (auto* slice = vtkImageSliceRepresentation::SafeDownCast(part))
    {
      vtkSonoImageMapper::UseIn(slice);
    }
  }
}

/// What the rulers and the grey bar of a flat image do not show.
bool isOnNoScale(const std::string& property)
{
  return property == "PositionMm" || property == "Axial" || property == "Lateral" || property == "Preview" ||
         property == "GainDb" || property.compare(0, 3, "Tgc") == 0;
}

/// Has the scale made anew where a setting changes that it shows.
class DropScale : public vtkCommand
{
public:
  static DropScale* New() { return new DropScale; }
  void Execute(vtkObject*, unsigned long, void* property) override
  {
    const auto* name = static_cast<const char*>(property); // null: of a stage, and of no property of the filter's own
    if (!name || !isOnNoScale(name))
    {
      this->Scale->drop();
    }
  }

  SonoKeptDrawing* Scale = nullptr;
};

QList<pqView*> visibleViews()
{
  QList<pqView*> views = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqView*>();
  // One whose layout was removed has no widget.
  const auto isHidden = [](pqView* view) { return !view->widget() || !view->widget()->isVisible(); };
  views.erase(std::remove_if(views.begin(), views.end(), isHidden), views.end());
  return views;
}

/// Of what was drawn last.
bool isSlow(pqView* view)
{
  auto* render = vtkSMRenderViewProxy::SafeDownCast(view->getProxy());
  return render && render->GetRenderer()->GetLastRenderTimeInSeconds() > slowS;
}

/// Whether an output is another one for other greys.
bool showsGrey(vtkSMProxy* source, unsigned int port)
{
  const std::string name = source->GetXMLName();
  if (sonoIsUltrasound(source))
  {
    return sonoImageKind(source, port) != SonoImageKind::None || port == vtkSonoUltrasound::BMODE_LINES;
  }
  return name != "SonoFlatScale" && name != "SonoALine"; // DropScale has the scale made anew
}

void drawOnInteraction(pqView* view, bool wanted)
{
  SCOPED_UNDO_EXCLUDE();
  vtkSMPropertyHelper(view->getProxy(), "EnableRenderOnInteraction").Set(wanted ? 1 : 0);
  view->getProxy()->UpdateVTKObjects();
}

/// An interactive picture alone would miss images, which have no light version.
void drawLightly(vtkSMViewProxy* view)
{
  sonoTell(view, "SetSuppressRendering", 1);
  view->StillRender();
  sonoTell(view, "SetSuppressRendering", 0);
  view->InteractiveRender();
}

} // namespace

SonoMovingViews::SonoMovingViews(vtkSMProxy* source)
  : Source(source)
  , Anatomy(std::make_unique<SonoKeptDrawing>(source, SonoKept::Anatomy))
  , Scale(std::make_unique<SonoKeptDrawing>(source, SonoKept::Scale))
{
  vtkNew<DropScale> drop;
  drop->Scale = this->Scale.get();
  this->ScaleWatch = source->AddObserver(vtkCommand::PropertyModifiedEvent, drop);
  for (pqView* view : visibleViews())
  {
    this->take(view);
  }
  // So that the first picture does not wait for those.
  std::stable_partition(this->Views.begin(), this->Views.end(),
                        [&](pqView* view) { return !this->Slow.contains(view); });
  if (!this->Slow.empty())
  {
    this->lighten();
  }
}

SonoMovingViews::~SonoMovingViews()
{
  if (this->Anatomy)
  {
    this->Anatomy->drop(); // it may be another one by now
    this->Scale->drop();
  }
  this->drawInFull();
}

void SonoMovingViews::prepare(pqView* view)
{
  if (isSlow(view))
  {
    sonoTell(view->getProxy(), "UpdateLOD"); // which makes what is not made
  }
}

void SonoMovingViews::take(pqView* view)
{
  this->Views.append(view);
  if (isSlow(view))
  {
    this->Slow.append(view);
  }
  for (pqRepresentation* each : view->getRepresentations())
  {
    auto* shown = qobject_cast<pqDataRepresentation*>(each);
    if (shown && shown->isVisible())
    {
      this->mute(shown->getProxy());
      drawOnGpu(shown);
      this->Shown[view].append(shown);
    }
  }
}

void SonoMovingViews::mute(vtkSMProxy* representation)
{
  constexpr float first = 1000.0F;
  vtkNew<NotPassedOn> quiet;
  for (vtkObject* part : partsOf(representation))
  {
    for (const int event : { int(vtkCommand::UpdateDataEvent), int(vtkPVDataRepresentation::SkippedUpdateDataEvent) })
    {
      this->Muted.append({ part, part->AddObserver(event, quiet, first) });
    }
  }
}

void SonoMovingViews::unmute()
{
  for (const auto& [part, observer] : this->Muted)
  {
    if (part)
    {
      part->RemoveObserver(observer);
    }
  }
  this->Muted.clear();
}

bool SonoMovingViews::isMarked(const pqDataRepresentation* shown, Marked which) const
{
  if (which == Marked::All)
  {
    return true;
  }
  if (this->Anatomy->holds(shown) || this->Scale->holds(shown))
  {
    return false;
  }
  const pqOutputPort* output = shown->getOutputPortFromInput();
  return which == Marked::ButAnatomy || !output ||
         showsGrey(output->getSource()->getProxy(), static_cast<unsigned int>(output->getPortNumber()));
}

void SonoMovingViews::markModified(pqView* view, Marked which)
{
  for (const auto& shown : this->Shown.value(view))
  {
    if (shown && this->isMarked(shown, which))
    {
      sonoTell(shown->getProxy(), "MarkModified");
    }
  }
  view->getProxy()->MarkDirty(view->getProxy());
}

void SonoMovingViews::lighten()
{
  for (pqView* view : this->Views)
  {
    if (vtkSMRenderViewProxy::SafeDownCast(view->getProxy()))
    {
      sonoTell(view->getProxy(), "SetUseDepthPeeling", 0);
      sonoTell(view->getProxy(), "SetUseFXAA", 0);
    }
  }
  this->makeLamp();
  for (pqView* view : this->Slow)
  {
    if (vtkSMPropertyHelper(view->getProxy(), "UseLight", true).GetAsInt())
    {
      sonoTell(view->getProxy(), "SetUseLightKit", 0); // four of its five lights are a third of the time
      sonoTell(view->getProxy(), "AddLight", VTKOBJECT(this->Lamp));
    }
    drawOnInteraction(view, false); // draw() follows each step
  }
}

/// At the eye, where a body is about as bright as in the light of ParaView's kit. Without any light a view shows it
/// unshaded, and brighter by half.
void SonoMovingViews::makeLamp()
{
  SCOPED_UNDO_EXCLUDE();
  this->Lamp.TakeReference(this->Source->GetSessionProxyManager()->NewProxy("additional_lights", "Light"));
  vtkSMPropertyHelper(this->Lamp, "LightType").Set(VTK_LIGHT_TYPE_CAMERA_LIGHT);
  this->Lamp->UpdateVTKObjects();
}

void SonoMovingViews::drawInFull()
{
  this->unmute();
  for (pqView* view : this->Views)
  {
    if (view && this->Shown.contains(view))
    {
      this->markModified(view, Marked::All); // their proxies take it that this was said and not yet heard
    }
  }
  this->Shown.clear();
  this->Anatomy.reset();
  this->Source->RemoveObserver(this->ScaleWatch);
  this->Scale.reset();
  if (this->Slow.empty())
  {
    return; // nothing was lightened
  }
  for (pqView* view : this->Views)
  {
    for (const char* name : { "DepthPeeling", "UseFXAA", "UseLight" })
    {
      if (view && view->getProxy()->GetProperty(name))
      {
        view->getProxy()->UpdateProperty(name, 1);
      }
    }
  }
  for (pqView* view : this->Slow)
  {
    if (view)
    {
      sonoTell(view->getProxy(), "RemoveLight", VTKOBJECT(this->Lamp));
      drawOnInteraction(view, true);
    }
  }
  this->Slow.clear();
}

/// The views that are no slow ones; false: there are none.
bool SonoMovingViews::drawQuick(Marked which)
{
  bool isAny = false;
  for (pqView* view : this->Views)
  {
    if (view && !this->Slow.contains(view) && vtkSMRenderViewProxy::SafeDownCast(view->getProxy()))
    {
      this->markModified(view, which);
      view->forceRender();
      isAny = true;
    }
  }
  return isAny;
}

void SonoMovingViews::drawGrey()
{
  if (!this->drawQuick(Marked::Grey))
  {
    return this->draw();
  }
  this->Source->InvokeEvent(PictureShownEvent);
}

void SonoMovingViews::drawRested()
{
  this->drawQuick();
  for (pqView* view : this->Slow)
  {
    if (view)
    {
      this->markModified(view, Marked::ButAnatomy);
      drawLightly(view->getViewProxy());
    }
  }
  this->drawInFull();
}

void SonoMovingViews::draw()
{
  const int picture = this->Pictures++;
  for (pqView* view : this->Views)
  {
    const bool isSolid = view && vtkSMRenderViewProxy::SafeDownCast(view->getProxy());
    if (view && this->Slow.contains(view))
    {
      if (picture % 2 == 0 || this->Views.size() == 1)
      {
        this->markModified(view, Marked::ButAnatomy);
        drawLightly(view->getViewProxy());
      }
    }
    else if (view && (isSolid || this->Slow.empty()))
    {
      this->markModified(view, Marked::ButAnatomy);
      view->forceRender();
    }
  }
  this->Source->InvokeEvent(PictureShownEvent);
}
