#include "SonoServerStops.h"

#include "SonoTell.h"
#include "vtkSonoServerStop.h"

#include "pqPipelineSource.h"
#include "vtkCommand.h"
#include "vtkPVProgressHandler.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"
#include "vtkSMSessionClient.h"
#include "vtkSMSessionProxyManager.h"

#include <cstring>
#include <utility>

SonoServerStops::SonoServerStops(std::function<bool()> wantsStop)
  : wantsStop_(std::move(wantsStop))
{
}

SonoServerStops::~SonoServerStops()
{
  while (!servers_.empty())
  {
    this->forget(servers_.begin()->first);
  }
}

namespace {

bool isOurs(vtkSMProxy* proxy)
{
  return std::strncmp(proxy->GetXMLName(), "Sono", 4) == 0;
}

} // namespace

void SonoServerStops::listenFor(pqPipelineSource* source)
{
  vtkSMProxy* proxy = source->getProxy();
  auto* session = vtkSMSessionClient::SafeDownCast(proxy->GetSession());
  if (!session || servers_.count(session) || !isOurs(proxy))
  {
    return;
  }
  Server& server = servers_[session];
  server.stop.TakeReference(proxy->GetSessionProxyManager()->NewProxy("misc", "SonoServerStop"));
  server.stop->UpdateVTKObjects();
  server.stop->InvokeCommand("Listen");
  server.progress = session->GetProgressHandler();
  server.onProgress = server.progress->AddObserver(vtkCommand::ProgressEvent, this, &SonoServerStops::heard);
  server.onEnd = server.progress->AddObserver(vtkCommand::EndEvent, this, &SonoServerStops::heard);
}

void SonoServerStops::forget(vtkSMSession* session)
{
  const auto found = servers_.find(session);
  if (found != servers_.end())
  {
    found->second.progress->RemoveObserver(found->second.onProgress);
    found->second.progress->RemoveObserver(found->second.onEnd);
    servers_.erase(found);
  }
}

void SonoServerStops::heard(vtkObject* progress, unsigned long event, void*)
{
  for (auto& [session, server] : servers_)
  {
    if (server.progress != progress)
    {
      continue;
    }
    if (event == vtkCommand::EndEvent)
    {
      server.asked = false;
    }
    else if (!server.asked && wantsStop_())
    {
      server.asked = true;
      vtkSonoServerStop::Ask(session);
    }
  }
}

bool SonoServerStops::isOn(pqPipelineSource* source) const
{
  return servers_.count(source->getProxy()->GetSession()) && isOurs(source->getProxy());
}

bool SonoServerStops::waits(pqPipelineSource* source) const
{
  vtkSMProxy* proxy = source->getProxy();
  return sonoAsk<bool>(servers_.at(proxy->GetSession()).stop, "Waits", VTKOBJECT(proxy));
}
