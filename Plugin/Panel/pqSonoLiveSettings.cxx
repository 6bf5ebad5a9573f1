#include "pqSonoLiveSettings.h"

#include "SonoMovingViews.h"
#include "SonoWaiting.h"
#include "pqSonoStop.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqPropertiesPanel.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkCommand.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"
#include "vtkSMStringVectorProperty.h"
#include "vtkSMTrace.h"
#include "vtkSMUncheckedPropertyHelper.h"
#include "vtkSMVectorProperty.h"
#include "vtkSmartPointer.h"

#include <QGuiApplication>

#include <utility>

namespace {

constexpr int settledMs = 300;
constexpr int burstMs = 100;

/// Of a probe, what no scan line stands by: how it is scanned while it moves.
bool isOfMoving(const std::string& name)
{
  return name == "Preview" || name == "PrepareInteraction";
}

bool isText(vtkSMProxy* proxy, const std::string& name)
{
  return vtkSMStringVectorProperty::SafeDownCast(proxy->GetProperty(name.c_str())) != nullptr;
}

} // namespace

pqSonoLiveSettings::pqSonoLiveSettings(vtkSMProxy* proxy, std::function<bool()> isLive, std::function<bool()> mayScan,
                                       std::function<void()> beforePicture, QObject* parentObject)
  : QObject(parentObject)
  , Proxy(proxy)
  , IsLive(std::move(isLive))
  , MayScan(std::move(mayScan))
  , BeforePicture(std::move(beforePicture))
{
  const auto all = vtkSmartPointer<vtkSMPropertyIterator>::Take(proxy->NewPropertyIterator());
  for (all->Begin(); !all->IsAtEnd(); all->Next())
  {
    auto* setting = vtkSMVectorProperty::SafeDownCast(all->GetProperty());
    if (!setting || setting->GetInformationOnly() || setting->GetNumberOfElements() != 1)
    {
      continue;
    }
    const std::string stage = setting->GetParent()->GetXMLName();
    if (stage == "BMode" || stage == "ScanConverter")
    {
      this->Display[all->GetKey()];
      for (const auto event : { vtkCommand::ModifiedEvent, vtkCommand::UncheckedPropertyModifiedEvent })
      {
        pqCoreUtilities::connect(setting, event, this, SLOT(displayChanged()));
      }
    }
    else if (((stage == "Probe" || stage == "SonoProbeSource") && !isOfMoving(all->GetKey())) ||
             all->GetKey() == std::string("TargetErrorDb"))
    {
      this->Scan[all->GetKey()];
      pqCoreUtilities::connect(setting, vtkCommand::UncheckedPropertyModifiedEvent, this, SLOT(scanChanged()));
    }
  }
  this->Frame.setSingleShot(true);
  this->Frame.setInterval(0);
  QObject::connect(&this->Frame, &QTimer::timeout, this, [this] { showStep(); });
  this->Rest.setSingleShot(true);
  this->Rest.setInterval(settledMs);
  QObject::connect(&this->Rest, &QTimer::timeout, this, [this] { rest(); });
}

pqSonoLiveSettings::~pqSonoLiveSettings() = default;

pqSonoLiveSettings::Settings pqSonoLiveSettings::applied(const Settings& among) const
{
  Settings found;
  for (const auto& [name, unused] : among)
  {
    const vtkSMPropertyHelper now(this->Proxy, name.c_str());
    found[name] = isText(this->Proxy, name) ? Setting{ 0.0, now.GetAsString() } : Setting{ now.GetAsDouble(), "" };
  }
  return found;
}

pqSonoLiveSettings::Settings pqSonoLiveSettings::waiting(const Settings& among) const
{
  Settings found;
  for (const auto& [name, now] : this->applied(among))
  {
    vtkSMUncheckedPropertyHelper helper(this->Proxy, name.c_str());
    const bool text = isText(this->Proxy, name);
    const Setting next = text ? Setting{ 0.0, helper.GetAsString() } : Setting{ helper.GetAsDouble(), "" };
    if (next.number != now.number || next.text != now.text)
    {
      found[name] = next;
    }
  }
  return found;
}

