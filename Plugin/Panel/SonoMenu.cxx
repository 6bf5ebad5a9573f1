#include "SonoMenu.h"

#include "pqCoreUtilities.h"

#include <QAction>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QToolBar>
#include <QToolButton>

#include <algorithm>

namespace {

QMenu* menuOf(QToolBar* bar, QAction* action)
{
  auto* button = qobject_cast<QToolButton*>(bar->widgetForAction(action));
  return button ? button->menu() : nullptr;
}

void fill(QMenu* menu, QToolBar* bar)
{
  menu->clear();
  for (QAction* action : bar->actions())
  {
    if (QMenu* inner = menuOf(bar, action))
    {
      menu->addMenu(inner);
    }
    else
    {
      menu->addAction(action);
    }
  }
  menu->addSeparator();
  for (QAction* action : pqCoreUtilities::mainWidget()->actions())
  {
    if (action->objectName().startsWith("actionSono"))
    {
      menu->addAction(action);
    }
  }
}

} // namespace

void sonoInstallMenu(QToolBar* bar)
{
  auto* window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
  if (!window)
  {
    return;
  }
  const QList<QAction*> menus = window->menuBar()->actions();
  const auto help = std::find_if(menus.begin(), menus.end(), [](const QAction* each) {
    return each->menu() && each->menu()->objectName() == "menu_Help";
  });
  auto* menu = new QMenu(QObject::tr("&Ultrasound"), window);
  menu->setObjectName("SonoMenu");
  menu->setToolTipsVisible(true);
  window->menuBar()->insertMenu(help == menus.end() ? nullptr : *help, menu);
  QObject::connect(menu, &QMenu::aboutToShow, bar, [menu, bar] { fill(menu, bar); });
}
