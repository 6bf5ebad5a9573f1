#include "SonoSplitScreen.h"

#include "SonoLayout.h"

#include "pqApplicationCore.h"
#include "pqLinksModel.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkNew.h"
#include "vtkSMParaViewPipelineController.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewProxy.h"
#include "vtkSmartPointer.h"

#include <initializer_list>

SonoSplit sonoSplitScreen(pqPipelineSource* first)
{
  auto* one = vtkSMSourceProxy::SafeDownCast(first->getProxy());
  auto other = vtkSmartPointer<vtkSMSourceProxy>::Take(
    vtkSMSourceProxy::SafeDownCast(one->GetSessionProxyManager()->NewProxy("filters", one->GetXMLName())));
  vtkNew<vtkSMParaViewPipelineController> controller;
  controller->PreInitializeProxy(other);
  other->Copy(one);
  controller->PostInitializeProxy(other);
  other->Copy(one); // what was initialized by the input
  other->UpdateVTKObjects();
  controller->RegisterPipelineProxy(other);
  pqLinksModel* links = pqApplicationCore::instance()->getLinksModel();
  auto* second = pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineSource*>(other.Get());
  for (const char* name : { "PositionMm", "Axial", "Lateral", "DepthMm", "Preview", "PrepareInteraction" })
  {
    links->addPropertyLink(QString("%1 of %2 and %3").arg(name, first->getSMName(), second->getSMName()), one, name,
                           other, name);
  }
  second->setModifiedState(pqProxy::UNMODIFIED); // nothing is left to apply
  vtkSMProxy* body = sonoShowSplitLayout(one, other);
  return { second, pqApplicationCore::instance()->getServerManagerModel()->findItem<pqView*>(body) };
}