void pqSonoLiveSettings::set(const Settings& settings)
{
  for (const auto& [name, setting] : settings)
  {
    vtkSMPropertyHelper property(this->Proxy, name.c_str());
    isText(this->Proxy, name) ? property.Set(setting.text.c_str()) : property.Set(setting.number);
  }
  this->Proxy->UpdateVTKObjects();
}

/// A run that was stopped does not start again by itself.
bool pqSonoLiveSettings::isLive() const
{
  return this->IsLive() &&
         !pqSonoStop::waits(pqApplicationCore::instance()->getServerManagerModel()->findItem<pqProxy*>(this->Proxy));
}

/// Before a panel marks the source as one that waits for Apply.
void pqSonoLiveSettings::begin()
{
  if (!this->IsAsked && !this->Frame.isActive() && !this->Rest.isActive() && !this->Shown)
  {
    this->NothingWaits = !sonoAnyWaits();
    this->Before.clear();
  }
}

void pqSonoLiveSettings::displayChanged()
{
  if (!this->IsSetting && this->isLive())
  {
    this->begin();
    this->askForStep();
  }
}

/// A first step before the window is painted for the slider that has moved: in software that takes as long as the
/// picture, and would be done twice. One of many waits until all has been heard that has come meanwhile.
void pqSonoLiveSettings::askForStep()
{
  if (this->IsAsked || (this->SinceStep.isValid() && this->SinceStep.elapsed() < burstMs))
  {
    return this->Frame.start();
  }
  this->IsAsked = true;
  QMetaObject::invokeMethod(
    this,
    [this] {
      this->IsAsked = false;
      this->showStep();
    },
    Qt::QueuedConnection); // Qt paints after what is queued, and fires timers after that
}

void pqSonoLiveSettings::scanChanged()
{
  if (!this->IsSetting && this->isLive() && this->MayScan())
  {
    this->begin();
    this->Rest.start();
  }
}

void pqSonoLiveSettings::showStep()
{
  const Settings next = this->waiting(this->Display);
  if (next.empty())
  {
    return;
  }
  if (this->Proxy->GetSession()->GetPendingProgress())
  {
    this->Frame.start(); // not while something runs
    return;
  }
  for (const auto& [name, before] : this->applied(next))
  {
    this->Before.insert({ name, before }); // the first one stays
  }
  if (!this->Shown)
  {
    this->Shown = std::make_unique<SonoMovingViews>(this->Proxy);
  }
  {
    SCOPED_UNDO_EXCLUDE();
    this->set(next);
  }
  this->Shown->drawGrey();
  this->SinceStep.start();
  this->Rest.start(); // however long that took
}

void pqSonoLiveSettings::rest()
{
  const bool isHeld = QGuiApplication::mouseButtons() != Qt::NoButton; // a slider
  if (isHeld || this->Proxy->GetSession()->GetPendingProgress())
  {
    this->Rest.start();
    return;
  }
  const std::unique_ptr<SonoMovingViews> shown = std::move(this->Shown);
  if (!this->isLive())
  {
    return;
  }
  Settings after = this->applied(this->Before);
  if (this->MayScan())
  {
    after.merge(this->waiting(this->Scan));
  }
  if (after.empty())
  {
    return; // as when the probe's widget has set its depth itself
  }
  if (shown)
  {
    shown->drawInFull();
  }
  const SonoKeptDrawing anatomy(this->Proxy, SonoKept::Anatomy);
  this->IsSetting = true;
  this->BeforePicture();
  {
    // So that undo finds what there was at first, not a step on the way.
    SCOPED_UNDO_EXCLUDE();
    this->set(this->Before);
  }
  auto* panel = pqCoreUtilities::mainWidget()->findChild<pqPropertiesPanel*>();
  if (panel && this->NothingWaits)
  {
    for (const auto& [name, setting] : after)
    {
      vtkSMUncheckedPropertyHelper property(this->Proxy, name.c_str());
      isText(this->Proxy, name) ? property.Set(setting.text.c_str()) : property.Set(setting.number);
    }
    panel->apply();
  }
  else
  {
    // Something else waits for Apply and goes on waiting.
    {
      SCOPED_UNDO_SET(tr("Change Settings"));
      SM_SCOPED_TRACE(PropertiesModified).arg("proxy", this->Proxy);
      this->set(after);
    }
    pqApplicationCore::instance()->render();
  }
  this->IsSetting = false;
}
