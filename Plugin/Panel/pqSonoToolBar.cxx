#include "pqSonoToolBar.h"

#include "SonoDrawNow.h"
#include "SonoExamples.h"
#include "SonoLayout.h"
#include "SonoMenu.h"
#include "SonoNeedleHere.h"
#include "SonoTimersWait.h"
#include "SonoUltrasoundHere.h"
#include "pqSonoDelete.h"
#include "pqSonoFlatMenu.h"
#include "pqSonoLoading.h"
#include "pqSonoLostViews.h"
#include "pqSonoNeedleFollow.h"
#include "pqSonoUndoing.h"

#include "vtkCommand.h"
#include "vtkDataObjectTypes.h"
#include "vtkPVDataInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewProxy.h"
#include "vtkSonoUltrasound.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqObjectBuilder.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqPropertiesPanel.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "pqView.h"

#include <QAction>
#include <QMenu>
#include <QPointer>
#include <QTimer>
#include <QToolButton>

namespace {

bool isUltrasound(pqPipelineSource* source)
{
  return source && sonoIsUltrasound(source->getProxy());
}

/// Whether Simulate Ultrasound takes it.
bool isLabelMapOrScene(pqOutputPort* port)
{
  if (!port || isUltrasound(port->getSource()))
  {
    return false;
  }
  vtkPVDataInformation* data = port->getDataInformation();
  return data->GetDataSetType() == VTK_IMAGE_DATA || data->GetCompositeDataSetType() == VTK_MULTIBLOCK_DATA_SET;
}

/// A run that was stopped, or refused, has none.
bool hasPicture(pqPipelineSource* source)
{
  auto* ultrasound = vtkSMSourceProxy::SafeDownCast(source->getProxy());
  ultrasound->UpdatePipeline();
  return ultrasound->GetDataInformation(vtkSonoUltrasound::FLAT_IMAGE)->GetNumberOfPoints() > 0;
}

/// As if Apply had been clicked before.
void applyWhatWaits(const pqPipelineSource* source)
{
  if (source->modifiedState() != pqProxy::UNMODIFIED)
  {
    pqCoreUtilities::mainWidget()->findChild<pqPropertiesPanel*>()->apply();
  }
}

} // namespace

pqSonoToolBar::pqSonoToolBar(QWidget* parent)
  : QToolBar(tr("Ultrasound"), parent)
{
  this->setObjectName("SonoToolBar");
  simulateAction_ = this->addAction(QIcon(":/sono/simulate.svg"), tr("Simulate Ultrasound"), [this] { simulate(); });
  simulateAction_->setObjectName("actionSonoSimulate");
  simulateAction_->setToolTip(tr("Simulate ultrasound of the selected label map and lay out its views"));
  layoutAction_ = this->addAction(QIcon(":/sono/layout.svg"), tr("Ultrasound Layout"), [this] { showLayout(); });
  layoutAction_->setObjectName("actionSonoLayout");
  layoutAction_->setToolTip(
    tr("Lay out the selected Simulate Ultrasound: in the body, flat with a depth scale, and one of its lines"));
  needleAction_ = this->addAction(QIcon(":/sono/needle.svg"), tr("Needle"), [this] { showNeedle(); });
  needleAction_->setObjectName("actionSonoNeedle");
  needleAction_->setToolTip(
    tr("Put a needle into the picture of the selected Simulate Ultrasound, to be dragged by its ends"));
  this->addWidget(new pqSonoFlatMenu(this));
  addExamples();
  new pqSonoDelete(this);
  new pqSonoLoading(this);
  new pqSonoLostViews(this);
  new pqSonoNeedleFollow(this);
  new pqSonoUndoing(this);
  auto* active = &pqActiveObjects::instance();
  QObject::connect(active, &pqActiveObjects::portChanged, this, [this] { updateActions(); });
  QObject::connect(active, &pqActiveObjects::dataUpdated, this, [this] { updateActions(); });
  updateActions();
  QTimer::singleShot(0, this, [this] { sonoInstallMenu(this); }); // the window may not have its menus yet
}

void pqSonoToolBar::updateActions()
{
  const auto& active = pqActiveObjects::instance();
  simulateAction_->setEnabled(isLabelMapOrScene(active.activePort()));
  layoutAction_->setEnabled(isUltrasound(active.activeSource()));
  needleAction_->setEnabled(isUltrasound(active.activeSource()) && sonoTakesNeedle(active.activeSource()));
}

void pqSonoToolBar::simulate()
{
  pqOutputPort* port = pqActiveObjects::instance().activePort();
  applyWhatWaits(port->getSource()); // so that it does not wait to show a slice of the labels in the new views
  BEGIN_UNDO_SET(tr("Simulate Ultrasound"));
  QMap<QString, QList<pqOutputPort*>> inputs;
  inputs["Input"] << port;
  pqPipelineSource* source = pqApplicationCore::instance()->getObjectBuilder()->createFilter(
    "filters", "SonoUltrasound", inputs, port->getServer());
  source->setModifiedState(pqProxy::UNMODIFIED); // nothing is left to apply
  pqActiveObjects::instance().setActiveSource(source);
  showLayout();
  END_UNDO_SET();
}

