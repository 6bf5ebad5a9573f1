#include "pqSonoProbeWidget.h"

#include "SonoFlatView.h"
#include "SonoFreeze.h"
#include "SonoHeldPanels.h"
#include "SonoMovingViews.h"
#include "SonoTell.h"
#include "SonoUltrasoundHere.h"
#include "SonoWaiting.h"
#include "SonoWindows.h"
#include "vtkSonoProbeRepresentation.h"
#include "vtkSonoSkin.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqPipelineSource.h"
#include "pqPropertiesPanel.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "pqView.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkSMPropertyGroup.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSession.h"
#include "vtkSMSessionClient.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSMUncheckedPropertyHelper.h"

#include <QCheckBox>
#include <QGuiApplication>
#include <QLabel>

#include <algorithm>
#include <string>
#include <utility>

const std::array<const char*, 4> pqSonoProbeWidget::PoseFunctions{ "PositionMm", "Axial", "Lateral", "DepthMm" };

/// Which has an anatomy.
bool pqSonoProbeWidget::isUltrasound() const
{
  return sonoIsUltrasound(this->proxy());
}

pqSonoProbeWidget::~pqSonoProbeWidget() = default;

vtkSonoProbeRepresentation* pqSonoProbeWidget::probe() const
{
  return vtkSonoProbeRepresentation::SafeDownCast(this->widgetProxy()->GetRepresentationProxy()->GetClientSideObject());
}

bool pqSonoProbeWidget::isLive() const
{
  auto* source = pqApplicationCore::instance()->getServerManagerModel()->findItem<pqProxy*>(this->proxy());
  // What was never applied has nothing to show yet.
  return this->Live->isChecked() && source && source->modifiedState() != pqProxy::UNINITIALIZED;
}

QString pqSonoProbeWidget::tickLive()
{
  return tr("Tick Live in the properties of Simulate Ultrasound, so that it scans without Apply.");
}

/// While it is frozen, only what the scanner's panel asks for.
bool pqSonoProbeWidget::mayScan() const
{
  return this->isLive() && (this->Asked || !sonoIsFrozen(this->proxy()));
}

void pqSonoProbeWidget::turn(double degrees)
{
  this->Asked = true;
  this->start();
  this->probe()->Rotate(degrees);
  this->takePose();
}

void pqSonoProbeWidget::goTo(const SonoWindow& place)
{
  this->Asked = true;
  this->stand(place);
}

void pqSonoProbeWidget::hold(bool held)
{
  this->Held = held;
  if (this->Moving)
  {
    this->Rest.start();
  }
}

std::array<double, 9> pqSonoProbeWidget::place() const
{
  return sonoPoseOf(this->widgetProxy());
}

void pqSonoProbeWidget::showAgain()
{
  this->Asked = true;
  this->IsOtherMoment = true;
  this->start();
  this->Frame.stop(); // where the probe has moved as well, this shows it
  this->showMoving();
}

void pqSonoProbeWidget::start()
{
  this->Refining.pause();
  this->findSkin();
  if (!this->Moving)
  {
    auto* source = pqApplicationCore::instance()->getServerManagerModel()->findItem<pqProxy*>(this->proxy());
    this->WasApplied = source && source->modifiedState() == pqProxy::UNMODIFIED;
    this->PoseBefore.clear();
    for (const char* function : PoseFunctions)
    {
      if (vtkSMProperty* smproperty = this->propertyGroup()->GetProperty(function))
      {
        const std::vector<double> values = vtkSMPropertyHelper(smproperty).GetDoubleArray();
        this->PoseBefore.append({ function, QVector<double>(values.begin(), values.end()) });
      }
    }
    this->Moving = true;
    if (!this->Shown && this->mayScan() && !this->proxy()->GetSession()->GetPendingProgress())
    {
      this->Shown = std::make_unique<SonoMovingViews>(this->proxy()); // before the probe itself is drawn
    }
  }
  this->Rest.stop();
}

/// By hand.
void pqSonoProbeWidget::grip()
{
  this->start();
  if (this->Shown)
  {
    if (QGuiApplication::mouseButtons() != Qt::NoButton)
    {
      this->Panels.reset(); // which lets go first
      this->Panels = std::make_unique<SonoHeldPanels>();
    }
    this->Ahead.restart(this->pose());
  }
}

void pqSonoProbeWidget::move()
{
  this->showMessage();
  Q_EMIT this->moved();
  if (this->mayScan() && !this->Frame.isActive())
  {
    this->Frame.start();
  }
}

