#include "SonoViewsInSpace.h"

#include "pqApplicationCore.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRepresentationProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewProxy.h"
#include "vtkSonoUltrasound.h"

#include <algorithm>
#include <iterator>

std::vector<pqRenderView*> sonoViewsInSpace(vtkSMSourceProxy* ultrasound)
{
  constexpr unsigned int ports[] = { vtkSonoUltrasound::IMAGE, vtkSonoUltrasound::ANATOMY };
  std::vector<pqRenderView*> views;
  for (auto* view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>())
  {
    const auto shows = [&](unsigned int port) {
      vtkSMProxy* shown = view->getViewProxy()->FindRepresentation(ultrasound, int(port));
      return shown && vtkSMPropertyHelper(shown, "Visibility").GetAsInt() == 1;
    };
    if (view->widget() && std::any_of(std::begin(ports), std::end(ports), shows)) // none is left of a removed layout's
    {
      views.push_back(view);
    }
  }
  return views;
}
