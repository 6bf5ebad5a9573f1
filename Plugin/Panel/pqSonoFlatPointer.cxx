#include "pqSonoFlatPointer.h"

#include "SonoCornerText.h"
#include "SonoFlatView.h"

#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"

#include <QApplication>

#include <functional>

namespace {

/// Of an interactor.
class PointerMoved : public vtkCommand
{
public:
  static PointerMoved* New() { return new PointerMoved; }
  void Execute(vtkObject*, unsigned long event, void*) override { happened(event); }

  std::function<void(unsigned long)> happened;
};

void say(const QString& sentence, QWidget* widget)
{
  sonoSayInCorner("SonoUnderPointer", Qt::BottomLeftCorner, sentence, "#e6e6e6", widget);
}

} // namespace

pqSonoFlatPointer::pqSonoFlatPointer(QObject* parent)
  : QObject(parent)
{
}

pqSonoFlatPointer::~pqSonoFlatPointer() = default;

void pqSonoFlatPointer::startup()
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(model, &pqServerManagerModel::viewAdded, this, [this](pqView* view) { watch(view); });
  QObject::connect(model, &pqServerManagerModel::preSourceRemoved, this, [this](pqPipelineSource* source) {
    if (pixel_ && vtkSMPropertyHelper(pixel_, "Input").GetAsProxy() == source->getProxy())
    {
      pixel_ = nullptr; // else it would hold the source
    }
  });
  QObject::connect(model, &pqServerManagerModel::preServerRemoved, this, [this] { pixel_ = nullptr; });
  for (pqView* view : model->findItems<pqView*>())
  {
    watch(view);
  }
}

void pqSonoFlatPointer::shutdown()
{
  pixel_ = nullptr;
}

void pqSonoFlatPointer::watch(pqView* view)
{
  auto* render = qobject_cast<pqRenderView*>(view);
  vtkRenderWindowInteractor* interactor = render ? render->getRenderViewProxy()->GetInteractor() : nullptr;
  if (!interactor)
  {
    return;
  }
  vtkNew<PointerMoved> moved;
  moved->happened = [this, render](unsigned long event) {
    event == vtkCommand::LeaveEvent ? say(QString(), render->widget()) : follow(render);
  };
  interactor->AddObserver(vtkCommand::MouseMoveEvent, moved);
  interactor->AddObserver(vtkCommand::LeaveEvent, moved);
}

void pqSonoFlatPointer::follow(pqRenderView* view)
{
  if (QApplication::mouseButtons() == Qt::NoButton)
  {
    say(sentenceAt(view), view->widget());
  }
}

QString pqSonoFlatPointer::sentenceAt(pqRenderView* view)
{
  const SonoShownImage shown = sonoFlatImageOf(view->getProxy());
  if (!shown.source)
  {
    return {};
  }
  const int* at = view->getRenderViewProxy()->GetInteractor()->GetEventPosition();
  vtkRenderer* renderer = view->getRenderViewProxy()->GetRenderer();
  renderer->SetDisplayPoint(at[0], at[1], 0.0);
  renderer->DisplayToWorld();
  const double* place = renderer->GetWorldPoint();

  SCOPED_UNDO_EXCLUDE();
  if (!pixel_ || vtkSMPropertyHelper(pixel_, "Input").GetAsProxy() != shown.source)
  {
    pixel_.TakeReference(
      vtkSMSourceProxy::SafeDownCast(shown.source->GetSessionProxyManager()->NewProxy("filters", "SonoFlatPixel")));
    vtkSMPropertyHelper(pixel_, "Input").Set(shown.source, shown.port);
  }
  vtkSMPropertyHelper(pixel_, "PlaceMm").Set(place, 2);
  pixel_->UpdateVTKObjects();
  pixel_->UpdatePropertyInformation();
  return QString::fromUtf8(vtkSMPropertyHelper(pixel_, "Sentence").GetAsString());
}
