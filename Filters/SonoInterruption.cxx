#include "SonoInterruption.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkDataObjectCollection.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkInformation.h"
#include "vtkInformationObjectBaseKey.h"
#include "vtkInformationUnsignedLongKey.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <atomic>

namespace sono {
namespace {

std::atomic<Interrupter*> current{ nullptr };

/// What the filter has made last, one data object a port.
vtkInformationObjectBaseKey* madeKey()
{
  static auto* const key = vtkInformationObjectBaseKey::MakeKey("MADE", "SonoVDB");
  return key;
}

/// The state of the pipeline in which the filter was stopped.
vtkInformationUnsignedLongKey* stoppedAtKey()
{
  static auto* const key = vtkInformationUnsignedLongKey::MakeKey("STOPPED_AT", "SonoVDB");
  return key;
}

/// As of this update's beginning; grows when the filter, anything upstream or the input's data change.
unsigned long stateOf(vtkAlgorithm* filter)
{
  auto* pipeline = vtkDemandDrivenPipeline::SafeDownCast(filter->GetExecutive());
  unsigned long state = pipeline ? pipeline->GetPipelineMTime() : filter->GetMTime();
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < filter->GetNumberOfInputConnections(port); ++i)
    {
      if (vtkDataObject* data = filter->GetInputDataObject(port, i))
      {
        state = std::max<unsigned long>(state, data->GetUpdateTime());
      }
    }
  }
  return state;
}

void showMade(vtkAlgorithm* filter, vtkInformationVector* outputs)
{
  auto* made = vtkDataObjectCollection::SafeDownCast(filter->GetInformation()->Get(madeKey()));
  if (!made)
  {
    filter->SetAbortOutput(true); // empty, and so is what is downstream
    return;
  }
  for (int port = 0; port < made->GetNumberOfItems(); ++port)
  {
    vtkDataObject::GetData(outputs, port)->ShallowCopy(made->GetItem(port));
  }
}

void rememberStop(vtkAlgorithm* filter)
{
  // Marking the outputs as aborted counts as a change of the filter.
  const unsigned long state = std::max<unsigned long>(stateOf(filter), filter->GetMTime());
  filter->GetInformation()->Set(stoppedAtKey(), state);
}

} // namespace

Interrupter::~Interrupter() = default;

void setInterrupter(Interrupter* interrupter)
{
  current = interrupter;
}

bool stopIsWanted()
{
  Interrupter* const interrupter = current;
  return interrupter && interrupter->wantsStop();
}

void keepMade(vtkAlgorithm* filter, vtkInformationVector* outputs)
{
  Interrupter* const interrupter = current;
  if (!interrupter)
  {
    return;
  }
  vtkNew<vtkDataObjectCollection> made;
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject* output = vtkDataObject::GetData(outputs, port);
    const auto copy = vtk::TakeSmartPointer(output->NewInstance());
    copy->ShallowCopy(output);
    made->AddItem(copy);
  }
  filter->GetInformation()->Set(madeKey(), made);
  interrupter->hasFinished(filter);
}

void standStill(vtkAlgorithm* filter, vtkInformationVector* outputs)
{
  showMade(filter, outputs);
  rememberStop(filter);
  if (Interrupter* const interrupter = current)
  {
    interrupter->hasStopped(filter);
  }
}

bool standsStill(vtkAlgorithm* filter, vtkInformationVector* outputs)
{
  vtkInformation* memory = filter->GetInformation();
  if (!memory->Has(stoppedAtKey()))
  {
    return false;
  }
  if (memory->Get(stoppedAtKey()) != stateOf(filter))
  {
    memory->Remove(stoppedAtKey());
    return false;
  }
  showMade(filter, outputs);
  rememberStop(filter);
  return true;
}

} // namespace sono
