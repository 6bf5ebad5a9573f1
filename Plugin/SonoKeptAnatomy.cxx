#include "SonoKeptAnatomy.h"

#include "SonoTell.h"
#include "SonoUltrasoundHere.h"

#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkPVView.h"
#include "vtkSonoUltrasound.h"

#include <algorithm>

namespace {

bool isAnatomy(const pqDataRepresentation* shown, vtkSMProxy* source)
{
  const pqOutputPort* port = shown->isVisible() ? shown->getOutputPortFromInput() : nullptr;
  return port && port->getSource()->getProxy() == source && port->getPortNumber() == vtkSonoUltrasound::ANATOMY;
}

} // namespace

SonoKeptAnatomy::SonoKeptAnatomy(vtkSMProxy* source)
{
  if (!sonoIsUltrasound(source))
  {
    return;
  }
  for (auto* shown : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqDataRepresentation*>())
  {
    const pqView* view = shown->getView();
    auto* drawn = view ? vtkPVView::SafeDownCast(view->getProxy()->GetClientSideObject()) : nullptr;
    if (drawn && isAnatomy(shown, source))
    {
      sonoTell(shown->getProxy(), "SetForcedCacheKey", drawn->GetCacheKey());
      sonoTell(shown->getProxy(), "SetForceUseCache", 1);
      this->Kept.append(shown);
    }
  }
}

SonoKeptAnatomy::~SonoKeptAnatomy()
{
  for (const auto& shown : this->Kept)
  {
    if (shown)
    {
      sonoTell(shown->getProxy(), "SetForceUseCache", 0);
    }
  }
}

bool SonoKeptAnatomy::holds(const pqDataRepresentation* shown) const
{
  return std::find(this->Kept.begin(), this->Kept.end(), shown) != this->Kept.end();
}

void SonoKeptAnatomy::drop()
{
  for (const auto& shown : this->Kept)
  {
    if (shown)
    {
      sonoTell(shown->getProxy(), "SetForceUseCache", 0);
      sonoTell(shown->getProxy(), "MarkModified");
    }
  }
  this->Kept.clear();
}
