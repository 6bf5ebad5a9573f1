#pragma once

#include "Core/SharedSpan.h"

#include "vtkSmartPointer.h"

#include <memory>

namespace sono {

/// Keeps `owner` until VTK frees the memory at `at` by freeShared.
void keepShared(const void* at, std::shared_ptr<const void> owner);
void freeShared(void* at);

/// Values as an array that does not copy them.
template<class Array, class T>
vtkSmartPointer<Array> sharedArray(const char* name, const SharedSpan<T>& values)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  // An array of VTK has no const values; what they belong to is not written through it.
  T* data = const_cast<T*>(values.data.get());
  keepShared(data, values.data);
  array->SetArray(data, static_cast<vtkIdType>(values.size), 0, Array::VTK_DATA_ARRAY_USER_DEFINED);
  array->SetArrayFreeFunction(freeShared);
  return array;
}

} // namespace sono
