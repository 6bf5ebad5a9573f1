#include "SonoDrawNow.h"

#include "vtkSMViewProxy.h"

#include <QCoreApplication>
#include <QEventLoop>

void sonoDrawNow(vtkSMViewProxy* view)
{
  const auto settle = [] {
    QCoreApplication::processEvents(QEventLoop::ExcludeUserInputEvents | QEventLoop::ExcludeSocketNotifiers |
                                    QEventLoop::X11ExcludeTimers);
  };
  settle();
  view->StillRender();
  settle();
}
