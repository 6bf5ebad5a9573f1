#include "vtkSonoResultHandle.h"

#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"

#include <utility>

vtkStandardNewMacro(vtkSonoResultHandle);

namespace {

constexpr const char* handleName = "SonoResult";

std::vector<vtkMTimeType> timesOf(const std::vector<vtkAbstractArray*>& arrays)
{
  std::vector<vtkMTimeType> times;
  for (vtkAbstractArray* array : arrays)
  {
    times.push_back(array ? array->GetMTime() : 0);
  }
  return times;
}

} // namespace

vtkSonoResultHandle::vtkSonoResultHandle() = default;
vtkSonoResultHandle::~vtkSonoResultHandle() = default;

void vtkSonoResultHandle::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Result: " << (this->Result.has_value() ? "some" : "none") << endl;
}

void vtkSonoResultHandle::Attach(std::any result, const std::vector<vtkAbstractArray*>& arrays, vtkFieldData* field)
{
  vtkNew<vtkSonoResultHandle> handle;
  handle->SetName(handleName);
  handle->InsertNextValue("a stage's result, of this process");
  handle->Result = std::move(result);
  handle->Times = timesOf(arrays);
  field->AddArray(handle);
}

void vtkSonoResultHandle::Remove(vtkFieldData* field)
{
  field->RemoveArray(handleName);
}

const std::any* vtkSonoResultHandle::FindAny(const std::vector<vtkAbstractArray*>& arrays, vtkFieldData* field)
{
  auto* handle = vtkSonoResultHandle::SafeDownCast(field->GetAbstractArray(handleName));
  return handle && handle->Times == timesOf(arrays) ? &handle->Result : nullptr;
}

void vtkSonoResultHandle::DeepCopy(vtkAbstractArray* other)
{
  this->Superclass::DeepCopy(other);
  if (auto* handle = vtkSonoResultHandle::SafeDownCast(other))
  {
    this->Result = handle->Result;
    this->Times = handle->Times;
  }
}
