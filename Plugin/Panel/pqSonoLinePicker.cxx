#include "pqSonoLinePicker.h"

#include "SonoPickLine.h"
#include "SonoTracePoint.h"

#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"

#include <cstdlib>
#include <functional>

namespace {

/// Hands an interactor's event to a function.
class Ear : public vtkCommand
{
public:
  static Ear* New() { return new Ear; }
  void Execute(vtkObject* caller, unsigned long event, void*) override { hear(caller, event); }

  std::function<void(vtkObject*, unsigned long)> hear;
};

} // namespace

pqSonoLinePicker::pqSonoLinePicker(QObject* parent)
  : QObject(parent)
{
}

void pqSonoLinePicker::startup()
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  this->connect(model, &pqServerManagerModel::viewAdded, this, [this](pqView* view) { watch(view); });
  for (pqView* view : model->findItems<pqView*>())
  {
    watch(view);
  }
}

void pqSonoLinePicker::watch(pqView* view)
{
  auto* shown = qobject_cast<pqRenderView*>(view);
  vtkRenderWindowInteractor* interactor = shown ? shown->getRenderViewProxy()->GetInteractor() : nullptr;
  if (!interactor)
  {
    return;
  }
  vtkNew<Ear> ear;
  ear->hear = [this, view](vtkObject* caller, unsigned long event) {
    event == vtkCommand::LeftButtonPressEvent ? press(caller) : release(caller, view);
  };
  interactor->AddObserver(vtkCommand::LeftButtonPressEvent, ear);
  interactor->AddObserver(vtkCommand::LeftButtonReleaseEvent, ear);
}

void pqSonoLinePicker::press(vtkObject* interactor)
{
  vtkRenderWindowInteractor::SafeDownCast(interactor)->GetEventPosition(pressedAt_);
}

void pqSonoLinePicker::release(vtkObject* caller, pqView* view)
{
  constexpr int trembling = 2; // pixels that a hand moves without meaning it
  auto* interactor = vtkRenderWindowInteractor::SafeDownCast(caller);
  const int* at = interactor->GetEventPosition();
  const bool isClick = std::abs(at[0] - pressedAt_[0]) <= trembling && std::abs(at[1] - pressedAt_[1]) <= trembling;
  pressedAt_[0] = pressedAt_[1] = -1000; // a release whose press a widget took is none of ours
  if (!isClick || interactor->GetShiftKey() || interactor->GetControlKey())
  {
    return;
  }
  const pqPipelineSource* active = pqActiveObjects::instance().activeSource();
  if (active && sonoTracePoint(vtkSMSourceProxy::SafeDownCast(active->getProxy()),
                               vtkSMRenderViewProxy::SafeDownCast(view->getProxy()), at[0], at[1]))
  {
    pqApplicationCore::instance()->render();
    return;
  }
  const SonoPickedLine picked = sonoPickLine(vtkSMRenderViewProxy::SafeDownCast(view->getProxy()), at[0], at[1]);
  if (!picked.plot || vtkSMPropertyHelper(picked.plot, "Line").GetAsInt() == picked.line)
  {
    return;
  }
  {
    // One step of undo; but looking at a line does not take away what may still be done again.
    pqUndoStack* steps = pqApplicationCore::instance()->getUndoStack();
    const bool isStep = steps && !steps->canRedo();
    isStep ? BEGIN_UNDO_SET(tr("Pick Scan Line")) : BEGIN_UNDO_EXCLUDE();
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", picked.plot);
    vtkSMPropertyHelper(picked.plot, "Line").Set(picked.line);
    picked.plot->UpdateVTKObjects();
    isStep ? END_UNDO_SET() : END_UNDO_EXCLUDE();
  }
  pqApplicationCore::instance()->render();
}
