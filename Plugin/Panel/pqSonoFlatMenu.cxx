#include "pqSonoFlatMenu.h"

#include "SonoFlatView.h"
#include "SonoLayout.h"
#include "SonoOutputFilter.h"
#include "SonoPipelineItem.h"
#include "SonoSplitScreen.h"
#include "SonoUltrasoundHere.h"
#include "pqSonoCaliperFollow.h"
#include "pqSonoKeptAlike.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqObjectBuilder.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "pqTimeKeeper.h"
#include "pqUndoStack.h"
#include "vtkCamera.h"
#include "vtkNew.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMRepresentationProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSonoCaliper.h"

#include <QAction>
#include <QInputDialog>
#include <QMenu>

#include <algorithm>
#include <cstring>

namespace {

constexpr const char* textKind = "SonoFlatText";
constexpr const char* labelsKind = "SonoFlatLabels";

/// The active one, or else the first; null: none.
pqRenderView* flatView()
{
  const auto isFlat = [](pqView* view) { return view && sonoIsFlatView(view->getProxy()); };
  pqView* active = pqActiveObjects::instance().activeView();
  if (isFlat(active))
  {
    return qobject_cast<pqRenderView*>(active);
  }
  const auto views = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>();
  const auto found = std::find_if(views.begin(), views.end(), isFlat);
  return found == views.end() ? nullptr : *found;
}

int numberOf(const char* kind)
{
  const auto sources = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>();
  return int(std::count_if(sources.begin(), sources.end(), [kind](const pqPipelineSource* source) {
    return std::strcmp(source->getProxy()->GetXMLName(), kind) == 0;
  }));
}

/// What a person writes; empty: nothing.
QString askForWords()
{
  QInputDialog dialog(pqCoreUtilities::mainWidget());
  dialog.setObjectName("SonoAnnotation");
  dialog.setWindowTitle(QObject::tr("Annotation"));
  dialog.setLabelText(QObject::tr("Text in the flat view:"));
  return dialog.exec() == QDialog::Accepted ? dialog.textValue().trimmed() : QString();
}

bool isShown(pqRenderView* view, const char* kind)
{
  const SonoShownImage image = view ? sonoFlatImageOf(view->getProxy()) : SonoShownImage();
  vtkSMSourceProxy* filter = image.source ? sonoFindFilterOf(image.source, image.port, kind) : nullptr;
  vtkSMRepresentationProxy* shown = filter ? view->getViewProxy()->FindRepresentation(filter, 0) : nullptr;
  return shown && vtkSMPropertyHelper(shown, "Visibility").GetAsInt() == 1;
}

pqPipelineSource* ultrasoundOf(pqRenderView* view)
{
  const SonoShownImage image = view ? sonoFlatImageOf(view->getProxy()) : SonoShownImage();
  return sonoIsUltrasound(image.source) ? sonoPipelineItem(image.source) : nullptr;
}

/// Where it can be read and dragged, each a line below the `before` others.
void write(vtkSMProxy* shown, int before)
{
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", shown);
  constexpr int lines = 8;
  constexpr int anywhere = 0;
  const double at[] = { 0.1, 0.8 - 0.08 * (before % lines) };
  const double yellow[] = { 1.0, 0.85, 0.2 };
  vtkSMPropertyHelper(shown, "WindowLocation", true).Set(anywhere);
  vtkSMPropertyHelper(shown, "Position", true).Set(at, 2);
  vtkSMPropertyHelper(shown, "Color", true).Set(yellow, 3);
  vtkSMPropertyHelper(shown, "FontSize", true).Set(16);
  shown->UpdateVTKObjects();
}

/// In the middle of what a view shows, so that each point can be seen and dragged; a little below the `before` others.
void place(vtkSMProxy* caliper, pqRenderView* view, int before)
{
  constexpr int places = 5;
  vtkCamera* camera = view->getRenderViewProxy()->GetActiveCamera();
  const double* at = camera->GetFocalPoint();
  const double reachMm = 0.3 * camera->GetParallelScale();
  const double y = at[1] + 0.4 * reachMm * (before % places - 1);
  const double points[3][3] = { { at[0] - reachMm, y, 0.0 }, { at[0] + reachMm, y, 0.0 }, { at[0], y + reachMm, 0.0 } };
  vtkSMPropertyHelper(caliper, "Point1Mm").Set(points[0], 3);
  vtkSMPropertyHelper(caliper, "Point2Mm").Set(points[1], 3);
  vtkSMPropertyHelper(caliper, "Point3Mm").Set(points[2], 3);
  vtkSMPropertyHelper(caliper, "DigitMm").Set(0.08 * camera->GetParallelScale());
  caliper->UpdateVTKObjects();
}

} // namespace

