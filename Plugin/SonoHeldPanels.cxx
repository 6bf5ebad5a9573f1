#include "SonoHeldPanels.h"

#include "pqCoreUtilities.h"

#include <QCoreApplication>
#include <QDockWidget>
#include <QEvent>
#include <QGuiApplication>
#include <QStatusBar>
#include <QToolBar>

namespace {

constexpr int paintedMs = 250;

/// Qt paints with a priority of its own, after which this one comes.
constexpr int afterPainting = Qt::LowEventPriority - 1;

QEvent::Type painted()
{
  static const int type = QEvent::registerEventType();
  return static_cast<QEvent::Type>(type);
}

} // namespace

SonoHeldPanels::SonoHeldPanels()
{
  const QWidget* window = pqCoreUtilities::mainWidget();
  const auto take = [this](const auto& found) {
    for (QWidget* panel : found)
    {
      if (panel->isVisible() && panel->updatesEnabled())
      {
        this->Panels.append(panel);
      }
    }
  };
  take(window->findChildren<QDockWidget*>());
  take(window->findChildren<QToolBar*>());
  take(window->findChildren<QStatusBar*>());
  this->paint(false);
  this->Look.setInterval(paintedMs);
  QObject::connect(&this->Look, &QTimer::timeout, this, [this] { look(); });
  this->Look.start();
}

SonoHeldPanels::~SonoHeldPanels()
{
  this->paint(true);
}

void SonoHeldPanels::paint(bool wanted)
{
  for (const QPointer<QWidget>& panel : this->Panels)
  {
    if (panel)
    {
      panel->setUpdatesEnabled(wanted);
    }
  }
}

void SonoHeldPanels::look()
{
  this->paint(true);
  if (QGuiApplication::mouseButtons() == Qt::NoButton)
  {
    this->Look.stop(); // however the drag has ended
    return;
  }
  QCoreApplication::postEvent(this, new QEvent(painted()), afterPainting);
}

bool SonoHeldPanels::event(QEvent* happened)
{
  if (happened->type() != painted())
  {
    return QObject::event(happened);
  }
  this->paint(!this->Look.isActive());
  return true;
}
