#include "SonoInterruption.h"

#include "vtkAbstractArray.h"
#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkDataObjectCollection.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationObjectBaseKey.h"
#include "vtkInformationUnsignedLongKey.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
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

/// The state of the pipeline in which the filter was stopped or failed.
vtkInformationUnsignedLongKey* standsAtKey()
{
  static auto* const key = vtkInformationUnsignedLongKey::MakeKey("STANDS_AT", "SonoVDB");
  return key;
}

/// When the youngest part of some data was made. The time of a data object itself does not tell: ParaView makes a new
/// shallow copy of the same data for each run.
unsigned long ageOf(vtkDataObject* data)
{
  unsigned long age = 0;
  for (int kind = 0; kind < vtkDataObject::NUMBER_OF_ATTRIBUTE_TYPES; ++kind)
  {
    vtkFieldData* arrays = data->GetAttributesAsFieldData(kind);
    for (int i = 0; arrays && i < arrays->GetNumberOfArrays(); ++i)
    {
      age = std::max<unsigned long>(age, arrays->GetAbstractArray(i)->GetMTime());
    }
  }
  auto* shape = vtkPointSet::SafeDownCast(data);
  return shape && shape->GetPoints() ? std::max<unsigned long>(age, shape->GetPoints()->GetMTime()) : age;
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
        state = std::max(state, ageOf(data));
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

void rememberState(vtkAlgorithm* filter)
{
  // Marking the outputs as aborted counts as a change of the filter.
  const unsigned long state = std::max<unsigned long>(stateOf(filter), filter->GetMTime());
  filter->GetInformation()->Set(standsAtKey(), state);
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
  rememberState(filter);
  if (Interrupter* const interrupter = current)
  {
    interrupter->hasStopped(filter);
  }
}

void standEmpty(vtkAlgorithm* filter)
{
  filter->GetInformation()->Remove(madeKey());
  filter->SetAbortOutput(true);
  rememberState(filter);
}

bool standsStill(vtkAlgorithm* filter, vtkInformationVector* outputs)
{
  vtkInformation* memory = filter->GetInformation();
  if (!memory->Has(standsAtKey()))
  {
    return false;
  }
  if (memory->Get(standsAtKey()) != stateOf(filter))
  {
    memory->Remove(standsAtKey());
    return false;
  }
  showMade(filter, outputs);
  rememberState(filter);
  return true;
}

} // namespace sono
