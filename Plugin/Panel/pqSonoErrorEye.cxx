#include "pqSonoErrorEye.h"

#include "SonoFlatView.h"
#include "SonoUltrasoundHere.h"

#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkDataObject.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRepresentationProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSonoUltrasound.h"

#include <cstring>

namespace {

/// Of an output of Simulate Ultrasound in a view; null where it was never shown.
pqDataRepresentation* shownIn(pqView* view, pqPipelineSource* ultrasound, int port)
{
  return ultrasound->getOutputPort(port)->getRepresentation(view);
}

bool isOf(pqDataRepresentation* shown, int port)
{
  pqOutputPort* output = shown->getOutputPortFromInput();
  return output && output->getPortNumber() == port && sonoIsUltrasound(output->getSource()->getProxy());
}

void makeMap(vtkSMProxy* ultrasound, vtkSMProxy* shown)
{
  if (vtkSMPropertyHelper(ultrasound, "ErrorMap").GetAsInt() == 0)
  {
    vtkSMPropertyHelper(ultrasound, "ErrorMap").Set(1);
    ultrasound->UpdateVTKObjects();
    vtkSMSourceProxy::SafeDownCast(ultrasound)->UpdatePipeline();
    // Of nothing, ParaView could not see how to show it.
    vtkSMRepresentationProxy::SetRepresentationType(shown, "Slice");
    vtkSMPVRepresentationProxy::SetScalarColoring(shown, "ErrorPercent", vtkDataObject::POINT);
    vtkSMPVRepresentationProxy::RescaleTransferFunctionToDataRange(shown, "ErrorPercent", vtkDataObject::POINT);
  }
}

/// The map's colours on the flat image, or grey again.
void recolour(vtkSMProxy* flat)
{
  const char* name = vtkSMPropertyHelper(flat, "ColorArrayName").GetInputArrayNameToProcess();
  const bool isMap = name && std::strcmp(name, "ErrorPercent") == 0;
  vtkSMPVRepresentationProxy::SetScalarColoring(flat, isMap ? "BMode" : "ErrorPercent", vtkDataObject::POINT);
  if (!isMap)
  {
    vtkSMPVRepresentationProxy::RescaleTransferFunctionToDataRange(flat, "ErrorPercent", vtkDataObject::POINT);
  }
}

} // namespace

pqSonoErrorEye::pqSonoErrorEye(QObject* parent)
  : QObject(parent)
{
}

void pqSonoErrorEye::startup()
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(model, &pqServerManagerModel::viewAdded, this, [this](pqView* view) { watch(view); });
  for (pqView* view : model->findItems<pqView*>())
  {
    watch(view);
  }
}

void pqSonoErrorEye::watch(pqView* view)
{
  QObject::connect(view, &pqView::representationAdded, this,
                   [this, view](pqRepresentation* shown) { changed(view, shown); });
  QObject::connect(view, &pqView::representationVisibilityChanged, this,
                   [this, view](pqRepresentation* shown, bool) { changed(view, shown); });
}

void pqSonoErrorEye::changed(pqView* view, pqRepresentation* each)
{
  auto* shown = qobject_cast<pqDataRepresentation*>(each);
  if (shown && !isLooking_ && !view->getProxy()->GetSessionProxyManager()->GetInLoadXMLState())
  {
    isLooking_ = true; // what is hidden or shown for it
    look(view, shown);
    isLooking_ = false;
  }
}

void pqSonoErrorEye::look(pqView* view, pqDataRepresentation* shown)
{
  const bool isMap = isOf(shown, vtkSonoUltrasound::ERROR_MAP);
  if (!isMap && !isOf(shown, vtkSonoUltrasound::IMAGE))
  {
    return;
  }
  pqPipelineSource* ultrasound = shown->getOutputPortFromInput()->getSource();
  if (isMap && shown->isVisible())
  {
    makeMap(ultrasound->getProxy(), shown->getProxy());
  }
  pqDataRepresentation* flat = shownIn(view, ultrasound, vtkSonoUltrasound::FLAT_IMAGE);
  if (isMap && flat && sonoIsFlatView(view->getProxy()))
  {
    if (shown->isVisible())
    {
      shown->setVisible(false); // it lies in the body
      recolour(flat->getProxy());
      view->render();
    }
    return;
  }
  // Only one of the two can be seen.
  pqDataRepresentation* other =
    shownIn(view, ultrasound, isMap ? vtkSonoUltrasound::IMAGE : vtkSonoUltrasound::ERROR_MAP);
  if (other && (shown->isVisible() ? other->isVisible() : isMap && !other->isVisible()))
  {
    other->setVisible(!shown->isVisible());
    view->render();
  }
}
