#include "pqSonoDelete.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqPipelineSource.h"
#include "pqPropertiesPanel.h"
#include "pqServerManagerModel.h"

#include <QAbstractButton>
#include <QEvent>
#include <QStringList>
#include <QTimer>

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
  QObject::connect(model, QOverload<pqPipelineSource*, pqPipelineSource*, int>::of(&pqServerManagerModel::connectionAdded),
                   this, [this] { look(); });
  QObject::connect(model,
                   QOverload<pqPipelineSource*, pqPipelineSource*, int>::of(&pqServerManagerModel::connectionRemoved),
                   this, [this, panel] {
                     QMetaObject::invokeMethod(panel, "updateButtonState");
                     look();
                   });
  look();
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
