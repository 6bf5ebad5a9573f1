#include "pqSonoStop.h"

#include "SonoServerStops.h"
#include "SonoTell.h"
#include "SonoTimersWait.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqPipelineSource.h"
#include "pqProgressManager.h"
#include "pqProgressWidget.h"
#include "pqPropertiesPanel.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "vtkAlgorithm.h"
#include "vtkOutputWindow.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"

#include <QApplication>
#include <QKeyEvent>
#include <QMainWindow>
#include <QMouseEvent>
#include <QOpenGLWidget>
#include <QStatusBar>
#include <QThread>
#include <QToolButton>
#include <QWheelEvent>
#include <QWindow>

#include <algorithm>

namespace {

constexpr int firstLookMs = 150; // shorter runs are over before anybody could stop them
constexpr int lookMs = 50;
constexpr int restPerLook = 10; // so that looking, which may draw, takes a tenth of the time
constexpr int longestRestMs = 1000;
constexpr int sentenceMs = 15000;
constexpr const char* waitsForApply = "SonoWaitsForApply"; // of a source, for others to know

pqProgressManager* progressManager()
{
  return pqApplicationCore::instance()->getProgressManager();
}

pqPipelineSource* sourceOf(vtkAlgorithm* filter)
{
  for (pqPipelineSource* source :
       pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>())
  {
    if (source->getProxy()->GetClientSideObject() == filter)
    {
      return source;
    }
  }
  return nullptr;
}

/// A copy to deliver later; nothing for events that are no input.
std::unique_ptr<QEvent> copyOf(QEvent* event)
{
  switch (event->type())
  {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseButtonDblClick:
    case QEvent::MouseMove:
      return std::make_unique<QMouseEvent>(*static_cast<QMouseEvent*>(event));
    case QEvent::KeyPress:
    case QEvent::KeyRelease:
      return std::make_unique<QKeyEvent>(*static_cast<QKeyEvent*>(event));
    case QEvent::Wheel:
      return std::make_unique<QWheelEvent>(*static_cast<QWheelEvent*>(event));
    default:
      return nullptr;
  }
}

bool isQuit(QEvent* event)
{
  return event->type() == QEvent::KeyPress && static_cast<QKeyEvent*>(event)->matches(QKeySequence::Quit);
}

} // namespace

pqSonoStop::pqSonoStop(QObject* parent)
  : QObject(parent)
{
  afterwards_.setSingleShot(true);
  afterwards_.setInterval(1); // a timer, because none fires while this looks for events
  QObject::connect(&afterwards_, &QTimer::timeout, this, &pqSonoStop::settle);
}

pqSonoStop::~pqSonoStop()
{
  this->shutdown();
}

void pqSonoStop::startup()
{
  sono::setInterrupter(this);
  pqProgressManager* manager = progressManager();
  QObject::connect(manager, &pqProgressManager::enableProgress, this, [this](bool on) { on ? begin() : end(); });
  QObject::connect(manager, &pqProgressManager::abort, this, [this] { stop_ = busy_; });
  servers_ = std::make_unique<SonoServerStops>([this] { return wantsStop(); });
  pqServerManagerModel* model = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(model, &pqServerManagerModel::sourceAdded, this, [this](pqPipelineSource* source) {
    if (servers_)
    {
      servers_->listenFor(source);
    }
  });
  QObject::connect(model, &pqServerManagerModel::preServerRemoved, this, [this](pqServer* server) {
    if (servers_)
    {
      servers_->forget(server->session());
    }
  });
}

void pqSonoStop::shutdown()
{
  sono::setInterrupter(nullptr);
  servers_.reset();
}

void pqSonoStop::begin()
{
  busy_ = true;
  // Events that wait were looked at with no button down; one that is down now belongs to them.
  dragging_ = held_.empty() && QGuiApplication::mouseButtons() != Qt::NoButton;
  sinceBegin_.start();
  sinceLook_.start();
}

void pqSonoStop::end()
{
  busy_ = false;
  progressManager()->setEnableAbort(false);
  if (stop_ || !held_.empty() || !waiting_.empty())
  {
    afterwards_.start();
  }
}

bool pqSonoStop::wantsStop()
{
  const bool canLook = busy_ && !dragging_ && !looking_ && QThread::currentThread() == this->thread();
  if (canLook && !stop_ && sinceBegin_.elapsed() > firstLookMs &&
      sinceLook_.elapsed() > std::clamp<qint64>(restPerLook * lastLookMs_, lookMs, longestRestMs))
  {
    this->look();
  }
  return stop_;
}

void pqSonoStop::look()
{
  looking_ = true;
  sinceLook_.start();
  progressManager()->setEnableAbort(true);
  qApp->installEventFilter(this); // in front of all others
  {
    // Some of ParaView's render, which would update the pipeline that is running, and a script's may delete it.
    const SonoTimersWait waiting;
    QCoreApplication::processEvents(QEventLoop::X11ExcludeTimers | QEventLoop::ExcludeSocketNotifiers);
  }
  qApp->removeEventFilter(this);
  lastLookMs_ = sinceLook_.restart();
  looking_ = false;
}

bool pqSonoStop::isOnButton(QEvent* event) const
{
  const auto* bar = pqCoreUtilities::mainWidget()->findChild<pqProgressWidget*>();
  const QToolButton* button = bar ? bar->abortButton() : nullptr;
  return button && button->isVisible() &&
         button->rect().contains(button->mapFromGlobal(static_cast<QMouseEvent*>(event)->globalPos()));
}

