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
  auto& fetcher = this->Fetchers[qMakePair(source, port)];
  if (!fetcher)
  {
    // From a remote server, too; it runs again only when the data have changed.
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

void SonoShownSurfaces::forget(vtkSMProxy* source)
{
  for (auto each = this->Fetchers.begin(); each != this->Fetchers.end();)
  {
    each = each.key().first == source ? this->Fetchers.erase(each) : std::next(each);
  }
}
