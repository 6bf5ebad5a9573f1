#include "SonoInterruption.h"

#include "vtkAbstractArray.h"
#include "vtkAlgorithm.h"
#include "vtkCompositeDataSet.h"
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
#include <thread>

namespace sono {
namespace {

std::atomic<Interrupter*> current{ nullptr };
std::atomic<std::thread::id> thread{};

/// Null on another thread than its own.
Interrupter* interrupterHere()
{
  return thread.load() == std::this_thread::get_id() ? current.load() : nullptr;
}

/// The outputs of the filter's last complete run, one data object a port.
vtkInformationObjectBaseKey* keptKey()
{
  static auto* const key = vtkInformationObjectBaseKey::MakeKey("KEPT_OUTPUTS", "SonoVDB");
  return key;
}

/// Of one of these, the output's time when it was copied.
vtkInformationUnsignedLongKey* keptAtKey()
{
  static auto* const key = vtkInformationUnsignedLongKey::MakeKey("KEPT_AT", "SonoVDB");
  return key;
}

/// The state of the pipeline (see stateOf) in which the filter was suspended: stopped, or failed.
vtkInformationUnsignedLongKey* suspendedAtKey()
{
  static auto* const key = vtkInformationUnsignedLongKey::MakeKey("SUSPENDED_AT", "SonoVDB");
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

/// Of data in blocks the blocks themselves: an anatomy has a hundred, and nothing changes them.
void share(vtkDataObject* from, vtkDataObject* to)
{
  auto* blocks = vtkCompositeDataSet::SafeDownCast(to);
  blocks ? blocks->CompositeShallowCopy(vtkCompositeDataSet::SafeDownCast(from)) : to->ShallowCopy(from);
}

void copyKept(vtkAlgorithm* filter, vtkInformationVector* outputs)
{
  auto* kept = vtkDataObjectCollection::SafeDownCast(filter->GetInformation()->Get(keptKey()));
  if (!kept)
  {
    filter->SetAbortOutput(true); // empty, and so is what is downstream
    return;
  }
  for (int port = 0; port < kept->GetNumberOfItems(); ++port)
  {
    share(kept->GetItem(port), vtkDataObject::GetData(outputs, port));
  }
}

void rememberState(vtkAlgorithm* filter)
{
  // Marking the outputs as aborted counts as a change of the filter.
  const unsigned long state = std::max<unsigned long>(stateOf(filter), filter->GetMTime());
  filter->GetInformation()->Set(suspendedAtKey(), state);
}

} // namespace

Interrupter::~Interrupter() = default;

void setInterrupter(Interrupter* interrupter)
{
  thread = std::this_thread::get_id();
  current = interrupter;
}

bool stopIsWanted()
{
  Interrupter* const interrupter = interrupterHere();
  return interrupter && interrupter->wantsStop();
}

void keepOutputs(vtkAlgorithm* filter, vtkInformationVector* outputs)
{
  Interrupter* const interrupter = interrupterHere();
  if (!interrupter)
  {
    return;
  }
  auto* before = vtkDataObjectCollection::SafeDownCast(filter->GetInformation()->Get(keptKey()));
  vtkNew<vtkDataObjectCollection> kept;
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject* output = vtkDataObject::GetData(outputs, port);
    const unsigned long time = output->GetMTime();
    vtkDataObject* last = before ? before->GetItem(port) : nullptr;
    if (last && last->GetInformation()->Get(keptAtKey()) == time)
    {
      kept->AddItem(last); // a run makes some of the outputs and leaves the others
      continue;
    }
    const auto copy = vtk::TakeSmartPointer(output->NewInstance());
    share(output, copy);
    copy->GetInformation()->Set(keptAtKey(), time);
    kept->AddItem(copy);
  }
  filter->GetInformation()->Set(keptKey(), kept);
  interrupter->hasFinished(filter);
}

void restoreOutputs(vtkAlgorithm* filter, vtkInformationVector* outputs)
{
  copyKept(filter, outputs);
  rememberState(filter);
  if (Interrupter* const interrupter = interrupterHere())
  {
    interrupter->hasStopped(filter);
  }
}

void abortOutputs(vtkAlgorithm* filter)
{
  filter->GetInformation()->Remove(keptKey());
  filter->SetAbortOutput(true);
  rememberState(filter);
}

bool staysSuspended(vtkAlgorithm* filter, vtkInformationVector* outputs)
{
  vtkInformation* memory = filter->GetInformation();
  if (!memory->Has(suspendedAtKey()))
  {
    return false;
  }
  if (memory->Get(suspendedAtKey()) != stateOf(filter))
  {
    memory->Remove(suspendedAtKey());
    return false;
  }
  copyKept(filter, outputs);
  rememberState(filter);
  return true;
}

} // namespace sono