pqSonoFlatMenu::pqSonoFlatMenu(QWidget* parent)
  : QToolButton(parent)
{
  this->setObjectName("SonoFlatButton");
  this->setIcon(QIcon(":/sono/caliper.svg"));
  this->setToolTip(tr("Text, labels, calipers, annotations and split screen of the flat view"));
  this->setPopupMode(QToolButton::InstantPopup);
  new pqSonoCaliperFollow(this);
  pqSonoKeptAlike::sharedProbe(this);
  auto* menu = new QMenu(tr("&Flat View"), this);
  menu->setObjectName("SonoFlatMenu");
  this->setMenu(menu);
  text_ =
    add("actionSonoFlatText", tr("Text"), tr("Probe, frequency, depth, gain and rate, written into the flat view"),
        [this] { toggle(textKind, tr("Flat Image Text")); });
  labels_ = add("actionSonoFlatLabels", tr("Label Outlines"), tr("Where one label ends and the next begins"),
                [this] { toggle(labelsKind, tr("Flat Image Labels")); });
  text_->setCheckable(true);
  labels_->setCheckable(true);
  menu->addSeparator();
  add("actionSonoDistance", tr("Distance (mm)"), tr("Measure a distance in the flat view"),
      [this] { measure(vtkSonoCaliper::Distance, tr("Distance")); });
  add("actionSonoEllipse", tr("Ellipse Area (mm^2)"), tr("Measure an ellipse's area in the flat view"),
      [this] { measure(vtkSonoCaliper::Ellipse, tr("Ellipse")); });
  add("actionSonoAngle", tr("Angle (degrees)"), tr("Measure an angle in the flat view"),
      [this] { measure(vtkSonoCaliper::Angle, tr("Angle")); });
  add("actionSonoVentricle", tr("Ventricle Volume (ml)"),
      tr("Simpson's method of discs: click from one end of the annulus along the wall to the other, in this flat view "
         "and, "
         "for biplane, in that of the two-chamber view"),
      [this] { measureVentricle(); });
  add("actionSonoAnnotation", tr("Annotation"), tr("Write into the flat view; drag the text to where it belongs"),
      [this] { annotate(); });
  menu->addSeparator();
  add("actionSonoSplit", tr("Split Screen"),
      tr("A second Simulate Ultrasound of the same probe, with settings of its own, beside the first"),
      [this] { split(); });
  mMode_ =
    add("actionSonoMMode", tr("M-Mode"),
        tr("The scan line of the A-Line over time, below the flat view, of a label map with phases; all of them are "
           "simulated for it"),
        [this] { showMMode(); });
  QObject::connect(menu, &QMenu::aboutToShow, this, [this] { update(); });
}

QAction* pqSonoFlatMenu::add(const char* name, const QString& words, const QString& tip,
                             const std::function<void()>& act)
{
  QAction* action = this->menu()->addAction(words);
  action->setObjectName(name);
  action->setToolTip(tip);
  QObject::connect(action, &QAction::triggered, this, act);
  return action;
}

void pqSonoFlatMenu::update()
{
  pqRenderView* view = flatView();
  for (QAction* action : this->menu()->actions())
  {
    action->setEnabled(view != nullptr);
  }
  pqPipelineSource* ultrasound = ultrasoundOf(view);
  mMode_->setEnabled(ultrasound && ultrasound->getServer()->getTimeKeeper()->getTimeSteps().size() > 1);
  text_->setChecked(isShown(view, textKind));
  labels_->setChecked(isShown(view, labelsKind));
}

void pqSonoFlatMenu::toggle(const char* kind, const QString& step)
{
  pqRenderView* view = flatView();
  if (!view)
  {
    return;
  }
  BEGIN_UNDO_SET(step);
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  const SonoShownImage image = sonoFlatImageOf(view->getProxy());
  const bool isOn = isShown(view, kind);
  const auto filter = sonoFilterOf(image.source, image.port, kind);
  isOn ? controller->Hide(filter, 0, view->getViewProxy()) : controller->Show(filter, 0, view->getViewProxy());
  END_UNDO_SET();
  view->render();
}

