#include "SonoProbePaths.h"

#include "SonoMakeSource.h"
#include "SonoPipelineItem.h"
#include "SonoViewsInSpace.h"

#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqUndoStack.h"
#include "vtkNew.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewProxy.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace {

constexpr std::size_t numbersPerPose = 10;

/// What both have by the same name, but for what they are connected to.
void copySettings(vtkSMProxy* from, vtkSMProxy* to, const std::set<std::string>& butNot)
{
  const auto each = vtkSmartPointer<vtkSMPropertyIterator>::Take(to->NewPropertyIterator());
  for (each->Begin(); !each->IsAtEnd(); each->Next())
  {
    vtkSMProperty* found = from->GetProperty(each->GetKey());
    if (found && !found->GetInformationOnly() && butNot.count(each->GetKey()) == 0)
    {
      each->GetProperty()->Copy(found);
    }
  }
  to->UpdateVTKObjects();
}

/// The same direction as a mixture of two, of any length.
void mix(const double* a, const double* b, double share, double* mixed)
{
  for (int i = 0; i < 3; ++i)
  {
    mixed[i] = (1.0 - share) * a[i] + share * b[i];
  }
}

} // namespace

pqPipelineSource* sonoMakePath(const std::vector<SonoTimedPose>& poses, pqPipelineSource* ultrasound)
{
  SCOPED_UNDO_SET(QObject::tr("Record Probe Path"));
  std::vector<double> numbers;
  for (const SonoTimedPose& pose : poses)
  {
    numbers.push_back(pose.timeS);
    numbers.insert(numbers.end(), pose.pose.begin(), pose.pose.end());
  }
  vtkSMProxy* from = ultrasound->getProxy();
  vtkSMSourceProxy* path =
    sonoMakeSource(from->GetSessionProxyManager(), "sources", "SonoProbePath", [&](vtkSMSourceProxy* made) {
      vtkSMPropertyHelper(made, "Poses").Set(numbers.data(), static_cast<unsigned int>(numbers.size()));
    });
  path->UpdatePipeline();
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  for (pqRenderView* view : sonoViewsInSpace(vtkSMSourceProxy::SafeDownCast(from)))
  {
    controller->Show(path, 0, view->getViewProxy());
    view->render();
  }
  pqPipelineSource* made = sonoPipelineItem(path);
  made->setModifiedState(pqProxy::UNMODIFIED); // nothing is left to apply
  return made;
}

std::vector<SonoTimedPose> sonoPathOf(pqPipelineSource* path)
{
  const std::vector<double> numbers = vtkSMPropertyHelper(path->getProxy(), "Poses").GetDoubleArray();
  std::vector<SonoTimedPose> poses(numbers.size() / numbersPerPose);
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    const double* first = numbers.data() + i * numbersPerPose;
    poses[i].timeS = first[0];
    std::copy(first + 1, first + numbersPerPose, poses[i].pose.begin());
  }
  return poses;
}

std::array<double, 9> sonoPoseAt(const std::vector<SonoTimedPose>& poses, double timeS)
{
  const auto after = std::upper_bound(poses.begin(), poses.end(), timeS,
                                      [](double at, const SonoTimedPose& pose) { return at < pose.timeS; });
  if (after == poses.begin() || after == poses.end())
  {
    return after == poses.begin() ? poses.front().pose : poses.back().pose;
  }
  const SonoTimedPose& one = *(after - 1);
  const double share = (timeS - one.timeS) / (after->timeS - one.timeS);
  std::array<double, 9> between{};
  for (std::size_t part = 0; part < between.size(); part += 3)
  {
    mix(&one.pose[part], &after->pose[part], share, &between[part]);
  }
  return between;
}

pqPipelineSource* sonoMakeSweep(pqPipelineSource* path, pqPipelineSource* ultrasound)
{
  SCOPED_UNDO_SET(QObject::tr("Sweep along Probe Path"));
  vtkSMProxy* from = ultrasound->getProxy();
  vtkSMSessionProxyManager* manager = from->GetSessionProxyManager();
  vtkSMSourceProxy* probe = sonoMakeSource(manager, "sources", "SonoProbeSource", [from](vtkSMSourceProxy* made) {
    copySettings(from, made, { "Preview", "PrepareInteraction" });
  });
  sonoPipelineItem(probe)->setModifiedState(pqProxy::UNMODIFIED);
  vtkSMSourceProxy* sweep = sonoMakeSource(manager, "filters", "SonoSweep", [&](vtkSMSourceProxy* made) {
    made->GetProperty("Input")->Copy(from->GetProperty("Input"));
    vtkSMPropertyHelper(made, "Probe").Set(probe);
    vtkSMPropertyHelper(made, "Poses").Set(path->getProxy());
    copySettings(from, made, { "Input", "Probe", "Poses" });
  });
  return sonoPipelineItem(sweep);
}
