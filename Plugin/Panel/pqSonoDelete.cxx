#include "pqSonoDelete.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqDeleteReaction.h"
#include "pqPipelineSource.h"
#include "pqPropertiesPanel.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkSMOutputPort.h"
#include "vtkSMProxySelectionModel.h"
#include "vtkSMSourceProxy.h"

#include <QAbstractButton>
#include <QAction>
#include <QEvent>
#include <QSet>
#include <QStringList>
#include <QTimer>

#include <algorithm>

namespace {

/// What is selected in the pipeline browser.
QSet<pqPipelineSource*> selectedSources()
{
  QSet<pqPipelineSource*> sources;
  vtkSMProxySelectionModel* selection = pqActiveObjects::instance().activeSourcesSelectionModel();
  const unsigned int count = selection ? selection->GetNumberOfSelectedProxies() : 0;
  for (unsigned int i = 0; i < count; ++i)
  {
    vtkSMProxy* proxy = selection->GetSelectedProxy(i);
    auto* port = vtkSMOutputPort::SafeDownCast(proxy);
    auto* source = pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineSource*>(
      port ? port->GetSourceProxy() : proxy);
    if (source)
    {
      sources.insert(source);
    }
  }
  return sources;
}

void addConsumers(pqPipelineSource* source, QSet<pqPipelineSource*>& sources)
{
  sources.insert(source);
  for (pqPipelineSource* consumer : source->getAllConsumers())
  {
    addConsumers(consumer, sources);
  }
}

} // namespace

pqSonoDelete::pqSonoDelete(QObject* parent)
  : QObject(parent)
{
  // The panel is made after the toolbars.
  QTimer::singleShot(0, this, [this] { watch(); });
}

void pqSonoDelete::watch()
{
  auto* panel = pqCoreUtilities::mainWidget()->findChild<pqPropertiesPanel*>();
  button_ = panel ? panel->findChild<QAbstractButton*>("Delete") : nullptr;
  if (!button_)
  {
    return;
  }
  tip_ = button_->toolTip();
  button_->installEventFilter(this);
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(&pqActiveObjects::instance(), &pqActiveObjects::sourceChanged, this, [this] { look(); });
  QObject::connect(model,
                   QOverload<pqPipelineSource*, pqPipelineSource*, int>::of(&pqServerManagerModel::connectionAdded),
                   this, [this] { look(); });
  QObject::connect(model,
                   QOverload<pqPipelineSource*, pqPipelineSource*, int>::of(&pqServerManagerModel::connectionRemoved),
                   this, [this, panel] {
                     QMetaObject::invokeMethod(panel, "updateButtonState");
                     look();
                   });
  for (const char* name : { "actionPBDeleteTree", "actionDeleteTree" })
  {
    if (auto* action = pqCoreUtilities::mainWidget()->findChild<QAction*>(name))
    {
      QObject::disconnect(action, &QAction::triggered, nullptr, nullptr);
      QObject::connect(action, &QAction::triggered, this, [] { deleteTree(); });
    }
  }
  look();
}

void pqSonoDelete::deleteTree()
{
  if (!pqDeleteReaction::canDeleteTree())
  {
    return;
  }
  QSet<pqPipelineSource*> doomed;
  for (pqPipelineSource* source : selectedSources())
  {
    addConsumers(source, doomed);
  }
  BEGIN_UNDO_SET(tr("Delete Downstream Pipeline"));
  while (!doomed.isEmpty())
  {
    const auto last = std::find_if(doomed.begin(), doomed.end(),
                                   [](const pqPipelineSource* source) { return source->getAllConsumers().isEmpty(); });
    pqPipelineSource* source = last == doomed.end() ? *doomed.begin() : *last;
    doomed.remove(source);
    pqDeleteReaction::deleteSources({ source });
  }
  END_UNDO_SET();
}

bool pqSonoDelete::eventFilter(QObject* watched, QEvent* event)
{
  if (watched == button_ && event->type() == QEvent::EnabledChange)
  {
    look();
  }
  return false;
}

void pqSonoDelete::look()
{
  const pqPipelineSource* source = pqActiveObjects::instance().activeSource();
  QStringList names;
  for (pqPipelineSource* consumer : source ? source->getAllConsumers() : QList<pqPipelineSource*>())
  {
    names << consumer->getSMName();
  }
  names.removeDuplicates();
  button_->setToolTip(names.isEmpty() ? tip_
                                      : tr("These depend on it and have to be deleted first, or with it by Delete "
                                           "Downstream Pipeline: %1")
                                          .arg(names.join(", ")));
  if (!names.isEmpty() && button_->isEnabled())
  {
    button_->setEnabled(false);
  }
}