void pqSonoProbeWidget::finish()
{
  this->Panels.reset();
  this->showMessage();
  this->Rest.start();
}

void pqSonoProbeWidget::showMoved()
{
  Q_EMIT this->changeAvailable();
  this->render();
  this->move();
  this->finish();
}

void pqSonoProbeWidget::takePose()
{
  vtkSonoProbeRepresentation* moved = this->probe();
  vtkSMProxy* widget = this->widgetProxy();
  vtkSMPropertyHelper(widget, "PositionMm").Set(moved->GetPositionMm(), 3);
  vtkSMPropertyHelper(widget, "Axial").Set(moved->GetAxial(), 3);
  vtkSMPropertyHelper(widget, "Lateral").Set(moved->GetLateral(), 3);
  widget->UpdateVTKObjects();
  this->showMoved();
}

void pqSonoProbeWidget::snap()
{
  this->start();
  this->probe()->SnapToSkin();
  this->takePose();
}

void pqSonoProbeWidget::resetPose()
{
  if (this->isUltrasound())
  {
    const SonoWindows found = sonoFindWindows(vtkSMSourceProxy::SafeDownCast(this->proxy()), SonoWindowsOf::Input, "");
    if (!found.windows.empty())
    {
      this->stand({ "", "", 0.0, found.windows.front().pose }); // with the probe and the depth that there are
    }
    this->showMessage(QString::fromStdString(found.refusal));
    return;
  }
  this->start();
  for (const char* function : PoseFunctions)
  {
    vtkSMProperty* smproperty = this->propertyGroup()->GetProperty(function);
    vtkSMProperty* ofWidget = this->widgetProxy()->GetProperty(function);
    if (smproperty && ofWidget && function != QString("DepthMm"))
    {
      ofWidget->ResetToXMLDefaults();
    }
  }
  this->widgetProxy()->UpdateVTKObjects();
  this->showMoved();
}

void pqSonoProbeWidget::stand(const SonoWindow& window)
{
  this->start();
  vtkSMProxy* widget = this->widgetProxy();
  vtkSMPropertyHelper(widget, "PositionMm").Set(window.pose.data(), 3);
  vtkSMPropertyHelper(widget, "Axial").Set(window.pose.data() + 3, 3);
  vtkSMPropertyHelper(widget, "Lateral").Set(window.pose.data() + 6, 3);
  if (window.depthMm > 0.0)
  {
    vtkSMPropertyHelper(widget, "DepthMm").Set(window.depthMm);
  }
  widget->UpdateVTKObjects();
  if (!window.preset.empty())
  {
    // As if it had been chosen among the presets; the depth is the window's.
    vtkSMUncheckedPropertyHelper(this->proxy(), "PresetFile").Set("");
    for (const auto& [name, value] : sonoPresetNumbers(this->proxy()->GetSessionProxyManager(), window.preset))
    {
      if (name != "DepthMm")
      {
        vtkSMUncheckedPropertyHelper(this->proxy(), name.c_str()).Set(value);
      }
    }
  }
  this->showMoved();
}

void pqSonoProbeWidget::showMessage()
{
  this->showMessage(this->probe()->GetMessage());
}

void pqSonoProbeWidget::showMessage(const QString& message)
{
  this->Message->setText(message);
  this->Message->setVisible(!message.isEmpty());
}

QList<QPair<QString, QVector<double>>> pqSonoProbeWidget::pose() const
{
  QList<QPair<QString, QVector<double>>> values;
  for (const auto& [function, before] : this->PoseBefore)
  {
    const std::vector<double> now = vtkSMPropertyHelper(this->widgetProxy(), function.toUtf8().data()).GetDoubleArray();
    values.append({ function, QVector<double>(now.begin(), now.end()) });
  }
  return values;
}

void pqSonoProbeWidget::push(const QList<QPair<QString, QVector<double>>>& values, bool preview)
{
  for (const auto& [function, numbers] : values)
  {
    vtkSMProperty* smproperty = this->propertyGroup()->GetProperty(function.toUtf8().data());
    vtkSMPropertyHelper(smproperty).Set(numbers.data(), static_cast<unsigned int>(numbers.size()));
  }
  vtkSMPropertyHelper(this->proxy(), "Preview", true).Set(preview ? 1 : 0);
  this->proxy()->UpdateVTKObjects();
}

