#include "DataSets/ImageTensor.h"

#include <dlpack/dlpack.h>

#include <utility>

namespace sono {

namespace {

/// What the tensor points to.
struct Held
{
  DLManagedTensor tensor{};
  std::int64_t shape[2];
  DeviceBytes bytes;
  std::uintptr_t stream;
};

void giveBack(DLManagedTensor* tensor)
{
  const std::unique_ptr<Held> held(static_cast<Held*>(tensor->manager_ctx));
  giveBackAfter(std::move(held->bytes), held->stream);
}

} // namespace

DLManagedTensor* newTensor(DeviceBytes bytes, int height, int width, std::uintptr_t stream)
{
  auto* held = new Held{ {}, { height, width }, std::move(bytes), stream };
  DLTensor& tensor = held->tensor.dl_tensor;
  tensor.data = const_cast<std::uint8_t*>(held->bytes.data); // DLPack knows no constants
  tensor.device = { kDLCUDA, held->bytes.device };
  tensor.ndim = 2;
  tensor.dtype = { kDLUInt, 8, 1 };
  tensor.shape = held->shape;
  tensor.strides = nullptr; // rows one after the other
  tensor.byte_offset = 0;
  held->tensor.manager_ctx = held;
  held->tensor.deleter = giveBack;
  return &held->tensor;
}

void deleteTensor(DLManagedTensor* tensor)
{
  tensor->deleter(tensor);
}

} // namespace sono
