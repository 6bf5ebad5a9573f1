#include "SonoMovingViews.h"

#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "pqView.h"
#include "vtkClientServerStream.h"
#include "vtkPVView.h"
#include "vtkRenderer.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSession.h"
#include "vtkSonoUltrasound.h"

#include <QWidget>

#include <cstring>

namespace {

constexpr double slowS = 0.1;

/// Sets what nobody is to see in a panel, undo or find in a state file.
template<class Value>
void tell(vtkSMProxy* proxy, const char* method, Value value)
{
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(proxy) << method << value << vtkClientServerStream::End;
  proxy->GetSession()->ExecuteStream(proxy->GetLocation(), stream);
}

bool isAnatomy(const pqDataRepresentation* shown, vtkSMProxy* source)
{
  const pqOutputPort* port = shown && shown->isVisible() ? shown->getOutputPortFromInput() : nullptr;
  return port && port->getSource()->getProxy() == source && port->getPortNumber() == vtkSonoUltrasound::ANATOMY &&
         std::strcmp(source->GetXMLName(), "SonoUltrasound") == 0;
}

void drawOnInteraction(pqView* view, bool wanted)
{
  SCOPED_UNDO_EXCLUDE();
  vtkSMPropertyHelper(view->getProxy(), "EnableRenderOnInteraction").Set(wanted ? 1 : 0);
  view->getProxy()->UpdateVTKObjects();
}

/// An interactive picture alone would miss images, which have no light version.
void drawLightly(vtkSMViewProxy* view)
{
  tell(view, "SetSuppressRendering", 1);
  view->StillRender();
  tell(view, "SetSuppressRendering", 0);
  view->InteractiveRender();
}

} // namespace

SonoMovingViews::SonoMovingViews(vtkSMProxy* source)
  : Source(source)
{
  for (pqView* view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqView*>())
  {
    if (view->widget()->isVisible())
    {
      this->Views.append(view);
    }
  }
  for (pqView* view : this->Views)
  {
    auto* render = vtkSMRenderViewProxy::SafeDownCast(view->getProxy());
    if (render && render->GetRenderer()->GetLastRenderTimeInSeconds() > slowS)
    {
      this->Slow.append(view);
    }
  }
  if (this->Slow.empty())
  {
    this->keepAnatomy();
  }
  else
  {
    this->lighten();
  }
}

SonoMovingViews::~SonoMovingViews()
{
  this->drawInFull();
  this->letGo();
}

void SonoMovingViews::keepAnatomy()
{
  for (pqView* view : this->Views)
  {
    auto* drawn = view ? vtkPVView::SafeDownCast(view->getProxy()->GetClientSideObject()) : nullptr;
    for (pqRepresentation* each : drawn ? view->getRepresentations() : QList<pqRepresentation*>())
    {
      auto* shown = qobject_cast<pqDataRepresentation*>(each);
      if (isAnatomy(shown, this->Source))
      {
        tell(shown->getProxy(), "SetForcedCacheKey", drawn->GetCacheKey());
        tell(shown->getProxy(), "SetForceUseCache", 1);
        this->Kept.append(shown);
      }
    }
  }
}

void SonoMovingViews::letGo()
{
  for (const auto& shown : this->Kept)
  {
    if (shown)
    {
      tell(shown->getProxy(), "SetForceUseCache", 0);
    }
  }
  this->Kept.clear();
}

void SonoMovingViews::lighten()
{
  for (pqView* view : this->Views)
  {
    if (vtkSMRenderViewProxy::SafeDownCast(view->getProxy()))
    {
      tell(view->getProxy(), "SetUseDepthPeeling", 0);
      tell(view->getProxy(), "SetUseFXAA", 0);
      tell(view->getProxy(), "SetLODResolution", 0.0);
    }
  }
  for (pqView* view : this->Slow)
  {
    drawOnInteraction(view, false); // draw() follows each step
  }
}

void SonoMovingViews::drawInFull()
{
  if (this->Slow.empty())
  {
    return; // nothing was lightened
  }
  for (pqView* view : this->Views)
  {
    for (const char* name : { "DepthPeeling", "UseFXAA", "LODResolution" })
    {
      if (view && view->getProxy()->GetProperty(name))
      {
        view->getProxy()->UpdateProperty(name, 1);
      }
    }
  }
  for (pqView* view : this->Slow)
  {
    if (view)
    {
      drawOnInteraction(view, true);
    }
  }
  this->letGo(); // so that the few triangles are replaced
  this->Slow.clear();
}

void SonoMovingViews::draw()
{
  const int picture = this->Pictures++;
  for (pqView* view : this->Views)
  {
    const bool isSolid = view && vtkSMRenderViewProxy::SafeDownCast(view->getProxy());
    if (view && this->Slow.contains(view))
    {
      if (picture % 2 == 0 || this->Views.size() == 1)
      {
        drawLightly(view->getViewProxy());
      }
      else
      {
        view->getViewProxy()->Update();
      }
    }
    else if (view && (isSolid || this->Slow.empty()))
    {
      view->forceRender();
    }
  }
  if (!this->Slow.empty() && picture == 0)
  {
    this->keepAnatomy(); // now that its few triangles are made
  }
}
