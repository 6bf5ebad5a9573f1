#include "pqSonoBiplane.h"

#include "SonoSplitScreen.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "vtkCommand.h"
#include "vtkSMProperty.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyLink.h"

#include <utility>

pqSonoBiplane::pqSonoBiplane(QObject* parent)
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

pqSonoBiplane::~pqSonoBiplane() = default;

void pqSonoBiplane::watch(pqPipelineSource* source)
{
  if (sonoIsUltrasound(source))
  {
    for (const char* name : { sonoMatrixPlane, "Input" })
    {
      pqCoreUtilities::connect(source->getProxy()->GetProperty(name), vtkCommand::ModifiedEvent, this, SLOT(link()));
    }
    this->link();
  }
}

void pqSonoBiplane::link()
{
  auto before = std::exchange(links_, {});
  for (auto* source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>())
  {
    const SonoPlanes planes = sonoPlanesOf(source);
    if (!planes.first || planes.second != source)
    {
      continue;
    }
    auto& [first, made] = links_[source->getProxy()];
    first = planes.first->getProxy();
    const auto there = before.find(source->getProxy());
    if (there != before.end() && there->second.first == first)
    {
      made = there->second.second;
      continue;
    }
    made = vtkSmartPointer<vtkSMProxyLink>::New();
    made->AddException(sonoMatrixPlane);
    for (const int direction : { vtkSMLink::INPUT, vtkSMLink::OUTPUT })
    {
      made->AddLinkedProxy(first, direction);
      made->AddLinkedProxy(source->getProxy(), direction);
    }
  }
  Q_EMIT changed();
}
