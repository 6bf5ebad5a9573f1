#include "pqSonoLink.h"

#include "SonoMovingViews.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqOutputPort.h"
#include "pqPipelineFilter.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSession.h"
#include "vtkSMSourceProxy.h"

#include <QMainWindow>
#include <QStatusBar>

#include <algorithm>
#include <cstring>

namespace {

constexpr int watchMs = 15; // for 60 pictures a second
constexpr int sayMs = 500;
constexpr int quietMs = 300; // then the hand rests

const char* const poseParts[] = { "PositionMm", "Axial", "Lateral" };

/// Who has the pose that a source's data were made with.
pqPipelineSource* probeOf(pqPipelineSource* source)
{
  const auto has = [source](const char* name) { return source->getProxy()->GetProperty(name) != nullptr; };
  if (std::all_of(std::begin(poseParts), std::end(poseParts), has))
  {
    return source;
  }
  if (const auto* filter = qobject_cast<pqPipelineFilter*>(source))
  {
    for (pqOutputPort* input : filter->getAllInputs())
    {
      if (pqPipelineSource* found = probeOf(input->getSource()))
      {
        return found;
      }
    }
  }
  return nullptr;
}

void setPreview(vtkSMProxy* probe, bool preview)
{
  vtkSMPropertyHelper(probe, "Preview", true).Set(preview ? 1 : 0);
}

} // namespace

pqSonoLink::pqSonoLink(QObject* parent)
  : QObject(parent)
{
}

pqSonoLink::~pqSonoLink() = default;

void pqSonoLink::startup()
{
  this->Watch.setInterval(watchMs);
  this->Listen.setInterval(sayMs);
  this->Rest.setInterval(quietMs);
  this->Rest.setSingleShot(true);
  QObject::connect(&this->Watch, &QTimer::timeout, this, [this] { look(); });
  QObject::connect(&this->Listen, &QTimer::timeout, this, [this] { say(); });
  QObject::connect(&this->Rest, &QTimer::timeout, this, [this] { rest(); });
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(model, &pqServerManagerModel::sourceAdded, this, [this](pqPipelineSource* source) { add(source); });
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>())
  {
    this->add(source);
  }
}

void pqSonoLink::shutdown()
{
  this->Watch.stop();
  this->Listen.stop();
  this->Rest.stop();
  this->Shown.reset();
}

void pqSonoLink::add(pqPipelineSource* source)
{
  if (std::strcmp(source->getProxy()->GetXMLName(), "SonoLiveLink") == 0)
  {
    this->Links.append({ source, 0, {} });
    this->Watch.start();
    this->Listen.start();
  }
}

void pqSonoLink::look()
{
  const auto isGone = [](const Known& known) { return !known.link; };
  this->Links.erase(std::remove_if(this->Links.begin(), this->Links.end(), isGone), this->Links.end());
  if (this->Links.empty())
  {
    this->Watch.stop();
    this->Listen.stop();
    return;
  }
  for (Known& known : this->Links)
  {
    vtkSMProxy* link = known.link->getProxy();
    if (link->GetSession()->GetPendingProgress())
    {
      return; // not while something runs
    }
    link->UpdatePropertyInformation(link->GetProperty("ReceivedCount"));
    const int count = vtkSMPropertyHelper(link, "ReceivedCount").GetAsInt();
    const bool isNew = count > known.count;
    known.count = count; // less where the port was opened anew
    if (isNew && this->take(known.link))
    {
      return; // the others at the next look
    }
  }
}

/// In the window's status bar.
void pqSonoLink::say()
{
  for (Known& known : this->Links)
  {
    if (!known.link || known.link->getProxy()->GetSession()->GetPendingProgress())
    {
      continue;
    }
    vtkSMProxy* link = known.link->getProxy();
    link->UpdatePropertyInformation(link->GetProperty("Status"));
    const QString status = vtkSMPropertyHelper(link, "Status").GetAsString();
    auto* window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
    if (status != known.status && window)
    {
      known.status = status;
      window->statusBar()->showMessage(known.link->getSMName() + ": " + status);
    }
  }
}

/// False where there is no probe to move.
bool pqSonoLink::take(pqPipelineSource* link)
{
  pqPipelineSource* probe = probeOf(link);
  if (!probe)
  {
    return false;
  }
  if (this->Probe && this->Probe != probe)
  {
    this->rest();
  }
  link->getProxy()->UpdatePropertyInformation(link->getProxy()->GetProperty("ReceivedPose"));
  const std::vector<double> pose = vtkSMPropertyHelper(link->getProxy(), "ReceivedPose").GetDoubleArray();
  if (!this->Shown)
  {
    this->Probe = probe;
    this->Shown = std::make_unique<SonoMovingViews>(probe->getProxy());
  }
  {
    SCOPED_UNDO_EXCLUDE();
    for (std::size_t part = 0; part < 3; ++part)
    {
      vtkSMPropertyHelper(probe->getProxy(), poseParts[part]).Set(&pose[3 * part], 3);
    }
    setPreview(probe->getProxy(), true);
    probe->getProxy()->UpdateVTKObjects();
  }
  this->Rest.start();
  this->Shown->draw();
  link->getSourceProxy()->UpdatePipeline(); // where it is not shown
  return true;
}

void pqSonoLink::rest()
{
  if (!this->Probe)
  {
    this->Shown.reset();
    return;
  }
  if (this->Probe->getProxy()->GetSession()->GetPendingProgress())
  {
    this->Rest.start();
    return;
  }
  {
    SCOPED_UNDO_EXCLUDE();
    setPreview(this->Probe->getProxy(), false);
    this->Probe->getProxy()->UpdateVTKObjects();
  }
  if (this->Shown)
  {
    this->Shown->drawInFull();
  }
  this->Shown.reset();
  this->Probe = nullptr;
  pqApplicationCore::instance()->render();
  for (const Known& known : this->Links)
  {
    if (known.link)
    {
      known.link->getSourceProxy()->UpdatePipeline();
    }
  }
}
