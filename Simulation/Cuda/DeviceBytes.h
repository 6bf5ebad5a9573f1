#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace sono {

struct DeviceLane;

/// Bytes in a GPU's memory, for programs of the same process that read them there. They stay as they are while somebody
/// holds them.
struct DeviceBytes
{
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
  int device = 0; ///< CUDA's number
  std::shared_ptr<const void> memory;
  DeviceLane* lane = nullptr; ///< to which it goes back
};

/// Gives them back: their memory is used again once all is done that a stream (CUDA's handle of it; 1: the default one)
/// has been asked for until now. From any thread.
void giveBackAfter(DeviceBytes bytes, std::uintptr_t stream);

} // namespace sono
