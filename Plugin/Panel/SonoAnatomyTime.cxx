#include "SonoAnatomyTime.h"

#include "pqPipelineSource.h"
#include "pqServer.h"
#include "pqTimeKeeper.h"
#include "pqUndoStack.h"
#include "vtkNew.h"
#include "vtkSMParaViewPipelineController.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

pqTimeKeeper* sonoTimeKeeperOf(const pqPipelineSource* source)
{
  return source && source->getServer() ? source->getServer()->getTimeKeeper() : nullptr;
}

double sonoTimeOf(const pqPipelineSource* source)
{
  const pqTimeKeeper* keeper = sonoTimeKeeperOf(source);
  return keeper ? keeper->getTime() : 0.0;
}

void sonoSetTime(const pqPipelineSource* source, double time)
{
  if (pqTimeKeeper* keeper = sonoTimeKeeperOf(source))
  {
    SCOPED_UNDO_EXCLUDE();
    keeper->setTime(time);
  }
}

void sonoKeepTime(const pqPipelineSource* source)
{
  if (sonoTimeKeeperOf(source))
  {
    SCOPED_UNDO_EXCLUDE();
    vtkNew<vtkSMParaViewPipelineController> controller;
    vtkSMProxy* scene = controller->FindAnimationScene(source->getProxy()->GetSession());
    vtkSMPropertyHelper(scene, "AnimationTime").Set(sonoTimeOf(source));
    scene->UpdateVTKObjects();
  }
}
