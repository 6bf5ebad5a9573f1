#include "pqSonoNeedleFollow.h"

#include "SonoFreeze.h"
#include "SonoMovingViews.h"
#include "SonoNeedleHere.h"
#include "SonoUltrasoundHere.h"
#include "SonoWaiting.h"
#include "SonoWidgetOf.h"
#include "pqSonoProbeWidget.h"
#include "pqSonoStop.h"

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

#include <algorithm>
#include <utility>

namespace {

constexpr int settledMs = 300;
constexpr std::array<const char*, 2> endNames{ "HubMm", "TipMm" };
constexpr std::array<const char*, 2> handleNames{ "Point1WorldPosition", "Point2WorldPosition" };

/// Whether a source shows what it scans as soon as it is scanned.
bool isLive(const pqPropertiesPanel* panel, const pqPipelineSource* source)
{
  const auto* probe = sonoWidgetOf<pqSonoProbeWidget>(panel, source->getProxy());
  return sonoIsUltrasound(source->getProxy()) && !sonoIsFrozen(source->getProxy()) && !pqSonoStop::waits(source) &&
         (!probe || probe->isLive());
}

} // namespace

pqSonoNeedleFollow::pqSonoNeedleFollow(QObject* parent)
  : QObject(parent)
{
  soon_.setSingleShot(true);
  rest_.setSingleShot(true);
  rest_.setInterval(settledMs);
  QObject::connect(&soon_, &QTimer::timeout, this, &pqSonoNeedleFollow::follow);
  QObject::connect(&rest_, &QTimer::timeout, this, [this] { rest(); });
  // The panel is made after the toolbars, and what it shows after a source was chosen.
  QObject::connect(
    &pqActiveObjects::instance(), &pqActiveObjects::sourceChanged, this, [this] { watch(); }, Qt::QueuedConnection);
}

pqSonoNeedleFollow::~pqSonoNeedleFollow() = default;

/// The handles of the active needle; those before are let go when they rest.
void pqSonoNeedleFollow::watch()
{
  pqPipelineSource* active = pqActiveObjects::instance().activeSource();
  if (!active || !sonoIsNeedle(active->getProxy()))
  {
    return;
  }
  panel_ = pqCoreUtilities::mainWidget()->findChild<pqPropertiesPanel*>();
  auto* handles = panel_ ? sonoWidgetOf<pqInteractivePropertyWidget>(panel_, active->getProxy()) : nullptr;
  if (handles == handles_)
  {
    return;
  }
  if (isMoving_)
  {
    this->rest();
  }
  if (handles_)
  {
    handles_->disconnect(this);
  }
  needle_ = active;
  handles_ = handles;
  if (handles_)
  {
    this->connect(handles_, SIGNAL(startInteraction()), SLOT(grip()));
    this->connect(handles_, SIGNAL(interaction()), &soon_, SLOT(start()));
    this->connect(handles_, SIGNAL(endInteraction()), SLOT(finish()));
  }
}

/// Before anything of it has been changed.
bool pqSonoNeedleFollow::mayFollow() const
{
  const QList<pqPipelineSource*> consumers = needle_->getAllConsumers();
  return needle_->modifiedState() == pqProxy::UNMODIFIED && !sonoAnyWaits() && !consumers.isEmpty() &&
         std::all_of(consumers.begin(), consumers.end(),
                     [this](const pqPipelineSource* consumer) { return isLive(panel_, consumer); });
}

void pqSonoNeedleFollow::grip()
{
  rest_.stop();
  if (isMoving_ || !needle_ || !panel_ || !this->mayFollow())
  {
    return;
  }
  pictures_.clear();
  for (pqPipelineSource* consumer : needle_->getAllConsumers())
  {
    pictures_.append(consumer);
  }
  for (std::size_t end = 0; end < before_.size(); ++end)
  {
    vtkSMPropertyHelper(needle_->getProxy(), endNames[end]).Get(before_[end].data(), 3);
  }
  isMoving_ = true;
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

void pqSonoNeedleFollow::setPreview(bool preview)
{
  for (const auto& picture : pictures_)
  {
    if (picture)
    {
      vtkSMPropertyHelper(picture->getProxy(), "Preview").Set(preview ? 1 : 0);
      picture->getProxy()->UpdateVTKObjects();
    }
  }
}

void pqSonoNeedleFollow::setEnds(const Ends& ends)
{
  for (std::size_t end = 0; end < ends.size(); ++end)
  {
    vtkSMPropertyHelper(needle_->getProxy(), endNames[end]).Set(ends[end].data(), 3);
  }
  needle_->getProxy()->UpdateVTKObjects();
}

void pqSonoNeedleFollow::follow()
{
  if (!isMoving_ || !needle_ || !handles_ || !pictures_.front())
  {
    return;
  }
  if (needle_->getProxy()->GetSession()->GetPendingProgress())
  {
    soon_.start(); // not while something runs
    return;
  }
  if (!shown_)
  {
    shown_ = std::make_unique<SonoMovingViews>(pictures_.front()->getProxy());
  }
  {
    SCOPED_UNDO_EXCLUDE();
    this->setPreview(true);
    this->setEnds(this->endsOfWidget());
  }
  shown_->draw();
}

void pqSonoNeedleFollow::finish()
{
  rest_.start();
}

void pqSonoNeedleFollow::rest()
{
  if (!isMoving_)
  {
    return;
  }
  const bool isPending = needle_ && needle_->getProxy()->GetSession()->GetPendingProgress();
  if (isPending || QGuiApplication::mouseButtons() != Qt::NoButton)
  {
    rest_.start();
    return;
  }
  isMoving_ = false;
  soon_.stop();
  const std::unique_ptr<SonoMovingViews> shown = std::move(shown_);
  if (!needle_ || !handles_ || !panel_)
  {
    SCOPED_UNDO_EXCLUDE();
    this->setPreview(false);
    return;
  }
  const Ends after = this->endsOfWidget();
  if (shown)
  {
    shown->drawInFull();
  }
  const SonoKeptDrawing anatomy(pictures_.front() ? pictures_.front()->getProxy() : nullptr, SonoKept::Anatomy);
  {
    // So that undo finds where it was, not a place on the way.
    SCOPED_UNDO_EXCLUDE();
    this->setPreview(false);
    this->setEnds(before_);
  }
  vtkSMProxy* widget = handles_->widgetProxy();
  for (std::size_t end = 0; end < after.size(); ++end)
  {
    vtkSMPropertyHelper(widget, handleNames[end]).Set(after[end].data(), 3);
  }
  widget->UpdateVTKObjects();
  needle_->setModifiedState(pqProxy::MODIFIED);
  panel_->apply();
}