void pqSonoFlatMenu::measure(int kind, const QString& step)
{
  pqRenderView* view = flatView();
  if (!view)
  {
    return;
  }
  BEGIN_UNDO_SET(step);
  const int before = numberOf("SonoCaliper");
  pqPipelineSource* caliper =
    pqApplicationCore::instance()->getObjectBuilder()->createSource("sources", "SonoCaliper", view->getServer());
  vtkSMPropertyHelper(caliper->getProxy(), "Kind").Set(kind);
  place(caliper->getProxy(), view, before);
  caliper->setModifiedState(pqProxy::UNMODIFIED); // nothing is left to apply
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  controller->Show(vtkSMSourceProxy::SafeDownCast(caliper->getProxy()), 0, view->getViewProxy());
  END_UNDO_SET();
  pqActiveObjects::instance().setActiveView(view);
  pqActiveObjects::instance().setActiveSource(caliper); // whose points can be dragged then
  view->render();
}

void pqSonoFlatMenu::annotate()
{
  const QString words = flatView() ? askForWords() : QString();
  pqRenderView* view = flatView();
  if (words.isEmpty() || !view)
  {
    return;
  }
  BEGIN_UNDO_SET(tr("Annotation"));
  const int before = numberOf("TextSource");
  pqPipelineSource* text =
    pqApplicationCore::instance()->getObjectBuilder()->createSource("sources", "TextSource", view->getServer());
  vtkSMPropertyHelper(text->getProxy(), "Text").Set(words.toUtf8().constData());
  text->getProxy()->UpdateVTKObjects();
  text->setModifiedState(pqProxy::UNMODIFIED); // nothing is left to apply
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  write(controller->Show(vtkSMSourceProxy::SafeDownCast(text->getProxy()), 0, view->getViewProxy()), before);
  END_UNDO_SET();
  view->render();
}

void pqSonoFlatMenu::measureVentricle()
{
  pqRenderView* view = flatView();
  if (!view)
  {
    return;
  }
  const auto portOf = [](pqRenderView* of) {
    const SonoShownImage image = sonoFlatImageOf(of->getProxy());
    auto* source = sonoPipelineItem(image.source);
    return source ? source->getOutputPort(static_cast<int>(image.port)) : nullptr;
  };
  QMap<QString, QList<pqOutputPort*>> inputs;
  inputs["Input"] << portOf(view);
  pqRenderView* second = nullptr;
  for (auto* other : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>())
  {
    if (!second && sonoIsFlatView(other->getProxy()) && portOf(other) != portOf(view))
    {
      second = other;
      inputs["TwoChamber"] << portOf(other);
    }
  }
  BEGIN_UNDO_SET(tr("Ventricle Volume"));
  pqPipelineSource* volume = pqApplicationCore::instance()->getObjectBuilder()->createFilter(
    "filters", "SonoVentricleVolume", inputs, view->getServer());
  vtkSMPropertyHelper(volume->getProxy(), "DigitMm")
    .Set(0.08 * view->getRenderViewProxy()->GetActiveCamera()->GetParallelScale());
  volume->getProxy()->UpdateVTKObjects();
  volume->setModifiedState(pqProxy::UNMODIFIED); // nothing is left to apply
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  auto* proxy = vtkSMSourceProxy::SafeDownCast(volume->getProxy());
  controller->Show(proxy, 0, view->getViewProxy());
  if (second)
  {
    controller->Show(proxy, 1, second->getViewProxy());
  }
  END_UNDO_SET();
  pqActiveObjects::instance().setActiveView(view);
  pqActiveObjects::instance().setActiveSource(volume); // whose contours are traced then
  pqApplicationCore::instance()->render();
}

void pqSonoFlatMenu::split()
{
  if (pqPipelineSource* first = ultrasoundOf(flatView()))
  {
    BEGIN_UNDO_SET(tr("Split Screen"));
    const SonoSplit split = sonoSplitScreen(first);
    END_UNDO_SET();
    pqActiveObjects::instance().setActiveSource(split.second);
    // Where the probe can be seen and dragged.
    pqActiveObjects::instance().setActiveView(split.body);
    pqApplicationCore::instance()->render();
  }
}

void pqSonoFlatMenu::showMMode()
{
  pqRenderView* view = flatView();
  if (pqPipelineSource* ultrasound = ultrasoundOf(view))
  {
    BEGIN_UNDO_SET(tr("M-Mode"));
    vtkSMViewProxy* body = sonoShowMMode(vtkSMSourceProxy::SafeDownCast(ultrasound->getProxy()), view->getViewProxy());
    END_UNDO_SET();
    pqActiveObjects::instance().setActiveSource(ultrasound);
    // Where the probe can be seen and dragged.
    auto* model = pqApplicationCore::instance()->getServerManagerModel();
    pqActiveObjects::instance().setActiveView(body ? model->findItem<pqView*>(body) : view);
    pqApplicationCore::instance()->render();
  }
}
