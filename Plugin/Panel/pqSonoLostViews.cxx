#include "pqSonoLostViews.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqPropertiesPanel.h"
#include "pqProxy.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkSMViewProxy.h"

#include <QTimer>

namespace {

/// ParaView looks at those alone that are out of date.
void bringUpToDate()
{
  for (pqView* view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqView*>())
  {
    if (!view->widget() && view->getViewProxy()->GetNeedsUpdate())
    {
      view->getViewProxy()->Update();
    }
  }
}

} // namespace

pqSonoLostViews::pqSonoLostViews(QObject* parent)
  : QObject(parent)
{
  QTimer::singleShot(0, this, [this] { listen(); }); // when the window is complete
}

void pqSonoLostViews::listen()
{
  for (auto* panel : pqCoreUtilities::mainWidget()->findChildren<pqPropertiesPanel*>())
  {
    // Of each proxy, before it is said that all are.
    QObject::connect(panel, QOverload<pqProxy*>::of(&pqPropertiesPanel::applied), this, bringUpToDate);
  }
}
