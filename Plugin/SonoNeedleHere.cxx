#include "SonoNeedleHere.h"

#include "SonoFlatView.h"
#include "SonoPipelineItem.h"
#include "SonoWindows.h"

#include "pqApplicationCore.h"
#include "pqObjectBuilder.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSMViewProxy.h"
#include "vtkSonoUltrasound.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace {

constexpr const char* needleKind = "SonoNeedle";

vtkSMProxy* targetsOf(const pqPipelineSource* ultrasound)
{
  return vtkSMPropertyHelper(ultrasound->getProxy(), "Targets").GetAsProxy();
}

/// In the plane that is scanned: from beside the probe, as a hand holds it, to below the middle of its face.
void placeAcross(vtkSMProxy* ultrasound, vtkSMProxy* needle)
{
  std::array<double, 9> pose = sonoPoseOf(ultrasound); // position, axial, lateral
  double* axial = pose.data() + 3;
  double* lateral = pose.data() + 6;
  vtkMath::Normalize(axial);
  vtkMath::Normalize(lateral);
  const double reachMm = std::min(vtkSMPropertyHelper(ultrasound, "DepthMm").GetAsDouble(), 120.0);
  const auto at = [&](double side, double depth) {
    std::array<double, 3> point{};
    for (std::size_t i = 0; i < 3; ++i)
    {
      point[i] = pose[i] + reachMm * (side * lateral[i] + depth * axial[i]);
    }
    return point;
  };
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", needle);
  vtkSMPropertyHelper(needle, "HubMm").Set(at(0.57, 0.22).data(), 3);
  vtkSMPropertyHelper(needle, "TipMm").Set(at(-0.04, 0.35).data(), 3);
  needle->UpdateVTKObjects();
}

} // namespace

bool sonoTakesNeedle(const pqPipelineSource* ultrasound)
{
  vtkSMProxy* targets = targetsOf(ultrasound);
  return !targets || std::strcmp(targets->GetXMLName(), needleKind) == 0;
}

pqPipelineSource* sonoNeedleOf(const pqPipelineSource* ultrasound)
{
  if (pqPipelineSource* there = sonoPipelineItem(targetsOf(ultrasound)))
  {
    return there;
  }
  pqPipelineSource* needle =
    pqApplicationCore::instance()->getObjectBuilder()->createSource("sources", needleKind, ultrasound->getServer());
  placeAcross(ultrasound->getProxy(), needle->getProxy());
  needle->setModifiedState(pqProxy::UNMODIFIED); // nothing is left to apply
  {
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", ultrasound->getProxy());
    vtkSMPropertyHelper(ultrasound->getProxy(), "Targets").Set(needle->getProxy());
    ultrasound->getProxy()->UpdateVTKObjects();
  }
  if (const pqView* body = sonoBodyOf(ultrasound))
  {
    vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
    controller->Show(vtkSMSourceProxy::SafeDownCast(needle->getProxy()), 0, body->getViewProxy());
  }
  return needle;
}

pqView* sonoBodyOf(const pqPipelineSource* ultrasound)
{
  auto* proxy = vtkSMSourceProxy::SafeDownCast(ultrasound->getProxy());
  const auto views = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>();
  const auto found = std::find_if(views.begin(), views.end(), [proxy](const pqRenderView* view) {
    return !sonoIsFlatView(view->getProxy()) &&
           view->getViewProxy()->FindRepresentation(proxy, vtkSonoUltrasound::IMAGE);
  });
  return found == views.end() ? nullptr : *found;
}
