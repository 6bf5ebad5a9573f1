#include "pqSonoLoading.h"

#include "pqApplicationCore.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"

#include <QCoreApplication>
#include <QEvent>
#include <QOpenGLWidget>
#include <QTimer>

#include <algorithm>
#include <utility>

pqSonoLoading::pqSonoLoading(QObject* parent)
  : QObject(parent)
{
  QCoreApplication::instance()->installEventFilter(this);
}

bool pqSonoLoading::eventFilter(QObject* watched, QEvent* event)
{
  auto* widget = event->type() == QEvent::Paint ? qobject_cast<QOpenGLWidget*>(watched) : nullptr;
  if (!widget)
  {
    return false;
  }
  vtkSMSessionProxyManager* manager = vtkSMProxyManager::GetProxyManager()->GetActiveSessionProxyManager();
  const bool isLoading = manager && manager->GetInLoadXMLState();
  if (isLoading && unpainted_.empty())
  {
    QTimer::singleShot(0, this, [this] { draw(); });
  }
  // Until it is drawn with its data no picture of it is asked for either.
  const bool waits = std::find(unpainted_.begin(), unpainted_.end(), widget) != unpainted_.end();
  if (isLoading && !waits)
  {
    unpainted_.emplace_back(widget);
  }
  return isLoading || waits;
}

void pqSonoLoading::draw()
{
  const auto unpainted = std::exchange(unpainted_, {});
  for (pqView* view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqView*>())
  {
    QWidget* widget = view->widget();
    const bool isOne = widget && std::any_of(unpainted.begin(), unpainted.end(), [widget](const auto& one) {
                         return one && (one == widget || widget->isAncestorOf(one));
                       });
    if (isOne)
    {
      view->forceRender();
    }
  }
}