void pqSonoProbeWidget::showMoving()
{
  if (!this->mayScan() || !this->Moving)
  {
    return;
  }
  if (this->proxy()->GetSession()->GetPendingProgress())
  {
    this->Frame.start(); // not while something runs
    return;
  }
  if (!this->Shown)
  {
    this->Shown = std::make_unique<SonoMovingViews>(this->proxy());
  }
  if (this->IsOtherMoment)
  {
    this->Ahead.restart(); // what is computed is of the anatomy as it was
  }
  const auto drawn = this->Ahead.toDraw(this->pose());
  if (!drawn.isEmpty())
  {
    {
      SCOPED_UNDO_EXCLUDE();
      this->push(drawn, true);
    }
    this->Shown->draw();
  }
  if (this->Ahead.isWaiting())
  {
    this->Look.start();
  }
}

void pqSonoProbeWidget::rest()
{
  if (!this->Moving)
  {
    return;
  }
  const bool isScrubbed = this->Asked && QGuiApplication::mouseButtons() != Qt::NoButton; // a slider is held
  if (isScrubbed || this->Held || this->proxy()->GetSession()->GetPendingProgress())
  {
    this->Rest.start();
    return;
  }
  this->Frame.stop();
  this->Look.stop();
  this->Ahead.restart();
  this->Moving = false;
  std::unique_ptr<SonoMovingViews> shown = std::move(this->Shown);
  const bool wanted = this->mayScan();
  this->Asked = false;
  if (!wanted)
  {
    return;
  }
  const auto after = this->pose();
  this->Refining.begin();
  std::unique_ptr<SonoKeptDrawing> anatomy;
  const bool isOtherMoment = std::exchange(this->IsOtherMoment, false);
  if (sonoAnyWaits(this->proxy()) || isOtherMoment)
  {
    shown.reset(); // what is applied with the pose may change the anatomy, and so has time
  }
  else if (shown)
  {
    {
      SCOPED_UNDO_EXCLUDE();
      this->push(after, false);
    }
    shown->drawRested(); // what follows makes nothing of the picture anew
    anatomy = std::make_unique<SonoKeptDrawing>(this->proxy(), SonoKept::Anatomy);
  }
  {
    // So that undo finds the pose before the movement, not one on the way.
    SCOPED_UNDO_EXCLUDE();
    this->push(this->PoseBefore, false);
  }
  auto* panel = pqCoreUtilities::mainWidget()->findChild<pqPropertiesPanel*>();
  if (panel && this->WasApplied)
  {
    // As if the new pose had been typed and applied.
    for (const auto& [function, numbers] : after)
    {
      vtkSMPropertyHelper(this->widgetProxy(), function.toUtf8().data())
        .Set(numbers.data(), static_cast<unsigned int>(numbers.size()));
    }
    this->widgetProxy()->UpdateVTKObjects();
    Q_EMIT this->changeAvailable();
    panel->apply();
    if (isOtherMoment)
    {
      pqApplicationCore::instance()->render(); // even where nothing was left to apply
    }
    return;
  }
  {
    // Something else waits for Apply and goes on waiting.
    SCOPED_UNDO_SET(tr("Move Probe"));
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", this->proxy());
    this->push(after, false);
  }
  pqApplicationCore::instance()->render();
}

void pqSonoProbeWidget::setView(pqView* next)
{
  if (next && sonoIsFlatView(next->getProxy())) // where a fan in space has no place; it stays where it is
  {
    return;
  }
  if (this->view())
  {
    this->view()->disconnect(&this->Prepare);
  }
  this->Superclass::setView(next);
  if (this->view())
  {
    // What is shown may have changed.
    this->Prepare.connect(this->view(), SIGNAL(endRender()), SLOT(start()));
  }
}

void pqSonoProbeWidget::prepare()
{
  if (this->Moving || !this->isWidgetVisible() || this->proxy()->GetSession()->GetPendingProgress())
  {
    return;
  }
  if (this->isUltrasound())
  {
    sonoTell(this->proxy(), "PrepareMoving");
  }
  // Not from a server: surfaces would come over unasked.
  if (!vtkSMSessionClient::SafeDownCast(this->proxy()->GetSession()))
  {
    this->findSkin();
    this->probe()->GetSkin()->Prepare();
    if (this->view())
    {
      SonoMovingViews::prepare(this->view());
    }
  }
}

void pqSonoProbeWidget::findSkin()
{
  SCOPED_UNDO_EXCLUDE(); // nobody wants to undo that data were looked at
  vtkNew<vtkMultiBlockDataSet> surfaces;
  if (this->view())
  {
    this->Surfaces.collect(*this->view(), this->proxy(), surfaces);
  }
  this->probe()->GetSkin()->SetSurfaces(surfaces);
}
