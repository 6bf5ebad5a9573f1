#include "SonoSplitScreen.h"

#include "SonoLayout.h"
#include "SonoPipelineItem.h"
#include "SonoUltrasoundHere.h"

#include "pqApplicationCore.h"
#include "pqObjectBuilder.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkNew.h"
#include "vtkSMParaViewPipelineController.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSMViewLayoutProxy.h"
#include "vtkSMViewProxy.h"
#include "vtkSmartPointer.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoUltrasound.h"

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

vtkSMSourceProxy* proxyOf(const pqPipelineSource* source)
{
  return vtkSMSourceProxy::SafeDownCast(source->getProxy());
}

/// Of the same input, with the settings of the first.
vtkSmartPointer<vtkSMSourceProxy> makeSecond(vtkSMSourceProxy* one)
{
  auto other = vtkSmartPointer<vtkSMSourceProxy>::Take(
    vtkSMSourceProxy::SafeDownCast(one->GetSessionProxyManager()->NewProxy("filters", one->GetXMLName())));
  vtkNew<vtkSMParaViewPipelineController> controller;
  controller->PreInitializeProxy(other);
  other->Copy(one);
  controller->PostInitializeProxy(other);
  other->Copy(one); // what was initialized by the input
  return other;
}

pqPipelineSource* registered(vtkSMSourceProxy* proxy)
{
  proxy->UpdateVTKObjects();
  vtkNew<vtkSMParaViewPipelineController> controller;
  controller->RegisterPipelineProxy(proxy);
  sonoPipelineItem(proxy)->setModifiedState(pqProxy::UNMODIFIED); // nothing is left to apply
  return sonoPipelineItem(proxy);
}

SonoSplit show(const char* tab, const pqPipelineSource* first, pqPipelineSource* second)
{
  vtkSMProxy* body = sonoShowSplitLayout(tab, proxyOf(first), proxyOf(second));
  return { second, pqApplicationCore::instance()->getServerManagerModel()->findItem<pqView*>(body) };
}

int planeOf(const pqPipelineSource* source)
{
  return vtkSMPropertyHelper(source->getProxy(), sonoMatrixPlane, true).GetAsInt();
}

void scan(int plane, const pqPipelineSource* source)
{
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", source->getProxy());
  vtkSMPropertyHelper(source->getProxy(), sonoMatrixPlane).Set(plane);
  source->getProxy()->UpdateVTKObjects();
}

/// What pqSonoKeptAlike does, for those who run a trace without it.
void tracePlanesLink(pqPipelineSource* first, pqPipelineSource* second)
{
  std::ostringstream text;
  text << "linkedPlanes = servermanager.vtkSMProxyLink()\nlinkedPlanes.AddException('" << sonoMatrixPlane << "')\n"
       << "for direction in (linkedPlanes.INPUT, linkedPlanes.OUTPUT):\n";
  for (pqPipelineSource* each : { first, second })
  {
    text << "    linkedPlanes.AddLinkedProxy(FindSource('" << each->getSMName().toStdString()
         << "').SMProxy, direction)\n";
  }
  SM_SCOPED_TRACE(TraceText).arg(text.str().c_str()).arg("comment", "both planes have all other settings in common");
}

/// What pqSonoKeptAlike does, as above.
void traceSharedProbe(pqPipelineSource* first, pqPipelineSource* second)
{
  std::ostringstream text;
  text << "sharedProbe = []\nfor name in (";
  for (const char* name : sonoProbeProperties)
  {
    text << "'" << name << "', ";
  }
  text << "):\n    sharedProbe.append(servermanager.vtkSMPropertyLink())\n"
       << "    for direction in (sharedProbe[-1].INPUT, sharedProbe[-1].OUTPUT):\n";
  for (pqPipelineSource* each : { first, second })
  {
    text << "        sharedProbe[-1].AddLinkedProperty(FindSource('" << each->getSMName().toStdString()
         << "').SMProxy, name, direction)\n";
  }
  SM_SCOPED_TRACE(TraceText).arg(text.str().c_str()).arg("comment", "both have one probe");
}

vtkSMProxy* inputOf(const pqPipelineSource* source)
{
  return vtkSMPropertyHelper(source->getProxy(), "Input").GetAsProxy();
}

int sharedProbeOf(const pqPipelineSource* source)
{
  return vtkSMPropertyHelper(source->getProxy(), sonoSharedProbe).GetAsInt();
}

/// Lets it share its probe with the next one of its settings, if it does not share it yet.
void shareProbe(const pqPipelineSource* first)
{
  if (sharedProbeOf(first) == 0)
  {
    int largest = 0;
    for (const pqPipelineSource* each : sonoUltrasounds())
    {
      largest = std::max(largest, sharedProbeOf(each));
    }
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", first->getProxy());
    vtkSMPropertyHelper(first->getProxy(), sonoSharedProbe).Set(largest + 1);
    first->getProxy()->UpdateVTKObjects();
  }
}

