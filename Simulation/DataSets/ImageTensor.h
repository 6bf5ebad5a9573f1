#pragma once

#include "Cuda/DeviceBytes.h"

struct DLManagedTensor;

namespace sono {

/// Height x width bytes, rows one after the other, as DLPack hands them from one program to another (a tensor of uint8
/// on a GPU). Whoever takes it calls its deleter, which gives the bytes back after all that `stream` was asked for (see
/// giveBackAfter).
DLManagedTensor* newTensor(DeviceBytes bytes, int height, int width, std::uintptr_t stream);
/// Of one that nobody has taken.
void deleteTensor(DLManagedTensor* tensor);

} // namespace sono
