#pragma once

#include <QCoreApplication>
#include <QEvent>
#include <QObject>

/// Keeps timers from firing while it is there: what they do would be done in the middle of what goes on, where events
/// are looked at. QEventLoop::X11ExcludeTimers alone does not: with GLib's event loop, Debian's, they fire whenever
/// there is nothing else to do. One that was due fires again later, also one that rings once.
class SonoTimersWait : public QObject
{
public:
  SonoTimersWait() { QCoreApplication::instance()->installEventFilter(this); }

protected:
  bool eventFilter(QObject*, QEvent* event) override { return event->type() == QEvent::Timer; }
};
