#include "SonoDrawNow.h"

#include "vtkSMViewProxy.h"

#include <QCoreApplication>
#include <QEventLoop>

void sonoDrawNow(vtkSMViewProxy* view)
{
  sonoShowSoFar();
  view->StillRender();
  sonoShowSoFar();
}

void sonoShowSoFar()
{
  QCoreApplication::processEvents(QEventLoop::ExcludeUserInputEvents | QEventLoop::ExcludeSocketNotifiers |
                                  QEventLoop::X11ExcludeTimers);
}
