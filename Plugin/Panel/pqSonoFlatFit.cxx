#include "pqSonoFlatFit.h"

#include "SonoFlatView.h"

#include "pqApplicationCore.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkBoundingBox.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkRenderer.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"

#include <QTimer>

#include <algorithm>
#include <cmath>
#include <functional>

namespace {

constexpr double margin = 1.04;
constexpr double unnoticed = 0.02; // a part of what is seen; the coarse pixels of a moving probe end elsewhere

bool isAbout(const pqSonoFlatFit::Sight& a, const pqSonoFlatFit::Sight& b, double part)
{
  const double far = part * b.halfHeight;
  return std::abs(a.x - b.x) <= far && std::abs(a.y - b.y) <= far && std::abs(a.halfHeight - b.halfHeight) <= far;
}

pqSonoFlatFit::Sight sightOf(vtkRenderer* renderer)
{
  const double* at = renderer->GetActiveCamera()->GetFocalPoint();
  return { at[0], at[1], renderer->GetActiveCamera()->GetParallelScale() };
}

/// Of a view.
class CameraReset : public vtkCommand
{
public:
  static CameraReset* New() { return new CameraReset; }
  void Execute(vtkObject*, unsigned long, void*) override { happened(); }

  std::function<void()> happened;
};

/// Of all that is shown.
pqSonoFlatFit::Sight bestSight(vtkRenderer* renderer)
{
  const vtkBoundingBox box(renderer->ComputeVisiblePropBounds());
  const int* size = renderer->GetSize();
  if (!box.IsValid() || size[0] <= 0 || size[1] <= 0)
  {
    return {};
  }
  double centre[3];
  box.GetCenter(centre);
  const double height = std::max(box.GetLength(1), box.GetLength(0) * size[1] / size[0]);
  return { centre[0], centre[1], margin * height / 2.0 };
}

} // namespace

pqSonoFlatFit::pqSonoFlatFit(QObject* parent)
  : QObject(parent)
{
}

void pqSonoFlatFit::startup()
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(model, &pqServerManagerModel::viewAdded, this, [this](pqView* view) { watch(view); });
  QObject::connect(model, &pqServerManagerModel::viewRemoved, this, [this](pqView* view) { Views.remove(view); });
  for (pqView* view : model->findItems<pqView*>())
  {
    watch(view);
  }
}

void pqSonoFlatFit::watch(pqView* view)
{
  if (auto* render = qobject_cast<pqRenderView*>(view))
  {
    QObject::connect(render, &pqView::endRender, this, [this, render] { look(render); });
    vtkNew<CameraReset> reset;
    reset->happened = [this, view] { Views[view].wasReset = true; };
    render->getProxy()->AddObserver(vtkCommand::ResetCameraEvent, reset);
  }
}

void pqSonoFlatFit::look(pqRenderView* view)
{
  vtkRenderer* renderer = view->getRenderViewProxy()->GetRenderer();
  const Sight best = sonoIsFlatView(view->getProxy()) ? bestSight(renderer) : Sight();
  if (best.halfHeight <= 0.0)
  {
    return;
  }
  constexpr double sameMm = 1e-6;
  const Sight now = sightOf(renderer);
  Known& known = this->Views[view];
  // A camera that comes from elsewhere, as from a state, is ours where we would have put it.
  known.isOurs = known.wasReset || isAbout(now, known.isOurs ? known.left : best, known.isOurs ? sameMm : unnoticed);
  known.wasReset = false;
  known.left = now;
  if (known.isOurs && !isAbout(now, best, unnoticed))
  {
    QTimer::singleShot(0, view, [this, view] { fit(view); }); // it is being drawn just now
  }
}

void pqSonoFlatFit::fit(pqRenderView* view)
{
  const Sight best = bestSight(view->getRenderViewProxy()->GetRenderer());
  {
    SCOPED_UNDO_EXCLUDE();
    vtkSMProxy* proxy = view->getProxy();
    const double* position = view->getRenderViewProxy()->GetActiveCamera()->GetPosition();
    const double from[] = { best.x, best.y, position[2] };
    const double at[] = { best.x, best.y, 0.0 };
    vtkSMPropertyHelper(proxy, "CameraPosition").Set(from, 3);
    vtkSMPropertyHelper(proxy, "CameraFocalPoint").Set(at, 3);
    vtkSMPropertyHelper(proxy, "CameraParallelScale").Set(best.halfHeight);
    proxy->UpdateVTKObjects();
  }
  this->Views[view].left = best;
  view->render();
}