bool pqSonoStop::eventFilter(QObject* watched, QEvent* event)
{
  switch (event->type())
  {
    case QEvent::Paint:
      return qobject_cast<QOpenGLWidget*>(watched) != nullptr; // a view, which might render; it keeps its picture
    case QEvent::ShortcutOverride:
      event->accept(); // so that no shortcut acts
      return true;
    case QEvent::DragEnter:
    case QEvent::Drop:
    case QEvent::ContextMenu:
    case QEvent::TouchBegin:
    case QEvent::TabletPress:
      return true;
    default:
      break;
  }
  auto* window = qobject_cast<QWindow*>(watched);
  if (!window)
  {
    return false; // input comes to windows first
  }
  const bool isPress = event->type() == QEvent::MouseButtonPress;
  if (event->type() == QEvent::Close || isQuit(event))
  {
    closing_ = event->type() == QEvent::Close ? window : pqCoreUtilities::mainWidget()->windowHandle();
    stop_ = true;
    event->ignore();
    return true;
  }
  if ((event->type() == QEvent::KeyPress && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape) ||
      (isPress && this->isOnButton(event)))
  {
    stop_ = true;
    return true;
  }
  std::unique_ptr<QEvent> copy = copyOf(event);
  if (!copy)
  {
    return false;
  }
  if (!held_.empty() && copy->type() == QEvent::MouseMove && held_.back().second->type() == QEvent::MouseMove)
  {
    held_.pop_back();
  }
  held_.emplace_back(watched, std::move(copy));
  return true;
}

bool pqSonoStop::waits(const pqProxy* source)
{
  return source && source->property(waitsForApply).toBool();
}

void pqSonoStop::hasStopped(vtkAlgorithm* filter)
{
  stopped_.push_back(filter);
}

void pqSonoStop::hasFinished(vtkAlgorithm* filter)
{
  const auto isIt = [&](const QPointer<pqPipelineSource>& source) {
    return source && source->getProxy()->GetClientSideObject() == filter;
  };
  // Apply stays as it is: something may have been typed meanwhile.
  const auto finished = std::find_if(waiting_.begin(), waiting_.end(), isIt);
  if (finished != waiting_.end())
  {
    (*finished)->setProperty(waitsForApply, false);
    waiting_.erase(finished);
  }
}

void pqSonoStop::offerApply()
{
  for (const QPointer<pqPipelineSource>& source : waiting_)
  {
    if (source && source->modifiedState() == pqProxy::UNMODIFIED)
    {
      source->setModifiedState(pqProxy::MODIFIED);
    }
  }
}

/// A source that was stopped; true: it did not wait before.
bool pqSonoStop::await(pqPipelineSource* source)
{
  if (std::find(waiting_.begin(), waiting_.end(), source) != waiting_.end())
  {
    return false;
  }
  waiting_.emplace_back(source);
  source->setProperty(waitsForApply, true);
  return true;
}

/// Those on servers tell of nothing and are asked.
void pqSonoStop::settleServers(QStringList& names)
{
  for (auto* source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>())
  {
    if (!servers_->isOn(source))
    {
      continue;
    }
    const auto known = std::find(waiting_.begin(), waiting_.end(), source);
    if (servers_->waits(source))
    {
      if (this->await(source))
      {
        names << source->getSMName();
      }
    }
    else if (known != waiting_.end())
    {
      source->setProperty(waitsForApply, false);
      waiting_.erase(known);
    }
  }
}

void pqSonoStop::settle()
{
  QStringList names;
  for (vtkAlgorithm* filter : std::exchange(stopped_, {}))
  {
    pqPipelineSource* source = sourceOf(filter);
    if (source && !names.contains(source->getSMName()))
    {
      names << source->getSMName();
      this->await(source);
    }
  }
  if (std::exchange(stop_, false) || !waiting_.empty())
  {
    this->settleServers(names);
  }
  this->offerApply();
  if (!names.isEmpty())
  {
    const QString sentence =
      tr("Stopped: %1. What was there before is shown; select it and click Apply to run it again.")
        .arg(names.join(", "));
    vtkOutputWindowDisplayText((sentence + "\n").toUtf8().data());
    if (auto* window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget()))
    {
      window->statusBar()->showMessage(tr("Stopped; select it and click Apply."), sentenceMs); // there is little room
    }
  }
  if (auto* panel = pqCoreUtilities::mainWidget()->findChild<pqPropertiesPanel*>())
  {
    QObject::connect(panel, QOverload<pqProxy*>::of(&pqPropertiesPanel::applied), this, &pqSonoStop::runAgain,
                     Qt::UniqueConnection);
    QObject::connect(panel, &pqPropertiesPanel::resetDone, this, &pqSonoStop::offerApply, Qt::UniqueConnection);
  }
  for (auto& [receiver, event] : std::exchange(held_, {}))
  {
    if (receiver)
    {
      QCoreApplication::postEvent(receiver, event.release());
    }
  }
  if (closing_)
  {
    std::exchange(closing_, nullptr)->close();
  }
}

void pqSonoStop::runAgain(pqProxy* applied)
{
  const auto found = std::find(waiting_.begin(), waiting_.end(), qobject_cast<pqPipelineSource*>(applied));
  if (found != waiting_.end() && *found)
  {
    waiting_.erase(found);
    applied->setProperty(waitsForApply, false);
    vtkSMProxy* proxy = applied->getProxy();
    sonoTell(proxy, "Modified");
    proxy->MarkModified(proxy);
  }
}
