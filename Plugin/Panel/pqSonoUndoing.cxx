#include "pqSonoUndoing.h"

#include "pqApplicationCore.h"
#include "pqUndoStack.h"

#include <QCoreApplication>
#include <QEvent>

pqSonoUndoing::pqSonoUndoing(QObject* parent)
  : QObject(parent)
{
  QCoreApplication::instance()->installEventFilter(this);
}

bool pqSonoUndoing::eventFilter(QObject* watched, QEvent* event)
{
  // ParaView's own timers: one that rings once and has not been heard rings again.
  if (event->type() != QEvent::Timer || !watched->inherits("pqTimer"))
  {
    return false;
  }
  const pqUndoStack* stack = pqApplicationCore::instance()->getUndoStack();
  return stack && (stack->getInUndo() || stack->getInRedo());
}
