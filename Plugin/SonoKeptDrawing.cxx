#include "SonoKeptDrawing.h"

#include "SonoTell.h"
#include "SonoUltrasoundHere.h"

#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkPVView.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSonoUltrasound.h"

#include <algorithm>
#include <string>

namespace {

bool isThat(const pqDataRepresentation* shown, vtkSMProxy* source, SonoKept what)
{
  const pqOutputPort* port = shown->isVisible() ? shown->getOutputPortFromInput() : nullptr;
  vtkSMProxy* drawn = port ? port->getSource()->getProxy() : nullptr;
  if (what == SonoKept::Anatomy)
  {
    return drawn == source && port && port->getPortNumber() == vtkSonoUltrasound::ANATOMY;
  }
  return drawn && std::string("SonoFlatScale") == drawn->GetXMLName() &&
         vtkSMPropertyHelper(drawn, "Input").GetAsProxy() == source;
}

} // namespace

SonoKeptDrawing::SonoKeptDrawing(vtkSMProxy* source, SonoKept what)
{
  if (!sonoIsUltrasound(source))
  {
    return;
  }
  for (auto* shown : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqDataRepresentation*>())
  {
    const pqView* view = shown->getView();
    auto* drawn = view ? vtkPVView::SafeDownCast(view->getProxy()->GetClientSideObject()) : nullptr;
    if (drawn && isThat(shown, source, what))
    {
      sonoTell(shown->getProxy(), "SetForcedCacheKey", drawn->GetCacheKey());
      sonoTell(shown->getProxy(), "SetForceUseCache", 1);
      this->Kept.append(shown);
    }
  }
}

SonoKeptDrawing::~SonoKeptDrawing()
{
  for (const auto& shown : this->Kept)
  {
    if (shown)
    {
      sonoTell(shown->getProxy(), "SetForceUseCache", 0);
    }
  }
}

bool SonoKeptDrawing::holds(const pqDataRepresentation* shown) const
{
  return this->IsHolding && std::find(this->Kept.begin(), this->Kept.end(), shown) != this->Kept.end();
}

void SonoKeptDrawing::drop()
{
  for (const auto& shown : this->Kept)
  {
    if (shown)
    {
      sonoTell(shown->getProxy(), "SetForceUseCache", 0);
      sonoTell(shown->getProxy(), "MarkModified");
    }
  }
  this->IsHolding = false;
}