void pqSonoToolBar::showLayout()
{
  const SonoTimersWait waiting; // where events are looked at
  const QPointer<pqPipelineSource> source = pqActiveObjects::instance().activeSource();
  unshown_ = nullptr; // what waits for Apply would take its turn now
  sonoShowSoFar();
  if (!source)
  {
    return;
  }
  if (!hasPicture(source))
  {
    // What is shown without data keeps the colours and the camera that it gets for want of them.
    unshown_ = source;
    QObject::connect(pqCoreUtilities::mainWidget()->findChild<pqPropertiesPanel*>(),
                     QOverload<>::of(&pqPropertiesPanel::applied), this, &pqSonoToolBar::showUnshown,
                     Qt::ConnectionType(Qt::QueuedConnection | Qt::UniqueConnection));
    return;
  }
  vtkSMProxy* solid = sonoShowLayout(vtkSMSourceProxy::SafeDownCast(source->getProxy()));
  pqActiveObjects::instance().setActiveSource(source);
  sonoShowSoFar();
  // Where the probe can be seen and dragged.
  pqActiveObjects::instance().setActiveView(
    pqApplicationCore::instance()->getServerManagerModel()->findItem<pqView*>(solid));
  pqApplicationCore::instance()->render();
}

void pqSonoToolBar::showNeedle()
{
  pqPipelineSource* source = pqActiveObjects::instance().activeSource();
  if (!isUltrasound(source) || !sonoTakesNeedle(source))
  {
    return; // its targets were changed since it was chosen
  }
  applyWhatWaits(source); // so that it lies across the picture at the probe's new place
  if (!hasPicture(source))
  {
    return;
  }
  BEGIN_UNDO_SET(tr("Needle"));
  const SonoShownNeedle shown = sonoShowNeedle(source);
  END_UNDO_SET();
  if (shown.body)
  {
    pqActiveObjects::instance().setActiveView(shown.body);
  }
  pqActiveObjects::instance().setActiveSource(shown.needle); // whose ends can be dragged then
  // ParaView keeps them hidden once another source was chosen.
  shown.needle->getProxy()->InvokeEvent(vtkCommand::UserEvent, const_cast<char*>("ShowWidget"));
  pqApplicationCore::instance()->render();
}

void pqSonoToolBar::addExamples()
{
  auto* button = new QToolButton(this);
  auto* menu = new QMenu(tr("&Examples"), button);
  menu->setObjectName("SonoExamplesMenu");
  menu->setToolTipsVisible(true);
  for (const SonoExample& example : sonoExamples())
  {
    QAction* action = menu->addAction(tr(example.name), this, [this, &example] { showExample(example); });
    action->setObjectName(QString("actionSonoExample") + example.name);
    action->setToolTip(tr(example.tip));
  }
  button->setObjectName("SonoExamplesButton");
  button->setText(tr("Examples"));
  button->setToolTip(tr("Pictures of what comes with SonoVDB: heart, liver, thyroid, lung, phantom, needle"));
  button->setPopupMode(QToolButton::InstantPopup);
  button->setMenu(menu);
  this->addWidget(button);
}

void pqSonoToolBar::showExample(const SonoExample& example)
{
  const pqServer* server = pqActiveObjects::instance().activeServer();
  if (!server)
  {
    return;
  }
  BEGIN_UNDO_SET(tr("Example %1").arg(tr(example.name)));
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  const QList<pqPipelineSource*> before = model->findItems<pqPipelineSource*>();
  vtkSMSourceProxy* ultrasound = sonoMakeExample(example, server->proxyManager());
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>())
  {
    if (!before.contains(source))
    {
      source->setModifiedState(pqProxy::UNMODIFIED); // nothing is left to apply
    }
  }
  pqActiveObjects::instance().setActiveSource(model->findItem<pqPipelineSource*>(ultrasound));
  showLayout();
  END_UNDO_SET();
  const pqView* body = pqActiveObjects::instance().activeView();
  if (auto* view = body && example.depthIsDown ? vtkSMRenderViewProxy::SafeDownCast(body->getProxy()) : nullptr)
  {
    // The way a phantom stands before a person.
    const double from[3] = { 0.5, -1.0, -0.35 };
    const double at[3] = { 0.0, 0.0, 0.0 };
    const double up[3] = { 0.0, 0.0, -1.0 };
    vtkSMPropertyHelper(view, "CameraPosition").Set(from, 3);
    vtkSMPropertyHelper(view, "CameraFocalPoint").Set(at, 3);
    vtkSMPropertyHelper(view, "CameraViewUp").Set(up, 3);
    view->UpdateVTKObjects();
    view->ResetCamera(true);
    pqApplicationCore::instance()->render();
  }
}

void pqSonoToolBar::showUnshown()
{
  if (unshown_ && unshown_->modifiedState() == pqProxy::UNMODIFIED)
  {
    BEGIN_UNDO_SET(tr("Ultrasound Layout"));
    pqActiveObjects::instance().setActiveSource(unshown_);
    showLayout();
    END_UNDO_SET();
  }
}
