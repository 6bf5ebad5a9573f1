#include "SonoPhases.h"

#include "SonoUltrasoundHere.h"

#include "pqUndoStack.h"
#include "vtkAlgorithm.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSonoLabelMapReader.h"
#include "vtkSonoPhasesAhead.h"
#include "vtkSonoThoraxSource.h"

namespace {

/// Of sources and filters alike: unregistered, of the same settings, connected to nothing.
vtkSmartPointer<vtkSMProxy> secondOf(vtkSMProxy* first)
{
  auto second = vtkSmartPointer<vtkSMProxy>::Take(
    first->GetSessionProxyManager()->NewProxy(first->GetXMLGroup(), first->GetXMLName()));
  second->Copy(first, "vtkSMInputProperty");
  return second;
}

} // namespace

SonoPhases::SonoPhases() = default;
SonoPhases::~SonoPhases() = default;

std::unique_ptr<SonoPhases> SonoPhases::begin(vtkSMProxy* ultrasound)
{
  vtkSMProxy* labels = vtkSMPropertyHelper(ultrasound, "Input").GetAsProxy();
  auto* filter = sonoUltrasoundHere(ultrasound);
  auto* source = labels ? vtkAlgorithm::SafeDownCast(labels->GetClientSideObject()) : nullptr;
  if (!filter || !(vtkSonoThoraxSource::SafeDownCast(source) || vtkSonoLabelMapReader::SafeDownCast(source)))
  {
    return nullptr;
  }
  SCOPED_UNDO_EXCLUDE();
  std::unique_ptr<SonoPhases> phases(new SonoPhases);
  phases->source_ = secondOf(labels);
  phases->ultrasound_ = secondOf(ultrasound);
  vtkSMPropertyHelper(phases->ultrasound_, "PresetFile").Set("");
  for (const auto& [name, value] : { std::pair("Preview", 1), std::pair("ErrorMap", 0),
                                     std::pair("NumberOfShownPaths", 0), std::pair("Progressive", 0) })
  {
    vtkSMPropertyHelper(phases->ultrasound_, name).Set(value);
  }
  phases->source_->UpdateVTKObjects();
  phases->ultrasound_->UpdateVTKObjects();
  phases->work_ = vtkSmartPointer<vtkSonoPhasesAhead>::New();
  phases->work_->Begin(source, filter, vtkAlgorithm::SafeDownCast(phases->source_->GetClientSideObject()),
                       sonoUltrasoundHere(phases->ultrasound_));
  return phases;
}
