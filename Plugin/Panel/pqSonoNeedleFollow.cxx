#include "pqSonoNeedleFollow.h"

#include "SonoFreeze.h"
#include "SonoMovingViews.h"
#include "SonoUltrasoundHere.h"
#include "SonoWaiting.h"

#include "pqActiveObjects.h"
#include "pqCoreUtilities.h"
#include "pqInteractivePropertyWidget.h"
#include "pqPipelineSource.h"
#include "pqPropertiesPanel.h"
#include "pqUndoStack.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"

#include <QGuiApplication>

#include <cstring>
#include <utility>

namespace {

constexpr int settledMs = 300;
constexpr std::array<const char*, 2> endNames{ "HubMm", "TipMm" };
constexpr std::array<const char*, 2> handleNames{ "Point1WorldPosition", "Point2WorldPosition" };

/// The handles that the panel shows of a source.
pqInteractivePropertyWidget* handlesOf(const pqPropertiesPanel* panel, const pqPipelineSource* source)
{
  for (auto* widget : panel->findChildren<pqInteractivePropertyWidget*>())
  {
    if (widget->proxy() == source->getProxy())
    {
      return widget;
    }
  }
  return nullptr;
}

/// The Simulate Ultrasounds that have it among their targets and show what they scan.
QList<QPointer<pqPipelineSource>> picturesOf(const pqPipelineSource* needle)
{
  QList<QPointer<pqPipelineSource>> pictures;
  for (pqPipelineSource* consumer : needle->getAllConsumers())
  {
    if (sonoIsUltrasound(consumer->getProxy()) && !sonoIsFrozen(consumer->getProxy()))
    {
      pictures.append(consumer);
    }
  }
  return pictures;
}

} // namespace

pqSonoNeedleFollow::pqSonoNeedleFollow(QObject* parent)
  : QObject(parent)
{
  soon_.setSingleShot(true);
  rest_.setSingleShot(true);
  rest_.setInterval(settledMs);
  QObject::connect(&soon_, &QTimer::timeout, this, [this] { follow(); });
  QObject::connect(&rest_, &QTimer::timeout, this, [this] { rest(); });
  // The panel is made after the toolbars.
  QTimer::singleShot(0, this, [this] {
    panel_ = pqCoreUtilities::mainWidget()->findChild<pqPropertiesPanel*>();
    if (panel_)
    {
      QObject::connect(panel_, &pqPropertiesPanel::modified, &soon_, QOverload<>::of(&QTimer::start));
    }
  });
}

pqSonoNeedleFollow::~pqSonoNeedleFollow() = default;

/// Whether a needle is dragged, or was and does not rest yet.
bool pqSonoNeedleFollow::begin()
{
  if (shown_)
  {
    return needle_ && handles_;
  }
  pqPipelineSource* active = pqActiveObjects::instance().activeSource();
  const bool isNeedle = active && std::strcmp(active->getProxy()->GetXMLName(), "SonoNeedle") == 0 &&
                        active->modifiedState() == pqProxy::MODIFIED && !sonoAnyWaits(active->getProxy());
  pqInteractivePropertyWidget* handles = isNeedle ? handlesOf(panel_, active) : nullptr;
  if (!handles || QGuiApplication::mouseButtons() == Qt::NoButton)
  {
    return false; // what is typed waits for Apply
  }
  pictures_ = picturesOf(active);
  if (pictures_.isEmpty())
  {
    return false;
  }
  needle_ = active;
  handles_ = handles;
  for (std::size_t end = 0; end < before_.size(); ++end)
  {
    vtkSMPropertyHelper(active->getProxy(), endNames[end]).Get(before_[end].data(), 3);
  }
  shown_ = std::make_unique<SonoMovingViews>(pictures_.front()->getProxy());
  return true;
}

pqSonoNeedleFollow::Ends pqSonoNeedleFollow::endsOfWidget() const
{
  Ends ends{};
  for (std::size_t end = 0; end < ends.size(); ++end)
  {
    vtkSMPropertyHelper(handles_->widgetProxy(), handleNames[end]).Get(ends[end].data(), 3);
  }
  return ends;
}

/// No step of undo.
void pqSonoNeedleFollow::push(const Ends& ends, bool preview)
{
  SCOPED_UNDO_EXCLUDE();
  for (const auto& picture : pictures_)
  {
    if (picture)
    {
      vtkSMPropertyHelper(picture->getProxy(), "Preview").Set(preview ? 1 : 0);
      picture->getProxy()->UpdateVTKObjects();
    }
  }
  for (std::size_t end = 0; end < ends.size(); ++end)
  {
    vtkSMPropertyHelper(needle_->getProxy(), endNames[end]).Set(ends[end].data(), 3);
  }
  needle_->getProxy()->UpdateVTKObjects();
}

void pqSonoNeedleFollow::follow()
{
  if (!panel_ || !this->begin())
  {
    return;
  }
  if (needle_->getProxy()->GetSession()->GetPendingProgress())
  {
    soon_.start(); // not while something runs
    return;
  }
  const Ends now = this->endsOfWidget();
  this->push(now, true);
  shown_->draw();
  rest_.start();
}

void pqSonoNeedleFollow::rest()
{
  if (QGuiApplication::mouseButtons() != Qt::NoButton ||
      (needle_ && needle_->getProxy()->GetSession()->GetPendingProgress()))
  {
    rest_.start();
    return;
  }
  const std::unique_ptr<SonoMovingViews> shown = std::move(shown_);
  if (!needle_)
  {
    return;
  }
  if (!handles_) // another source was selected meanwhile: it stays where the hand has left it
  {
    Ends last{};
    for (std::size_t end = 0; end < last.size(); ++end)
    {
      vtkSMPropertyHelper(needle_->getProxy(), endNames[end]).Get(last[end].data(), 3);
    }
    this->push(last, false);
    return;
  }
  const Ends after = this->endsOfWidget();
  shown->drawInFull();
  const SonoKeptAnatomy anatomy(pictures_.front() ? pictures_.front()->getProxy() : nullptr);
  this->push(before_, false); // so that undo finds where it was, not a place on the way
  vtkSMProxy* widget = handles_->widgetProxy();
  for (std::size_t end = 0; end < after.size(); ++end)
  {
    vtkSMPropertyHelper(widget, handleNames[end]).Set(after[end].data(), 3);
  }
  widget->UpdateVTKObjects();
  Q_EMIT handles_->changeAvailable();
  panel_->apply();
  needle_ = nullptr;
}
