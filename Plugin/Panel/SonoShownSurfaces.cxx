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
  if (vtkSMSessionClient::SafeDownCast(source->GetSession()))
  {
    return this->fetchCoarse(source, port);
  }
  auto& fetcher = this->Fetched[qMakePair(source, port)].producer;
  if (!fetcher)
  {
    // It runs again only when the data have changed.
    fetcher.TakeReference(source->GetSessionProxyManager()->NewProxy("filters", "ClientServerMoveData"));
    vtkSMPropertyHelper(fetcher, "Input").Set(source, static_cast<unsigned int>(port));
  }
  const bool isComposite = about->GetCompositeDataSetType() > 0;
  vtkSMPropertyHelper(fetcher, "OutputDataType")
    .Set(isComposite ? about->GetCompositeDataSetType() : about->GetDataSetType());
  fetcher->UpdateVTKObjects();
  vtkSMSourceProxy::SafeDownCast(fetcher)->UpdatePipeline();
  return vtkAlgorithm::SafeDownCast(fetcher->GetClientSideObject())->GetOutputDataObject(0);
}

/// From a server, when it has others than those that have come over.
vtkDataObject* SonoShownSurfaces::fetchCoarse(vtkSMProxy* source, int port)
{
  Surfaces& known = this->Fetched[qMakePair(source, port)];
  vtkSMSessionProxyManager* manager = source->GetSessionProxyManager();
  if (!known.producer)
  {
    known.producer.TakeReference(manager->NewProxy("sono_server", "SonoCoarseSurfaces"));
    vtkSMPropertyHelper(known.producer, "Input").Set(source, static_cast<unsigned int>(port));
    known.producer->UpdateVTKObjects();
  }
  vtkSMSourceProxy::SafeDownCast(known.producer)->UpdatePipeline();
  known.producer->UpdatePropertyInformation();
  const int version = vtkSMPropertyHelper(known.producer, "Version").GetAsInt();
  if (known.version != version)
  {
    const auto mover = vtkSmartPointer<vtkSMProxy>::Take(manager->NewProxy("filters", "ClientServerMoveData"));
    vtkSMPropertyHelper(mover, "Input").Set(known.producer);
    vtkSMPropertyHelper(mover, "OutputDataType").Set(VTK_MULTIBLOCK_DATA_SET);
    mover->UpdateVTKObjects();
    vtkSMSourceProxy::SafeDownCast(mover)->UpdatePipeline();
    known.data = vtkAlgorithm::SafeDownCast(mover->GetClientSideObject())->GetOutputDataObject(0);
    known.version = version;
  }
  return known.data;
}

void SonoShownSurfaces::forget(vtkSMProxy* source)
{
  for (auto each = this->Fetched.begin(); each != this->Fetched.end();)
  {
    each = each.key().first == source ? this->Fetched.erase(each) : std::next(each);
  }
}
