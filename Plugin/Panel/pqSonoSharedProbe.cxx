#include "pqSonoSharedProbe.h"

#include "SonoSplitScreen.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "vtkCommand.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyLink.h"
#include "vtkSMProxy.h"

#include <utility>

pqSonoSharedProbe::pqSonoSharedProbe(QObject* parent)
  : Superclass(parent)
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

pqSonoSharedProbe::~pqSonoSharedProbe() = default;

void pqSonoSharedProbe::watch(pqPipelineSource* source)
{
  if (sonoIsUltrasound(source))
  {
    for (const char* name : { sonoSharedProbe, "Input" })
    {
      pqCoreUtilities::connect(source->getProxy()->GetProperty(name), vtkCommand::ModifiedEvent, this, SLOT(link()));
    }
    this->link();
  }
}

void pqSonoSharedProbe::link()
{
  auto before = std::exchange(links_, {});
  for (const std::vector<vtkSMProxy*>& sharers : sonoProbeSharers())
  {
    Links& links = links_[sharers];
    const auto there = before.find(sharers);
    if (there != before.end())
    {
      links = there->second;
      continue;
    }
    for (const char* name : sonoProbeProperties)
    {
      links.push_back(vtkSmartPointer<vtkSMPropertyLink>::New());
      for (const int direction : { vtkSMLink::INPUT, vtkSMLink::OUTPUT }) // the first one's value is taken by all
      {
        for (vtkSMProxy* proxy : sharers)
        {
          links.back()->AddLinkedProperty(proxy, name, direction);
        }
      }
    }
  }
}
