#include "SonoNeedleHere.h"

#include "SonoMakeSource.h"
#include "SonoPipelineItem.h"
#include "SonoSplitScreen.h"
#include "SonoViewsInSpace.h"
#include "SonoWindows.h"

#include "pqActiveObjects.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSMViewProxy.h"
#include "vtkSonoProbeSource.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

namespace {

constexpr const char* needleKind = "SonoNeedle";

vtkSMProxy* targetsOf(const pqPipelineSource* ultrasound)
{
  return vtkSMPropertyHelper(ultrasound->getProxy(), "Targets").GetAsProxy();
}

/// Along the picture's rows, as the probe sees it (vtkSonoProbeSource::Probe).
void turnLateral(vtkSMProxy* ultrasound, double* axial, double* lateral)
{
  double elevation[3];
  vtkMath::Normalize(axial);
  vtkMath::Cross(axial, lateral, elevation);
  vtkMath::Normalize(elevation);
  const bool isSecond = vtkSMPropertyHelper(ultrasound, "ScanKind").GetAsInt() == vtkSonoProbeSource::MATRIX &&
                        vtkSMPropertyHelper(ultrasound, sonoMatrixPlane).GetAsInt() == vtkSonoProbeSource::SECOND_PLANE;
  if (isSecond)
  {
    std::copy_n(elevation, 3, lateral);
  }
  else
  {
    vtkMath::Cross(elevation, axial, lateral);
  }
}

/// In the plane that is scanned: from beside the probe, as a hand holds it, to below the middle of its face.
void placeAcross(vtkSMProxy* ultrasound, vtkSMProxy* needle)
{
  std::array<double, 9> pose = sonoPoseOf(ultrasound); // position, axial, lateral
  const double* axial = pose.data() + 3;
  const double* lateral = pose.data() + 6;
  turnLateral(ultrasound, pose.data() + 3, pose.data() + 6);
  const double reachMm = std::min(vtkSMPropertyHelper(ultrasound, "DepthMm").GetAsDouble(), 120.0);
  const double besideMm = 0.5 * vtkSMPropertyHelper(ultrasound, "WidthMm").GetAsDouble() + 5.0;
  const auto at = [&](double sideMm, double depthMm) {
    std::array<double, 3> point{};
    for (std::size_t i = 0; i < 3; ++i)
    {
      point[i] = pose[i] + sideMm * lateral[i] + depthMm * axial[i];
    }
    return point;
  };
  vtkSMPropertyHelper(needle, "HubMm").Set(at(std::max(0.57 * reachMm, besideMm), 0.22 * reachMm).data(), 3);
  vtkSMPropertyHelper(needle, "TipMm").Set(at(-0.04 * reachMm, 0.35 * reachMm).data(), 3);
}

/// In the pipeline.
vtkSMSourceProxy* makeNeedle(vtkSMProxy* ultrasound)
{
  return sonoMakeSource(ultrasound->GetSessionProxyManager(), "sources", needleKind,
                        [ultrasound](vtkSMSourceProxy* needle) { placeAcross(ultrasound, needle); });
}

void setTargets(vtkSMProxy* ultrasound, vtkSMProxy* targets)
{
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", ultrasound);
  vtkSMPropertyHelper(ultrasound, "Targets").Set(targets);
  ultrasound->UpdateVTKObjects();
}

std::vector<pqRenderView*> ownBodies(const pqPipelineSource* ultrasound)
{
  return sonoViewsInSpace(vtkSMSourceProxy::SafeDownCast(ultrasound->getProxy()));
}

/// Its own, or, where it has none as the second of a split screen, the others'.
std::vector<pqRenderView*> bodiesOf(const pqPipelineSource* ultrasound)
{
  std::vector<pqRenderView*> bodies = ownBodies(ultrasound);
  if (bodies.empty())
  {
    for (const pqPipelineSource* other : sonoUltrasounds())
    {
      const std::vector<pqRenderView*> more = ownBodies(other);
      bodies.insert(bodies.end(), more.begin(), more.end());
    }
  }
  return bodies;
}

/// The active one, or one on top where there are several; null: none.
pqRenderView* bestOf(const std::vector<pqRenderView*>& bodies)
{
  const auto active = std::find(bodies.begin(), bodies.end(), pqActiveObjects::instance().activeView());
  const auto onTop =
    std::find_if(bodies.begin(), bodies.end(), [](pqRenderView* body) { return body->widget()->isVisible(); });
  const auto best = active != bodies.end() ? active : onTop != bodies.end() ? onTop : bodies.begin();
  return best == bodies.end() ? nullptr : *best;
}

} // namespace

bool sonoIsNeedle(vtkSMProxy* source)
{
  return source && std::strcmp(source->GetXMLName(), needleKind) == 0;
}

bool sonoTakesNeedle(const pqPipelineSource* ultrasound)
{
  vtkSMProxy* targets = targetsOf(ultrasound);
  return !targets || sonoIsNeedle(targets);
}

SonoShownNeedle sonoShowNeedle(const pqPipelineSource* ultrasound)
{
  auto* needle = vtkSMSourceProxy::SafeDownCast(targetsOf(ultrasound));
  if (!needle)
  {
    needle = makeNeedle(ultrasound->getProxy());
    setTargets(ultrasound->getProxy(), needle);
  }
  const std::vector<pqRenderView*> bodies = bodiesOf(ultrasound);
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  for (const pqRenderView* body : bodies)
  {
    controller->Show(needle, 0, body->getViewProxy());
  }
  return { sonoPipelineItem(needle), bestOf(bodies) };
}
