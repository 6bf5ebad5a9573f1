#include "pqSonoKeptAlike.h"

#include "SonoSplitScreen.h"
#include "SonoUltrasoundHere.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "vtkCommand.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyLink.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyLink.h"

#include <utility>

pqSonoKeptAlike* pqSonoKeptAlike::biplane(QObject* parent)
{
  return new pqSonoKeptAlike(sonoMatrixPlane, sonoPlanePairs, linksOfPlanes, parent);
}

pqSonoKeptAlike* pqSonoKeptAlike::sharedProbe(QObject* parent)
{
  return new pqSonoKeptAlike(sonoSharedProbe, sonoProbeSharers, linksOfProbe, parent);
}

pqSonoKeptAlike::pqSonoKeptAlike(const char* property, std::vector<Group> (*groups)(), Links (*linksOf)(const Group&),
                                 QObject* parent)
  : Superclass(parent)
  , property_(property)
  , groups_(groups)
  , linksOf_(linksOf)
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(model, &pqServerManagerModel::sourceAdded, this,
                   [this](pqPipelineSource* source) { watch(source); });
  QObject::connect(model, &pqServerManagerModel::sourceRemoved, this, [this] { link(); });
  for (auto* source : model->findItems<pqPipelineSource*>())
  {
    this->watch(source);
  }
}

pqSonoKeptAlike::~pqSonoKeptAlike() = default;

void pqSonoKeptAlike::watch(pqPipelineSource* source)
{
  if (sonoIsUltrasound(source->getProxy()))
  {
    for (const char* name : { property_, "Input" })
    {
      pqCoreUtilities::connect(source->getProxy()->GetProperty(name), vtkCommand::ModifiedEvent, this, SLOT(link()));
    }
    this->link();
  }
}

void pqSonoKeptAlike::link()
{
  auto before = std::exchange(links_, {});
  for (const Group& group : groups_())
  {
    const auto there = before.find(group);
    links_[group] = there != before.end() ? there->second : linksOf_(group);
  }
  Q_EMIT changed();
}

// In both, the first one's values are taken by all.

pqSonoKeptAlike::Links pqSonoKeptAlike::linksOfPlanes(const Group& planes)
{
  const auto all = vtkSmartPointer<vtkSMProxyLink>::New();
  all->AddException(sonoMatrixPlane);
  for (const int direction : { vtkSMLink::INPUT, vtkSMLink::OUTPUT })
  {
    for (vtkSMProxy* proxy : planes)
    {
      all->AddLinkedProxy(proxy, direction);
    }
  }
  return { all };
}

pqSonoKeptAlike::Links pqSonoKeptAlike::linksOfProbe(const Group& sharers)
{
  Links links;
  for (const char* name : sonoProbeProperties)
  {
    const auto one = vtkSmartPointer<vtkSMPropertyLink>::New();
    for (const int direction : { vtkSMLink::INPUT, vtkSMLink::OUTPUT })
    {
      for (vtkSMProxy* proxy : sharers)
      {
        one->AddLinkedProperty(proxy, name, direction);
      }
    }
    links.push_back(one);
  }
  return links;
}