void destroyWithConsumers(pqPipelineSource* source)
{
  for (pqPipelineSource* consumer : source->getAllConsumers())
  {
    destroyWithConsumers(consumer);
  }
  pqApplicationCore::instance()->getObjectBuilder()->destroy(source);
}

} // namespace

std::vector<pqPipelineSource*> sonoUltrasounds()
{
  const auto all = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>();
  std::vector<pqPipelineSource*> found;
  std::copy_if(all.begin(), all.end(), std::back_inserter(found),
               [](const pqPipelineSource* source) { return sonoIsUltrasound(source->getProxy()); });
  return found;
}

SonoSplit sonoSplitScreen(pqPipelineSource* first)
{
  shareProbe(first);
  pqPipelineSource* second = registered(makeSecond(proxyOf(first)));
  traceSharedProbe(first, second);
  return show("Split Screen", first, second);
}

std::vector<std::vector<vtkSMProxy*>> sonoProbeSharers()
{
  std::map<std::pair<vtkSMProxy*, int>, std::vector<vtkSMProxy*>> groups;
  for (const pqPipelineSource* each : sonoUltrasounds())
  {
    if (sharedProbeOf(each) > 0)
    {
      groups[{ inputOf(each), sharedProbeOf(each) }].push_back(each->getProxy());
    }
  }
  std::vector<std::vector<vtkSMProxy*>> sharers;
  for (auto& [of, group] : groups)
  {
    if (group.size() > 1)
    {
      sharers.push_back(std::move(group));
    }
  }
  return sharers;
}

SonoPlanes sonoPlanesOf(const pqPipelineSource* source)
{
  SonoPlanes planes;
  bool isIn = false;
  for (pqPipelineSource* each : sonoUltrasounds())
  {
    if (sonoIsUltrasound(source->getProxy()) && inputOf(each) == inputOf(source))
    {
      pqPipelineSource** place = planeOf(each) == vtkSonoProbeSource::FIRST_PLANE    ? &planes.first
                                 : planeOf(each) == vtkSonoProbeSource::SECOND_PLANE ? &planes.second
                                                                                     : nullptr;
      if (place && *place != source) // of several, the last one
      {
        *place = each;
        isIn = isIn || each == source;
      }
    }
  }
  return isIn && planes.first && planes.second ? planes : SonoPlanes();
}

std::vector<std::vector<vtkSMProxy*>> sonoPlanePairs()
{
  std::vector<std::vector<vtkSMProxy*>> pairs;
  for (const pqPipelineSource* each : sonoUltrasounds())
  {
    const SonoPlanes planes = sonoPlanesOf(each);
    if (planes.first && planes.second == each)
    {
      pairs.push_back({ planes.first->getProxy(), planes.second->getProxy() });
    }
  }
  return pairs;
}

SonoSplit sonoShowBiplane(pqPipelineSource* first)
{
  scan(vtkSonoProbeSource::FIRST_PLANE, first);
  const auto made = makeSecond(proxyOf(first));
  vtkSMPropertyHelper(made, sonoMatrixPlane).Set(vtkSonoProbeSource::SECOND_PLANE);
  pqPipelineSource* second = registered(made);
  tracePlanesLink(first, second);
  const SonoSplit split = show("Biplane", first, second);
  sonoShowImageInBody(made, split.body->getViewProxy());
  return split;
}

void sonoEndBiplane(const SonoPlanes& planes)
{
  vtkSMViewLayoutProxy* layout = nullptr;
  for (pqView* view : planes.second->getOutputPort(vtkSonoUltrasound::FLAT_IMAGE)->getViews())
  {
    layout = vtkSMViewLayoutProxy::FindLayout(view->getViewProxy());
  }
  const std::vector<vtkSMViewProxy*> views = layout ? layout->GetViews() : std::vector<vtkSMViewProxy*>();
  {
    SM_SCOPED_TRACE(TraceText).arg("linkedPlanes = None");
  }
  destroyWithConsumers(planes.second);
  pqObjectBuilder* builder = pqApplicationCore::instance()->getObjectBuilder();
  for (vtkSMViewProxy* view : views)
  {
    builder->destroy(pqApplicationCore::instance()->getServerManagerModel()->findItem<pqView*>(view));
  }
  if (layout)
  {
    vtkNew<vtkSMParaViewPipelineController> controller;
    controller->UnRegisterProxy(layout);
  }
  scan(vtkSonoProbeSource::WHOLE_VOLUME, planes.first);
}
