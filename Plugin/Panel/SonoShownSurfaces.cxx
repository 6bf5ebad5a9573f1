#include "SonoShownSurfaces.h"

#include "vtkSonoUltrasound.h"

#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqView.h"
#include "vtkAlgorithm.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPVDataInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionClient.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"

#include <iterator>

void SonoShownSurfaces::collect(const pqView& view, vtkSMProxy* probe, vtkMultiBlockDataSet* surfaces)
{
  for (pqRepresentation* each : view.getRepresentations())
  {
    auto* shown = qobject_cast<pqDataRepresentation*>(each);
    pqOutputPort* port = shown && shown->isVisible() ? shown->getOutputPortFromInput() : nullptr;
    if (port && (port->getSource()->getProxy() != probe || port->getPortNumber() == vtkSonoUltrasound::ANATOMY))
    {
      surfaces->SetBlock(surfaces->GetNumberOfBlocks(),
                         this->fetch(port->getSource()->getProxy(), port->getPortNumber()));
    }
  }
}

vtkDataObject* SonoShownSurfaces::fetch(vtkSMProxy* source, int port)
{
  auto* producer = vtkSMSourceProxy::SafeDownCast(source);
  vtkPVDataInformation* about = producer->GetDataInformation(static_cast<unsigned int>(port));
  const bool isSurface = about->DataSetTypeIsA("vtkPolyData") || about->DataSetTypeIsA("vtkCompositeDataSet");
  if (!isSurface)
  {
    return nullptr;
  }
  const bool isRemote = vtkSMSessionClient::SafeDownCast(source->GetSession()) != nullptr;
  auto& fetcher = this->Fetchers[qMakePair(source, port)];
  if (!fetcher)
  {
    // It runs again only when the data have changed.
    vtkSMSessionProxyManager* manager = source->GetSessionProxyManager();
    fetcher.TakeReference(manager->NewProxy("filters", "ClientServerMoveData"));
    vtkSmartPointer<vtkSMProxy> moved = source;
    if (isRemote)
    {
      moved.TakeReference(manager->NewProxy("sono_server", "SonoCoarseSurfaces"));
      vtkSMPropertyHelper(moved, "Input").Set(source, static_cast<unsigned int>(port));
      moved->UpdateVTKObjects();
    }
    vtkSMPropertyHelper(fetcher, "Input").Set(moved, isRemote ? 0 : static_cast<unsigned int>(port));
  }
  const bool isComposite = about->GetCompositeDataSetType() > 0;
  vtkSMPropertyHelper(fetcher, "OutputDataType")
    .Set(isRemote      ? VTK_MULTIBLOCK_DATA_SET
         : isComposite ? about->GetCompositeDataSetType()
                       : about->GetDataSetType());
  fetcher->UpdateVTKObjects();
  vtkSMSourceProxy::SafeDownCast(fetcher)->UpdatePipeline();
  return vtkAlgorithm::SafeDownCast(fetcher->GetClientSideObject())->GetOutputDataObject(0);
}

void SonoShownSurfaces::forget(vtkSMProxy* source)
{
  for (auto each = this->Fetchers.begin(); each != this->Fetchers.end();)
  {
    each = each.key().first == source ? this->Fetchers.erase(each) : std::next(each);
  }
}
